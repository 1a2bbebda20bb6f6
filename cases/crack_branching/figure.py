#!/usr/bin/python3
"""Damage at 20, 30, 40 and 50 us and the tip's speed: FOLDER/figures/branching.png, speed.png.

usage: figure.py FOLDER [FINER]
FOLDER holds a run with output.picture_every=200; FINER one of a finer lattice, for the speed only."""
import csv
import subprocess
import sys
from pathlib import Path

from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

SHOWN = {400: "20 us", 600: "30 us", 800: "40 us", 1000: "50 us"}  # steps of 50 ns
DAMAGED = 0.05


def particles(path):
    """(x, y, damage) of the damaged ones, mm."""
    reader = vtkXMLPolyDataReader()
    reader.SetFileName(str(path))
    reader.Update()
    data = reader.GetOutput()
    damage = data.GetPointData().GetArray("damage")
    for q in range(data.GetNumberOfPoints()):
        if damage.GetValue(q) > DAMAGED:
            x, y, _ = data.GetPoint(q)
            yield 1e3 * x, 1e3 * y, damage.GetValue(q)


def maps(folder, out):
    lines = ["set terminal pngcairo size 1200,560 font 'sans,10'", f"set output '{out}'",
             "set multiplot layout 2,2", "set xrange [0:100]", "set yrange [0:40]",
             "set size ratio -1", "set cbrange [0:0.8]", "set cblabel 'damage'", "unset key",
             "set xlabel 'x [mm]'", "set ylabel 'y [mm]'",
             "set palette defined (0 '#f4f4f0', 0.3 '#7fb0dd', 0.8 '#0b2d5c')"]
    # A panel per instant: damaged particles, coloured by damage.
    for step, title in SHOWN.items():
        lines.append("$p << E")
        lines += [f"{x:.3f} {y:.3f} {d:.3f}" for x, y, d in
                  particles(folder / f"damage-{step:06d}.vtp")]
        lines += ["E", f"set title '{title}'",
                  "plot $p using 1:2:3 with points pt 5 ps 0.35 lc palette"]
    return lines


def speeds(folders, out):
    lines = ["set terminal pngcairo size 900,420 font 'sans,10'", f"set output '{out}'",
             "set xlabel 'time [us]'", "set ylabel 'speed of the tip over 2 us [m/s]'",
             "set xrange [0:60]", "set yrange [0:2500]",
             "set grid lc rgb '#dddddd'", "set key top right"]
    # The speed is that of history.csv, over 2 us.
    for q, folder in enumerate(folders):
        with open(folder / "history.csv", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        lines += [f"$d{q} << E"] + [f"{1e6 * float(r['time[s]'])} {r['speed[m/s]']}"
                                    for r in rows] + ["E"]
    titles = ["200 x 80 particles", "400 x 160"]
    lines.append("plot " + ", ".join(
        [f"$d{q} using 1:2 with lines lw 2 title '{titles[q]}'" for q in range(len(folders))] +
        ["1580 with lines dt 2 lc rgb 'black' title 'highest measured (Bowden et al. 1967)'"]))
    return lines


def main():
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    folders = [Path(a) for a in sys.argv[1:]]
    figures = folders[0] / "figures"
    figures.mkdir(exist_ok=True)
    for lines in (maps(folders[0], figures / "branching.png"),
                  speeds(folders, figures / "speed.png")):
        done = subprocess.run(["gnuplot"], input="\n".join(lines) + "\n", text=True,
                              capture_output=True)
        if done.returncode != 0:
            sys.exit(f"figure.py: gnuplot made no figure:\n{done.stderr}")


main()
