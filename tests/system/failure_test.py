#!/usr/bin/env python3
"""tests/system/failure_test.py - bad input, full disks, interruptions and runs that become unphysical: the exit code, the words of
the message, and what is left on the disk. See program.py."""
import os
import random
import resource
import signal
import subprocess
import time

from program import FILES, LIMIT, SMALL, Skip, check_trajectory, contains, main, read, scene, summary, vector_paths, wait_for, write

LIST = "particles=[{list: [%s]}]"
PAIR = LIST % "{radius: 1 cm, position: [0, 0, 2 cm]}, {radius: 1 cm, position: [0, 0, 3.5 cm]}"


# The scene file ------------------------------------------------------------------------------------------------------


def case_unknown_key(program):
    write("s.yaml", SMALL + "gravty: [0, 0, -1]\n")
    program("run", "s.yaml", code=3, says=["s.yaml:11:1: error: unknown key 'gravty'; did you mean 'gravity'?", "gravty: [0, 0, -1]\n  ^"])
    program.small("materials.glass.frictoin=1", code=3, says=["--set materials.glass.frictoin=1", "did you mean 'friction'?"])
    program.small("a=10", code=3, says=["no key or parameter 'a'"])


def case_wrong_unit(program):
    write("s.yaml", SMALL.replace("5 MPa", "5 mm").replace("0.02 s", "0.02 m"))
    program("run", "s.yaml", code=3, says=["s.yaml:1:11: error: end_time: '0.02 m' is a length [m]; expected a time [s]",
                                           "s.yaml:3:", "youngs_modulus: '5 mm' is a length"])


def case_out_of_range(program):
    program.small(LIST % "{radius: -1 cm, position: [0, 0, 1]}", code=3, says=["radius: -1 cm is out of range: must be > 0 m"])
    program.small("materials.glass.restitution=1.5", code=3, says=["restitution", "1.5", "out of range"])
    program.small("materials.glass.restitution=0", code=3, says=["'glass'", "restitution 0 is out of range", "0.01 .. 1"])
    program.small("periodic.x=[0, 4 cm]", "search.skin=3 mm", code=3, says=["periodic: x: a length of 0.04 m is too short: at least 0.046 m"])
    program.small("end_time=1e300", code=3, says=["end_time: 1e+300 s takes", "steps", "allowed 1e+15"])
    program.small("time_step=1e-300", code=3, says=["end_time: 0.02 s takes", "steps of 1e-300 s"])
    for setting in ("gravity=[0, 0, 1e308]", LIST % "{radius: 1 cm, position: [0, 0, 1], velocity: [1e300, 0, 0]}",
                    LIST % "{radius: 1e-120, position: [0, 0, 1]}"):
        program.small(setting, code=3, says=["time_step: none can be found", "SI units"])


def case_overlapping_start(program):
    program.small(PAIR, code=3, says=["particle 0 and particle 1", "0.5 of the smaller radius", "allowed 0.01", "relax: true"])
    program.small(LIST % "{radius: 1 cm, position: [0, 0, 5 mm]}", code=3, says=["particle 0 and body 'floor' by 0.5"])
    program.small(PAIR, "start.relax=true", says=["relaxed the start", "greatest overlap 0.5 ->"])
    same = ", ".join(["{radius: 1 cm, position: [0, 0, 2 cm]}"] * 3)
    program.small(LIST % same, "start.relax=true", options=["--overwrite"], says=["relaxed the start", "greatest overlap 2 ->", "finished"])
    cage = "bodies=[{name: low, geometries: [{plane: {}}]}, {name: high, geometries: [{plane: {normal: [0, 0, -1], point: [0, 0, 1 cm]}}]}]"
    program.small(LIST % "{radius: 1 cm, position: [0, 0, 5 mm]}", cage, "start.relax=true", code=3, says=["may be no room"],
                  output="none")
    assert not os.path.exists("none")


