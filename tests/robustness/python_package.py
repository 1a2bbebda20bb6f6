"""python/breakwater against other readers of the same files: csv, VTK, h5py, pandas, xarray."""
import csv
import time

import breakwater as bw
import h5py
import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLImageDataReader, vtkXMLPolyDataReader

# ---- scenes: a template that is written again runs the same ----
assert "beam_under_load" in bw.templates()
scene = bw.template("beam_under_load")
assert scene["materials"]["polymer"]["young_modulus"] == 3.0e9  # 3.0e9 is a number
scene["bodies"]["beam"]["spacing"] = 4e-3
scene["phases"]["until"] = 2e-3
bw.write(scene, "beam.yaml")
assert bw.read("beam.yaml") == scene
one, two = bw.run(scene, "out/one"), bw.run("beam.yaml", "out/two", ranks=2)
assert len(one.history["time"]) == 5 and one.history.units["tip.y"] == "L"
for name in one.history:  # sums over ranks in another order
    a, b = one.history[name], two.history[name]
    largest = max(abs(a).max(), abs(one.history[name[:-1] + "y"]).max() if name[-2:] == ".x" else 0)
    assert abs(a - b).max() <= 1e-9 * largest, name
with open("out/one/history.csv", newline="") as file:
    rows = list(csv.DictReader(file))
assert [float(row["tip.y[L]"]) for row in rows] == list(one.history["tip.y"])

# ---- particles and fluids as VTK reads them ----
reader = vtkXMLPolyDataReader()
picture = one.particles("beam")
reader.SetFileName(str(sorted(one.folder.glob("beam-*.vtp"))[-1]))
reader.Update()
data = reader.GetOutput()
assert (vtk_to_numpy(data.GetPoints().GetData()) == picture.points).all()
for name in ("displacement", "damage"):
    assert (vtk_to_numpy(data.GetPointData().GetArray(name)) == picture[name]).all(), name
assert data.GetFieldData().GetArray("TimeValue").GetTuple1(0) == picture.time == 2e-3
flow = bw.template("flow_past_cylinder")
flow["phases"]["until"] = 1
flow["gauges"]["wake"]["every"] = 0.5
flow["output"]["picture_every"] = 0.5
run = bw.run(flow, "out/flow")
assert run.names == ["fluid"] and list(run.times()) == [0.5, 1.0]
fluid, reader = run.fluid(), vtkXMLImageDataReader()
reader.SetFileName(str(sorted(run.folder.glob("fluid-*.vti"))[-1]))
reader.Update()
cells = reader.GetOutput().GetCellData()
assert fluid["velocity"].shape == (1, 60, 120, 3) and fluid.time == 1.0
assert (vtk_to_numpy(cells.GetArray("velocity")) == fluid["velocity"].reshape(-1, 3)).all()
assert abs(fluid.x[0] - 8 / 240) < 1e-12 and abs(fluid.y[-1] - (4 - 8 / 240)) < 1e-12
# The mask is the cylinder: its area, to the cells that its edge cuts.
area = fluid["cylinder"].sum() * (8 / 120) ** 2
assert abs(area - np.pi / 4) < 0.02 * np.pi, area
lines = run.lines("wake")
assert len(lines) == 2 and len(lines[0][1]) == 41

# ---- checkpoints as h5py reads them ----
saved = run.checkpoint()
with h5py.File(run.folder / "checkpoint-last.h5") as file:
    assert (file["fluid/u"][()] == saved["fluid/u"]).all() and saved.time == 1.0

# ---- failures ----
flow["bodies"]["cylinder"]["motion"] = "flies"
try:
    bw.run(flow, "out/wrong")
    raise AssertionError("a wrong scene has run")
except bw.RunError as error:
    assert error.code == 2 and "flies" in str(error), error
try:
    bw.Run("out")
    raise AssertionError("a folder without a run is no run")
except FileNotFoundError:
    pass
assert "memory" in bw.run(scene, "out/checked", check=True)

# ---- a run that goes on ----
scene["phases"]["until"] = 4e-3
started = bw.run(scene, "out/later", wait=False)
while started.poll() is None:
    time.sleep(0.05)
assert started.returncode == 0 and len(bw.Run("out/later").history["time"]) == 9

# ---- tables, where they are ----
try:
    import pandas  # noqa: F401
except ImportError:
    pass
else:
    assert one.history.frame()["tip.y"].iloc[-1] == one.history["tip.y"][-1]
    assert len(picture.frame()) == len(picture.points)
try:
    import xarray  # noqa: F401
except ImportError:
    pass
else:
    assert fluid.dataset()["pressure"].dims == ("z", "y", "x")
