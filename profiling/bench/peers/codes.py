# profiling/bench/peers/codes.py - how LAMMPS and LIGGGHTS are set up for a scene, run and read.
"""One input text per code and scene kind. What was found about both codes, and why they are set as they are:

LAMMPS (29 Sep 2021, Debian 12)
  - `damping tsuji` feeds the reduced mass to a fit that wants the particle's: a measured restitution of 0.18 takes 0.0538.
  - xt = sqrt(4 G*/E*) = 0.926 makes its tangential damping that of LIGGGHTS and Skred. Its rolling spring is a constant: 4000 N/m
    is 8 G* a at a usual overlap.
  - A cylinder turned by `wall/gran ... shear` adds up its speed over the particles and throws them out; a rotating region is right.
  - Two processes must split a drum across its diameter, with the cut balanced, and a column across its axis.
  - compute contact/atom may show an old list's value at the first output of a run: one step is run, and its end is read.
LIGGGHTS (3.8, Debian 12)
  - `hertz` with `tangential history` and `epsd2` is Skred's law but for details; no load balance: a drum is halved along its axis.
  - Curved walls may be a triangle mesh or a primitive; which is faster depends on scene and machine, so both are tried.
    A primitive is turned by `shear`, which is an angular rate in the source and a speed in the manual: alike at R = 1 m only.
"""
import re
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

import machine
import states

GRAVITY = 9.81
SIDES = {"drum": 240, "column": 96}     # of the mesh walls
MPI = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", "OMP_NUM_THREADS": "1"}


@dataclass(frozen=True)
class Settings:
    """What may be chosen freely for speed, without a change of the physics."""
    skin: float = 0.0                   # [m]
    wall: str = ""                      # of LIGGGHTS: mesh or primitive

    def __str__(self):
        return ", ".join([f"skin {self.skin * 1e3:g} mm"] * (self.skin > 0) + [f"{self.wall} wall"] * bool(self.wall))


@dataclass
class Result:
    """One timed run. `problems` is empty if all is well."""
    code: str
    scene: str
    processes: int
    repeat: int
    steps: int = 0
    particles: int = 0
    seconds: float = 0.0                # of the timed steps
    rate: float = 0.0                   # [particle-steps/s]
    contacts: float = 0.0               # between particles, per particle (each counts for both): mean of before and after
    speed: float = 0.0                  # [m/s] mean over the particles, at the end; 0: not told
    searches: int = 0                   # within the timed steps
    settings: str = ""
    memory: float = 0.0
    others: float = 0.0
    steal: float = 0.0
    load: float = 0.0
    problems: list = field(default_factory=list)

    def take(self, outcome):
        self.memory, self.others, self.steal, self.load = outcome.memory, outcome.others, outcome.steal, outcome.load


def gravity(scene):
    direction = {"drum": (0, -1, 0), "column": (0, 0, -1), "bed": (np.sin(states.TILT), 0, -np.cos(states.TILT))}[scene.kind]
    return "fix gravity all gravity {} vector {:.15g} {:.15g} {:.15g}".format(GRAVITY, *direction)


def lammps_input(scene, data, settings, processes, steps):
    pellet = "hertz/material 6.1684e6 0.0538 0.25 tangential mindlin NULL 0.926 {} {}damping tsuji"
    rough = pellet.format("0.91", "rolling sds 4000.0 0.0 0.3211 ")
    smooth = pellet.format("0.0", "")
    split = {"drum": ("x", f"{processes} 1 1"), "column": ("z", f"1 1 {processes}"), "bed": ("", f"{processes} 1 1")}[scene.kind]
    walls = {
        "drum": ["variable angle equal 0.5*step*dt",
                 "region drum cylinder z 0 0 1.0 -5 5 units box rotate v_angle 0 0 0 0 0 1",
                 f"fix drum all wall/gran/region granular {rough} region drum",
                 f"fix ends all wall/gran granular {smooth} zplane -0.1 0.1"],
        "column": [f"fix cylinder all wall/gran granular {rough} zcylinder 0.2",
                   f"fix floor all wall/gran granular {rough} zplane 0.0 NULL"],
        "bed": [f"fix floor all wall/gran granular {rough} zplane 0.0 NULL"],
    }[scene.kind]
    balance = []
    if processes > 1 and split[0]:
        balance = [f"balance 1.01 shift {split[0]} 20 1.005", f"fix balance all balance 2000 1.03 shift {split[0]} 20 1.02"]
    return "\n".join([
        "units si", "atom_style sphere", "newton off", "comm_modify vel yes", f"processors {split[1]}",
        f"boundary {'p p f' if scene.kind == 'bed' else 'f f f'}", f"read_data {data}", f"timestep {states.TIME_STEP}",
        "pair_style granular", f"pair_coeff * * {rough}", f"neighbor {settings.skin} bin",
        "neigh_modify every 1 delay 0 check yes", "fix motion all nve/sphere", gravity(scene), *walls, *balance,
        *measurement(scene, steps)])


