#!/usr/bin/env python3
"""tests/system/program_test.py - what a run prints and leaves, and what the other verbs print: see program.py."""
import csv
import math
import os
import re
import shutil
import subprocess
import sys
import xml.etree.ElementTree as xml

from program import (FILES, SMALL, Skip, check_trajectory, contains, h5py, json, main, read, scene, state_hash, summary, vector_paths,
                     write)


def case_run_leaves_a_complete_folder(program):
    done = program.run(scene("hello"), "--end-time", "0.3 s", "--threads", "2", "--summary", "copy.json")
    assert set(os.listdir("out")) == FILES, os.listdir("out")
    assert done.stdout == ""
    contains(done.stderr, ["5 particles", "threads 2", f"vector path {vector_paths()[-1]} (auto: the widest", "time step", "(auto)", "force_calculation_particle_body", "profiling:",
                           "finished at t = 0.2999", "state hash " + state_hash()])
    contains(read("out", "log.txt"), ["5 particles", "rolling resistance: in", "finished at t = 0.2999"])
    s = summary()
    assert json.loads(read("copy.json")) == s
    keys = ("scene method threads vector_path particles bodies steps time_step simulated_time wall_time particle_steps_per_second contacts "
            "max_overlap_ratio kinetic_energy state_hash kernels").split()
    assert not [k for k in keys if k not in s], s.keys()
    assert (s["scene"], s["method"], s["threads"], s["particles"], s["bodies"], s["outcome"]) == ("hello", "sdem", 2, 5, 1, "finished")
    assert math.isclose(s["steps"] * s["time_step"], s["simulated_time"]) and abs(s["simulated_time"] - 0.3) < s["time_step"]
    assert 0 < s["contacts"] and 0 < s["max_overlap_ratio"] < 0.5 and re.fullmatch("[0-9a-f]{16}", s["state_hash"])
    for kernel in s["kernels"]:
        assert {"name", "count", "total", "share"} <= kernel.keys()
    assert {k["name"]: k["count"] for k in s["kernels"]}["integrate"] == s["steps"]


# The drum made so narrow that its filling meets the wall within 0.1 s.
DRUM = [scene("drum"), "--set", "drum_radius=0.21", "--end-time", "0.1 s", "--quiet"]


def case_hash_needs_neither_threads_nor_output(program):
    def run(name, *options):
        program.run(*DRUM, *options, output=name)
        return state_hash(name)

    hashes = {"1": run("1", "--threads", "1")}
    assert summary("1")["contacts"] > 10
    for threads in (2, 4):
        hashes[str(threads)] = run(str(threads), "--threads", threads)
    for path in vector_paths():
        hashes[path] = run(path, "--vector", path)
        assert summary(path)["vector_path"] == path
    hashes["trace"] = run("trace", "--trace", "t.json", "--timeline", "t.svg")
    hashes["output"] = run("output", "--set", "output={frame_interval: 1 ms, statistics_interval: 50 us, contacts: true, precision: double}")
    hashes["search"] = run("search", "--set", "search={skin: 0.5 mm, cell_size: 20 mm, reorder_every: 1}")
    assert len(set(hashes.values())) == 1, hashes
    assert run("other", "--seed", "2") != hashes["1"], "the hash does not see another start"


FLOW = """
end_time: 0.3 s
time_step: 50 us
solver: {time_step: 0.1 ms}
materials: [{name: grain, density: 2500, youngs_modulus: 5 MPa, restitution: 0.5, friction: 0.5}]
inflow:
  - name: feed
    box: {min: [0, 0, 0.05], max: [0.1, 0.1, 0.1]}
    radius: {min: 4 mm, max: 6 mm}
    rate: 400
    number: 60
    velocity: [0, 0, -1]
bodies: [{name: step, geometries: [{box: {size: [0.05, 0.2, 0.02]}, position: [0.02, 0.05, 0]}]}]
remove: [{name: bin, half_space: {point: [0, 0, -0.05], normal: [0, 0, -1]}, interval: 2 ms}]
probes:
  - {name: out, disc: {point: [0, 0, -0.02], normal: [0, 0, -1], radius: .inf}}
  - {name: air, box: {min: [-1, -1, -0.02], max: [1, 1, 1]}}
output: {frame_interval: 20 ms, statistics_interval: 10 ms, contacts: true}
"""


