#!/bin/sh
# Legal input runs, and the steps that a program chooses give the answer however they are asked for:
# walls that move over fluid at rest, thin cells, narrow gaps, whichever way the stream goes.
# usage: legal_steps.sh SOURCE BUILD
set -u
source=$1 build=$2
out=$build/test_legal_steps
failed=0
rm -rf "$out" && mkdir -p "$out"
cavity=$source/cases/box_flow/box_flow.yaml cylinder=$source/cases/cylinder_drag/cylinder_drag.yaml

# run NAME PROGRAM FILE --set ...: it ends well
run() {
  name=$1 program=$2 file=$3
  shift 3
  if ! "$build/bin/$program" "$file" --out "$out/$name" "$@" > "$out/$name.txt" 2>&1; then
    echo "FAIL $name: $(grep -m 1 'error:' "$out/$name.txt")"
    failed=1
  fi
}
# value NAME COLUMN [ROW]: of the last row of a history, or of this one
value() {
  awk -F, -v column="$2" -v row="${3:-0}" '
    NR == 1 { for (i = 1; i <= NF; i++) if (index($i, column) == 1) at = i }
    row == 0 || NR == row + 1 { last = $at }
    END { print last }' "$out/$1/history.csv"
}
# near WHAT MEASURED REFERENCE TOLERANCE (of the reference)
near() {
  if awk -v a="$2" -v b="$3" -v e="$4" 'BEGIN { exit !(a - b <= e * (b < 0 ? -b : b) &&
      b - a <= e * (b < 0 ? -b : b) && a != "") }'; then
    echo "ok   $1: $2, reference $3"
  else
    echo "FAIL $1: $2, reference $3 to $4"
    failed=1
  fi
}

# A lid that starts at once over fluid at rest, in a cavity of 32 x 32 cells: rows every 1 and every
# 0.02. A step of sqrt(3) 0.8 dx/U has an error in time of some (0.04)^2 of the changes within t = 1.
small="--set domain.cells=[32,32,1] --set time.end=1 --set fluid.viscosity=0.01"
for every in 1 0.02; do
  # shellcheck disable=SC2086
  run lid-$every box_flow "$cavity" $small --set fluid.viscous=implicit \
    --set output.sample_every=$every
done
near "energy, rows every 1 and 0.02" "$(value lid-1 kinetic_energy)" \
  "$(value lid-0.02 kinetic_energy)" 1e-3
near "stress of a side wall" "$(value lid-1 stress_x_lower)" "$(value lid-0.02 stress_x_lower)" 1e-3

# The steps that were announced are those that were made: the lid is as fast as it gets.
run cavity box_flow "$cavity" --set "domain.cells=[32, 32, 1]" --set time.end=10
announced=$(sed -n 's/.*: about \([0-9]*\) steps.*/\1/p' "$out/cavity.txt")
made=$(tr '\r' '\n' < "$out/cavity.txt" | sed -n 's/.*step \([0-9]*\) .*/\1/p' | tail -n 1)
near "steps announced and made" "$announced" "$made" 0.15

# A wall that moves over fluid at rest beside thin cells: after five viscous times a straight line.
cat > "$out/couette.yaml" << 'END'
domain: {length: [1, 1, 1], cells: [4, 32, 1]}
fluid: {viscosity: 1, viscous: implicit}
sides:
  x: {lower: {kind: periodic}, upper: {kind: periodic}}
  y: {lower: {kind: wall}, upper: {kind: wall, velocity: [1, 0, 0]}}
time: {end: 5}
output: {sample_every: 0.5}
END
for stretch in 0 3; do
  for viscous in implicit implicit_y; do
    name=couette-$stretch-$viscous
    run $name box_flow "$out/couette.yaml" --set domain.stretch=$stretch --set fluid.viscous=$viscous
    near "stress of the moving wall, $viscous, stretch $stretch" "$(value $name stress_y_upper_x)" \
      -1 1e-9
    near "mean velocity" "$(value $name bulk_velocity)" 0.5 1e-9
  done
done

# A vortex in a channel, and their mirror image: the same steps, the same flow. Chaos has no time to
# make more than 1e-10 of the round-off.
inflow="{kind: inflow, profile: poiseuille, bulk_velocity: "
for way in 1 -1; do
  case $way in
    1) lower="${inflow}1}" upper="{kind: outflow}" ;;
    *) lower="{kind: outflow}" upper="${inflow}-1}" ;;
  esac
  run channel$way box_flow "$source/cases/box_flow/poiseuille.yaml" --set "domain.cells=[24, 16, 1]" \
    --set time.end=2 --set output.sample_every=1 --set "sides.x.lower=$lower" \
    --set "sides.x.upper=$upper" \
    --set start="{velocity: [$way, 0, 0], vortices: [{centre: [2, 0.4], radius: 0.2, swirl: ${way}.5}]}"
done
near "energy, mirrored" "$(value channel1 kinetic_energy)" "$(value channel-1 kinetic_energy)" 1e-9
near "step, mirrored" "$(value channel1 'dt[')" "$(value channel-1 'dt[')" 1e-9

# The drag case: documented steps and blockages; the box of its balance ends at the walls.
quick="--set until.latest=1 --set cylinder.cells_per_diameter=8"
# shellcheck disable=SC2086
run fast cylinder_drag "$cylinder" $quick --set cylinder.dt_fraction=0.9 --set cylinder.reynolds=200
for blockage in 0.6 0.8; do
  # shellcheck disable=SC2086
  run blocked-$blockage cylinder_drag "$cylinder" $quick --set cylinder.blockage=$blockage
  near "drag by markers and by momentum, blockage $blockage" \
    "$(value blocked-$blockage Cd_control_volume)" "$(value blocked-$blockage Cd_reaction)" 1e-10
done
grep -q "warning.*gaps between cylinder and walls" "$out/blocked-0.8.txt" ||
  { echo "FAIL narrow gaps are not told"; failed=1; }

# A surface that leaks is told on the screen, in the history and in run.yaml.
run leak porous_breakup "$source/tests/support/porous_small.yaml" --quiet --set coupling.memory=0 \
  --set coupling.iterations=1 --set flow.steps=110 --set deformation.steps=0 \
  --set breakage.steps=0 --set output.sample_every=2 --set output.checkpoint_every=0
for file in "$out/leak.txt" "$out/leak/run.yaml"; do
  grep -q "% of it passes through the surface" "$file" ||
    { echo "FAIL the leak is not told in $file"; failed=1; }
done
awk -v leak="$(value leak leak_over_flux_past)" 'BEGIN { exit !(leak > 0.02) }' ||
  { echo "FAIL the history has no leak"; failed=1; }
exit $failed
