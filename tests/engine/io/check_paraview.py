"""tests/engine/io/check_paraview.py - opens the folder of write_sample in ParaView, with each of its XDMF readers:
pvpython check_paraview.py FOLDER"""
import os
import sys

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import numpy as np
from paraview import servermanager, simple
from vtkmodules.util.numpy_support import vtk_to_numpy

import expected as want

folder = sys.argv[1]


def leaves(data):
    if not data.IsA("vtkCompositeDataSet"):
        return [data]
    at, found = data.NewIterator(), []
    while not at.IsDoneWithTraversal():
        found.append(at.GetCurrentDataObject())
        at.GoToNextItem()
    return found


def frames(name, reader):
    argument = "FileNames" if reader is simple.XDMFReader else "FileName"
    source = reader(registrationName=name, **{argument: [os.path.join(folder, name)]})
    source.UpdatePipelineInformation()
    assert list(source.TimestepValues) == want.TIMES, f"{name}: times {source.TimestepValues}"
    for k, time in enumerate(want.TIMES):
        source.UpdatePipeline(time)
        yield k, leaves(servermanager.Fetch(source))


for reader in (simple.XDMFReader, simple.Xdmf3ReaderS, simple.Xdmf3ReaderT):
    for k, (grid,) in frames("trajectory.xdmf", reader):
        assert grid.GetNumberOfPoints() == grid.GetNumberOfCells() == want.COUNT
        points = vtk_to_numpy(grid.GetPoints().GetData())
        assert np.allclose(points, want.frame(k)["position"], rtol=1e-6), f"positions, frame {k}:\n{points}"
        for name in set(want.frame(k)) - {"position"}:
            have = vtk_to_numpy(grid.GetPointData().GetArray(name))
            assert np.allclose(have, want.frame(k)[name], rtol=1e-6, atol=1e-7), f"{name}, frame {k}:\n{have}"
    for k, (fixed, moving) in frames("bodies.xdmf", reader):
        points = vtk_to_numpy(moving.GetPoints().GetData())
        assert fixed.GetCellType(0) == 5 and set(vtk_to_numpy(moving.GetCellData().GetArray("body"))) == {1, 3}
        assert all(np.abs(points - c).sum(axis=1).min() < 1e-6 for c in want.mixer_corners(k)), f"box, frame {k}"
    print("ParaView", simple.GetParaViewVersion(), reader.__name__, "shows every frame")