def case_particles_come_and_go(program):
    """A scene that starts empty. What came, went and crossed adds up, in every file; threads and a resolved scene leave no trace."""
    write("flow.yaml", FLOW)
    for method in ("sdem", "ndem"):
        hashes = set()
        for threads in (1, 2, 4):
            program.run("flow.yaml", "--method", method, "--threads", threads, "--overwrite", "--quiet")
            hashes.add(state_hash())
        program.run("out/scene.resolved.yaml", "--quiet", "--overwrite", output="again")
        hashes.add(state_hash("again"))
        assert len(hashes) == 1, (method, hashes)
        s = summary()
        created, removed, crossed = s["created"]["feed"], s["removed"]["bin"], s["crossed"]["out"]
        assert created["count"] == 60 and created["waiting"] == 0 and 10 < removed["count"] <= crossed["count"] < 60, s
        assert s["particles"] == 60 - removed["count"]
        with open("out/statistics.csv", newline="") as text:
            rows = [{k: float(v) for k, v in row.items()} for row in csv.DictReader(text)]
        for row in rows:
            assert row["feed.created [1]"] == row["particles [1]"] + row["bin.removed [1]"]
            assert row["feed.created [1]"] == row["air.count [1]"] + row["out.crossed [1]"], row
            assert math.isclose(row["feed.created_mass [kg]"], row["air.mass [kg]"] + row["out.crossed_mass [kg]"], abs_tol=1e-12)
        assert rows[0]["particles [1]"] == 0 and rows[-1]["bin.removed [1]"] == removed["count"]
        check_trajectory("out", 10)
        with h5py().File("out/trajectory.h5", "r") as file:
            counts, ids = file["VTKHDF/NumberOfPoints"][...], file["particles/id"][...]
            first = file["VTKHDF/Steps/PointOffsets"][...]
            assert counts[0] == 0 and counts[-1] == s["particles"]
            for a, n in zip(first, counts):
                assert n < 2 or (ids[a + 1:a + n] > ids[a:a + n - 1]).all(), "in order of id"
            assert ids.max() == 59
    contains(program("graph", "flow.yaml").stdout, ["emit_particles", "remove_particles", "count_crossings", "removal of particles", "1 region"])
    plain = program("graph", scene("drum")).stdout
    assert "emit_particles" not in plain and "remove_particles" not in plain and "the scene has no inflow" in plain


def case_nonsmooth_run(program):
    """The same scene file by the other method, at its own step: what the solver did is told, and threads leave no trace."""
    hashes = set()
    for threads in (1, 2, 4):
        program.run(*DRUM, "--method", "ndem", "--threads", threads, "--overwrite")
        hashes.add(state_hash())
        s = summary()
        assert (s["method"], s["time_step"], s["steps"], s["steps_unsolved"], s["outcome"]) == ("ndem", 1e-3, 100, 0, "finished"), s
        assert 0 < s["iterations"] <= s["most_iterations"] <= 500 and 0 < s["greatest_residual"] <= 1e-3 and s["contact_sweeps"] > 0
        log = read("out", "log.txt")
        contains(log, ["impact stage: in", "contact history: in", "sweeps a step"])
        assert "sweeps above the tolerance 0.001" not in log
        assert "contact_solve" in {k["name"] for k in s["kernels"]}
    assert len(hashes) == 1, hashes
    assert check_trajectory("out", 2) == s["frames"]
    with open("out/statistics.csv", newline="") as text:
        header, *rows = csv.reader(text)
    assert {"solver_sweeps [1]", "solver_residual [1]", "impacts [1]", "steps_unsolved [1]"} <= set(header), header
    program.run("out/scene.resolved.yaml", "--quiet", output="again")
    assert state_hash("again") in hashes
    contains(program("validate", scene("drum"), "--method", "ndem").stdout, ["scene 'drum' is sound", "5000 steps"])
    lean = ["--set", "materials.pellet.friction=0", "--set", "materials.pellet.rolling_friction=0"]
    for options, kernels in (([], 16), ([*lean, "--set", "materials.pellet.restitution=0", "--set", "materials.disc.restitution=0"], 15)):
        text = program("graph", scene("drum"), "--method", "ndem", *options).stdout
        contains(text, ["nonsmooth DEM: %d kernels" % kernels, "contact_solve", "impact stage"])
        assert ("impact_solve" in text) == (not options)