def case_bodies_that_cannot_touch(program):
    write("valley.obj", "v -1 -1 1\nv 0 -1 0\nv 0 1 0\nv -1 1 1\nv 1 -1 1\nv 1 1 1\nf 1 2 3 4\nf 2 5 6 3\n")
    block = "{name: block, motion: dynamic, mass: 1, position: [0, 0, %s], geometries: [{box: {size: [0.1, 0.1, 0.1]}}]}"
    program.small("bodies=[{name: valley, geometries: [{mesh: {file: valley.obj}}]}, %s]" % block % 1, code=3, options=["--quiet"],
                  says=["bodies 'valley' and 'block' may touch: a mesh that is not convex and closed and a box", "several convex parts"])
    program.small("bodies=[{name: floor, geometries: [{plane: {}}]}, %s]" % block % 0.04, "particles=[{list: [{radius: 1 cm, position: [1, 0, 2 cm]}]}]",
                  code=3, options=["--quiet"], says=["overlap at the start: bodies 'floor' and 'block' by 0.115 of the smaller outer radius"])


def case_missing_file(program):
    program.run("no.yaml", code=3, says=["no.yaml", "No such file"])
    program.run("/tmp", code=3, says=["/tmp", "it is a folder"])
    program.small("particles=[{file: {path: no.csv}}]", code=3, says=["there is no file", "no.csv"])
    program.small("bodies=[{name: b, geometries: [{mesh: {file: no.obj}}]}]", code=3, says=["there is no file", "no.obj"])


def case_bad_mesh(program):
    corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\n"
    for name, text, why in (("degenerate.obj", corners + "f 1 2 2\n", "triangle 1: degenerate"),
                            ("none.obj", corners, "the mesh has no triangles"),
                            ("beyond.obj", corners + "f 1 2 9\n", "refers to vertex 9"),
                            ("nan.obj", corners.replace("0 0 0", "0 0 nan") + "f 1 2 3\n", "not a finite number"),
                            ("cut.stl", bytes(80) + b"\x02\0\0\0" + bytes(50), "truncated")):
        write(name, text)
        program.small("bodies=[{name: b, geometries: [{mesh: {file: %s}}]}]" % name, code=3, says=[name, why])
    assert not os.path.exists("out")


def case_bad_table(program):
    for text, why in (("x,y,z,radius\n0,0,nan,0.01\n", ["p.csv:2", "column z: 'nan' is not a finite number"]),
                      ("id,x,y,z,radius\n1,0,0,1,0.01\n1,0,0,2,0.01\n", ["p.csv:3", "column id: 1 was given before, in line 2"]),
                      ("x,y,z,radius\n0,0,1,-0.01\n", ["p.csv:2", "radius", "must be > 0 m"]),
                      ("x,y,z,radius\n0,0,1\n", ["p.csv:2", "3 cells; the header has 4"]),
                      ("", ["p.csv", "the file is empty"])):
        write("p.csv", text)
        program.small("particles=[{file: {path: p.csv}}]", code=3, says=why)


def case_empty_scene(program):
    write("s.yaml", "")
    program.run("s.yaml", code=3, says=["s.yaml:1:1: error: the scene is empty"])
    program.small("particles=[]", code=3, says=["particles: empty"])
    write("p.csv", "x,y,z,radius\n")
    program.small("particles=[{file: {path: p.csv}}]", code=3, says=["the scene has no particles"])


def case_threads(program):
    for n in ("0", "-1", "x", "10000", "2.5", "1025"):
        program.small(options=["--threads", n], code=2, says=[f"--threads: '{n}' is not allowed: 1 .. 1024 or 'auto'"])
    program.small("end_time=1 ms", options=["--threads", "1024", "--quiet"])
    assert summary()["threads"] == 1024


def case_vector_path(program):
    here = vector_paths()
    has = "this machine has " + ", ".join(["auto", *here])
    for name in ("sse", "AVX2", "avx512f", "", "auto,scalar"):
        program.small(options=["--vector", name], code=2, says=[f"--vector: '{name}' is not allowed", has])
    for name in {"sse2", "avx2", "avx512"} - set(here):
        program.small(options=["--vector", name], code=2, says=[f"--vector: the processor has no '{name}'", has])
    assert not os.path.exists("out"), "a refused run leaves nothing behind"
    program.small("end_time=1 ms", options=["--vector", "scalar"], says=["; vector path scalar\n"])


