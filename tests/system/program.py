"""tests/system/program.py - the program as its users start it: what the system tests share.

A test script holds functions case_NAME(program); main() runs one by its name, in a folder of its own: SCRIPT PROGRAM NAME,
or lists them all: SCRIPT PROGRAM list. Exit code 77: skipped, for a reason that is printed."""
import json
import os
import subprocess
import sys
import tempfile
import time
import xml.etree.ElementTree as xml

sys.dont_write_bytecode = True
SCENES = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "scenes")
FILES = {"bodies.xdmf", "log.txt", "scene.resolved.yaml", "statistics.csv", "statistics.h5", "summary.json", "trajectory.h5",
         "trajectory.xdmf"}
LIMIT = 60  # [s] a run that takes longer hangs

# Two spheres above a floor; a test appends to it or changes it with --set.
SMALL = """\
end_time: 0.02 s
materials:
  - {name: glass, density: 2500, youngs_modulus: 5 MPa, restitution: 0.5, friction: 0.5, rolling_friction: 0.01}
particles:
  - list:
      - {radius: 1 cm, position: [0, 0, 1.1 cm]}
      - {radius: 1 cm, position: [5 mm, 0, 3.2 cm]}
bodies:
  - {name: floor, geometries: [{plane: {normal: [0, 0, 1]}}]}
bounds: {min: [-1, -1, -0.1], max: [1, 1, 1]}
"""


class Skip(Exception):
    pass


def scene(name):
    return os.path.join(SCENES, name + ".yaml")


def write(path, text):
    with open(path, "wb" if isinstance(text, bytes) else "w") as file:
        file.write(text)
    return path


def read(*path):
    with open(os.path.join(*path)) as file:
        return file.read()


def contains(text, words):
    for word in words:
        assert word in text, f"'{word}' is not in:\n{text}"


class Program:
    def __init__(self, path):
        self.path = os.path.abspath(path)

    def __call__(self, *arguments, code=0, says=(), **options):
        """Runs it to the end, and checks the exit code and the words on standard error; the result has stdout, stderr."""
        words = [self.path, *map(str, arguments)]
        done = subprocess.run(words, capture_output=True, text=True, stdin=subprocess.DEVNULL, timeout=LIMIT, **options)
        told = f"{' '.join(words)}\nexit code {done.returncode}, expected {code}\n{done.stdout[-2000:]}\n{done.stderr[-4000:]}"
        assert done.returncode == code, told
        contains(done.stderr, says)
        return done

    def run(self, path, *arguments, output="out", **expected):
        return self("run", path, "--output", output, *arguments, **expected)

    def small(self, *settings, options=(), **expected):
        """Runs SMALL with --set of each setting."""
        write("small.yaml", SMALL)
        return self.run("small.yaml", *options, *(word for s in settings for word in ("--set", s)), **expected)

    def start(self, *arguments):
        return subprocess.Popen([self.path, *map(str, arguments)], stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                                stderr=subprocess.PIPE, text=True)


def summary(folder="out"):
    return json.loads(read(folder, "summary.json"))


def state_hash(folder="out"):
    return summary(folder)["state_hash"]


def vector_paths():
    """Those that this processor has, by what the system says of it; the widest last."""
    with open("/proc/cpuinfo") as file:
        flags = next((line.split() for line in file if line.startswith("flags")), [])
    needs = {"sse2": ["sse2"], "avx2": ["avx2"], "avx512": ["avx512f", "avx512dq", "avx512vl"]}
    return ["scalar"] + [name for name, all_of in needs.items() if set(all_of) <= set(flags)]


def h5py():
    try:
        import h5py as module
    except ImportError as missing:
        raise Skip(missing)
    return module


def check_trajectory(folder, least_frames):
    """The file has whole frames and nothing else, and trajectory.xdmf refers to what is there. Returns the number of frames."""
    with h5py().File(os.path.join(folder, "trajectory.h5"), "r") as file:
        times, counts = file["frames/time"][...], file["VTKHDF/NumberOfPoints"][...]
        frames = len(times)
        assert frames >= least_frames and (times[1:] > times[:-1]).all(), f"{frames} frames at {times}"
        assert file["VTKHDF/Steps"].attrs["NSteps"] == frames and len(file["particles/position"]) == counts.sum()
        for k, (first, count) in enumerate(zip(file["VTKHDF/Steps/PointOffsets"][...], counts)):
            assert count == 0 or (file[f"frames/{k:06d}/position"][...] == file["particles/position"][first:first + count]).all(), k
        for item in xml.parse(os.path.join(folder, "trajectory.xdmf")).iter("DataItem"):
            assert list(file[item.text.split(":")[1]].shape) == [int(n) for n in item.get("Dimensions").split()], item.text
        return frames


def wait_for(what, process, seconds=LIMIT):
    """Until what() is true of the running process."""
    end = time.monotonic() + seconds
    while not what():
        assert process.poll() is None, f"the run ended with {process.returncode}:\n{process.stderr.read()}"
        assert time.monotonic() < end, "waited for nothing"
        time.sleep(0.02)


def main(cases):
    cases = {name[5:]: case for name, case in cases.items() if name.startswith("case_")}
    program, name = sys.argv[1:]
    if name == "list":
        print("\n".join(cases))
        return
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        try:
            cases[name](Program(program))
        except Skip as reason:
            print("skipped:", reason)
            sys.exit(77)
        finally:
            os.chdir("/")