def case_energy_ledger(program):
    """It is told where it is asked for, closes, and leaves no trace: nor do pictures, frames, threads and its columns together."""
    names = ("energy_translation energy_rotation energy_gravity energy_elastic_normal energy_elastic_tangential energy_elastic_rolling "
             "lost_to_normal_damping lost_to_friction lost_to_rolling lost_to_impacts work_of_bodies carried_in carried_out energy_error").split()
    for method in ("sdem", "ndem"):
        hashes = set()
        for options in ([], ["--set", "output.energy=true"],
                        ["--threads", "3", "--trace", "t.json", "--timeline", "t.svg", "--set",
                         "output={energy: true, frame_interval: 2 ms, statistics_interval: 1 ms, contacts: true, orientation: true}"]):
            program.run(*DRUM, "--method", method, *options, "--overwrite")
            s = summary()
            # The orientation of particles is part of the state, and so of the hash; nothing else of it may differ.
            hashes.add((s["kinetic_energy"], s["contacts"]) if "orientation" in str(options) else s["state_hash"])
            assert ("energy" in s) == bool(options), s.keys()
            with open("out/statistics.csv", newline="") as text:
                rows = list(csv.DictReader(text))
            assert {f"{n} [J]" in rows[0] for n in names} == {bool(options)}, rows[0]
            if not options:
                plain = (s["kinetic_energy"], s["contacts"])
                continue
            assert (s["kinetic_energy"], s["contacts"]) == plain
            e = s["energy"]
            assert list(e) == sorted(names) and all(e[n] == float(rows[-1][f"{n} [J]"]) for n in names), e
            moved = e["lost_to_normal_damping"] + e["lost_to_friction"] + e["lost_to_rolling"] + e["lost_to_impacts"]
            bound = 1e-3 * moved if method == "sdem" else 0.02 * e["energy_translation"]     # m g^2 h t / 2 of a fall of 0.1 s
            assert moved > 0 and abs(e["energy_error"]) < bound, e
            assert e["work_of_bodies"] > 0, e
            first = {n: float(rows[0][f"{n} [J]"]) for n in names}
            change = sum(e[n] - first[n] for n in names if n.startswith("energy_") and n != "energy_error")
            assert math.isclose(change + moved - e["work_of_bodies"], e["energy_error"], abs_tol=1e-9 * moved), (change, e)
            text = program("graph", *DRUM[:3], "--method", method, *options).stdout if "--threads" not in options else ""
            assert not text or ("energy_ledger" in text and "energy ledger                            in " in text), text
        assert len(hashes) == 2, hashes                      # with and without the ledger: one hash
        program.run(scene("hopper"), "--method", method, "--set", "filling=kept_up", "--set", "height=50 mm", "--set", "silo_radius=40 mm",
                    "--set", "orifice=40 mm", "--set", "open_at=50 ms", "--set", "output.energy=true", "--end-time", "0.3 s", "--overwrite")
        e = summary()["energy"]
        assert e["carried_in"] > 0 and e["carried_out"] != 0 and abs(e["energy_error"]) < 0.05 * e["lost_to_friction"], e


def drum(program):
    """A real run, with bodies, contacts, many particles and 6 frames."""
    program.run(*DRUM, "--set", "output.frame_interval=0.02", "--set", "output.contacts=true")


