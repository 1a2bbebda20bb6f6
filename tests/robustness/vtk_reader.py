"""Compare what VTK reads with what tests/unit/vtk/test_vtk.c wrote on two ranks."""
import sys
from vtkmodules.vtkIOXML import (vtkXMLImageDataReader, vtkXMLPolyDataReader,
                                 vtkXMLRectilinearGridReader)

N = (5, 7, 6)
checked = 0


def read(reader, path):
    """Read a file; any complaint of the reader is a failure."""
    errors = []
    reader.AddObserver("ErrorEvent", lambda *_: errors.append(1))
    reader.SetFileName(path)
    reader.Update()
    assert not errors and reader.GetErrorCode() == 0, f"{path}: VTK reports an error"
    return reader.GetOutput()


def same(got, want, what):
    """Numbers of the test are exact, so that equality is asked for."""
    global checked
    assert got == want, f"{what}: VTK reads {got}, written was {want}"
    checked += 1


def check_cells(data, nz, path):
    """Cell (i, j, k) holds i + 10 j + 100 k and the face fields averaged to the centre."""
    cells = data.GetCellData()
    same(data.GetNumberOfCells(), N[0] * N[1] * nz, f"{path} cells")
    pressure, velocity = cells.GetArray("pressure"), cells.GetArray("velocity")
    scaled = cells.GetArray("scaled & <odd>")
    q = 0
    for k in range(1, nz + 1):
        for j in range(1, N[1] + 1):
            for i in range(1, N[0] + 1):
                face = i + 10 * j + 100 * k
                same(pressure.GetTuple1(q), face, f"{path} pressure ({i}, {j}, {k})")
                same(scaled.GetTuple1(q), -0.5 * face, f"{path} scaled ({i}, {j}, {k})")
                w = 2950 + face if nz > 1 else 0
                same(velocity.GetTuple3(q),
                     (999.5 + face, 1995 + face, w), f"{path} velocity ({i}, {j}, {k})")
                q += 1


def check_time(data, time, path):
    """The time of the file, as VTK's readers hand it on; NaN leaves none."""
    stamp = data.GetFieldData().GetArray("TimeValue")
    same(None if stamp is None else stamp.GetTuple1(0), time, f"{path} time")


def check_points(data, path):
    """Rank 0 wrote two points, rank 1 (the last) none."""
    same(data.GetNumberOfPoints(), 2, f"{path} points")
    same(data.GetNumberOfVerts(), 2, f"{path} vertices")
    point = data.GetPointData()
    for q in range(2):
        x = tuple(q + 0.25 * c for c in range(3))
        same(data.GetPoint(q), x, f"{path} point {q}")
        same(point.GetArray("force").GetTuple3(q), tuple(1 / (1 + a) for a in x), f"{path} force")
        same(point.GetArray("damage").GetTuple1(q), 0.5 * q, f"{path} damage")
        same(point.GetArray("id").GetValue(q), 5000000000 + q, f"{path} id")
        same(point.GetArray("surface").GetTuple1(q), 200 + q, f"{path} surface")


folder = sys.argv[1]
image = read(vtkXMLImageDataReader(), f"{folder}/uniform.vti")
same(image.GetSpacing(), (0.25, 0.5, 0.75), "uniform.vti spacing")
same(image.GetOrigin(), (0, 0, 0), "uniform.vti origin")
check_cells(image, N[2], "uniform.vti")
check_time(image, 0.125, "uniform.vti")
check_cells(read(vtkXMLImageDataReader(), f"{folder}/flat.vti"), 1, "flat.vti")
rectilinear = read(vtkXMLRectilinearGridReader(), f"{folder}/stretched.vtr")
check_cells(rectilinear, N[2], "stretched.vtr")
y = rectilinear.GetYCoordinates()
same((y.GetValue(0), y.GetValue(N[1])), (0.0, 3.5), "stretched.vtr ends of y")
assert all(y.GetValue(j) < y.GetValue(j + 1) for j in range(N[1])), "y does not increase"
points = read(vtkXMLPolyDataReader(), f"{folder}/points.vtp")
check_points(points, "points.vtp")
check_time(points, 0.375, "points.vtp")
none = read(vtkXMLPolyDataReader(), f"{folder}/none.vtp")
same(none.GetNumberOfPoints(), 0, "none.vtp")
check_time(none, None, "none.vtp")
print(f"VTK reads what was written: {checked} comparisons")
