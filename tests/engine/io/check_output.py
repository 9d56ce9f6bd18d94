#!/usr/bin/env python3
"""tests/engine/io/check_output.py - reads the folder of write_sample with h5py as a user would, checks it against the VTKHDF 2.0
rules and follows every reference of the XDMF files: check_output.py FOLDER float|double

Where python3's own VTK is 9.3 or later it must show the frames too (older ones do not know time in VTKHDF)."""
import csv
import json
import os
import sys
import xml.etree.ElementTree as xml

try:
    import h5py
    import numpy as np
except ImportError as missing:
    print(f"skipped: {missing}")
    sys.exit(77)

sys.dont_write_bytecode = True
import expected as want

folder, precision = sys.argv[1], sys.argv[2]
real = np.dtype("f4" if precision == "float" else "f8")
close = dict(rtol=1e-6, atol=1e-7) if precision == "float" else dict(rtol=1e-14, atol=1e-15)


def same(have, expect, what):
    assert np.shape(have) == np.shape(expect), f"{what}: shape {np.shape(have)}, not {np.shape(expect)}"
    assert np.allclose(have, expect, **close), f"{what}:\n{have}\nnot\n{expect}"


def check_particles(file):
    moving = ["position", "velocity", "angular_velocity", "force", "orientation", "coordination"]
    assert list(file["frames/time"]) == want.TIMES and list(file["frames/step"]) == [0, 100, 200]
    for name in want.frame(0):
        data = file["particles"][name]
        assert data.attrs["units"] == want.UNITS[name], f"{name}: units {data.attrs['units']}"
        assert data.dtype == (real if name not in ("coordination", "material", "id") else np.uint32), f"{name}: {data.dtype}"
        for k in range(3):
            expect = want.frame(k)[name]
            rows = data[k * want.COUNT:(k + 1) * want.COUNT] if name in moving else data[...]
            same(rows, expect, f"particles/{name}, frame {k}")
            if name in moving:
                view = file[f"frames/{k:06d}/{name}"]
                same(view[...], expect, view.name)
                assert view.attrs["units"] == want.UNITS[name] and view.dtype == data.dtype


def check_vtkhdf(file):
    root, steps = file["VTKHDF"], file["VTKHDF/Steps"]
    assert list(root.attrs["Version"]) == [2, 0]
    kind = root.attrs.get_id("Type").get_type()
    assert not kind.is_variable_str() and root.attrs["Type"] == b"UnstructuredGrid", "Type must have a fixed length"
    n, count = int(steps.attrs["NSteps"]), want.COUNT
    assert n == 3 and list(steps["Values"]) == want.TIMES
    for name in ("NumberOfPoints", "NumberOfCells", "NumberOfConnectivityIds"):
        assert list(root[name]) == [count] * n, name
    assert list(steps["NumberOfParts"]) == [1] * n and list(steps["PartOffsets"]) == [0] * n
    assert list(steps["PointOffsets"]) == [k * count for k in range(n)]
    for name in ("CellOffsets", "ConnectivityIdOffsets"):
        assert steps[name].shape == (n, 1) and not steps[name][...].any(), name
    assert list(root["Connectivity"]) == list(range(count)) and list(root["Offsets"]) == list(range(count + 1))
    assert root["Types"].dtype == np.uint8 and (root["Types"][...] == 1).all()
    assert set(root["PointData"]) == set(steps["PointDataOffsets"]) == set(want.frame(0)) - {"position"}
    for name, data in root["PointData"].items():
        for k, first in enumerate(steps["PointDataOffsets"][name]):
            same(data[first:first + count], want.frame(k)[name], f"VTKHDF {name}, step {k}")
    for data in [d for d in steps.values() if isinstance(d, h5py.Dataset)] + list(steps["PointDataOffsets"].values()):
        assert data.shape[0] == n, f"{data.name} has {data.shape[0]} rows"


def check_bodies(file):
    bodies = file["bodies"]
    assert list(bodies["names"].asstr()) == want.BODIES
    assert list(bodies["motion"].asstr()) == ["static", "kinematic", "static", "dynamic"]
    assert list(bodies["geometry_body"]) == [0, 1, 2, 2, 3]
    shapes = [json.loads(text) for text in bodies["geometry"].asstr()]
    assert [s["shape"] for s in shapes] == ["plane", "box", "hollow_cylinder", "sphere", "cylinder"]
    assert shapes[2]["radius"] == 0.3 and shapes[3]["position"] == [0, 0, 1]
    for name in ("position", "orientation", "velocity", "angular_velocity", "force", "torque"):
        data, width = bodies[name], 4 if name == "orientation" else 3
        assert data.shape == (3, 4, width) and data.attrs["units"] == want.UNITS[name] and data.dtype == np.float64, name
    for k in range(3):
        assert bodies["position"][k, 1].tolist() == [0, 0.5 * k, 1]
        assert np.allclose(bodies["orientation"][k, 3], [np.cos(0.125 * k), 0, 0, np.sin(0.125 * k)], atol=1e-15)
        assert bodies["force"][k].tolist() == [[b, k, 1] for b in range(4)]


def check_contacts(file):
    pairs, walls = file["contacts/particle_particle"], file["contacts/particle_body"]
    assert list(pairs["first"]) == [0, 0, 1] and list(pairs["count"]) == [0, 1, 2]
    assert list(pairs["i"]) == [0, 0, 1] and list(pairs["j"]) == [1, 1, 2]
    same(pairs["force"][...], [[1, 0, 0.5], [2, 0, 0.5], [2, 0, 0.5]], "contact force")
    assert list(walls["first"]) == [0, 0, 1] and list(walls["count"]) == [0, 1, 1]
    assert list(walls["particle"]) == [2, 2] and list(walls["body"]) == [0, 0]
    same(walls["force"][...], [[0, 0, 3], [0, 0, 6]], "body contact force")
    same(walls["point"][...], [[0.2, 0, 0]] * 2, "contact point")
    assert pairs["force"].attrs["units"] == "N" and walls["point"].attrs["units"] == "m"