def case_trajectory_in_h5py(program):
    drum(program)
    assert check_trajectory("out", 6) == 6
    with h5py().File("out/trajectory.h5", "r") as file:
        units = {"position": "m", "velocity": "m/s", "angular_velocity": "rad/s", "force": "N", "radius": "m", "mass": "kg", "id": "1"}
        for name, unit in units.items():
            assert file["particles"][name].attrs["units"] == unit, name
        time, n = file["frames/time"][...], 867
        assert abs(time - [0, 0.02, 0.04, 0.06, 0.08, 0.1]).max() < 1e-12, time
        assert list(file["particles/id"]) == list(range(n)) and file["particles/radius"].shape == (n,)
        first, last = file["frames/000000/position"][...], file["frames/000005/position"][...]
        fallen = (first - last)[:, 2]
        assert abs(fallen.max() - 9.81 / 2 * 0.1**2) < 1e-6 and fallen.min() < 0.9 * fallen.max(), "some fall freely, some are held"
        assert abs(file["frames/000005/velocity"][:, 2].min() + 9.81 * 0.1) < 1e-6
        bodies = file["bodies"]
        assert list(bodies["names"].asstr()) == ["drum"] and list(bodies["motion"].asstr()) == ["kinematic"]
        w, x, y, z = bodies["orientation"][5, 0]
        assert math.isclose(2 * math.atan2(y, w), 0.5 * 0.1, rel_tol=1e-9) and abs(x) + abs(z) < 1e-12, "the drum's turn"
        assert list(bodies["angular_velocity"][5, 0]) == [0, 0.5, 0]
        walls = file["contacts/particle_body"]
        assert walls["count"][5] > 0 and len(walls["force"]) == sum(walls["count"])
        total = walls["force"][walls["first"][5]:][: walls["count"][5]].sum(axis=0)
        assert abs(total + bodies["force"][5, 0]).max() < 1e-5 * abs(total).max(), (total, bodies["force"][5, 0])


def case_trajectory_in_vtk(program):
    """Every frame at its time: in ParaView where it is installed, in VTK that knows time (9.3), else as XDMF says."""
    drum(program)
    h5 = h5py()
    frames = xml.parse("out/trajectory.xdmf").findall("Domain/Grid/Grid")
    times = [float(f.find("Time").get("Value")) for f in frames]
    assert len(times) == 6 and abs(times[-1] - 0.1) < 1e-12
    with h5.File("out/trajectory.h5", "r") as file:
        want = [file[f"frames/{k:06d}/position"][...] for k in range(6)]
        for k, frame in enumerate(frames):
            for item in frame.iter("DataItem"):
                data = file[item.text.strip().split(":")[1]]
                assert data.shape == tuple(map(int, item.get("Dimensions").split())), item.text
            assert (file[frame.find("Geometry/DataItem").text.strip().split(":")[1]][...] == want[k]).all()
        bodies = xml.parse("out/bodies.xdmf").findall("Domain/Grid/Grid")
        assert [float(f.find("Time").get("Value")) for f in bodies] == times
    if shutil.which("pvpython"):
        write("look.py", "from paraview import servermanager, simple\n"
                         "source = simple.Xdmf3ReaderS(FileName=['out/trajectory.xdmf'])\n"
                         "source.UpdatePipelineInformation()\n"
                         "for time in source.TimestepValues:\n"
                         "    source.UpdatePipeline(time)\n"
                         "    data = servermanager.Fetch(source)\n"
                         "    while data.IsA('vtkMultiBlockDataSet'): data = data.GetBlock(0)\n"
                         "    print(time, *data.GetPoint(866))\n")
        seen = subprocess.run(["pvpython", "look.py"], capture_output=True, text=True, check=True).stdout.splitlines()
        seen = [list(map(float, line.split())) for line in seen]
    else:
        try:
            from vtkmodules.vtkCommonCore import vtkVersion
            from vtkmodules.vtkIOHDF import vtkHDFReader
        except ImportError as missing:
            raise Skip(missing)
        version = vtkVersion()
        if (version.GetVTKMajorVersion(), version.GetVTKMinorVersion()) < (9, 3):
            print(f"XDMF references agree; VTK {version.GetVTKVersion()} has no time in VTKHDF")
            return
        reader, seen = vtkHDFReader(), []
        reader.SetFileName("out/trajectory.h5")
        reader.UpdateInformation()
        for k in range(reader.GetNumberOfSteps()):
            reader.SetStep(k)
            reader.UpdateTimeStep(times[k])
            seen.append([times[k], *reader.GetOutputDataObject(0).GetPoint(866)])
    assert len(seen) == 6
    for k, (time, *point) in enumerate(seen):
        assert abs(time - times[k]) < 1e-12 and max(abs(point - want[k][866])) < 1e-6, (k, point, want[k][866])


