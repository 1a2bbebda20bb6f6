"""What a run has left in its folder."""
import csv
from pathlib import Path

import numpy as np

from .vtkfile import read_vtk, series


class History(dict):
    """Columns of history.csv by name, without the unit; units has those: "tip.y" -> "L"."""

    def __init__(self, path):
        super().__init__()
        self.units = {}
        with open(path, newline="") as file:
            rows = list(csv.reader(file))
        # A run that is writing may be amid a row; an empty cell is a value that was not measured.
        whole = [[x or "nan" for x in row] for row in rows[1:] if len(row) == len(rows[0])]
        table = np.array(whole, dtype=float).reshape(len(whole), len(rows[0]))
        for q, head in enumerate(rows[0]):
            name, _, unit = head.partition("[")
            self[name] = table[:, q]
            self.units[name] = unit.rstrip("]")

    def frame(self):
        """A pandas.DataFrame over time, which has to be installed."""
        import pandas
        return pandas.DataFrame(dict(self)).set_index("time")


class Checkpoint(dict):
    """Arrays of a checkpoint by their paths, "fluid/u": numpy. Fields are (nz, ny, nx), of velocity
    with one more along its own direction where that is walled. Needs h5py."""

    def __init__(self, path):
        import h5py
        super().__init__()
        with h5py.File(path, "r") as file:
            file.visititems(lambda name, item: self.update({name: item[()]})
                            if isinstance(item, h5py.Dataset) else None)
        self.time = float(self["scene/time"][0]) if "scene/time" in self else None


class Run:
    """A folder that build/bin/breakwater, or a case, has written to, or is writing to."""

    def __init__(self, folder):
        self.folder = Path(folder)
        if not (self.folder / "run.yaml").is_file():
            raise FileNotFoundError(f"{folder}: no run.yaml: not the folder of a run")

    @property
    def history(self):
        """Read anew each time: the run may go on."""
        return History(self.folder / "history.csv")

    @property
    def watched(self):
        """Rows of watch.csv by gauge: mean, amplitude, frequency, periods."""
        with open(self.folder / "watch.csv", newline="") as file:
            return {row.pop("gauge"): {key.partition("[")[0]: float(value)
                                       for key, value in row.items()}
                    for row in csv.DictReader(file)}

    @property
    def names(self):
        """Of the series of pictures: fluid, and bodies."""
        return sorted(path.stem for path in self.folder.glob("*.pvd"))

    def _picture(self, name, which):
        path = self.folder / f"{name}.pvd"
        if not path.is_file():
            raise KeyError(f"{self.folder}: no pictures of {name}; there are: {self.names}")
        time, file = series(path)[which]
        return read_vtk(file, time)

    def times(self, name="fluid"):
        """Times of the pictures of a series."""
        return np.array([time for time, _ in series(self.folder / f"{name}.pvd")])

    def fluid(self, which=-1):
        """Picture number `which` of the fluid; -1: the last."""
        return self._picture("fluid", which)

    def particles(self, name, which=-1):
        """Picture number `which` of the particles, or surface points, of a body."""
        return self._picture(name, which)

    def lines(self, gauge):
        """[(path, table)] of the files of a line or slice; tables are numpy with named columns."""
        files = sorted(self.folder.glob(f"{gauge}-[0-9]*.csv"))
        return [(path, np.genfromtxt(path, delimiter=",", names=True)) for path in files]

    def checkpoint(self, name="checkpoint-last.h5"):
        """The arrays of a checkpoint."""
        return Checkpoint(self.folder / name)
