#!/usr/bin/python3
"""FSI figure 7: the velocity along the stream at four instants, with the plate; through gnuplot.

usage: figure.py FOLDER [PNG] [t1 t2 t3 t4]     (times in H/U_b; default 0.4 1.2 2.4 and the last)
Reads fluid.pvd and plate.pvd of a run of bending_plate and the scales from its run.yaml.
"""
import re
import subprocess
import sys
import xml.etree.ElementTree as xml
from pathlib import Path

from vtkmodules.vtkIOXML import vtkXMLImageDataReader, vtkXMLPolyDataReader


def read(reader, path):
    reader.SetFileName(str(path))
    reader.Update()
    return reader.GetOutput()


def series(folder, name):
    entries = xml.parse(folder / f"{name}.pvd").iter("DataSet")
    return [(float(e.get("timestep")), folder / e.get("file")) for e in entries]


def scales(folder):
    text = (folder / "run.yaml").read_text()
    number = {k: float(re.search(rf"^\s*{k}:\s*([-+.\deE]+)", text, re.M).group(1))
              for k in ("bulk_velocity",)}
    # The first `height` behind `plate:` is the plate's own.
    plate = text[text.index("plate:"):]
    return number["bulk_velocity"], float(re.search(r"height:\s*([-+.\deE]+)", plate).group(1))


def velocity(path, U, H):
    """Rows of x/H, y/H, u/U_b, a blank line after each row of cells."""
    image = read(vtkXMLImageDataReader(), path)
    n, h = [d - 1 for d in image.GetDimensions()], image.GetSpacing()
    data = image.GetCellData().GetArray("velocity")
    for j in range(n[1]):
        for i in range(n[0]):
            u = data.GetComponent(j * n[0] + i, 0)
            yield f"{(i + 0.5) * h[0] / H:.4f} {(j + 0.5) * h[1] / H:.4f} {u / U:.4f}"
        yield ""


def plate(path, H):
    points = read(vtkXMLPolyDataReader(), path)
    rows = (points.GetPoint(q) for q in range(points.GetNumberOfPoints()))
    return [f"{x / H:.5f} {y / H:.5f}" for x, y, _ in rows if y > 0]


def main():
    if len(sys.argv) not in (2, 3, 7):
        sys.exit(__doc__)
    folder = Path(sys.argv[1])
    png = sys.argv[2] if len(sys.argv) > 2 else folder / "figures" / "velocity.png"
    Path(png).parent.mkdir(exist_ok=True)
    U, H = scales(folder)
    fluid, solid = series(folder, "fluid"), series(folder, "plate")
    wanted = [float(t) * H / U for t in sys.argv[3:]] or [0.4 * H / U, 1.2 * H / U, 2.4 * H / U,
                                                          fluid[-1][0]]
    # The nearest picture to each time that was asked for.
    picks = [min(range(len(fluid)), key=lambda q: abs(fluid[q][0] - t)) for t in wanted]
    script = [f"set terminal pngcairo size 1300,560 font ',10'; set output '{png}'",
              "set palette defined (0 '#2b4c9b', 0.35 '#bcd3e8', 0.45 '#f5f5f0', 0.7 '#f0a35e',"
              " 1 '#9b1c1c')", "set cbrange [-1.5:4]; unset key; set size ratio -1",
              "set xrange [0:4.5]; set yrange [0:1.5]; set xtics 0.5; set ytics 0.5",
              "set cblabel 'u/U_b'", "set multiplot layout 2,2"]
    # Velocity as a map, the plate's particles as dots above it.
    for q in picks:
        script += ["$u << EOD", *velocity(fluid[q][1], U, H), "EOD",
                   "$p << EOD", *plate(solid[q][1], H), "EOD",
                   f"set title 't U_b/H = {fluid[q][0] * U / H:.2f}'",
                   "plot $u using 1:2:3 with image,"
                   " $p using 1:2 with dots lc rgb 'black'"]
    script.append("unset multiplot")
    subprocess.run(["gnuplot"], input="\n".join(script), text=True, check=True)


main()
