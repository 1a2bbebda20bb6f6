#!/usr/bin/python3
"""Curves of FOLDER/failure.csv (validation solid_tools.failure, --full): FOLDER/failure.png.

A panel for each medium and rule that breaks it: true against false positives of every other gauge."""
import csv
import subprocess
import sys
from pathlib import Path

GAUGES = ("rankine", "energy", "mises", "mohr_coulomb", "drucker_prager", "stretch", "griffith")
RULES = ("stretch", "rankine", "mohr_coulomb")  # of six: the others lie beside rankine's


def curves(path):
    """{(medium, rule): {gauge: [(false, true)]}} in the order of the file."""
    found = {}
    with path.open() as file:
        for row in csv.DictReader(file):
            points = found.setdefault((row["medium"], row["rule"]), {}).setdefault(row["gauge"], [])
            points.append((row["false_positives"], row["true_positives"]))
    return found


def panel(number, medium, rule, gauges):
    """gnuplot's lines for one panel; the rule's own gauge is the check and not drawn."""
    lines = [f"$d_{number} << E"]
    shown = {name: points for name, points in gauges.items() if name != rule}
    for points in shown.values():
        lines += ["0 0"] + [f"{a} {b}" for a, b in points] + ["", ""]
    lines += ["E", f"set title '{medium}, breaks by {rule}'"]
    parts = [f"$d_{number} index {q} using 1:2 with lines lw 2 lc {GAUGES.index(name) + 1} title '{name}'"
             for q, name in enumerate(shown)]
    return lines + ["plot " + ", \\\n ".join(parts)]


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    folder = Path(sys.argv[1])
    found = {key: value for key, value in curves(folder / "failure.csv").items() if key[1] in RULES}
    if not found:
        sys.exit(f"plot_failure.py: no curves in {folder}/failure.csv")
    lines = ["set terminal pngcairo size 1300,1200 noenhanced font 'sans,10'",
             f"set output '{folder}/failure.png'", "set grid lc rgb '#dddddd'", "set xrange [0:0.3]",
             "set yrange [0:1]", "set xlabel 'false positives'", "set ylabel 'true positives'",
             "set key bottom right", f"set multiplot layout {(len(found) + 2) // 3},3"]
    for number, ((medium, rule), gauges) in enumerate(found.items()):
        lines += panel(number, medium, rule, gauges)
    done = subprocess.run(["gnuplot"], input="\n".join(lines) + "\n", text=True, capture_output=True)
    if done.returncode != 0 or not (folder / "failure.png").is_file():
        sys.exit(f"plot_failure.py: gnuplot made no figure:\n{done.stderr}")
    print(f"{len(found)} panels in {folder}/failure.png")


main()