def case_statistics_agree(program):
    program.run(scene("hello"), "--end-time", "0.2 s", "--quiet")
    with open("out/statistics.csv", newline="") as text:
        header, *rows = csv.reader(text)
    names = dict(re.fullmatch(r"(\S+) \[(.+)\]", h).groups() for h in header)
    need = ("time step kinetic_energy rotational_energy potential_energy contacts body_contacts normal_force_particle_particle "
            "normal_force_particle_body highest_particle mean_speed max_overlap_ratio floor.force_z floor.torque_x").split()
    assert not set(need) - names.keys(), names
    with h5py().File("out/statistics.h5", "r") as file:
        found = []
        file.visititems(lambda name, item: found.append(name) if hasattr(item, "shape") else None)
        assert {n.replace("/", ".") for n in found} == names.keys(), found
        for column, (name, unit) in enumerate(names.items()):
            data = file[name] if name in file else file[name.replace(".", "/")]
            assert data.attrs["units"] == unit and data[...].tolist() == [float(r[column]) for r in rows], name
    steps = [float(r[1]) for r in rows]
    assert all(a < b for a, b in zip(steps, steps[1:])) and len(rows) > 190
    energy = [sum(float(r[list(names).index(k)]) for k in need[2:5]) for r in rows]
    assert energy[-1] < energy[0] and max(energy) < energy[0] * 1.001, "an impact dissipates"


def case_resolved_scene_runs_the_same(program):
    for name, *options in (["hello"], ["drum"], ["drum", "--set", "wall=cylinder"], ["drum", "--set", "wall=mesh"]):
        program.run(scene(name), "--end-time", "2 ms", "--quiet", *options, "--overwrite", output="one")
        program.run("one/scene.resolved.yaml", "--quiet", "--overwrite", output="two")
        assert state_hash("one") == state_hash("two"), (name, options)
        assert read("one/scene.resolved.yaml") == read("two/scene.resolved.yaml")


def case_trace_is_valid(program):
    program.run(scene("drum"), "--end-time", "5 ms", "--threads", "2", "--trace", "t.json", "--trace-steps", "10:20", "--quiet")
    events = json.loads(read("t.json"))["traceEvents"]
    threads = {e["tid"]: e["args"]["name"] for e in events if e["name"] == "thread_name"}
    contains(str(threads), ["steps", "thread 0", "thread 1", "writer"])
    steps = [e for e in events if e.get("cat") == "step"]
    assert [e["args"]["step"] for e in steps] == list(range(10, 20))
    for counter in ("contacts", "kinetic energy [J]"):
        at = [e["ts"] for e in events if e["ph"] == "C" and e["name"] == counter]
        assert len(at) >= 2 and at[0] < steps[1]["ts"] and at[-1] > steps[-1]["ts"], (counter, at)   # first and last, and where a row is due
    begin, end = steps[0]["ts"], steps[-1]["ts"] + steps[-1]["dur"]
    for thread in threads:
        open_until = []
        spans = sorted((e for e in events if e["ph"] == "X" and e["tid"] == thread), key=lambda e: (e["ts"], -e["dur"]))
        for span in spans:
            while open_until and open_until[-1] <= span["ts"] + 2e-3:      # times are printed to the nanosecond
                open_until.pop()
            last = span["ts"] + span["dur"]
            assert not open_until or last <= open_until[-1] + 2e-3, f"a span of {threads[thread]} overlaps its neighbour: {span}"
            open_until.append(last)
            assert span["dur"] >= 0 and (threads[thread] == "writer" or begin - 1e3 <= span["ts"] <= end + 1e3), span
    names = {e["name"] for e in events if e.get("cat") == "call"}
    assert {"broadphase", "contact_hashing", "force_calculation_particle_particle", "integrate"} <= names, names


def case_sweeps_and_colours_in_the_trace(program):
    """The solver is one kernel, and what its threads did in it is told by sweep and colour."""
    program.run(*DRUM, "--method", "ndem", "--threads", 2, "--trace", "t.json", "--trace-steps", "90:100", "--quiet")
    loops = [e["args"] for e in json.loads(read("t.json"))["traceEvents"] if e.get("cat") == "chunk" and e["name"] == "contact_solve"]
    steps = {a["step"] for a in loops}
    assert steps == set(range(90, 100)), steps
    for step in steps:
        done = [(a["sweep"], a["colour"]) for a in loops if a["step"] == step and "sweep" in a]
        last = max(sweep for sweep, _ in done)
        assert last >= 1 and {c for _, c in done} <= set(range(8)) and {s for s, _ in done} == set(range(1, last + 1)), done


