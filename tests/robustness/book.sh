#!/bin/sh
# A coupling that makes work from nothing is stopped with what, since when and a remedy, exit code 6
# and the last good state on disk; the same plate with a relaxed load is left alone. A plate in a
# stream, coarse, loaded by the reaction: half of it in every step, and a tenth. (All of it grows so fast that the
# fluid's limit of the step is met first, as below.)
# usage: book.sh SOURCE BUILD
set -u
case=$1/cases/bending_plate/bending_plate.yaml program=$2/bin/bending_plate out=$2/test_book
rm -rf "$out" && mkdir -p "$out"
coarse="--set physics.channel.cells=[90,30] --set physics.plate.particles_across=10
  --set time.step=1.6e-3 --set physics.coupling.load=reaction"
fail() { echo "FAIL: $1"; exit 1; }
run() {
  # shellcheck disable=SC2086 # a list of words
  "$program" "$case" --quiet $coarse "$@" > "$out/run.txt" 2>&1
  code=$?
  cat "$out/run.txt"
}

# The plate is let go at 0.1 s; 500 steps later it would be 0.9 s.
run --out "$out/bad" --set time.end=0.9 --set physics.coupling.load_relaxation=0.5
[ $code -eq 6 ] || fail "exit code $code of a coupling that makes work"
for words in "no physics since step" "from nowhere" "smaller load_relaxation" "checkpoint-good.h5"; do
  grep -q "$words" "$out/run.txt" || fail "the message does not say '$words'"
done
[ -s "$out/bad/checkpoint-good.h5" ] || fail "no good state is kept"
# Without virtual mass the fluid's own limit is met first; the message names the coupling as well.
run --out "$out/worse" --set time.end=0.9 --set physics.coupling.load=probes \
  --set physics.coupling.load_relaxation=1 --set physics.coupling.virtual_mass=0
[ $code -eq 5 ] || [ $code -eq 6 ] || fail "exit code $code without virtual mass"
grep -q "coupling of fluid and solid" "$out/run.txt" || fail "the coupling is not named"

run --out "$out/good" --set time.end=0.5 --set physics.coupling.load_relaxation=0.1
[ $code -eq 0 ] || fail "exit code $code of a coupling that holds"
grep -q "no physics" "$out/run.txt" && fail "a coupling that holds is called nonsense"
echo "the book of the coupling stops what makes work and nothing else"
