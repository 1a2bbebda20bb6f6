#!/bin/sh
# A flow stopped and gone on with tells the same history to the last bit, whatever its sides; and the
# history has what a user asks of it: the forcing balances the walls, what enters leaves.
# usage: box_flow.sh SOURCE BUILD
set -eu
source=$1 build=$2
out=$build/test_box_flow
rm -rf "$out" && mkdir -p "$out"

# same NAME RANKS FILE END HALF [arguments]: to END at once, and to HALF and on
same() {
  name=$1 ranks=$2 file=$source/cases/box_flow/$3.yaml end=$4 half=$5
  shift 5
  flow="mpirun -n $ranks $build/bin/box_flow $file --quiet"
  $flow --out "$out/$name-whole" --set time.end="$end" "$@"
  $flow --out "$out/$name-half" --set time.end="$half" "$@"
  $flow --out "$out/$name-half" --set time.end="$end" --restart "$out/$name-half/checkpoint.h5" "$@"
  cmp "$out/$name-whole/history.csv" "$out/$name-half/history.csv"
}
same cavity 2 box_flow 4 2 --set "domain.cells=[24, 24, 1]" --set output.picture_every=0
same channel 2 poiseuille 1 0.5 --set "domain.cells=[32, 16, 1]"
same back_flow 2 back_flow 0.8 0.4 --set "domain.cells=[48, 24, 1]" --set output.picture_every=0.4
same duct 2 duct 0.4 0.2 --set "domain.cells=[4, 12, 10]" --set domain.stretch=1.2 \
  --set fluid.viscous=implicit_y
same implicit 2 back_flow 0.4 0.2 --set "domain.cells=[48, 24, 1]" --set fluid.viscous=implicit \
  --set fluid.viscosity=0.01 --set output.picture_every=0
same fixed_step 1 duct 0.4 0.2 --set "domain.cells=[4, 8, 8]" --set time.step=0.005

# Steady in the end: the forcing is what the four walls take, G = 4 stress/a. Named columns.
mpirun -n 2 "$build/bin/box_flow" "$source/cases/box_flow/duct.yaml" --out "$out/steady" --quiet \
  --set "domain.cells=[4, 12, 12]" --set time.end=4
awk -F, 'NR == 1 { for (q = 1; q <= NF; q++) at[$q] = q }
  { force = $at["forcing[L/T2]"]; divergence = $at["divergence[-]"]
    walls = $at["stress_y_lower_x[L2/T2]"] + $at["stress_y_upper_x[L2/T2]"] \
          + $at["stress_z_lower_x[L2/T2]"] + $at["stress_z_upper_x[L2/T2]"] }
  END { d = (force - walls) / force; if (force < 2.5 || d > 1e-9 || d < -1e-9 || divergence > 1e-12) {
          print "FAIL: forcing " force ", walls " walls ", divergence " divergence; exit 1 } }' \
  "$out/steady/history.csv"
awk -F, 'NR == 1 { for (q = 1; q <= NF; q++) at[$q] = q }
  NR > 1 { net = $at["flux_x_lower[L3/T]"] + $at["flux_x_upper[L3/T]"]
           if (net > 1e-13 || net < -1e-13) { print "FAIL: net flux " net; exit 1 } }' \
  "$out/back_flow-whole/history.csv"