def case_time_step_too_large(program):
    said = ["time_step: 0.001 s is too large: at most 0.000", "recommended", "--force"]
    program.small("time_step=1 ms", code=3, says=said)
    program("validate", "small.yaml", "--time-step", "1 ms", code=3, says=said)
    program("validate", "small.yaml", "--method", "ndem", "--set", "solver.time_step=15 ms", code=3,
            says=["solver.time_step: 0.015 s is too large: at most 0.0", "goes its radius", "recommended 0.00", "--force"])
    program.small("time_step=0.4 ms", "end_time=1.2 ms", options=["--force"], says=["warning: time_step: 0.0004 s is too large", "forced"])


# Where results go ----------------------------------------------------------------------------------------------------


def case_unwritable_output(program):
    write("file", "")
    program.small(output="file", code=5, says=["file: cannot be the output folder: it is a file"])
    program.small(output="/proc/skred", code=5, says=["/proc/skred: cannot make the output folder"])
    program.small(output="a" * 300, code=5, says=["File name too long"])
    for option in ("--trace", "--timeline", "--summary"):
        program.small(options=[option, "none/file"], code=5, says=["none/file: cannot be written: No such file"])
    program.small("end_time=1 ms", options=["--quiet", "--summary", "/dev/full"], code=5, says=["/dev/full", "No space left"])
    assert summary()["outcome"] == "finished", "the folder's own summary does not depend on the copy"


LONG = ["run", "small.yaml", "--end-time", "1000", "--set", "output={frame_interval: 1 ms, statistics_interval: 1 ms, precision: double}"]


def case_full_disk(program):
    write("small.yaml", SMALL)
    os.mkdir("disk")
    mount = "mount -t tmpfs -o size=2500k tmpfs disk && " if os.geteuid() == 0 else ""
    if not mount or subprocess.run(["unshare", "-m", "sh", "-c", mount + "true"], capture_output=True).returncode:
        raise Skip("no file system of its own can be mounted here")
    keep = '"$@"; code=$?; cp -r disk/out kept; exit $code'
    done = subprocess.run(["unshare", "-m", "sh", "-c", mount + keep, "sh", program.path, *LONG, "--output", "disk/out"],
                          capture_output=True, text=True, timeout=LIMIT)
    assert done.returncode == 5, (done.returncode, done.stderr)
    contains(done.stderr, ["error: disk/out/trajectory.h5: cannot write the frame at ", "No space left on device", "output error at t = "])
    assert check_trajectory("kept", 2) > 10


def case_file_size_limit(program):
    write("small.yaml", SMALL)

    def limit():
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        resource.setrlimit(resource.RLIMIT_FSIZE, (2_000_000, 2_000_000))

    program(*LONG, "--output", "out", code=5, says=["error: out/", "cannot write the frame at ", "File too large", "output error at t = "], preexec_fn=limit,
            restore_signals=False)
    assert check_trajectory("out", 2) > 10


# Runs that end early -------------------------------------------------------------------------------------------------


def started(program, *options):
    """A run that has written three frames and would go on for long."""
    write("small.yaml", SMALL)
    process = program.start(*LONG, "--output", "out", *options)
    wait_for(lambda: os.path.exists("out/trajectory.xdmf") and read("out", "trajectory.xdmf").count("<Time") >= 3, process)
    return process


def case_interrupted_once(program):
    for sent in (signal.SIGINT, signal.SIGTERM):
        process = started(program)
        process.send_signal(sent)
        said = process.communicate(timeout=LIMIT)[1]
        assert process.returncode == 130, (process.returncode, said)
        contains(said, ["interrupted at t = ", "writing what there is"])
        assert set(os.listdir("out")) == FILES
        s = summary()
        assert s["outcome"] == "interrupted" and 0 < s["simulated_time"] < 1000
        assert check_trajectory("out", 3) == s["frames"]
        steps = [line.split(",")[1] for line in read("out", "statistics.csv").splitlines()[1:]]
        assert steps[-1] == str(s["steps"]) and len(set(steps)) == len(steps), "every step once, up to the last"
        os.rename("out", f"out-{sent}")