def liggghts_input(scene, data, settings, processes, steps, mesh):
    law = "model hertz tangential history rolling_friction epsd2"
    plane = f"all wall/gran {law} primitive type"
    walls = {"drum": [f"fix left {plane} 2 zplane -0.1", f"fix right {plane} 2 zplane 0.1"],
             "column": [f"fix floor {plane} 1 zplane 0.0"], "bed": [f"fix floor {plane} 1 zplane 0.0"]}[scene.kind]
    if scene.kind != "bed" and settings.wall == "mesh":
        walls += [f"fix triangles all mesh/surface file {mesh} type 1 curvature_tolerant yes",
                  f"fix cylinder all wall/gran {law} mesh n_meshes 1 meshes triangles"]
        if scene.kind == "drum":
            walls += [f"fix turn all move/mesh mesh triangles rotate origin 0. 0. 0. axis 0. 0. 1. period {2 * np.pi / 0.5:.15g}"]
    elif scene.kind == "drum":
        walls += [f"fix cylinder {plane} 1 zcylinder 1.0 0. 0. shear x 0.5"]
    elif scene.kind == "column":
        walls += [f"fix cylinder {plane} 1 zcylinder 0.2 0. 0."]
    pair = "fix {} all property/global {} peratomtypepair 2 {}"
    return "\n".join([
        "atom_style granular", "atom_modify map array", "units si", "newton off", "communicate single vel yes",
        f"processors {f'{processes} 1 1' if scene.kind == 'bed' else f'1 1 {processes}'}",
        f"boundary {'p p f' if scene.kind == 'bed' else 'f f f'}", "hard_particles no", f"read_data {data}",
        f"neighbor {settings.skin} bin", "neigh_modify every 1 delay 0 check yes",
        "fix m1 all property/global youngsModulus peratomtype 6.1684e6 6.1684e6",
        "fix m2 all property/global poissonsRatio peratomtype 0.25 0.25",
        pair.format("m3", "coefficientRestitution", "0.18 0.18 0.18 0.18"),
        pair.format("m4", "coefficientFriction", "0.91 0.0 0.0 0.0"),
        pair.format("m5", "coefficientRollingFriction", "0.3211 0.0 0.0 0.0"),
        f"pair_style gran {law}", "pair_coeff * *", f"timestep {states.TIME_STEP}", "fix motion all nve/sphere",
        gravity(scene), *walls, *measurement(scene, steps)])


def measurement(scene, steps):
    """The timed steps between two single ones that measure, after the untimed ones."""
    plain = ["thermo_style custom step atoms", "thermo_modify lost ignore norm no"]
    measure = ["thermo_style custom step atoms c_contacts c_speed", "thermo_modify lost ignore norm no", "run 1"]
    return ["variable speed atom sqrt(vx*vx+vy*vy+vz*vz)", "compute speed all reduce ave v_speed",
            "compute touching all contact/atom", "compute contacts all reduce ave c_touching", "thermo 0",
            *plain, f"run {scene.warm_steps - 1}", *measure, *plain, f"run {steps}", *measure, ""]


LOOP = re.compile(r"Loop time of (\S+) on (\d+) procs for (\d+) steps with (\d+) atoms")


