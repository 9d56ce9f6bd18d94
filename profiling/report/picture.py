#!/usr/bin/python3
# profiling/report/picture.py - a picture of particles and bodies out of a results folder.
"""Draws one or several frames of a run as PNG: particles as spheres, bodies cut open in front of them. Needs no display.

    picture.py results/drum-sdem --frame last --view front --color speed -o drum.png
    picture.py results/silo-sdem --frame 4 8 last --color load --cut 0 -o silo.png

front looks along +y with z up; iso looks the same way, turned aside and from above.
"""
import argparse
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.colors import ListedColormap, Normalize
from PIL import Image

from read_run import Failure, Run
from render import Camera, Canvas

SAMPLES = 2            # per pixel and direction, averaged: smooth edges
MATERIALS = np.array([[0.84, 0.37, 0.00], [0.00, 0.45, 0.70], [0.00, 0.62, 0.45], [0.90, 0.62, 0.00], [0.80, 0.47, 0.65],
                      [0.34, 0.71, 0.91]])                                      # Okabe and Ito 2008


def quantity(run, k, color):
    """What is shown of each particle, and its name with the unit."""
    if color == "speed":
        return np.linalg.norm(run.particles("velocity", k), axis=1), "speed [m/s]"
    if color == "load":
        return run.contact_forces(k), "sum of contact forces on a particle [N]"
    return run.particles("material", k).astype(float), "material"


def enclosure(camera, centres, reach, args, triangles):
    """The rectangle to draw (right, up) [m]: as asked for, or around the particles (and bodies) with a margin."""
    if args.region:
        return np.array(args.region[::2]), np.array(args.region[1::2])
    seen = camera.view(centres)[:, :2]
    low, high = seen.min(axis=0) - reach, seen.max(axis=0) + reach
    if args.show == "all" and len(triangles):
        corners = camera.view(triangles.reshape(-1, 3))[:, :2]
        low, high = np.minimum(low, corners.min(axis=0)), np.maximum(high, corners.max(axis=0))
    margin = 0.03 * (high - low).max()
    return low - margin, high + margin


def draw(run, frames, args):
    camera = Camera() if args.view == "front" else Camera(np.radians(-28), np.radians(24))
    shown = [quantity(run, k, args.color) for k in frames]
    top = args.max if args.max else max((np.percentile(values, 99.5) for values, _ in shown if len(values)), default=0) or 1.0
    colors = plt.get_cmap("viridis" if args.color == "speed" else "magma_r")
    positions = [run.particles("position", k) for k in frames]
    surfaces = [run.surfaces(k) for k in frames]
    radii = [run.particles("radius", k) for k in frames]
    reach = max(r.max(initial=0) for r in radii)
    # By default just behind the foremost particles' surface: an end wall that they press into is in front of it as a whole.
    foremost = np.concatenate(positions)[:, 1]
    cut = (np.percentile(foremost, 1) if len(foremost) else 0) - 0.5 * reach if args.cut is None else args.cut
    kept = [p[:, 1] >= (-np.inf if args.cut is None else cut) for p in positions]
    if not any(len(p) for p in positions):
        raise Failure("there is no particle in the frames asked for")
    if not any(k.any() for k in kept):
        raise Failure(f"--cut {cut} leaves no particle; they lie between y = {min(p[:, 1].min() for p in positions if len(p)):.3g} "
                      f"and {max(p[:, 1].max() for p in positions if len(p)):.3g} m")
    everything = np.concatenate([p[k] for p, k in zip(positions, kept)])
    low, high = enclosure(camera, everything, reach, args, np.concatenate([triangles for triangles, _ in surfaces]))
    pictures = []
    for position, radius, keep, (values, _), (triangles, closed) in zip(positions, radii, kept, shown, surfaces):
        canvas = Canvas(camera, low, high, args.width * SAMPLES)
        canvas.bodies(triangles, closed, cut)
        rgb = MATERIALS[values.astype(int) % len(MATERIALS)] if args.color == "material" else colors(np.clip(values / top, 0, 1))[:, :3]
        canvas.spheres(position[keep], radius[keep], rgb[keep])
        canvas.shade(3 * reach)
        pictures.append(canvas.image(SAMPLES))
    return pictures, (low[0], high[0], low[1], high[1]), Normalize(0, top), colors, shown[0][1]


