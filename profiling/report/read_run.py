# profiling/report/read_run.py - a results folder of `skred run`, for the analysis scripts beside this file.
"""Reads trajectory.h5 and statistics.csv; engine/io/trajectory.h says what is in them. SI units, particles in order of id."""
import csv
from pathlib import Path

import h5py
import numpy as np


class Failure(Exception):
    """Something the user can put right; its text is all that he is told."""


class Run:
    """A run, finished or still going on. Frames are numbered from 0; -1 is the last."""

    def __init__(self, folder):
        self.folder = Path(folder)
        path = self.folder / "trajectory.h5"
        if not path.is_file():
            raise Failure(f"{path}: no such file; give the folder that `skred run --output` has filled")
        try:
            # A run that still writes holds the lock; what it has written so far may be read nevertheless.
            self.file = h5py.File(path, "r", locking=False)
        except OSError as error:
            raise Failure(f"{path}: {error}") from error
        self.frames = int(self.file["VTKHDF/Steps"].attrs["NSteps"])
        if self.frames == 0:
            raise Failure(f"{path}: holds no frame yet")
        self.times = self.file["VTKHDF/Steps/Values"][: self.frames]             # [s]
        # Row with which the particles of a frame begin, and how many there are; they may come and go.
        self.first = self.file["VTKHDF/Steps/PointOffsets"][: self.frames].astype(int)
        self.count = self.file["VTKHDF/NumberOfPoints"][: self.frames].astype(int)
        self.material_names = [name.decode() for name in self.file["skred/material_names"][:]]
        self.scene = self.text("scene")
        self.method = {"sdem": "smooth DEM", "ndem": "nonsmooth DEM"}.get(self.text("method"), self.text("method"))

    def text(self, name):
        value = self.file["skred"].attrs[name] if name in self.file["skred"].attrs else self.file["skred"][name][()]
        return value.decode() if isinstance(value, bytes) else str(value)

    def number(self, frame):
        """The frame's number, counted from 0: `frame` is one, counted from the end if negative, or the word last."""
        try:
            k = self.frames - 1 if frame == "last" else int(frame)
        except ValueError:
            raise Failure(f"frame '{frame}': give a number or the word last") from None
        if not -self.frames <= k < self.frames:
            raise Failure(f"frame {k}: this run has frames 0 to {self.frames - 1}")
        return k % self.frames

    def particles(self, name, k):
        """Column `name` (position, velocity, radius, id, ...) in frame k: one row per particle."""
        offsets = self.file["VTKHDF/Steps/PointDataOffsets"]
        first = int(offsets[name][k]) if name in offsets else self.first[k]
        rows = self.file["particles"][name][first : first + self.count[k]]
        return rows if rows.dtype.kind in "iu" else rows.astype(float)

    def contact_forces(self, k):
        """Sum of the magnitudes of the contact forces on each particle in frame k [N]."""
        if "contacts" not in self.file:
            raise Failure(f"{self.folder}: the frames have no contacts; run the scene with --set output.contacts=true")
        ids = self.particles("id", k).astype(int)
        total = np.zeros(ids.max(initial=-1) + 1)
        for table, columns in (("particle_particle", ("i", "j")), ("particle_body", ("particle",))):
            group = self.file["contacts"][table]
            first, count = int(group["first"][k]), int(group["count"][k])
            force = np.linalg.norm(group["force"][first : first + count], axis=1)
            for column in columns:
                total += np.bincount(group[column][first : first + count], weights=force, minlength=len(total))
        return total[ids]

    def surfaces(self, k):
        """All bodies in frame k: triangles, shape (n, 3 corners, 3) [m], and for each if it is part of a closed surface.

        Seen from outside, corners of closed surfaces are counter-clockwise; meshes of an open surface may have either sense.
        """
        corners, closed = [np.empty((0, 3, 3))], [np.empty(0, bool)]
        for name, vertices in (("fixed", "bodies/surface/fixed/vertices"), ("moving", f"frames/{k:06d}/moving_vertices")):
            if f"bodies/surface/{name}" in self.file:
                triangles = self.file[f"bodies/surface/{name}/triangles"][:].astype(int)
                corners.append(self.file[vertices][:].astype(float)[triangles])
                closed.append(in_closed_surface(triangles))
        return np.concatenate(corners), np.concatenate(closed)

    def statistics(self):
        """The time series: an array for each name in the header of statistics.csv, without the unit."""
        with open(self.folder / "statistics.csv", newline="", encoding="utf-8") as file:
            names, *rows = csv.reader(file)
        values = np.array([row for row in rows if len(row) == len(names)], dtype=float)
        return {name.split(" [")[0]: values[:, column] for column, name in enumerate(names)}


def in_closed_surface(triangles):
    """For each triangle (rows of three vertex numbers): is every edge of the connected surface it belongs to shared by two?"""
    label = np.arange(triangles.max() + 1)
    while True:
        least = np.repeat(label[triangles].min(axis=1), 3)
        before = label.copy()
        np.minimum.at(label, triangles.ravel(), least)
        label = label[label]
        if (label == before).all():
            break
    edges, shared = np.unique(np.sort(triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1), axis=0, return_counts=True)
    return ~np.isin(label[triangles[:, 0]], label[edges[shared != 2, 0]])
