#!/usr/bin/env python3
"""tests/profiling/peers_test.py - the comparison with other codes (profiling/bench/peers), with stand-ins for all programs.

Usage: peers_test.py list | CASE ... . Exit code 77: numpy or h5py is missing."""
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

PEERS = Path(__file__).resolve().parents[2] / "profiling/bench/peers"
sys.path.insert(0, str(PEERS))
sys.dont_write_bytecode = True

# Writes a log as LAMMPS does, of 1000 particles. @WORDS@ are replaced.
LAMMPS = """#!/bin/bash
[[ $1 == -h ]] && { echo 'LAMMPS - 29 Sep 2021 - Update 2'; echo 'Compiler: none'; exit; }
input=$2 log=$4 steps=0
grep -q 'read_data .*bed-1k.data' "$input" || exit 9
cp "$input" "$PEERS_INPUT"
{
  for n in $(sed -n 's/^run //p' "$input"); do
    steps=$((steps + n))
    if ((n == 1)); then echo "   $steps @ATOMS@ @CONTACTS@ 0.01"; else echo "   $steps @ATOMS@"; fi
    echo "Loop time of @SECONDS@ on 1 procs for $n steps with 1000 atoms"
    echo "Neighbor list builds = $n"
    echo "Dangerous builds = 0"
  done
  echo '@LAST@'
} >"$log"
exit @CODE@
"""

SKRED = """#!/bin/bash
[[ $1 == --version ]] && { echo 'skred 9'; exit; }
while (($# > 1)); do [[ $1 == --json ]] && json=$2; [[ $1 == --steps ]] && steps=$2; shift; done
cat >"$json" <<END
{"scenes": [{"name": "bed-1k", "particles": 1000, "timings": [{"particle_steps_per_second": {"median": 8e6}, "steps": $steps,
  "seconds_per_step": {"median": 1.25e-4}, "contacts_per_particle": 5.0, "searches": 3}]}]}
END
"""


def executable(name, text):
    Path(name).write_text(text)
    os.chmod(name, 0o755)
    return str(Path(name).absolute())


def lammps(name="lammps", seconds=0.5, contacts=5.1, atoms=1000, last="", code=0):
    text = LAMMPS
    for word, value in (("SECONDS", seconds), ("CONTACTS", contacts), ("ATOMS", atoms), ("LAST", last), ("CODE", code)):
        text = text.replace(f"@{word}@", str(value))
    return executable(name, text)


def state(n=1000, name="bed-1k"):
    import h5py
    import numpy as np
    os.makedirs("states", exist_ok=True)
    numbers = np.random.default_rng(1)
    with h5py.File(f"states/{name}-1.h5", "w") as file:
        file["position"] = numbers.uniform(-0.01, 0.3, (n, 3))
        file["velocity"] = numbers.normal(size=(n, 3))
        file["angular_velocity"] = numbers.normal(size=(n, 3))
        file["radius"] = np.full(n, 0.00636665)


def compare(*options, code=0):
    done = subprocess.run([sys.executable, PEERS / "compare", "--skred", executable("skred", SKRED), "--liggghts", "", "--states", "states",
                           "--scenes", "bed-1k", "--processes", "1", "--repeats", "2", "--seconds", "0.1", "--folder", "work",
                           "--json", "out.json", "--markdown", "out.md", "--quiet", "99", *options], capture_output=True, text=True, check=False,
                          env=os.environ | {"PEERS_INPUT": str(Path("input").absolute())})
    assert done.returncode == code, done.stdout + done.stderr
    return done


def case_ratio_of_what_was_measured():
    state()
    compare("--lammps", lammps(seconds=0.5))
    whole = json.loads(Path("out.json").read_text())
    assert [run["code"] for run in whole["runs"]] == ["Skred", "LAMMPS", "LAMMPS", "Skred"], "the order is not rotated"
    (row,) = whole["summary"]
    assert row["codes"]["LAMMPS"]["rate"] == [2e6] * 3 and row["codes"]["LAMMPS"]["contacts"] == 5.1, row
    assert row["ratios"] == {"LAMMPS": [4.0] * 3} and row["best_peer"] == "LAMMPS"
    text = Path("out.md").read_text()
    assert "| bed-1k | 1000 | 1 | 1000 | 5.00, 5.10 | 8.00 (8.00-8.00) | 2.00 (2.00-2.00) | 4.00 (4.00-4.00) |" in text, text
    again = subprocess.run([sys.executable, PEERS / "compare", "--from", "out.json"], capture_output=True, text=True, check=True)
    assert again.stdout == text


def case_best_peer():
    state()
    compare("--lammps", f"slow={lammps('slow', seconds=1)},fast={lammps('fast', seconds=0.25)}")
    (row,) = json.loads(Path("out.json").read_text())["summary"]
    assert row["best_peer"] == "fast" and row["ratios"] == {"slow": [8.0] * 3, "fast": [2.0] * 3}, row


def case_bad_runs_are_told_and_left_out():
    state()
    for bad, words in (({"code": 3}, "exit code 3"), ({"atoms": 998}, "2 particles lost"), ({"last": "ERROR: Lost"}, "ERROR: Lost"),
                       ({"contacts": 5.2}, "5.200 contacts per particle, Skred has 5.000"), ({"contacts": "nan"}, "nan contacts")):
        compare("--lammps", lammps(**bad))
        told = [run["problems"] for run in json.loads(Path("out.json").read_text())["runs"] if run["code"] == "LAMMPS"]
        assert len(told) == 2 and all(words in " ".join(problems) for problems in told), (words, told)
        text = Path("out.md").read_text()
        assert words in text and "| 8.00 (8.00-8.00) | failed |" in text, text


