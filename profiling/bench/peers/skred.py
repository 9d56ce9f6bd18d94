# profiling/bench/peers/skred.py - times Skred itself: with `skred bench`, or with `skred run` on the same scene files.
import csv
import json
from dataclasses import dataclass
from pathlib import Path

import machine
import states
from codes import Result, Settings

ROOT = Path(__file__).resolve().parents[3]


@dataclass
class Skred:
    """verb `run` is for a program without `bench`; its time then includes the first search and the statistics."""
    label: str
    program: str
    folder: Path
    states: Path
    verb: str = "bench"
    timeout: float = 1200.0

    def prepare(self, scene, state):
        pass

    def candidates(self, scene, tune):
        return [Settings()]

    def run(self, scene, settings, processes, steps, repeat, name):
        result = Result(self.label, scene.name, processes, repeat, steps)
        output = self.folder / f"{name}.out"
        stem = self.folder / name
        command, read = ((self.run_command(scene, processes, steps, stem), read_run) if self.verb == "run" else
                         (self.bench_command(scene, processes, steps, stem), read_bench))
        outcome = machine.run([self.program, *command], output, {}, self.timeout, self.folder)
        result.take(outcome)
        if outcome.code != 0:
            tail = output.read_text(errors="replace").strip().splitlines()[-1:]
            result.problems.append(f"exit code {outcome.code}: {' '.join(tail)}")
            return result
        try:
            read(stem, scene, steps, result)
        except (OSError, KeyError, ValueError, IndexError) as error:
            result.problems.append(f"its output is not as expected: {error!r}")
        return result

    def bench_command(self, scene, processes, steps, stem):
        return ["bench", "--scene", scene.name, "--threads", str(processes), "--execution", "graph", "--steps", str(steps),
                "--repeats", "1", "--warm-up", str(scene.warm_steps), "--states", str(self.states), "--json", f"{stem}.json"]

    def run_command(self, scene, processes, steps, stem):
        state = states.state_path(self.states, scene).resolve()
        settings = {"end_time": f"{(steps + scene.warm_steps) * states.TIME_STEP:.9g} s", "output.frame_interval": "0",
                    "output.statistics_interval": f"{scene.warm_steps * states.TIME_STEP:.9g} s", "start.overlap_limit": "1",
                    "particles": f"[{{file: {{path: {state}, radius: 6.36665 mm, material: pellet}}}}]"}
        if scene.kind == "drum":
            file = ROOT / "scenes/drum.yaml"
            settings |= {"a": "10", "wall": "cylinder"}
        else:
            file = ROOT / f"profiling/bench/scenes/{scene.kind}.yaml"
            if scene.kind == "bed":
                settings |= {"spheres_x": str(scene.cells[0]), "spheres_y": str(scene.cells[1])}
        command = ["run", str(file), "--threads", str(processes), "--output", f"{stem}.run", "--overwrite", "--quiet",
                   "--summary", f"{stem}.json"]
        for key, value in settings.items():
            command += ["--set", f"{key}={value}"]
        return command


def read_run(stem, scene, steps, result):
    summary = json.loads(Path(f"{stem}.json").read_text())
    result.rate, result.particles = summary["particle_steps_per_second"], summary["particles"]
    result.steps, result.seconds = summary["steps"], summary["wall_time"]
    with open(f"{stem}.run/statistics.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    result.contacts = sum(float(row["contacts [1]"]) for row in (rows[1], rows[-1])) / result.particles
    result.speed = float(rows[-1]["mean_speed [m/s]"])
    result.searches = summary["searches"]


def read_bench(stem, scene, steps, result):
    timed = json.loads(Path(f"{stem}.json").read_text())["scenes"][0]
    if len(timed["timings"]) != 1 or timed["name"] != scene.name:
        raise ValueError("it has other timings than those asked for")
    timing = timed["timings"][0]
    result.rate, result.particles = timing["particle_steps_per_second"]["median"], timed["particles"]
    result.steps, result.seconds = timing["steps"], timing["steps"] * timing["seconds_per_step"]["median"]
    result.contacts, result.searches = timing["contacts_per_particle"], timing["searches"]
    if result.steps != steps or result.particles != scene.particles:
        result.problems.append(f"{result.steps} steps of {result.particles} particles, not {steps} of {scene.particles}")
