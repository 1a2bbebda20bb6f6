#!/bin/sh
# The memory that --check tells is what the run takes at its most, counted array by array; of a case
# that is built to be checked, and of one that is not (tests/robustness/check_big.sh has those).
# usage: memory.sh SOURCE BUILD
set -u
source=$1 build=$2
out=$build/test_memory
failed=0
rm -rf "$out" && mkdir -p "$out"

# as_told NAME RANKS PROGRAM FILE [arguments]
as_told() {
  name=$1 ranks=$2 program=$build/bin/$3 file=$source/$4
  shift 4
  # one rank without mpirun: its helpers would count, too
  start= && [ "$ranks" -eq 1 ] || start="mpirun -n $ranks"
  told=$($start "$program" "$file" --check "$@" 2> /dev/null |
    sed -n 's/.*about \([0-9.e+]*\) MiB for each of .*/\1/p' | tail -n 1)
  COUNT_MEMORY=$out/$name.count LD_PRELOAD=$build/lib/libcount_memory.so \
    $start "$program" "$file" --quiet --out "$out/$name" "$@" > "$out/$name.txt" 2>&1
  code=$?
  # A tenth less, where surfaces and pores have other shares than in a small set-up; a quarter more,
  # as the largest of pictures, checkpoints and first steps is added to all that lasts.
  if [ $code -eq 0 ] && awk -v told="${told:-0}" '{ most = $1 / 1048576; r = told / most
      printf "%.2f MiB, told %s: %.2f", most, told, r; exit !(r > 0.9 && r < 1.25) }' \
      "$out/$name.count" > "$out/$name.is"; then
    echo "ok   $name: $(cat "$out/$name.is")"
  else
    echo "FAIL $name: exit $code, $(cat "$out/$name.is")"
    tail -n 4 "$out/$name.txt"
    failed=1
  fi
}
picture="--set output.picture_every=0.01"
# shellcheck disable=SC2086 # words
{
as_told box 1 box_flow cases/box_flow/box_flow.yaml --set "domain.cells=[256, 256, 1]" \
  --set time.end=0.01 --set output.sample_every=0.01 $picture
as_told duct 2 box_flow cases/box_flow/duct.yaml --set "domain.cells=[64, 64, 64]" \
  --set time.end=0.01 --set output.sample_every=0.01
as_told channel 1 channel_turbulence cases/channel_turbulence/channel_turbulence.yaml \
  --set "domain.cells=[64, 64, 64]" --set time.spin_up=0 --set time.interval=0.01 \
  --set time.statistics=0.02
as_told porous 1 porous_breakup cases/porous_breakup/porous_breakup.yaml --set flow.steps=1 \
  --set deformation.steps=1 --set breakage.steps=1 --set output.picture_every=1
as_told plate 1 bending_plate cases/bending_plate/bending_plate.yaml --set time.end=0.001 \
  --set "physics.channel.cells=[720, 240]" --set physics.plate.particles_across=40 \
  --set time.step=1e-4
as_told branching 1 crack_branching cases/crack_branching/crack_branching.yaml --set time.end=1e-7 \
  --set time.step=2e-8 --set shape.particles=400
as_told cylinder 1 cylinder_drag cases/cylinder_drag/cylinder_drag.yaml --set until.latest=0.002 \
  --set until.interval=0.001 --set cylinder.cells_per_diameter=48
as_told tank 1 dam_break cases/dam_break/dam_break.yaml --set time.end=0.02
as_told tank_large 1 dam_break cases/dam_break/dam_break.yaml --set fluid.spacing=0.00125 \
  --set time.end=1e-4 --set output.sample_every=1e-4 --set output.picture_every=0 \
  --set "tank.size=[1.605, 0.6, 0]" --set "gauges=[{name: a, kind: depth, at: [1, 0, 0]}]"
}
exit $failed
