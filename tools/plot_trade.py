#!/usr/bin/python3
"""Error against cost of the studies in FOLDER/trade.json (./run bench trade): FOLDER/trade.png.

A case is named STUDY/CURVE/POINT and has two rows, `error` and `cost`."""
import json
import subprocess
import sys
from pathlib import Path


def studies(rows):
    """{study: {curve: [(cost, error, point)]}} and {study: unit of its cost}."""
    found, unit = {}, {}
    value = {(r["case"], r["quantity"]): r for r in rows}
    # In the order of the file: a curve goes through its points as they were run.
    for case in dict.fromkeys(r["case"] for r in rows):
        study, curve, point = case.split("/")
        cost = value[case, "cost"]
        unit[study] = cost["unit"]
        found.setdefault(study, {}).setdefault(curve, []).append(
            (cost["value"], value[case, "error"]["value"], point))
    return found, unit


def panel(study, curves, unit):
    """gnuplot's lines for one study: a block of data and its plot."""
    lines = [f"$d_{study} << E"]
    # One block of data per curve, two blank lines apart, so that `index` finds it.
    for points in curves.values():
        lines += [f'{cost} {error} "{point}"' for cost, error, point in points] + ["", ""]
    lines += ["E", f"set title '{study}'", f"set xlabel 'cost [{unit}]'"]
    parts = []
    for q, name in enumerate(curves):
        parts.append(f"$d_{study} index {q} using 1:2 with linespoints lw 2 pt 7 lc {q + 1} "
                     f"title '{name}'")
        parts.append(f"$d_{study} index {q} using 1:2:3 with labels left offset 0.7,0.5 "
                     f"font ',8' tc lt {q + 1} notitle")
    return lines + ["plot " + ", \\\n ".join(parts)]


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    folder = Path(sys.argv[1])
    found, unit = studies(json.loads((folder / "trade.json").read_text()))
    lines = ["set terminal pngcairo size 1300,1000 noenhanced font 'sans,11'",
             f"set output '{folder}/trade.png'", "set logscale xy", "set grid lc rgb '#dddddd'",
             "set ylabel 'error'", "set format '%.0e'", "set key bottom left",
             "set offsets graph 0.02, graph 0.12, graph 0.02, graph 0.02",
             f"set multiplot layout {(len(found) + 1) // 2},2"]
    for study, curves in found.items():
        lines += panel(study, curves, unit[study])
    done = subprocess.run(["gnuplot"], input="\n".join(lines) + "\n", text=True,
                          capture_output=True)
    if done.returncode != 0 or not (folder / "trade.png").is_file():
        sys.exit(f"plot_trade.py: gnuplot made no figure:\n{done.stderr}")
    print(f"{len(found)} studies in {folder}/trade.png")


main()