def case_disturbed_runs_give_way():
    import report
    from codes import Result

    def result(code, repeat, rate, others):
        return Result(code, "drum", 2, repeat, rate=rate, contacts=4, others=others)

    runs = [result("Skred", 0, 8, 0), result("Skred", 1, 1, 0.9), result("Skred", 2, 6, 0), result("LAMMPS", 0, 4, 0), result("LAMMPS", 1, 1, 0),
            result("LAMMPS", 2, 1, 0.9), result("LIGGGHTS", 0, 2, 0.9)]
    (row,) = report.summary(runs, quiet=0.2)
    assert row["ratios"] == {"LAMMPS": (2, 2, 2), "LIGGGHTS": (4, 4, 4)} and row["codes"]["Skred"]["rate"] == (7, 6, 8), row


def case_input_of_lammps():
    import numpy as np
    state()
    compare("--lammps", lammps())
    lines = Path("input").read_text().splitlines()
    assert [line for line in lines if line.startswith("run")] == ["run 99", "run 1", "run 1000", "run 1"]
    assert "fix gravity all gravity 9.81 vector 0.438371146789077 0 -0.898794046299167" in lines and "boundary p p f" in lines
    data = Path("work/bed-1k.data").read_text().splitlines()
    rows = np.array([line.split() for line in data[data.index("Atoms") + 2 : data.index("Velocities") - 1]], float)
    assert rows.shape == (1000, 7) and (rows[:, 4:6] >= 0).all() and (rows[:, 4:6] < 10 * 2.06 * 0.00636665).all()


def case_drum_is_turned_properly():
    import numpy as np
    import states
    r, v = np.random.default_rng(2).normal(size=(2, 5, 3))
    drum = states.for_peers(states.SCENES["drum"], states.State(r, v, np.cross(r, v)))
    assert np.allclose(np.cross(drum.position, drum.velocity), drum.spin), "no proper rotation"
    axes = np.eye(3)                    # x, y, z of Skred: the drum turns about y, up is z
    turned = states.for_peers(states.SCENES["drum"], states.State(axes, axes, axes)).position
    assert turned.tolist() == [[-1, 0, 0], [0, 0, 1], [0, 1, 0]]


def case_cylinder_of_triangles():
    import numpy as np
    import states
    states.write_cylinder("wall.stl", 0.2, -0.1, 0.3, 96, 4)
    corners = np.array([line.split()[1:] for line in Path("wall.stl").read_text().splitlines() if line.startswith("vertex")], float)
    triangles = corners.reshape(-1, 3, 3)
    normal = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    middle = triangles.mean(axis=1)
    assert len(triangles) == 96 * 4 * 2 and ((normal * middle)[:, :2].sum(axis=1) < 0).all(), "normals point outwards"
    assert abs(np.linalg.norm(normal, axis=1).sum() / 2 / (2 * np.pi * 0.2 * 0.4) - 1) < 1e-3


def case_errors():
    assert "no-such-program: no such program" in compare("--lammps", "no-such-program", code=1).stderr
    assert "--settle-only" in compare("--lammps", lammps(), code=1).stderr
    assert "no scene sea" in compare("--scenes", "sea", code=1).stderr


def sweeps(*options, code=0):
    """With a compiler that makes programs which found 2 million contact sweeps a second."""
    executable("counter", """#!/bin/bash
[[ $1 == column && $3 == 50 && $(wc -w <"$2") == $((11000 * 6)) ]] || exit 9
echo '{"contacts": 23000, "contact_sweeps_per_second": 2e6}'
""")
    os.makedirs("bin", exist_ok=True)
    executable("bin/g++", f"""#!/bin/bash
while [[ $1 != -o ]]; do shift; done
cp {Path("counter").absolute()} "$2"
""")
    skred = executable("skred", """#!/bin/bash
[[ " $* " == *" --set solver.iterations=50 --set solver.tolerance=0 "* ]] || exit 9
while (($# > 1)); do [[ $1 == --output ]] && output=$2; shift; done
mkdir -p "$output"
echo '{"iterations": 50, "steps": 3, "contact_sweeps": 3000000, "seconds_per_sweep": 0.001}' >"$output/summary.json"
""")
    done = subprocess.run([sys.executable, PEERS / "sweeps", "--skred", skred, "--states", "states", "--scenes", "column-11k", "--repeats", "2",
                           *options], capture_output=True, text=True, check=False, env=os.environ | {"PATH": f"{Path('bin').absolute()}:{os.environ['PATH']}"})
    assert done.returncode == code, done.stdout + done.stderr
    return done


def case_sweeps_in_turn():
    state(11000, "column-11k")
    done = sweeps()
    assert [line.split()[1] for line in done.stderr.splitlines()] == ["Skred", "Bullet", "Siconos", "Bullet", "Siconos", "Skred"], done.stderr
    assert "| column-11k | Skred | 20000 | 20 (20 - 20) |  |" in done.stdout, done.stdout
    assert "| column-11k | Siconos | 23000 | 2 (2 - 2) | 10 (10 - 10) |" in done.stdout, done.stdout
    assert "a drum or a column" in sweeps("--scenes", "bed-1k", code=1).stderr


def main():
    cases = {name.removeprefix("case_"): case for name, case in globals().items() if name.startswith("case_")}
    if sys.argv[1:] == ["list"]:
        print("\n".join(cases))
        return
    try:
        import h5py, numpy  # noqa: F401
    except ImportError as missing:
        print(missing)
        sys.exit(77)
    for name in sys.argv[1:] or cases:
        with tempfile.TemporaryDirectory() as folder:
            os.chdir(folder)
            cases[name]()
            os.chdir("/")
        print("passed:", name)


main()
