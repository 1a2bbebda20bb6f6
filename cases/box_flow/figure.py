#!/usr/bin/python3
"""Vorticity at four instants of a two-dimensional run of box_flow on a uniform grid; through gnuplot.

usage: figure.py FOLDER [PNG] [t1 t2 t3 t4]     (default: spread evenly over fluid.pvd)
"""
import subprocess
import sys
import xml.etree.ElementTree as xml
from pathlib import Path

from vtkmodules.vtkIOXML import vtkXMLImageDataReader


def vorticity(path):
    """Rows of x, y, dv/dx - du/dy by central differences of the cells' velocities."""
    reader = vtkXMLImageDataReader()
    reader.SetFileName(str(path))
    reader.Update()
    image = reader.GetOutput()
    n, h = [d - 1 for d in image.GetDimensions()], image.GetSpacing()
    data = image.GetCellData().GetArray("velocity")

    def u(c, i, j):
        return data.GetComponent(j * n[0] + i, c)

    # Cells beside the sides have no neighbour on both sides and are left out.
    for j in range(1, n[1] - 1):
        for i in range(1, n[0] - 1):
            w = ((u(1, i + 1, j) - u(1, i - 1, j)) / (2 * h[0])
                 - (u(0, i, j + 1) - u(0, i, j - 1)) / (2 * h[1]))
            yield f"{(i + 0.5) * h[0]:.5f} {(j + 0.5) * h[1]:.5f} {w:.4f}"
        yield ""


def main():
    if len(sys.argv) not in (2, 3, 7):
        sys.exit(__doc__)
    folder = Path(sys.argv[1])
    png = Path(sys.argv[2]) if len(sys.argv) > 2 else folder / "figures" / "vorticity.png"
    png.parent.mkdir(parents=True, exist_ok=True)
    entries = [(float(e.get("timestep")), e.get("file"))
               for e in xml.parse(folder / "fluid.pvd").iter("DataSet")]
    last = entries[-1][0]
    wanted = [float(t) for t in sys.argv[3:]] or [last * q / 3 for q in range(4)]
    # The nearest picture to each time that was asked for.
    picks = [min(entries, key=lambda e: abs(e[0] - t)) for t in wanted]
    script = [f"set terminal pngcairo size 1300,720 font ',11'; set output '{png}'",
              "set palette defined (-1 '#2b4c9b', -0.1 '#cfe0ef', 0 '#f7f7f4', 0.1 '#f6cfa8',"
              " 1 '#9b1c1c')", "unset key; set size ratio -1; set autoscale xfix; set autoscale yfix",
              "set xlabel 'x'; set ylabel 'y'; set cblabel 'vorticity'", "set multiplot layout 2,2"]
    for time, name in picks:
        rows = list(vorticity(folder / name))
        # Every panel has its own colours, symmetric about zero.
        most = max(abs(float(r.split()[2])) for r in rows if r)
        script += ["$w << EOD", *rows, "EOD", f"set cbrange [{-most}:{most}]",
                   f"set title 't = {time:.2f}'", "plot $w using 1:2:3 with image"]
    script.append("unset multiplot")
    subprocess.run(["gnuplot"], input="\n".join(script), text=True, check=True)


main()