def case_interrupted_twice(program):
    process = started(program)
    process.send_signal(signal.SIGSTOP)        # both signals are there when it goes on
    process.send_signal(signal.SIGINT)
    process.send_signal(signal.SIGTERM)
    process.send_signal(signal.SIGCONT)
    said = process.communicate(timeout=LIMIT)[1]
    assert process.returncode == 130, (process.returncode, said)
    contains(said, ["interrupted twice, ending at once"])
    assert not os.path.exists("out/summary.json")
    check_trajectory("out", 2)


LARGE = "particles=[{lattice: {radius: 1 cm, min: [-0.3, -0.3, 0], max: [0.3, 0.3, 1], spacing: 2.1 cm}}]"


def case_killed(program):
    for k, options in enumerate(2 * [[], ["--set", LARGE]]):   # most of the time something is being written
        process = started(program, *options)
        time.sleep(random.uniform(0, 0.3))
        process.kill()
        process.communicate(timeout=LIMIT)
        check_trajectory("out", 3)
        os.rename("out", f"out-{k}")


# Runs that become unphysical -----------------------------------------------------------------------------------------


def case_particles_fall_out(program):
    fall = ["bodies=[]", "bounds.min=[-1, -1, 0]", "end_time=0.1 s"]
    program.small(*fall, code=4, says=["error: t = 0.04", "particle 0 at (0, 0, -", "left the bounds", "gap between walls", "action: report"])
    assert summary()["outcome"] == "numerical failure" and set(os.listdir("out")) == FILES - {"bodies.xdmf"}
    assert check_trajectory("out", 2) == summary()["frames"]
    program.small(*fall, "bounds.action=report", says=["1 particle outside the bounds", "finished"], output="report")
    assert summary("report")["particles_outside_bounds"] == 2 and summary("report")["outcome"] == "finished"
    program.small("bounds.max=[1, 1, 0.03]", code=3, says=["particle 1 starts at", "outside the bounds"])


def case_many_particles_outside_are_told_briefly(program):
    heap = "particles=[{lattice: {radius: 1 cm, min: [0, 0, 0], max: [10 cm, 10 cm, 60 cm], spacing: 2.1 cm, jitter: 1 %}}]"
    program.small(heap, "bodies=[]", "bounds={min: [-1, -1, -0.01], max: [1, 1, 1], action: report}", "end_time=0.4 s", options=["--quiet"])
    told = [line for line in read("out", "log.txt").splitlines() if "outside" in line]
    assert summary()["particles_outside_bounds"] > 300 and 2 <= len(told) <= 12, told


def case_explosion(program):
    for step in ("0.05", "1 ms", "0.6 ms"):
        program.run(scene("drum"), "--time-step", step, "--end-time", "1 s", "--force", "--overwrite", "--quiet", code=4,
                    says=["error: t = ", "step ", "particle ", "likely causes: a time step that is too large"])
        s = summary()
        assert s["outcome"] == "numerical failure" and s["steps"] * s["time_step"] < 1 and s["frames"] >= 2
        assert check_trajectory("out", 2) == s["frames"]


def case_overlap_beyond_the_limit(program):
    program.small(LIST % "{radius: 1 cm, position: [0, 0, 1.5 cm], velocity: [0, 0, -20]}", "time_step=10 us", "limits.overlap=0.3",
                  "output.statistics_interval=10 us", code=4, says=["particle 0: overlap of 0.3", "allowed 0.3 (limits.overlap)"])


def told_by(done):
    """The closing line."""
    return next(line for line in reversed(done.stderr.splitlines()) if line.startswith("finished"))


