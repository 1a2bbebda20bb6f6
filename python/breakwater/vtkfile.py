"""The VTK files that Breakwater writes: .vti, .vtr, .vtp with raw appended data, and .pvd series."""
import re
import xml.etree.ElementTree as xml
from pathlib import Path

import numpy as np

_TYPES = {"Float32": "<f4", "Float64": "<f8", "Int32": "<i4", "Int64": "<i8", "UInt8": "u1"}


class Picture(dict):
    """Arrays by name. Of a fluid each has the shape (nz, ny, nx) or (nz, ny, nx, 3), and x, y, z are
    the centres of its cells; of particles (n,) or (n, 3), and points are where they are."""

    def __init__(self, time=None):
        super().__init__()
        self.time = time
        self.x = self.y = self.z = self.points = None

    def dataset(self):
        """The fluid as an xarray.Dataset, which has to be installed."""
        import xarray
        axes = ("z", "y", "x")
        return xarray.Dataset(
            {name: (axes + (("component",) if a.ndim == 4 else ()), a) for name, a in self.items()},
            coords={"x": self.x, "y": self.y, "z": self.z}, attrs={"time": self.time})

    def frame(self):
        """The particles as a pandas.DataFrame, which has to be installed."""
        import pandas
        columns = {"x": self.points[:, 0], "y": self.points[:, 1], "z": self.points[:, 2]}
        for name, a in self.items():
            if a.ndim == 1:
                columns[name] = a
            else:
                columns.update({f"{name}.{'xyz'[d]}": a[:, d] for d in range(a.shape[1])})
        return pandas.DataFrame(columns)


class _File:
    """Head and data of one file."""

    def __init__(self, path):
        raw = Path(path).read_bytes()
        found = re.search(rb'<AppendedData encoding="raw">\s*_', raw)
        if found is None:
            raise ValueError(f"{path}: no raw appended data: not a file of Breakwater")
        self.path, self.data = path, raw[found.end():]
        self.head = xml.fromstring(raw[:found.start()] + b"</VTKFile>")

    def array(self, element):
        kind = element.get("type")
        if kind not in _TYPES:
            raise ValueError(f"{self.path}: values of the type {kind}")
        start = int(element.get("offset"))
        size = int(np.frombuffer(self.data, "<u8", 1, start)[0])
        values = np.frombuffer(self.data[start + 8:start + 8 + size], _TYPES[kind])
        width = int(element.get("NumberOfComponents", 1))
        return values.reshape(-1, width) if width > 1 else values


def _fill_grid(file, grid, picture):
    ends = [int(n) for n in grid.get("WholeExtent").split()]
    n = [ends[2 * d + 1] - ends[2 * d] for d in range(3)]
    piece = grid.find("Piece")
    if grid.tag == "ImageData":
        spacing = [float(h) for h in grid.get("Spacing").split()]
        origin = [float(x) for x in grid.get("Origin").split()]
        faces = [origin[d] + spacing[d] * np.arange(n[d] + 1) for d in range(3)]
    else:
        faces = [file.array(a) for a in piece.find("Coordinates").iter("DataArray")]
    picture.x, picture.y, picture.z = (0.5 * (f[1:] + f[:-1]) for f in faces)
    for element in piece.find("CellData").iter("DataArray"):
        a = file.array(element)
        picture[element.get("Name")] = a.reshape((n[2], n[1], n[0]) + a.shape[1:])


def read_vtk(path, time=None):
    """The Picture in a .vti, .vtr or .vtp file."""
    file = _File(path)
    picture = Picture(time)
    stamp = file.head.find(".//FieldData/DataArray[@Name='TimeValue']")
    if stamp is not None and time is None:
        picture.time = float(file.array(stamp)[0])
    body = next(e for e in file.head if e.tag in ("ImageData", "RectilinearGrid", "PolyData"))
    if body.tag != "PolyData":
        _fill_grid(file, body, picture)
        return picture
    piece = body.find("Piece")
    picture.points = file.array(piece.find("Points/DataArray"))
    for element in piece.findall("PointData/DataArray"):
        picture[element.get("Name")] = file.array(element)
    return picture


def series(path):
    """[(time, path)] of a .pvd file, as it was last written."""
    folder = Path(path).parent
    return [(float(d.get("timestep")), folder / d.get("file"))
            for d in xml.parse(path).getroot().iter("DataSet")]