def check_description(file):
    about = file["skred"]
    assert about.attrs["scene"] == 'sample <&"' and about.attrs["method"] == "sdem" and about.attrs["time_step"] == 1e-4
    assert list(about["material_names"].asstr()) == ["pellet", "stål"]
    without = []
    file.visititems(lambda name, d: without.append(name) if isinstance(d, h5py.Dataset) and d.dtype.kind in "fiu"
                    and "units" not in d.attrs else None)
    assert not without, f"without units: {without}"


def referenced(item):
    """The array that a DataItem of an XDMF file means; its description must fit the dataset exactly."""
    path, name = item.text.strip().split(":")
    with h5py.File(os.path.join(folder, path)) as file:
        data = file[name]
        kind = {"Float": "f", "Int": "i", "UInt": "u", "UChar": "u"}[item.get("NumberType")]
        described, size = np.dtype(kind + item.get("Precision")), tuple(map(int, item.get("Dimensions").split()))
        assert data.shape == size, f"{name}: {data.shape} is not {size}"
        assert data.dtype == described, f"{name}: {data.dtype} is not {described}"
        return data[...]


def temporal_grids(name):
    collection = xml.parse(os.path.join(folder, name)).find("Domain/Grid")
    assert collection.get("CollectionType") == "Temporal" and collection.get("Name") == 'sample <&"'
    grids = collection.findall("Grid")
    assert [float(g.find("Time").get("Value")) for g in grids] == want.TIMES
    return grids


def check_xdmf():
    for k, grid in enumerate(temporal_grids("trajectory.xdmf")):
        have = {a.get("Name"): referenced(a.find("DataItem")) for a in grid.findall("Attribute")}
        have["position"] = referenced(grid.find("Geometry/DataItem"))
        assert have.keys() == want.frame(k).keys()
        for name, expect in want.frame(k).items():
            same(have[name], expect, f"trajectory.xdmf {name}, frame {k}")
        assert list(referenced(grid.find("Topology/DataItem"))) == list(range(want.COUNT))
    for k, group in enumerate(temporal_grids("bodies.xdmf")):
        fixed, moving = group.findall("Grid")
        for grid, owners in ((fixed, {0, 2}), (moving, {1, 3})):
            points, corners, body = (referenced(grid.find(f"{tag}/DataItem")) for tag in ("Geometry", "Topology", "Attribute"))
            assert corners.max() == len(points) - 1 and set(body) == owners and len(body) == len(corners)
            if grid is moving:
                box = points[np.unique(corners[body == 1])]
                expect = want.mixer_corners(k)
                assert len(box) == 8, f"box in frame {k}:\n{box}"
                assert all(np.abs(box - c).sum(axis=1).min() < 1e-6 for c in expect), f"box in frame {k}:\n{box}"
            else:
                drum = points[np.unique(corners[body == 2])]
                r = np.hypot(drum[:, 0], drum[:, 1])[np.abs(drum[:, 2]) < 0.5]
                assert set(np.round(r.astype(float), 6)) == {0.3, 0.31}, "inner and outer wall"


def check_statistics():
    with open(os.path.join(folder, "statistics.csv"), newline="") as text:
        rows = list(csv.reader(text))
    assert rows[0] == ["time [s]", "kinetic_energy [J]", "contacts [1]"]
    values = np.array(rows[1:], dtype=float)
    with h5py.File(os.path.join(folder, "statistics.h5")) as file:
        for column, (name, unit) in enumerate((("time", "s"), ("kinetic_energy", "J"), ("contacts", "1"))):
            assert file[name].attrs["units"] == unit
            assert file[name][...].tolist() == values[:, column].tolist() == [k * (0.01, 0.1, 1.0)[column] for k in range(3)]


def check_vtk():
    try:
        from vtkmodules.vtkCommonCore import vtkVersion
        from vtkmodules.vtkIOHDF import vtkHDFReader
        from vtkmodules.util.numpy_support import vtk_to_numpy
    except ImportError:
        return "no VTK"
    version = vtkVersion()
    if (version.GetVTKMajorVersion(), version.GetVTKMinorVersion()) < (9, 3):
        return f"VTK {version.GetVTKVersion()} has no time in VTKHDF"
    reader = vtkHDFReader()
    reader.SetFileName(os.path.join(folder, "trajectory.h5"))
    reader.UpdateInformation()
    assert reader.GetNumberOfSteps() == 3
    for k, time in enumerate(want.TIMES):
        reader.SetStep(k)
        reader.UpdateTimeStep(time)
        grid = reader.GetOutputDataObject(0)
        assert grid.GetNumberOfCells() == want.COUNT and grid.GetCellType(0) == 1
        same(vtk_to_numpy(grid.GetPoints().GetData()), want.frame(k)["position"], f"VTK positions, step {k}")
        for name in set(want.frame(k)) - {"position"}:
            same(vtk_to_numpy(grid.GetPointData().GetArray(name)), want.frame(k)[name], f"VTK {name}, step {k}")
    return f"VTK {version.GetVTKVersion()} shows the same"


with h5py.File(os.path.join(folder, "trajectory.h5")) as trajectory:
    for check in (check_particles, check_vtkhdf, check_bodies, check_contacts, check_description):
        check(trajectory)
check_xdmf()
check_statistics()
print("h5py and XDMF references agree;", check_vtk())
