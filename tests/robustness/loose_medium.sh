#!/bin/sh
# A medium of porosity 0.98 is a dozen loose grains: it runs, breakage and all, and no grain is lost.
# usage: loose_medium.sh SOURCE BUILD
set -eu
out=$2/test_loose
rm -rf "$out"
mpirun -n 1 "$2/bin/porous_breakup" "$1/tests/support/porous_small.yaml" --out "$out" --quiet \
  --set medium.radius_over_pitch=0.75 --set breakage.steps=40
awk -F, 'NR == 1 { for (i = 1; i <= NF; i++) col[$i] = i }
  NR > 1 { porosity = $col["porosity[-]"]; pieces = $col["fragments[-]"]
           mass = $col["solid_mass_inside[kg]"] + $col["solid_mass_passing_out[kg]"] + $col["solid_mass_left[kg]"]
           if (first == "") first = mass
           if (mass != first) { print "FAIL: mass " mass " was " first; exit 1 } }
  END { if (!(porosity > 0.97 && pieces >= 4)) { print "FAIL: porosity " porosity ", pieces " pieces; exit 1 } }' \
  "$out/history.csv"
