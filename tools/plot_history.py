#!/usr/bin/python3
"""FOLDER/history.csv over its first column: at most six figures, FOLDER/figures/NAME.png.

usage: plot_history.py FOLDER [REFERENCE.csv]
Columns of one gauge and one unit are curves of one panel, told apart in print by their dashes. Up to
six panels are a figure each, by name; more share figures history-1.png .. history-6.png.
REFERENCE.csv has the columns column,value,source: dashed lines in the panel of that column.
"""
import csv
import subprocess
import sys
from pathlib import Path

import history

FIGURES = 6
CURVES = ["#000000", "#1f5fa8", "#c03020", "#4a8a3a", "#8050a0", "#a07020"]


def quoted(text):
    """A string of gnuplot in single quotes."""
    return "'" + str(text).replace("'", "''") + "'"


def panel(table, head, one, references):
    """Lines that draw one panel."""
    title, unit, curves = one
    lines = [f"set title {quoted(title)}", f"set ylabel {quoted('[' + unit + ']')}",
             "set key below" if len(curves) > 1 or references else "set key off"]
    drawn = [f"{quoted(table)} using 1:{q + 1} every ::1 with lines lw 2 dt {k % 5 + 1} "
             f"lc rgb '{CURVES[k % len(CURVES)]}' title {quoted(label)}"
             for k, (label, q) in enumerate(curves)]
    names = {head[q].partition("[")[0] for _, q in curves}
    drawn += [f"{float(row['value'])!r} with lines lw 1.5 dt 2 lc rgb '#777777' "
              f"title {quoted(row['source'])}"
              for row in references if row["column"] in names]
    return lines + ["plot " + ", ".join(drawn)]


def share(panels):
    """[(name, panels)] of the figures."""
    if len(panels) <= FIGURES:
        return [(history.file_name(one[0] if sum(p[0] == one[0] for p in panels) == 1
                                   else f"{one[0]}-{one[1]}"), [one]) for one in panels]
    size = -(-len(panels) // FIGURES)
    parts = [panels[q:q + size] for q in range(0, len(panels), size)]
    return [(f"history-{k + 1}", part) for k, part in enumerate(parts)]


def script(table, head, figures, folder, references):
    lines = ["set datafile separator ','", "set grid lc rgb '#dddddd'",
             f"set xlabel {quoted(head[0])}", "set format y '%.4g'"]
    for name, part in figures:
        lines += [f"set terminal pngcairo size 900,{80 + 420 * len(part)} noenhanced font 'sans,11'",
                  f"set output {quoted(folder / (name + '.png'))}",
                  f"set multiplot layout {len(part)},1"]
        for one in part:
            names = {head[q].partition("[")[0] for _, q in one[2]}
            lines += panel(table, head, one, [r for r in references if r["column"] in names])
        lines.append("unset multiplot")
    return "\n".join(lines) + "\n"


def main():
    if len(sys.argv) not in (2, 3):
        sys.exit("usage: plot_history.py FOLDER [REFERENCE.csv]")
    folder = Path(sys.argv[1])
    table = folder / "history.csv"
    references = []
    if len(sys.argv) == 3 and Path(sys.argv[2]).is_file():
        with open(sys.argv[2], newline="") as file:
            references = list(csv.DictReader(file))
    head, rows = history.read(table)
    # Two samples make a curve.
    if len(rows) < 2:
        print(f"{table}: fewer than two samples, nothing to plot")
        return
    target = folder / "figures"
    target.mkdir(exist_ok=True)
    figures = share(history.panels(head))
    done = subprocess.run(["gnuplot"], input=script(table, head, figures, target, references),
                          text=True, capture_output=True)
    # gnuplot may end without an error and without a figure.
    missing = [name for name, _ in figures if not (target / f"{name}.png").is_file()]
    if done.returncode != 0 or missing:
        sys.exit(f"plot_history.py: gnuplot made no figure of {missing}:\n{done.stderr}")
    print(f"{len(figures)} figures of {len(rows)} samples in {target}")


main()
