# profiling/bench/peers/states.py - the scenes of `skred bench`, their settled states, and the same as input for the other codes.
"""Positions, velocities and spins of the particles are handed on to 12 digits; contact springs start empty in every code.

The drum of Skred turns about +y and up is z; the other codes like their cylinders along z, so up is y there:
(X, Y, Z) = (-x, z, y), a proper rotation, of vectors and spins alike. Columns and beds are the same in all codes."""
from dataclasses import dataclass, field
from pathlib import Path

import h5py
import numpy as np

RADIUS = 0.00636665                     # [m] of every pellet
DENSITY = 3700.0                        # [kg/m^3]
TIME_STEP = 5e-5                        # [s]
SPACING = 2.06 * RADIUS                 # [m] of the lattice that the beds were dropped in: what their periods are counted in
TILT = np.radians(26.0)                 # of gravity in the beds
VERSION = 1                             # of the states


class Failure(Exception):
    """Something the user can put right; its text is all that he is told."""


@dataclass(frozen=True)
class Scene:
    name: str
    kind: str                           # drum, column or bed
    particles: int
    skin: float                         # [m] of the other codes' neighbour lists
    least_steps: int                    # of a timed window, so that it holds several searches
    warm_steps: int = 100               # untimed, before: the springs refill
    cells: tuple = (0, 0)               # a bed's periods in x and y, in lattice spacings
    pieces: int = 4                     # of a column's mesh along the axis

    @property
    def periods(self):
        return tuple(n * SPACING for n in self.cells)


SCENES = {scene.name: scene for scene in (
    Scene("drum", "drum", 95052, 2e-3, 300),
    Scene("column-11k", "column", 11000, 0.7e-3, 1000, 200),
    Scene("column-100k", "column", 100000, 1.5e-3, 300, pieces=16),
    Scene("bed-1k", "bed", 1000, 0.4e-3, 1000, cells=(10, 10)),
    Scene("bed-10k", "bed", 10000, 0.4e-3, 500, cells=(25, 20)),
    Scene("bed-32k", "bed", 32000, 0.4e-3, 300, cells=(40, 40)),
    Scene("bed-256k", "bed", 256000, 0.4e-3, 100, cells=(160, 80)),
    Scene("bed-1m", "bed", 1024000, 0.4e-3, 60, cells=(320, 160)),
)}


@dataclass
class State:
    position: np.ndarray                # n x 3 [m]
    velocity: np.ndarray                # n x 3 [m/s]
    spin: np.ndarray                    # n x 3 [rad/s]
    low: np.ndarray = field(default=None)    # corners of the box that the other codes are given [m]
    high: np.ndarray = field(default=None)


def state_path(folder, scene):
    return Path(folder) / f"{scene.name}-{VERSION}.h5"


def read_state(folder, scene):
    path = state_path(folder, scene)
    if not path.is_file():
        raise Failure(f"{path}: no such file; `skred bench --scene {scene.name} --settle-only --states {folder}` makes it")
    with h5py.File(path, "r", locking=False) as file:
        state = State(*(file[name][:].astype(float) for name in ("position", "velocity", "angular_velocity")))
        radius = file["radius"][:]
    if len(state.position) != scene.particles:
        raise Failure(f"{path}: {len(state.position)} particles; the scene has {scene.particles}")
    if np.ptp(radius) > 0 or abs(radius[0] - RADIUS) > 1e-9:
        raise Failure(f"{path}: radii are not all {RADIUS} m")
    return state


def for_peers(scene, state):
    """The state in the other codes' axes, in a box that ends closely above the particles, so that halves of it are even."""
    if scene.kind == "drum":
        turned = [np.stack([-v[:, 0], v[:, 2], v[:, 1]], axis=1) for v in (state.position, state.velocity, state.spin)]
        return State(*turned, low=np.array([-1.02, -1.02, -0.11]), high=np.array([1.02, 1.02, 0.11]))
    position = state.position.copy()
    top = position[:, 2].max() + 0.02
    if scene.kind == "column":
        low, high = np.array([-0.21, -0.21, -0.02]), np.array([0.21, 0.21, top])
    else:
        x, y = scene.periods
        position[:, 0] %= x
        position[:, 1] %= y
        low, high = np.array([0, 0, -0.02]), np.array([x, y, top])
    return State(position, state.velocity, state.spin, low, high)


def write_data(path, state):
    """The text file that both LAMMPS and LIGGGHTS read. Material 2 is for walls without friction."""
    n = len(state.position)
    ids = np.arange(1, n + 1)
    with open(path, "w") as file:
        file.write(f"a settled state of skred bench\n\n{n} atoms\n2 atom types\n\n")
        for axis, low, high in zip("xyz", state.low, state.high):
            file.write(f"{low:.15g} {high:.15g} {axis}lo {axis}hi\n")
        file.write("\nAtoms\n\n")
        rows = np.column_stack([ids, np.ones(n), np.full(n, 2 * RADIUS), np.full(n, DENSITY), state.position])
        np.savetxt(file, rows, fmt="%d %d %.12g %.12g %.12g %.12g %.12g")
        file.write("\nVelocities\n\n")
        np.savetxt(file, np.column_stack([ids, state.velocity, state.spin]), fmt="%d %.12g %.12g %.12g %.12g %.12g %.12g")


def write_cylinder(path, radius, low, high, sides, pieces):
    """An open cylinder about z as an STL file, normals towards the axis; its facets are at `radius` on average."""
    corner = radius / np.sqrt(np.cos(np.pi / sides))
    angle = 2 * np.pi / sides * np.arange(sides + 1)
    ring = np.stack([corner * np.cos(angle), corner * np.sin(angle)], axis=1)
    heights = np.linspace(low, high, pieces + 1)
    with open(path, "w") as file:
        file.write("solid wall\n")
        for k in range(sides):
            inward = -(ring[k] + ring[k + 1])
            inward /= np.linalg.norm(inward)
            for below, above in zip(heights, heights[1:]):
                a, b, c, d = (*ring[k], below), (*ring[k + 1], below), (*ring[k + 1], above), (*ring[k], above)
                for triangle in ((a, c, b), (a, d, c)):
                    file.write(f"facet normal {inward[0]:.9g} {inward[1]:.9g} 0\nouter loop\n")
                    file.writelines(f"vertex {x:.9g} {y:.9g} {z:.9g}\n" for x, y, z in triangle)
                    file.write("endloop\nendfacet\n")
        file.write("endsolid wall\n")
