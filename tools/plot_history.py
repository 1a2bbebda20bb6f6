#!/usr/bin/python3
"""One figure per column of FOLDER/history.csv against its first column: FOLDER/figures/NAME.png."""
import csv
import re
import subprocess
import sys
from pathlib import Path


def label(column):
    """'force_probe_x[N]' -> 'force probe x [N]'"""
    name, _, unit = column.partition("[")
    return name.replace("_", " ") + (f" [{unit}" if unit else "")


def file_name(column):
    return re.sub(r"[^A-Za-z0-9_-]", "_", column.partition("[")[0]) + ".png"


def quoted(text):
    """A string of gnuplot in single quotes."""
    return "'" + str(text).replace("'", "''") + "'"


def script(table, columns, figures):
    lines = ["set terminal pngcairo size 900,560 noenhanced font 'sans,11'",
             "set datafile separator ','", "set key off", "set grid lc rgb '#dddddd'",
             f"set xlabel {quoted(label(columns[0]))}", "set format y '%.4g'"]
    for q, column in enumerate(columns[1:], start=2):
        lines += [f"set output {quoted(figures / file_name(column))}",
                  f"set ylabel {quoted(label(column))}",
                  f"plot {quoted(table)} using 1:{q} every ::1 with lines lw 2 lc rgb '#1f5fa8'"]
    return "\n".join(lines) + "\n"


def main():
    if len(sys.argv) != 2:
        sys.exit("usage: plot_history.py FOLDER")
    folder = Path(sys.argv[1])
    table = folder / "history.csv"
    with open(table, newline="") as file:
        rows = list(csv.reader(file))
    # A head line and two samples make a curve.
    if len(rows) < 3:
        print(f"{table}: fewer than two samples, nothing to plot")
        return
    figures = folder / "figures"
    figures.mkdir(exist_ok=True)
    done = subprocess.run(["gnuplot"], input=script(table, rows[0], figures), text=True,
                          capture_output=True)
    # gnuplot may end without an error and without a figure.
    missing = [c for c in rows[0][1:] if not (figures / file_name(c)).is_file()]
    if done.returncode != 0 or missing:
        sys.exit(f"plot_history.py: gnuplot made no figure of {missing}:\n{done.stderr}")
    print(f"{len(rows[0]) - 1} figures of {len(rows) - 1} samples in {figures}")


main()
