# tests/engine/io/expected.py - the sample run of sample.h once more, in Python: what a reader must find.
import numpy as np

TIMES = [0.0, 0.01, 0.02]
COUNT = 5
BODIES = ["floor", "mixer", "drum", "roller"]
x = np.arange(COUNT, dtype=float)
RADIUS = 0.01 + 0.001 * x
MASS = 0.5 + x


def columns(*values):
    return np.stack([np.broadcast_to(np.asarray(v, dtype=float), (COUNT,)) for v in values], axis=1)


def frame(k):
    """Arrays of frame k by name, one row per particle."""
    half = 0.05 * x * k
    return {
        "position": columns(0.1 * x, 0.1 * k, 0.25 + 0.01 * x * k),
        "velocity": columns(1 + x, k, -x * k),
        "angular_velocity": columns(k, x, 0.5),
        "force": columns(0, 0, -9.81 * MASS),
        "orientation": columns(np.cos(half), 0, 0, np.sin(half)),
        "coordination": x + k,
        "radius": RADIUS,
        "mass": MASS,
        "material": x % 2,
        "id": x,
    }


UNITS = {"position": "m", "velocity": "m/s", "angular_velocity": "rad/s", "force": "N", "radius": "m", "mass": "kg",
         "orientation": "1", "coordination": "1", "material": "1", "id": "1", "torque": "N m", "time": "s"}


def mixer_corners(k):
    """The corners of the box that turns about z and moves along y, in the world, in any order."""
    c, s = np.cos(0.25 * k), np.sin(0.25 * k)
    local = np.array([[0.2 + i * 0.1, j * 0.02, l * 0.03] for i in (-1, 1) for j in (-1, 1) for l in (-1, 1)])
    return local @ np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]]) + [0, 0.5 * k, 1]
