#!/usr/bin/python3
# profiling/report/drum_slope.py - the slope of the free surface in a rotating drum, against time, with its error.
"""Measures the slope of the free surface of the bed in a drum that turns about the y axis, z up.

How it is measured, in every frame:
  1. Particles that touch nothing (coordination number 0) are in flight and left out.
  2. The bed is cut into vertical slices across the drum, 2 particle diameters wide and as deep as the drum. In a slice the
     surface is where half a dense layer of particles lies above it: the height of the centre ranked COVERAGE * area / (pi R^2)
     / 2 from the top, area being that of the slice seen from above. A few particles that bounce on the bed do not move it.
  3. The surface reaches from the first to the last slice that hold at least one such layer. A straight line is fitted to its
     heights by least squares, over two windows: the middle half of that reach, and what lies below the drum's axis, without the
     outer tenths of the reach where the bed ends in a wedge ("below the midpoint of the cylinder", Pettersson 2015, section
     4.3). A window of less than 4 slices gives no slope in that frame.
  4. The slope is the line's angle to the horizontal, positive where the bed climbs with the wall.

The mean is over the frames from --from on (3.5 s, as in the thesis). Frames are correlated, so its standard error comes from
means over blocks of frames: the largest that any block length with at least 5 blocks gives (Flyvbjerg and Petersen 1989).
Nothing is fitted to the 35 degrees of the thesis: they are drawn for orientation.

    drum_slope.py results/drum-sdem --picture slope.png
    drum_slope.py results/drum-a4 results/drum-a8 --picture slope.png       several runs in one picture
"""
import argparse
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

from read_run import Failure, Run

SLICE = 2.0            # width of a slice [particle diameters]
COVERAGE = 0.8         # part of the area that one dense, disordered layer of spheres covers
LEAST = 4              # slices in a window
THESIS = 35.0          # [degrees] Pettersson 2015, section 4.3, at a = 8
WINDOWS = {"middle": "middle half of the surface", "lower": "below the drum's axis"}
COLORS = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00"]


def uphill(run):
    """+1 if the lowest part of the drum moves towards +x, -1 if towards -x; the middle of the drum in the x-z plane."""
    if "bodies" not in run.file:
        raise Failure(f"{run.folder}: the scene has no bodies, so no drum")
    turning = run.file["bodies/angular_velocity"][-1][:, 1]
    drum = int(np.argmax(np.abs(turning)))
    if turning[drum] == 0:
        raise Failure(f"{run.folder}: no body turns about the y axis in the last frame")
    # omega x (0, 0, -1) along x is -omega_y.
    return -np.sign(turning[drum]), run.file["bodies/position"][-1][drum]


def surface(position, radius, depth):
    """Middle and height of the surface in each slice that holds at least a layer: x, z [m]."""
    width = SLICE * 2 * radius
    layer = COVERAGE * width * depth / (np.pi * radius**2)
    number = np.floor(position[:, 0] / width).astype(int)
    x, z = [], []
    for k in np.unique(number):
        heights = np.sort(position[number == k, 2])[::-1]
        if len(heights) >= layer:
            x.append((k + 0.5) * width)
            z.append(heights[int(layer / 2)])
    return np.array(x), np.array(z)


def line(x, z):
    """Slope angle of the least-squares line and its standard error from the scatter [degrees], rms distance to the line [m]."""
    design = x - x.mean()
    slope = design @ z / (design @ design)
    rest = z - z.mean() - slope * design
    error = np.sqrt(rest @ rest / max(1, len(x) - 2) / (design @ design))
    return np.degrees(np.arctan(slope)), np.degrees(error / (1 + slope**2)), np.sqrt(np.mean(rest**2))


def window(x, z, axis, name):
    reach = x.max() - x.min() if len(x) else 0
    if name == "middle":
        return np.abs(x - (x.max() + x.min()) / 2) <= reach / 4 if len(x) else np.zeros(0, bool)
    inner = (x >= x.min() + 0.1 * reach) & (x <= x.max() - 0.1 * reach) if len(x) else np.zeros(0, bool)
    return inner & (z < axis)


def slopes(run, frames):
    """Per window: rows of time [s], slope, error of the fit [degrees], rms distance to the line, thickness of the bed [m]."""
    sign, axis = uphill(run)
    radius = float(np.median(run.particles("radius", 0)))
    found = {name: [] for name in WINDOWS}
    for k in frames:
        position = run.particles("position", k)
        touching = position[run.particles("coordination", k) > 0]
        if len(touching) == 0:
            continue
        # Slices are as deep as the particles reach, but for single ones that sit in a gap.
        depth = np.subtract(*np.percentile(touching[:, 1], [99, 1])) + 2 * radius
        x, z = surface(touching, radius, depth)
        for name in WINDOWS:
            inside = window(x, z, axis[2], name)
            if inside.sum() >= LEAST:
                angle, error, rms = line(x[inside], z[inside])
                thickness = bed_thickness(touching, x[inside], z[inside], np.radians(angle))
                found[name].append((run.times[k], sign * angle, error, rms, thickness))
    return {name: np.array(rows).reshape(-1, 5) for name, rows in found.items()}


