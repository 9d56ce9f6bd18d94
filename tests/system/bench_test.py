#!/usr/bin/env python3
"""tests/system/bench_test.py - what `skred bench` measures and says: see program.py. How fast it was is no test's business."""
import csv
import io
import os
import re
import signal

from program import SMALL, contains, h5py, json, main, read, scene, vector_paths, wait_for, write

QUICK = ["bench", "--states", "states", "--threads", "1,2", "--steps", "20", "--repeats", "2", "--warm-up", "10"]


def case_from_nothing(program):
    """Settles the small bed, keeps the state, and measures everything."""
    done = program(*QUICK, "--scene", "bed-1k", "--roofline", "--frames", "--json", "-", says=["settling bed-1k, once"])
    assert os.listdir("states") == ["bed-1k-1.h5"], os.listdir("states")
    with h5py().File("states/bed-1k-1.h5", "r") as file:
        assert file["position"].shape == file["velocity"].shape == file["angular_velocity"].shape == (1000, 3)
        speed = (file["velocity"][...] ** 2).sum(axis=1) ** 0.5
        assert speed.mean() < 0.02 and file["position"][:, 2].max() < 0.12, "settled, no more than ten layers high"
    result = json.loads(done.stdout)
    for key in ("software processor processors compiler flags build_type vector_path commit threads repeats interrupted "
                "program_start_seconds").split():
        assert key in result, key
    (bed,) = result["scenes"]
    assert (bed["name"], bed["particles"], bed["steps_per_window"], bed["warm_up"]) == ("bed-1k", 1000, 20, 10)
    assert re.fullmatch("[0-9a-f]{16}", bed["state_hash"])
    assert [p["threads"] for p in bed["processes"]] == [1, 2]
    for p in bed["processes"]:
        assert p["state_hash"] == bed["state_hash"] and p["last_state_hash"] == bed["processes"][0]["last_state_hash"]
        assert 0 < p["seconds_to_read"] < p["seconds_to_first_step"]
        assert 0 < p["memory_before_reading"] < p["peak_memory"] and p["peak_bytes_per_particle"] > 500
    timings = {(t["threads"], t["execution"]): t for t in bed["timings"]}
    assert set(timings) == {(n, e) for n in (1, 2) for e in ("graph", "list", "serial")}
    for (threads, execution), t in timings.items():
        rate = t["particle_steps_per_second"]
        assert 0 < rate["min"] <= rate["median"] <= rate["max"] and t["windows"] == 2 and t["steps"] == 40
        assert 4 < t["contacts_per_particle"] < 6 and 0 < t["wall_contacts_per_particle"] < 0.2
        assert t["candidates_per_particle"] > t["contacts_per_particle"] / 2 and t["listings"] >= t["searches"]
        assert (t["steps_per_listing"] is None) == (t["listings"] == 0)
        assert (t["efficiency"] is None) == (threads == 1)
        contacts = 1000 * (t["contacts_per_particle"] / 2 + t["wall_contacts_per_particle"])
        close = t["ns_per_contact_and_step"]["median"] * contacts / (1e9 * t["seconds_per_step"]["median"])
        assert 0.9 < close < 1.1, close
        shares = {k["name"]: k["share"] for k in t["kernels"]}
        assert abs(sum(shares.values()) - 1) < 1e-6 and "integrate" in shares
    assert len(bed["windows"]) == 2 * 2 * (3 + 1) and sum(w["frame"] for w in bed["windows"]) == 4
    assert [f["threads"] for f in bed["frames"]] == [1, 2]
    for roofline in bed["roofline"]:
        assert roofline["flops_per_second"] > 1e8 and roofline["bandwidth"][0]["bytes_per_second"] > 1e8
        assert {k["bound"] for k in roofline["kernels"]} <= {"memory", "arithmetic"}
        assert all(k["predicted_seconds"] >= 0 for k in roofline["kernels"]) and len(roofline["kernels"]) > 3


def case_text_and_csv(program):
    done = program(*QUICK, "--scene", "bed-1k", "--csv", "rows.csv", "-v")
    contains(done.stdout, ["bed-1k: 1\u00a0000 particles", "contacts a particle", "us/step", "efficiency", "serial", "state hash", "kernel"])
    assert max(map(len, done.stdout.splitlines())) <= 110, done.stdout
    rows = list(csv.DictReader(io.StringIO(read("rows.csv"))))
    assert [(r["threads"], r["execution"]) for r in rows] == [(n, e) for n in "12" for e in ("graph", "list", "serial")]
    assert all(float(r["particle_steps_per_second"]) > 0 for r in rows)


def case_states_are_kept_and_made_once(program):
    program("bench", "--states", "deep/states", "--scene", "bed-1k", "--settle-only", says=["settling bed-1k"])
    before = os.stat("deep/states/bed-1k-1.h5")
    done = program("bench", "--states", "deep/states", "--scene", "bed-1k", "--settle-only")
    assert done.stderr == "" and os.stat("deep/states/bed-1k-1.h5").st_mtime_ns == before.st_mtime_ns
    listed = program("bench", "--list", "--states", "deep/states").stdout.splitlines()
    assert len(listed) == 9 and [line.split()[0] for line in listed if "state is there" in line] == ["bed-1k"]
    # The same state, run by hand from the scene file.
    program.run(os.path.join(os.path.dirname(scene("drum")), "..", "profiling", "bench", "scenes", "bed.yaml"), "--set", "spheres_x=10",
                "--set", "spheres_y=10", "--set", "particles.0.file.path=" + os.path.abspath("deep/states/bed-1k-1.h5"), "--end-time",
                "1 ms", "--quiet")