def read_log(text, scene, steps, result):
    """Fills the result from a log of either code; what is wrong goes to its problems."""
    error = re.search(r"^.*ERROR.*$", text, re.M)
    if error:
        result.problems.append(error[0].strip())
        return
    loops = list(LOOP.finditer(text))
    planned = [scene.warm_steps - 1, 1, steps, 1]
    if [int(loop[3]) for loop in loops] != planned:
        result.problems.append(f"the log has runs of {[int(loop[3]) for loop in loops]} steps, not {planned}")
        return
    timed = loops[2]
    result.seconds, processes, result.steps, result.particles = float(timed[1]), int(timed[2]), int(timed[3]), int(timed[4])
    result.rate = result.particles * steps / result.seconds
    if processes != result.processes:
        result.problems.append(f"ran on {processes} processes")
    # The line before each loop's time has the last output of that run.
    rows = [text[: loops[k].start()].splitlines()[-1].split() for k in (1, 3)]
    when = [str(scene.warm_steps), str(scene.warm_steps + steps + 1)]
    if [len(row) for row in rows] != [4, 4] or [row[0] for row in rows] != when:
        result.problems.append(f"no measurements before and after, but {' '.join(rows[0])} | {' '.join(rows[1])}")
        return
    result.contacts = sum(float(row[2]) for row in rows) / 2
    result.speed = float(rows[1][3])
    lost = scene.particles - int(rows[1][1])
    if lost:
        result.problems.append(f"{lost} particles lost")
    after = text[timed.end() : loops[3].start()]
    builds, dangerous = (re.search(kind + r" builds = (\d+)", after) for kind in ("Neighbor list", "Dangerous"))
    result.searches = int(builds[1]) if builds else 0
    if dangerous and int(dangerous[1]):
        result.problems.append(f"{dangerous[1]} dangerous builds")


@dataclass
class Peer:
    """LAMMPS or LIGGGHTS."""
    label: str
    program: str
    kind: str                           # lammps or liggghts
    folder: Path
    timeout: float = 1200.0
    prepared: dict = field(default_factory=dict)

    def prepare(self, scene, state):
        """Writes the scene's files, which LAMMPS and LIGGGHTS share."""
        data, mesh = self.folder / f"{scene.name}.data", self.folder / f"{scene.name}.stl"
        if not data.exists():
            states.write_data(data, state)
        if scene.kind == "drum":
            states.write_cylinder(mesh, 1.0, -0.105, 0.105, SIDES["drum"], 2)
        elif scene.kind == "column":
            states.write_cylinder(mesh, 0.2, -0.01, state.high[2] - 0.004, SIDES["column"], scene.pieces)
        self.prepared[scene.name] = (data, mesh)

    def candidates(self, scene, tune):
        skins = [scene.skin * f for f in ((0.5, 1, 2) if tune else (1,))]
        walls = ("mesh", "primitive") if self.kind == "liggghts" and scene.kind != "bed" else ("",)
        return [Settings(skin, wall) for wall in walls for skin in skins]

    def run(self, scene, settings, processes, steps, repeat, name):
        data, mesh = self.prepared[scene.name]
        text = (lammps_input(scene, data, settings, processes, steps) if self.kind == "lammps" else
                liggghts_input(scene, data, settings, processes, steps, mesh))
        file, log, output = (self.folder / f"{name}.{end}" for end in ("in", "log", "out"))
        file.write_text(text)
        command = [] if processes == 1 else ["mpirun", "-np", str(processes), "--bind-to", "core"]
        command += [self.program, "-in", str(file), "-log", str(log)]
        log.unlink(missing_ok=True)
        outcome = machine.run(command, output, MPI, self.timeout, self.folder)
        result = Result(self.label, scene.name, processes, repeat, steps, settings=str(settings))
        result.take(outcome)
        if log.exists():
            read_log(log.read_text(errors="replace"), scene, steps, result)
        if outcome.code != 0 or not log.exists():
            tail = output.read_text(errors="replace").strip().splitlines()[-1:]
            result.problems.append(f"exit code {outcome.code}: {' '.join(tail)}")
        return result