def case_trace_that_misses_the_run_says_so(program):
    program.small(options=["--trace", "t.json", "--trace-steps", "100000:100001"], says=["none of the steps asked for was run"])
    json.loads(read("t.json"))


def case_timeline_is_svg(program):
    program.run(scene("drum"), "--end-time", "5 ms", "--timeline", "t.svg", "--quiet")
    root = xml.parse("t.svg").getroot()
    assert root.tag == "{http://www.w3.org/2000/svg}svg"
    contains(read("t.svg"), ["drum", "867", "force_calculation_particle_body"])


def case_graph(program):
    text = program("graph", scene("drum")).stdout
    contains(text, ["kernels, in order", "force_calculation_particle_body", "after reorder (id)", "effects", "rolling resistance"])
    assert len({program("graph", s).stdout for s in (scene("drum"), scene("hello"))}) == 2
    dot = program("graph", scene("drum"), "--format", "dot").stdout
    assert dot.startswith("digraph step {") and dot.rstrip().endswith("}") and '"integrate" -> ' in dot
    if not shutil.which("dot"):
        program("graph", scene("drum"), "--format", "svg", code=2, says=["graphviz", "--format dot"])
        raise Skip("graphviz is not installed: no SVG")
    subprocess.run(["dot", "-Tcanon"], input=dot, text=True, check=True, stdout=subprocess.DEVNULL)
    svg = xml.fromstring(program("graph", scene("drum"), "--format", "svg").stdout)
    assert svg.tag.endswith("svg") and any(t.text == "integrate" for t in svg.iter() if t.text)


def case_other_verbs(program):
    for name in ("hello", "drum", "silo", "laws"):
        contains(program("validate", scene(name)).stdout, [f"scene '{name}' is sound", "time step"])
    for name in ("hello", "drum", "silo", "tower"):
        for method in ("sdem", "ndem"):
            done = program("validate", scene(name), "--method", method)
            assert done.stderr == "" and "WARNING" not in done.stdout, done.stderr + done.stdout
            contains(done.stdout, ["estimated before the run", "overlap under own weight", " ok"])
    schema = json.loads(program("schema").stdout)
    assert schema["type"] == "object" and "materials" in schema["properties"]
    contains(program("models").stdout, ["hertz", "spring", "Cundall & Strack 1979", "restitution"])
    contains(program("explain", "materials.youngs_modulus").stdout, ["Pa", "> 0"])
    contains(program("explain").stdout, ["materials", "bodies", "end_time"])
    for shell in ("bash", "zsh", "fish"):
        contains(program("completion", shell).stdout, ["skred", "run", "validate"])
    contains(program("--version").stdout, ["skred 0."])
    contains(program("--help").stdout, ["run", "graph", "validate"])
    contains(program("run", "--help").stdout, ["--threads", "--vector", "auto|scalar|sse2|avx2|avx512", "--trace-steps", "--summary"])


def case_automatic_step_of_nonsmooth_dem(program):
    """However it is asked for, it is that of equation 2.7, and told with where it comes from."""
    asked = [["--time-step", "auto"], ["--set", "solver.time_step=auto"], ["--set", "solver={}"]]
    for words in asked:                                      # 2 * 0.05 * 2 cm / 1.98 m/s
        contains(program("validate", scene("hello"), "--method", "ndem", *words).stdout,
                 ["time step 0.001 s (auto): at 1.98 m/s a particle goes 1.98 mm in this step, of 2 mm that overlap_tolerance 0.05 allows; "
                  "1.98 m/s is that of a fall of 0.2 m", "in 1000 steps"])
    slow = ["--set", "expected_speed=0.5 m/s", "--set", "solver.overlap_tolerance=0.1"]   # 2 * 0.1 * 6.36665 mm / 0.5 m/s, two digits
    done = program.run(scene("drum"), "--method", "ndem", *asked[1], *slow, "--end-time", "20 ms")
    contains(read("out", "log.txt"), ["time step 0.0025 s (auto): at 0.5 m/s a particle goes 1.25 mm in this step, of 1.27 mm",
                                      "0.5 m/s is given as expected_speed"])
    assert summary()["time_step"] == 0.0025 and summary()["steps"] == 8 and "time step 0.0025 s (auto)" in done.stderr
    contains(program("validate", "out/scene.resolved.yaml").stdout, ["time step 0.0025 s (auto)"])
    contains(program("validate", scene("drum"), *asked[1]).stdout, ["time step 5e-05 s (given"])   # smooth DEM has its own
    still = program("validate", scene("hello"), "--method", "ndem", "--set", "expected_speed=1 mm/s").stdout
    contains(still, ["time step 0.02 s (auto): at rest, a particle falls 1.96 mm in this step, of 2 mm"])
    for a in (4, 6, 8, 10):
        for name in ("drum", "silo"):
            contains(program("validate", scene(name), "--method", "ndem", "--set", f"a={a}").stdout, ["is sound"])


