#!/usr/bin/python3
"""The stability map of explicit coupling as a figure, through gnuplot.

usage: stability.py PNG [JSON]      JSON: build/verification/coupler.added_mass.json of a --full run
"""
import json
import subprocess
import sys

BODIES = ("block", "cylinder", "plate")
LOADS = (("probes", "#1f77b4"), ("reaction", "#d62728"))
POINTS = {0.0005: 4, 0.002: 7, 0.008: 8}

rows = json.load(open(sys.argv[2] if len(sys.argv) > 2 else
                      "build/verification/coupler.added_mass.json"))
rows = rows["rows"] if isinstance(rows, dict) else rows
script = ["set terminal pngcairo size 1300,470 font ',10'", f"set output '{sys.argv[1]}'",
          "set multiplot layout 1,3", "set logscale xy; set grid",
          "set xlabel 'share w of the new load in each step'; set xrange [0.04:1.3]",
          "set ylabel 'density of the body over that of the fluid'; set yrange [0.01:20]",
          "set key bottom right font ',9'"]
for body in BODIES:
    script.append("set key" if body == BODIES[-1] else "unset key")
    plots = []
    for load, colour in LOADS:
        of = [r for r in rows if r.get("body") == body and r.get("load") == load]
        mine = sorted((r for r in of if r["quantity"] == "critical_density_ratio"),
                      key=lambda r: r["w"])
        for dt, point in POINTS.items():
            name = f"${body}{load}{point}"
            script += [f"{name} << EOD",
                       *(f"{r['w']} {r['measured']}" for r in mine if r["dt"] == dt), "EOD"]
            plots.append(f"{name} with points pt {point} ps 1.2 lc rgb '{colour}'"
                         f" title '{load}, dt = {dt}'")
        name = f"${body}{load}"
        script += [f"{name} << EOD", *(f"{r['w']} {r['reference']}" for r in mine
                                       if r["dt"] == 0.002), "EOD"]
        plots.append(f"{name} with lines lw 2 lc rgb '{colour}' title '{load}, from its answer'")
        for r in of:
            if r["quantity"] == "critical_density_ratio_iterated":
                plots.append(f"{r['measured']} with lines dt 2 lw 2 lc rgb '{colour}'"
                             f" title '{load}, iterated'")
    script += [f"set title '{body}: holds above'", "plot " + ", ".join(plots)]
subprocess.run(["gnuplot"], input="\n".join(script), text=True, check=True)