def case_solver_short_of_its_tolerance(program):
    """Of nonsmooth DEM: it says so on the terminal, in the log, in the summary and in the time series."""
    nonsmooth = ["--method", "ndem", "--time-step", "1 ms"]
    stack = ", ".join("{radius: 1 cm, position: [0, 0, %g]}" % (0.0099 + 0.0198 * k) for k in range(10))
    done = program.small(LIST % stack, "solver={iterations: 3, tolerance: 1e-9}", "end_time=0.1", options=nonsmooth)
    s = summary()
    told = "%d of 100 steps stopped at 3 sweeps above the tolerance 1e-09 (greatest residual " % s["steps_unsolved"]
    assert s["steps_unsolved"] > 50 and s["greatest_residual"] > 1e-9 and s["most_iterations"] == 3, s
    contains(done.stderr, ["finished at t = 0.1", told])
    contains(read("out", "log.txt"), [told])
    header, *rows = [line.split(",") for line in read("out", "statistics.csv").splitlines()]
    assert int(rows[-1][header.index("steps_unsolved [1]")]) == s["steps_unsolved"]
    assert 0 < s["greatest_error"] < 1 and "inf" not in told_by(done), s
    done = program.small(LIST % stack, "solver={iterations: 1, tolerance: 1e-9}", "end_time=0.1", options=nonsmooth, output="one")   # no trend
    s = summary("one")
    assert s["steps_unsolved"] == s["steps_of_unknown_error"] == 100 and s["greatest_error"] == 0, s
    contains(told_by(done), ["the error tolerance 0.1 (error unknown in 100 steps, whose changes hardly fell from sweep to sweep)"])
    done = program.small(LIST % stack, "solver={iterations: 5000, tolerance: 1e-9}", options=nonsmooth, output="solved")
    s = summary("solved")
    assert s["steps_unsolved"] == s["steps_of_unknown_error"] == 0 and "above the tolerance" not in done.stderr


def case_rounding_is_no_error(program):
    """Where the silo's first contacts close, sweeps change nothing but the rounding of falling spheres, by the same amount each time."""
    done = program.run(scene("silo"), "--method", "ndem", "--end-time", "0.04")
    s = summary()
    assert s["steps_unsolved"] == s["steps_of_unknown_error"] == 0 and s["most_iterations"] < 100 and s["greatest_error"] < 0.1, s
    assert "above the tolerance" not in done.stderr


def case_nonsmooth_beyond_numbers(program):
    nonsmooth = ["--method", "ndem", "--time-step", "1 ms", "--quiet", "--overwrite"]
    program.small("gravity=[0, 0, -1e160]", options=nonsmooth, code=3, says=["time_step: none can be found"])
    program.small(LIST % "{radius: 1 cm, position: [0, 0, 9 mm], angular_velocity: [0, 1e200, 0]}", options=nonsmooth, code=4,
                  says=["error: t = 0 s", "not a number"])
    program.small(LIST % "{radius: 1 cm, position: [0, 0, 9 mm], velocity: [1e6, 0, 0]}", "expected_speed=1", options=nonsmooth, code=4,
                  says=["particle 0 at (", "left the bounds"])


def case_contact_beyond_numbers(program):
    """Spheres so light that 1/m overflows: nonsmooth DEM names the contact; smooth DEM the particle, for it divides before it looks."""
    light = ["materials.glass.density=1e-305", LIST % "{radius: 1 cm, position: [0, 0, 1 cm]}, {radius: 1 cm, position: [0, 0, 3 cm]}"]
    program.small(*light, options=["--method", "ndem", "--time-step", "1 ms", "--quiet"], code=4,
                  says=["error: t = 0.001 s, step 1, contact of particle 0 (radius 0.01 m, mass 4.18879e-311 kg) and particle 1 (radius 0.01 m",
                        "not a number; likely causes: masses, radii"])
    assert summary()["outcome"] == "numerical failure"
    program.small(*light, options=["--time-step", "1 ms", "--force", "--quiet", "--overwrite"], code=4,
                  says=["error: t = 0 s, step 0, particle 0", "not a number; likely causes: masses, radii"])


def case_body_gone_wild(program):
    block = "bodies=[{name: block, motion: dynamic, mass: 1, position: [0, 0, 0.5], %s, geometries: [{sphere: {radius: 1 cm}}]}]"
    program.small(block % "angular_velocity: [1e200, 1e200, 0]", "expected_speed=1", code=4, says=["t = 0 s", "body 'block'", "not a number"])
    program.small(block % "velocity: [0, 0, 1e6]", "expected_speed=1", options=["--overwrite"], code=4,
                  says=["body 'block'", "moves more than the smallest particle's radius (0.01 m)"])


main(globals())