def case_contact_laws(program):
    """Every contact law can be named on the command line, gives its own motion, and the log says what it does not use."""
    def run(*laws, code=0, says=(), method="sdem"):
        names = [w for pair in zip(("normal", "tangential", "rolling"), laws) for w in ("--set", "contact.%s=%s" % pair)]
        return program.run(scene("laws"), *names, "--method", method, "--end-time", "0.1 s", "--overwrite", code=code, says=says)
    hashes = set()
    laws = [(n, "spring", "spring") for n in ("hertz", "linear", "kuwabara_kono", "walton_braun")]
    laws += [("hertz", t, "spring") for t in ("coulomb", "viscous", "haff_werner", "walton_braun", "none")]
    laws += [("linear", "spring", r) for r in ("constant_torque", "viscous", "none")]
    for law in laws:
        run(*law)
        hashes.add(state_hash_of_last := state_hash())
        assert summary()["max_overlap_ratio"] < 0.3, law
    assert len(hashes) == len(laws), hashes
    contains(read("out", "log.txt"), ["given, but not used by contact: {normal: linear, tangential: spring, rolling: none}: rolling_friction, damping_time"])
    run("walton_braun", "coulomb", "none", method="ndem", says=["are laws of smooth DEM"])
    program.run(scene("laws"), "--set", "contact.normal=linear", "--set", "contact.rolling=none", "--set", "output.energy=true",
                "--end-time", "0.1 s", "--overwrite")
    assert state_hash() == state_hash_of_last and summary()["energy"]["lost_to_normal_damping"] > 0
    contains(program("graph", scene("laws"), "--set", "contact.normal=linear").stdout, ["normal: linear, tangential: spring, rolling: spring"])
    contains(program("explain", "contact.tangential").stdout, ["haff_werner", "default spring"])
    contains(program("models").stdout, ["kuwabara_kono", "walton_braun", "constant_torque", "rolling_viscosity", "N s/m"])


def case_guard_before_the_run(program):
    """A scene that will go wrong is told so with numbers, in validate's table and in the log of a run; and it runs."""
    soft = ["--set", "materials.rubber.youngs_modulus=50 kPa"]
    done = program("validate", scene("hello"), *soft, says=["warning: overlap under own weight / radius: 0.1", "should be <= 0.08",
                                                             "Hertz is for small overlaps"])
    contains(done.stdout, ["WARNING", "sound"])
    program.run(scene("hello"), *soft, "--end-time", "0.01 s", "--quiet", says=["warning: overlap under own weight"])
    contains(read("out", "log.txt"), ["warning: overlap under own weight"])
    floating = program("validate", scene("hello"), "--set", "gravity=[0, 0, 0]")
    contains(floating.stdout, ["cannot be estimated: no gravity"])
    assert floating.stderr == ""


def case_wrong_usage(program):
    write("s.yaml", SMALL)
    for words in ([], ["walk"], ["run"], ["run", "s.yaml", "--colour"], ["run", "s.yaml", "--method", "pdem"], ["completion", "tcsh"],
                  ["graph", "s.yaml", "--format", "gif"], ["run", "s.yaml", "--set", "gravity"],
                  ["run", "s.yaml", "--trace-steps", "5:6"], ["run", "s.yaml", "--trace", "t", "--trace-steps", "6:5"]):
        assert program(*words, code=2).stderr, words
    program("explain", "materials.colour", code=2, says=["colour"])
    assert os.listdir(".") == ["s.yaml"], "a refused run leaves nothing behind"


