#!/usr/bin/env python3
"""tests/kernels/vector_symbols_test.py NM BUILD_TYPE PATH OBJECT... - the objects that are compiled for wider vectors share no code.

Of functions that several objects define (inline ones, instances of templates) the linker keeps any one. Were it the one with
instructions of the wide path, the program would crash on a processor without them, wherever else the function is used. So every
such symbol must belong to this path alone: its loop, or a function of its packs. Exit code 77: skipped."""
import subprocess
import sys

PACKS = {"avx2": "simd_abi::_VecBuiltin<32>", "avx512": "simd_abi::_VecBltnBtmsk<64>"}   # of std::experimental::simd
NUMBER = {"avx2": 2, "avx512": 3}                                                       # VectorPath in engine/vector_path.h
LOOPS = {"PairForces": "run", "WallForces": "run", "ContactSweep": "run", "Surroundings": "near", "VerletStep": "run", "VelocityUpdate": "run"}
NOT_CODE = {"DW.ref.__gxx_personality_v0"}                                              # a pointer


def main(nm, build_type, path, *objects):
    if build_type == "Debug":
        print("skipped: a Debug build inlines nothing; its vector paths are for processors that have them")
        sys.exit(77)
    loops, shared = 0, []
    for symbol in subprocess.run([nm, "-C", *objects], check=True, capture_output=True, text=True).stdout.splitlines():
        kind, _, name = symbol[17:].partition(" ")              # after the address
        if kind not in ("W", "V", "u"):
            continue
        ours = any(f"skred::{of}<" in name and f"::{run}<(skred::VectorPath){NUMBER[path]}>(" in name for of, run in LOOPS.items())
        loops += ours
        if not ours and PACKS[path] not in name and name not in NOT_CODE:
            shared.append(name)
    assert loops, f"no loop of {path} in {objects}"
    if shared:
        sys.exit(f"{len(shared)} functions of {path} that the linker may give to others:\n" + "\n".join(shared))
    print(f"{path}: {loops} loops, nothing shared")


main(*sys.argv[1:])
