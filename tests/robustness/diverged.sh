#!/bin/sh
# A run that blows up stops with the step, the place and the cause, exit code not 0, after writing
# the last good state, from which it can go on. Made to blow up honestly: plain explicit coupling
# of a solid as light as the fluid, without virtual mass: the added-mass instability.
# usage: diverged.sh SOURCE BUILD
set -u
case=$1/tests/support/porous_small.yaml program=$2/bin/porous_breakup out=$2/test_diverged
rm -rf "$out" && mkdir -p "$out"
light="--set solid.density=1000 --set coupling.load_relaxation=1 --set coupling.virtual_mass=0 --set deformation.steps=4000"
# shellcheck disable=SC2086 # a list of words
mpirun -n 2 "$program" "$case" --out "$out/run" --quiet $light --set output.keep_every=5 \
  --set output.checkpoint_every=0 > "$out/run.txt" 2>&1
code=$?
cat "$out/run.txt"
[ $code -eq 5 ] || [ $code -eq 6 ] || { echo "FAIL: exit code $code"; exit 1; }
grep -qE 'error: step [0-9]+ \(deformation\): .*checkpoint-good.h5' "$out/run.txt" ||
  { echo "FAIL: no step, cause and file"; exit 1; }
# With the relaxed load and virtual mass it goes on from there.
mpirun -n 1 "$program" "$case" --out "$out/again" --quiet --restart "$out/run/checkpoint-good.h5" \
  --set solid.density=1000 --set deformation.steps=200 --set deformation.time_step=2.0e-5 --set breakage.steps=0 || { echo "FAIL: cannot go on"; exit 1; }