def compose(run, frames, args):
    pictures, extent, norm, colors, label = draw(run, frames, args)
    height, width = pictures[0].shape[:2]
    dpi = 100                                                          # a pixel of the picture is one of the file
    counts, alone = run.count[frames], len(pictures) == 1
    numbers = str(counts[0]) if (counts == counts[0]).all() else f"{counts.min()} to {counts.max()}"
    title = f"{run.scene}, {run.method}, {numbers} particles"
    left, bottom = (0.75, 0.55) if args.view == "front" else (0.1, 0.1)
    top, gap, right = 0.4 if alone else 0.7, 0.15, 1.1                           # [inch]
    size = (left + len(pictures) * (width / dpi + gap) + right, bottom + height / dpi + top)
    figure = plt.figure(figsize=size, dpi=dpi)
    if not alone:
        figure.suptitle(title, fontsize=12, y=1 - 0.12 / size[1], va="top")
    for place, (picture, k) in enumerate(zip(pictures, frames)):
        box = (left + place * (width / dpi + gap)) / size[0], bottom / size[1], width / dpi / size[0], height / dpi / size[1]
        axes = figure.add_axes(box)
        axes.imshow(picture, extent=extent, interpolation="nearest")
        axes.set_title(f"{title}, t = {run.times[k]:.2f} s" if alone else f"t = {run.times[k]:.2f} s", fontsize=11)
        if args.view == "front":
            axes.set_xlabel("x [m]")
            axes.set_yticks([]) if place else axes.set_ylabel("z [m]")
        else:
            axes.set_axis_off()
    bar = figure.add_axes(((left + len(pictures) * (width / dpi + gap)) / size[0], bottom / size[1], 0.16 / size[0],
                           height / dpi / size[1]))
    if args.color == "material":
        used = np.unique(np.concatenate([run.particles("material", k) for k in frames]))
        legend = ListedColormap(MATERIALS[used % len(MATERIALS)])
        ticks = figure.colorbar(ScalarMappable(Normalize(0, len(used)), legend), cax=bar, ticks=np.arange(len(used)) + 0.5)
        ticks.ax.set_yticklabels([run.material_names[m] for m in used])
    else:
        figure.colorbar(ScalarMappable(norm, colors), cax=bar, label=label, extend="max")
    return figure


def save(figure, path, small):
    """Writes the figure as PNG; small: with 256 colours, which takes a third of the space."""
    figure.canvas.draw()
    picture = Image.fromarray(np.asarray(figure.canvas.buffer_rgba())[:, :, :3].copy())
    if small:
        picture = picture.quantize(256, method=Image.Quantize.MEDIANCUT, kmeans=2)
    picture.save(path, format="PNG", optimize=True)


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("results", help="folder that `skred run --output` has filled")
    parser.add_argument("--frame", nargs="+", default=["last"], metavar="K",
                        help="numbers of frames, from 0, or last; side by side")
    parser.add_argument("--view", choices=["front", "iso"], default="front")
    parser.add_argument("--color", choices=["speed", "load", "material"], default="speed",
                        help="load: sum of contact forces on each particle, needs output.contacts")
    parser.add_argument("--max", type=float,
                        help="value at the top of the colour bar (default: 99.5 %% of the particles lie below)")
    parser.add_argument("--cut", type=float, metavar="Y",
                        help="cut away all with y below this [m] (default: the front of the particles)")
    parser.add_argument("--show", choices=["particles", "all"], default="particles", help="what the picture encloses")
    parser.add_argument("--region", type=float, nargs=4, metavar=("LEFT", "RIGHT", "BOTTOM", "TOP"),
                        help="what the picture encloses [m]; in the front view these are x and z")
    parser.add_argument("--width", type=int, default=900, help="of each frame [pixels]")
    parser.add_argument("--small", action="store_true", help="256 colours: a third of the size")
    parser.add_argument("-o", "--output", required=True, metavar="FILE.png")
    args = parser.parse_args()
    if not 50 <= args.width <= 8000:
        parser.error(f"--width {args.width}: give 50 to 8000 pixels")
    if args.region and not (args.region[0] < args.region[1] and args.region[2] < args.region[3]):
        parser.error(f"--region {' '.join(map(str, args.region))}: LEFT must be less than RIGHT, BOTTOM less than TOP")
    return args


def main():
    args = arguments()
    try:
        run = Run(args.results)
        save(compose(run, [run.number(frame) for frame in args.frame], args), args.output, args.small)
    except (Failure, OSError, ValueError) as error:
        sys.exit(f"picture.py: {error}")


if __name__ == "__main__":
    main()