def case_nonsmooth(program):
    """The solver's work beside the rates, from the last impulses and from none; all thread counts did the same."""
    settle = ["--scene", "bed-1k", "--method", "ndem"]
    done = program(*QUICK, *settle, "--csv", "rows.csv")
    contains(done.stdout, ["nonsmooth DEM", "M contact sweeps/s", "warm", "cold", "s/simulated s", "detection", "solve"])
    machine, _, *rest = done.stdout.splitlines()             # the second line has the compiler's flags: as long as they are
    assert "smooth DEM" not in done.stdout.replace("nonsmooth DEM", "") and max(map(len, [machine, *rest])) <= 110, done.stdout
    rows = list(csv.DictReader(io.StringIO(read("rows.csv"))))
    assert {r["method"] for r in rows} == {"ndem"} and {float(r["time_step"]) for r in rows} == {1e-3}
    assert [r["contact_sweeps_per_second"] != "" for r in rows] == [True, False, False] * 2
    result = json.loads(program(*QUICK, *settle, "--execution", "graph", "--json", "-").stdout)
    (bed,) = result["scenes"]
    assert result["method"] == bed["method"] == "ndem" and bed["time_step"] == 1e-3
    assert [(s["threads"], s["warm_start"]) for s in bed["solver"]] == [(1, True), (1, False), (2, True), (2, False)]
    for s in bed["solver"]:
        assert s["steps"] == 40 and 2000 < s["contacts"] < 3500 and s["contact_sweeps_per_second"]["min"] > 1e5
        assert s["steps_unsolved"] == 0 and 0 < s["residual"] <= 1e-3 and s["wall_seconds_per_simulated_second"]["min"] > 0
        assert (s["efficiency"] is None) == (s["threads"] == 1) and abs(sum(s["shares"].values()) - 1) < 1e-6
    warm, cold = (s["sweeps_per_step"] for s in bed["solver"][:2])
    assert 1 <= warm < cold, (warm, cold)


def case_scene_file(program):
    write("small.yaml", SMALL)
    done = program(*QUICK, "--scene", "small.yaml", "--execution", "list", "--json", "-")
    (small,) = json.loads(done.stdout)["scenes"]
    assert small["particles"] == 2 and [t["execution"] for t in small["timings"]] == ["list", "list"]
    assert not os.path.exists("states"), "nothing to settle"


def case_vector_path(program):
    write("small.yaml", SMALL)
    hashes = set()
    for name in ["auto", *vector_paths()]:
        result = json.loads(program(*QUICK, "--scene", "small.yaml", "--execution", "list", "--vector", name, "--json", "-").stdout)
        assert result["vector_path"] == (vector_paths()[-1] if name == "auto" else name)
        hashes.add(result["scenes"][0]["state_hash"])
    assert len(hashes) == 1, hashes
    contains(program(*QUICK, "--scene", "small.yaml", "--vector", "scalar").stdout, ["vector path: scalar"])
    program("bench", "--scene", "small.yaml", "--vector", "mmx", code=2, says=["--vector: 'mmx' is not allowed", "scalar"])


def case_refused(program):
    program("bench", "--scene", "bed-1", code=2, says=["--scene: 'bed-1'", "did you mean 'bed-1k'?"])
    for threads in ("0", "1,", "1;2", "2000"):
        program("bench", "--scene", "bed-1k", "--threads", threads, code=2, says=["--threads", "1 .. 1024"])
    program("bench", "--execution", "fast", code=2, says=["--execution: 'fast'", "graph, list, serial"])
    program("bench", "--repeats", "0", code=2, says=["--repeats"])
    program("bench", "--json", "-", "--csv", "-", code=2, says=["standard output"])
    write("broken.yaml", SMALL.replace("2500", "heavy"))
    program("bench", "--scene", "bed-1k,broken.yaml", code=3, says=["broken.yaml:3", "density"])


def case_files_that_cannot_be_written(program):
    write("file", "")
    program(*QUICK[:1], "--states", "file/states", "--scene", "bed-1k", code=5, says=["file/states", "--states"])
    write("small.yaml", SMALL)
    program(*QUICK, "--scene", "small.yaml", "--json", "none/x.json", code=5, says=["none/x.json: cannot be written"])
    write("old.json", "old")
    write("broken.yaml", SMALL.replace("2500", "heavy"))
    program("bench", "--scene", "broken.yaml", "--json", "old.json", code=3)
    assert read("old.json") == "old", "a failure leaves an older result alone"


def case_interrupt(program):
    process = program.start("bench", "--states", "states", "--scene", "bed-10k", "--settle-only")
    wait_for(lambda: os.path.exists("states") and os.listdir("states"), process)
    process.send_signal(signal.SIGINT)
    said = process.communicate(timeout=20)[1]
    assert process.returncode == 130 and "interrupted" in said, (process.returncode, said)
    assert os.listdir("states") == [], os.listdir("states")


main(globals())
