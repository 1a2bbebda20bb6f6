#!/bin/sh
# A run that is stopped after every single step, wherever in an interval or a phase that is, and gone
# on with each time, tells the same history to the last bit. Its exit code is 75 until it is complete.
# usage: stopped.sh SOURCE BUILD
set -u
source=$1 build=$2
out=$build/test_stopped
rm -rf "$out" && mkdir -p "$out"

# same NAME CHECKPOINTS PROGRAM FILE [arguments]: at once, and in single steps. CHECKPOINTS: what a
# stopped run leaves; the newest counts.
same() {
  name=$1 program=$3 file=$source/$4 starts=1
  checkpoints=$2
  shift 4
  "$build/bin/$program" "$file" --quiet --out "$out/$name-whole" "$@" || exit 1
  "$build/bin/$program" "$file" --quiet --out "$out/$name" --stop-after 0 "$@" 2> "$out/$name.txt"
  code=$?
  while [ $code -eq 75 ] && [ $starts -lt 200 ]; do
    grep -q 'status: "unfinished"' "$out/$name/run.yaml" || { echo "FAIL $name: status"; exit 1; }
    # shellcheck disable=SC2086,SC2012 # words; names of our own
    last=$(cd "$out/$name" && ls -t $checkpoints 2> /dev/null | head -n 1)
    grep -q "go on with --restart .*$last" "$out/$name.txt" || { echo "FAIL $name: $last is not named"; exit 1; }
    "$build/bin/$program" "$file" --quiet --out "$out/$name" --restart "$out/$name/$last" \
      --stop-after 0s "$@" 2> "$out/$name.txt"
    code=$?
    starts=$((starts + 1))
  done
  [ $code -eq 0 ] || { echo "FAIL $name: exit code $code"; cat "$out/$name.txt"; exit 1; }
  [ $starts -ge 4 ] || { echo "FAIL $name: only $starts starts, nothing was stopped on the way"; exit 1; }
  cmp "$out/$name-whole/history.csv" "$out/$name/history.csv" || exit 1
  echo "ok   $name: $starts starts"
}

same box checkpoint.h5 box_flow cases/box_flow/box_flow.yaml --set "domain.cells=[16, 16, 1]" \
  --set time.end=0.2 --set output.sample_every=0.1 --set fluid.viscosity=0.1
same channel checkpoint.h5 channel_turbulence cases/channel_turbulence/channel_turbulence.yaml \
  --set "domain.cells=[8, 8, 8]" --set time.spin_up=0.5 --set time.interval=0.25 --set time.statistics=0.5
same plate checkpoint-last.h5 bending_plate cases/bending_plate/bending_plate.yaml \
  --set "physics.channel.cells=[45, 15]" --set physics.plate.particles_across=5 \
  --set time.step=1.6e-3 --set time.end=0.0096 --set output.sample_every=4
same porous "checkpoint-flow.h5 checkpoint-deformation.h5 checkpoint-last.h5" porous_breakup \
  tests/support/porous_small.yaml --set flow.steps=3 --set deformation.steps=0 --set breakage.steps=3 \
  --set output.checkpoint_every=0 --set output.sample_every=2