def bed_thickness(position, x, z, angle):
    """Depth at right angles to the surface above which 98 % of the particles below the window lie [m]."""
    there = (position[:, 0] >= x.min()) & (position[:, 0] <= x.max())
    below = (np.interp(position[there, 0], x, z) - position[there, 2]) * np.cos(angle)
    return np.percentile(below, 98)


def block_error(values):
    """Standard error of the mean of correlated values [their unit], and the length of the blocks that gave it."""
    errors = []
    for length in range(1, len(values) // 5 + 1):
        means = values[len(values) % length:].reshape(-1, length).mean(axis=1)
        errors.append(means.std(ddof=1) / np.sqrt(len(means)))
    return (max(errors), 1 + int(np.argmax(errors))) if errors else (np.nan, 0)


def summary(run, rows, start):
    """Prints the numbers of a run; returns mean and error of the middle window, or None."""
    diameter = 2 * float(np.median(run.particles("radius", 0)))
    print(f"{run.folder}: {run.scene}, {run.method}, {run.count[0]} particles, "
          f"{run.frames} frames to t = {run.times[-1]:.2f} s")
    results = {}
    for name, text in WINDOWS.items():
        late = rows[name][rows[name][:, 0] >= start - 1e-9]
        if len(late) < 5:
            print(f"  {text}: a surface long enough in only {len(late)} frames from t = {start:g} s on, no mean")
            continue
        slope, layers = late[:, 1], np.median(late[:, 4]) / diameter
        error, length = block_error(slope)
        results[name] = slope.mean(), error
        print(f"  {text}: {slope.mean():.1f} +- {error:.1f} degrees ({len(late)} frames, blocks of {length}; standard deviation "
              f"{slope.std(ddof=1):.1f}; rms from the line {late[:, 3].mean() / diameter:.2f} d; bed {layers:.1f} d thick)")
        first, second = (half.mean() for half in np.array_split(slope, 2))
        if abs(second - first) > 2 * error:
            print(f"  The slope still changes: {first:.1f} degrees in the first half of these frames, {second:.1f} in the "
                  "second. They are too few for the error to be trusted; run longer.")
        if name == "middle" and layers < 8:
            print("  The bed is only a few particles deep: this is the slope of a thin layer on a curved, rough wall.")
    return results.get("middle")


def plot(results, args):
    figure, axes = plt.subplots(figsize=(8, 4.5), dpi=110)
    for (run, rows, mean), color in zip(results, COLORS * len(results)):
        t, slope, error = rows["middle"][:, :3].T
        axes.fill_between(t, slope - error, slope + error, color=color, alpha=0.25, linewidth=0)
        axes.plot(t, slope, color=color, linewidth=1.2, label=f"{run.count[0]} particles, {run.method}")
        if mean:
            axes.plot([args.start, t[-1]], [mean[0]] * 2, color=color, linewidth=2.5)
            axes.fill_between([args.start, t[-1]], mean[0] - mean[1], mean[0] + mean[1], color=color, alpha=0.4, linewidth=0,
                              label=rf"mean from {args.start:g} s on: ${mean[0]:.1f} \pm {mean[1]:.1f}$ degrees")
    axes.axhline(THESIS, color="0.3", linestyle="--", linewidth=1, label="35 degrees (Pettersson 2015, a = 8)")
    axes.axvline(args.start, color="0.7", linewidth=0.8, zorder=0)
    axes.set(xlabel="time [s]", ylabel="slope of the free surface [degrees]", xlim=(0, None))
    axes.set_title("Rotating drum: middle half of the free surface, error of the fit as band", fontsize=11)
    axes.legend(frameon=False, fontsize=9)
    axes.spines[["top", "right"]].set_visible(False)
    figure.tight_layout()
    figure.savefig(args.picture)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("results", nargs="+", help="folders that `skred run --output` has filled")
    parser.add_argument("--from", dest="start", type=float, default=3.5, metavar="T", help="start of the mean [s] (default: 3.5)")
    parser.add_argument("--picture", metavar="FILE", help="plot slope against time (PNG, SVG or PDF)")
    args = parser.parse_args()
    try:
        results = []
        for folder in args.results:
            run = Run(folder)
            rows = slopes(run, range(run.frames))
            if not len(rows["middle"]):
                raise Failure(f"{run.folder}: in no frame is the bed's surface long enough to be measured")
            results.append((run, rows, summary(run, rows, args.start)))
        if args.picture:
            plot(results, args)
    except (Failure, OSError, ValueError) as error:
        sys.exit(f"drum_slope.py: {error}")


if __name__ == "__main__":
    main()