def case_results_are_kept(program):
    """Of an earlier run: nothing is lost unless a new run replaces it."""
    program.small("end_time=1 ms", options=["--quiet"])
    kept = read("out/summary.json")
    write("out/notes.txt", "mine")
    program.small(code=5, says=["out: the output folder is not empty"])
    program.small("end_time=-1", options=["--overwrite"], code=3)
    program.small("time_step=1", "end_time=2", options=["--overwrite"], code=3, says=["too large"])
    program.small(options=["--overwrite", "--trace", "none/t.json"], code=5, says=["none/t.json", "No such file"])
    assert read("out/summary.json") == kept
    program.small("end_time=2 ms", options=["--overwrite", "--quiet", "--trace", "out/trace.json"])
    assert read("out/summary.json") != kept and read("out/notes.txt") == "mine" and os.path.getsize("out/trace.json") > 1000
    for name in ("small-sdem", "small-sdem-2"):
        program("run", "small.yaml", "--quiet")
        assert set(os.listdir("results/" + name)) == FILES


def case_bodies_and_particles_exchange_momentum(program):
    """A dynamic block hits a free heap: momentum stays, and the block slows down."""
    write("hit.yaml", """
end_time: 0.15 s
gravity: [0, 0, 0]
materials: [{name: a, density: 2500, youngs_modulus: 5 MPa, restitution: 0.3, friction: 0.5, rolling_friction: 0.05}]
particles: [{lattice: {radius: 1 cm, min: [-4 cm, -4 cm, 0], max: [4 cm, 4 cm, 4 cm], spacing: 2.1 cm}}]
bodies:
  - {name: block, motion: dynamic, mass: 0.5, position: [0.01, 0.005, 0.1], velocity: [0, 0.1, -1], angular_velocity: [0, 3, 0],
     geometries: [{box: {size: [6 cm, 6 cm, 6 cm]}}]}
output: {frame_interval: 0.05, precision: double}
""")
    program.run("hit.yaml", "--quiet")
    with h5py().File("out/trajectory.h5", "r") as file:
        mass, velocity = file["particles/mass"][...], file["bodies/velocity"][:, 0]
        for k in range(len(velocity)):
            momentum = (mass[:, None] * file[f"frames/{k:06d}/velocity"][...]).sum(axis=0) + 0.5 * velocity[k]
            assert abs(momentum - [0, 0.05, -0.5]).max() < 1e-12, (k, momentum)
        assert velocity[-1][2] > -0.85, velocity


def case_one_particle_and_less_than_a_step(program):
    program.small("particles=[{list: [{radius: 1 cm, position: [0, 0, 2 cm]}]}]", "bodies=[]", options=["--quiet"])
    assert summary()["particles"] == 1 and check_trajectory("out", 2) == 2
    program.small("end_time=1e-9", "output={frame_interval: 1e-12, statistics_interval: 1e300}", options=["--quiet"], output="short")
    assert summary("short")["steps"] == 1 and summary("short")["simulated_time"] == 1e-9
    program("run", "/dev/stdin", "--quiet", "--output", "piped", code=3, says=["the scene is empty"])


def case_report_scripts(program):
    try:
        import matplotlib, PIL  # noqa: F401
    except ImportError as missing:
        raise Skip(missing)
    drum(program)
    scripts = os.path.join(os.path.dirname(scene("drum")), "..", "profiling", "report")
    def report(script, *options):
        return subprocess.run([sys.executable, os.path.join(scripts, script), "out", *options], capture_output=True, text=True, timeout=60)

    picture = report("picture.py", "--width", "250", "-o", "last.png")
    assert picture.returncode == 0, picture.stderr
    with open("last.png", "rb") as file:
        assert file.read(8) == b"\x89PNG\r\n\x1a\n"
    slope = report("drum_slope.py")                # of this bed there is no slope, and it says so
    assert slope.returncode != 0
    contains(slope.stderr, ["out: in no frame is the bed's surface long enough to be measured"])


main(globals())
