#!/bin/sh
# Water in a tank, stopped and gone on with, tells the same history to the last bit: on the same ranks
# every column; on another number of them the state, as gauges show it.
# usage: dam_break.sh SOURCE BUILD
set -eu
source=$1 build=$2
out=$build/test_dam_break
rm -rf "$out" && mkdir -p "$out"

# same NAME RANKS FILE END HALF [arguments]: to END at once, and to HALF and on
same() {
  name=$1 ranks=$2 file=$source/cases/dam_break/$3.yaml end=$4 half=$5
  shift 5
  run="mpirun -n $ranks $build/bin/dam_break $file --quiet"
  $run --out "$out/$name-whole" --set time.end="$end" "$@"
  $run --out "$out/$name-half" --set time.end="$half" "$@"
  $run --out "$out/$name-half" --set time.end="$end" --restart "$out/$name-half/checkpoint-last.h5" "$@"
  cmp "$out/$name-whole/history.csv" "$out/$name-half/history.csv"
}
same dam 2 dam_break 0.1 0.04 --set fluid.spacing=0.0321 --set tank.size='[1.605, 0.642, 0]' \
  --set output.picture_every=0
same sloshing 1 sloshing 0.2 0.1 --set fluid.spacing=0.075 --set tank.size='[1.725, 0.975, 0]' \
  --set output.picture_every=0
same gate 1 gate 0.01 0.005 --set output.picture_every=0

# Another number of ranks: the front and the height are the same numbers, at the same times.
mpirun -n 3 "$build/bin/dam_break" "$source/cases/dam_break/dam_break.yaml" --quiet --out "$out/three" \
  --set time.end=0.1 --set fluid.spacing=0.0321 --set tank.size='[1.605, 0.642, 0]' \
  --set output.picture_every=0
for run in dam-whole three; do cut -d, -f1,14,15 "$out/$run/history.csv" > "$out/$run.csv"; done
cmp "$out/dam-whole.csv" "$out/three.csv"
