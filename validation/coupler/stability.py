#!/usr/bin/python3
"""The stability map of explicit coupling as a figure, through gnuplot.

usage: stability.py PNG [JSON]      JSON: build/verification/coupler.added_mass.json of a --full run
"""
import json
import subprocess
import sys

LOADS = (("probes", "#1f77b4"), ("reaction", "#d62728"))
POINTS = {0.0005: 4, 0.002: 7, 0.008: 8}

rows = json.load(open(sys.argv[2] if len(sys.argv) > 2 else
                      "build/verification/coupler.added_mass.json"))
rows = rows["rows"] if isinstance(rows, dict) else rows
rows = [r for r in rows if r["quantity"] == "critical_density_ratio"]
script = ["set terminal pngcairo size 980,480 font ',10'", f"set output '{sys.argv[1]}'",
          "set logscale xy; set grid; set key outside right top; set rmargin 32",
          "set xlabel 'share w of the new load in each step'; set xrange [0.04:1.2]",
          "set ylabel 'density of the block over that of the fluid'; set yrange [0.01:4]",
          "set label 'holds' at 0.06,1; set label 'diverges' at 0.5,0.05"]
plots = []
for load, colour in LOADS:
    mine = sorted((r for r in rows if r["load"] == load), key=lambda r: r["w"])
    for dt, point in POINTS.items():
        script += [f"${load}{point} << EOD",
                   *(f"{r['w']} {r['measured']}" for r in mine if r["dt"] == dt), "EOD"]
        plots.append(f"${load}{point} with points pt {point} ps 1.2 lc rgb '{colour}'"
                     f" title '{load}, runs, dt = {dt}'")
    script += [f"${load} << EOD", *(f"{r['w']} {r['reference']} {r['w_below_2_over_1_plus_ratio']}"
                                    for r in mine if r["dt"] == 0.002), "EOD"]
    plots += [f"${load} using 1:2 with lines lw 2 lc rgb '{colour}' title '{load}, from the answer'",
              f"${load} using 1:3 with lines dt 2 lc rgb '{colour}'"
              f" title '{load}, w < 2/(1 + m_a/m)'"]
script.append("plot " + ", ".join(plots))
subprocess.run(["gnuplot"], input="\n".join(script), text=True, check=True)
