#!/usr/bin/python3
# profiling/report/compare_methods.py - the same scenes by smooth and nonsmooth DEM, side by side over time.
"""Draws mean speed, slope of the surface (of drums), contacts, highest particle and the sum of normal forces against time: a column
for each scene and number of particles, a line for each method. Prints their means over the time from --from on.

    compare_methods.py results/drum-sdem results/drum-ndem -o methods.png
"""
import argparse
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

from drum_slope import block_error, slopes
from read_run import Failure, Run

COLORS = {"smooth DEM": "#0072b2", "nonsmooth DEM": "#d55e00"}
SMOOTHED = 0.05        # [s] forces and speeds are means over so long a time


def series(run):
    """Quantity -> time [s], value, half width of the band or None; the slope only if there is one."""
    s = run.statistics()
    t = s["time"]
    width = max(1, round(SMOOTHED / np.median(np.diff(t))))

    def smooth(values):
        return np.convolve(values, np.ones(width) / width, mode="valid")

    def column(values):
        return smooth(t), smooth(values), None

    found = {"mean speed [m/s]": column(s["mean_speed"]),
             "contacts": column(s["contacts"] + s["body_contacts"]),
             "highest particle [m]": column(s["highest_particle"]),
             "sum of normal forces [N]": column(s["normal_force_particle_particle"] + s["normal_force_particle_body"])}
    try:
        rows = slopes(run, range(run.frames))["middle"]
        if len(rows):
            found["slope [degrees]"] = tuple(rows[:, :3].T)
    except Failure:
        pass                                                                      # nothing turns
    return found


def name(run):
    return f"{run.scene}, {run.count[0]} particles"


def late_means(run, found, start):
    print(f"{name(run)}, {run.method}, t = {start:g} .. {run.times[-1]:.2f} s")
    for what, (t, values, _) in sorted(found.items()):
        late = values[t >= start - 1e-9]
        if len(late) >= 5:
            error, length = block_error(late)
            print(f"  {what:26} {late.mean():10.4g} +- {error:.2g}  (blocks of {length} of {len(late)})")


def plot(results, path):
    scenes = list(dict.fromkeys(name(run) for run, _ in results))
    quantities = [q for q in ("mean speed [m/s]", "slope [degrees]", "contacts", "highest particle [m]", "sum of normal forces [N]")
                  if any(q in found for _, found in results)]
    figure, axes = plt.subplots(len(quantities), len(scenes), figsize=(4.2 * len(scenes), 1.9 * len(quantities)), dpi=110, squeeze=False)
    for run, found in results:
        column = scenes.index(name(run))
        for row, quantity in enumerate(quantities):
            if quantity not in found:
                continue
            t, values, half = found[quantity]
            a = axes[row][column]
            if half is not None:
                a.fill_between(t, values - half, values + half, color=COLORS[run.method], alpha=0.25, linewidth=0)
            a.plot(t, values, color=COLORS[run.method], linewidth=1, label=run.method)
    for row, quantity in enumerate(quantities):
        axes[row][0].set_ylabel(quantity, fontsize=9)
        for a in axes[row]:
            a.spines[["top", "right"]].set_visible(False)
            a.set_xlim(0, None)
            if not a.lines:
                a.set_axis_off()
    for column, title in enumerate(scenes):
        axes[0][column].set_title(title, fontsize=10)
        axes[-1][column].set_xlabel("time [s]", fontsize=9)
    axes[0][0].legend(frameon=False, fontsize=8)
    figure.align_ylabels()
    figure.tight_layout()
    figure.savefig(path)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("results", nargs="+", help="folders that `skred run --output` has filled")
    parser.add_argument("--from", dest="start", type=float, default=3.5, metavar="T", help="start of the means [s] (default: 3.5)")
    parser.add_argument("-o", "--picture", metavar="FILE", help="the picture (PNG, SVG or PDF)")
    args = parser.parse_args()
    try:
        results = []
        for folder in args.results:
            run = Run(folder)
            results.append((run, series(run)))
            late_means(*results[-1], args.start)
        if args.picture:
            plot(results, args.picture)
    except (Failure, OSError, ValueError) as error:
        sys.exit(f"compare_methods.py: {error}")


if __name__ == "__main__":
    main()
