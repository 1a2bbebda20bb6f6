#!/usr/bin/python3
"""Reflection at jumps between levels: levels_reflection.png beside levels_reflection.csv.

usage: plot_levels.py FOLDER, where the validations pd_bond.levels_reflection and
pd_bond.levels_patch left their tables (build/verification); the ghost force at a flat jump, times
horizon over E strain, is named with each form."""
import csv
import subprocess
import sys
from pathlib import Path


def curves(path):
    """{(levels, wave): {form: [(horizons per wave, R)]}}"""
    found = {}
    with open(path, newline="", encoding="utf-8") as table:
        for row in csv.DictReader(table):
            panel = found.setdefault((row["levels_above_0"], row["wave"]), {})
            panel.setdefault(row["form"], []).append((row["horizons_per_wave"], row["R"]))
    return found


def ghosts(path):
    """{form: ghost force at a flat jump}; nothing without the table."""
    if not path.exists():
        return {}
    with open(path, newline="", encoding="utf-8") as table:
        return {row["form"]: float(row["ghost"]) for row in csv.DictReader(table)
                if row["shape"] == "plane"}


def label(form, ghost):
    """A form by its name and what it leaves of a uniform strain."""
    return form.replace("_", " ") + (f" ({ghost[form]:.1g})" if form in ghost else "")


def panel(name, forms, ghost):
    """gnuplot's lines for one wave and one number of levels."""
    lines = [f"$d_{name} << E"]
    # Two blank lines between the blocks of data, so that `index` finds them.
    for points in forms.values():
        lines += [f"{length} {value}" for length, value in points] + ["", ""]
    wave, levels = name.split("_")
    lines += ["E", f"set title '{wave} waves, levels above the coarsest: {levels}'"]
    parts = [f"$d_{name} index {q} using 1:2 with linespoints lw 2 pt 7 title '{label(form, ghost)}'"
             for q, form in enumerate(forms)]
    return lines + ["plot " + ", ".join(parts)]


def main():
    folder = Path(sys.argv[1])
    ghost = ghosts(folder / "levels_patch.csv")
    lines = ["set terminal pngcairo noenhanced size 1000,800",
             f"set output '{folder / 'levels_reflection.png'}'", "set multiplot layout 2,2",
             "set logscale xy", "set format y '%.0e'",
             "set xlabel 'wavelength over coarse horizon'",
             "set ylabel 'reflected amplitude'", "set key bottom left"]
    for (levels, wave), forms in curves(folder / "levels_reflection.csv").items():
        lines += panel(f"{wave}_{levels}", forms, ghost)
    subprocess.run(["gnuplot"], input="\n".join(lines), text=True, check=True)


if __name__ == "__main__":
    main()
