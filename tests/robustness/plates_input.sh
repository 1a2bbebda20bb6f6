#!/bin/sh
# Notches, holes, loads and cracks that touch nothing of a plate, and steps that its material does not
# bear, are refused before a plate is built, by --check as by the run.
# usage: plates_input.sh SOURCE BUILD
set -u
source=$1 build=$2
out=$build/test_plates_input
failed=0
rm -rf "$out" && mkdir -p "$out"
. "$source/tests/support/refused.sh"

# with NAME PATTERN [arguments]: by the run and by --check
with() {
  name=$1 pattern=$2
  shift 2
  for check in "" --check; do
    # shellcheck disable=SC2086 # nothing, or a word
    refused "$name$check" "$pattern" "$build/bin/crack_branching" \
      "$source/cases/crack_branching/crack_branching.yaml" --quiet --out "$out/$name" $check \
      --set shape.particles=40 --set time.step=2e-7 --set time.end=4e-7 "$@"
  done
}
with notch "notches.0: .* cuts no bond .*0 to 0.1 and 0 to 0.04 m .millimetres" \
  --set "notches=[{from: [-1, 20], to: [50, 20]}]"
with notch_in_hole "notches.0: .* cuts no bond" --set "holes=[{centre: [0.05, 0.02], radius: 0.015}]" \
  --set "notches=[{from: [0.045, 0.02], to: [0.055, 0.02]}]"
with second_notch "notches.1: .* cuts no bond" \
  --set "notches=[{from: [-0.001, 0.02], to: [0.05, 0.02]}, {from: [0, 0.05], to: [0.1, 0.05]}]"
with hole "holes.0: .* takes no particle" --set "holes=[{centre: [50, 20], radius: 2}]"
with small_hole "holes.0: .*radius 1e-05 takes no particle" \
  --set "holes=[{centre: [0.05, 0.02], radius: 1e-5}]"
with load "loads.0: from 80 to 100 loads no particle of its edge, 0 to 0.1 m" \
  --set "loads=[{edge: top, kind: traction, value: [0, 12e6], from: 80, to: 100}]"
with backwards "loads.0.from = 0.08 has to be below loads.0.to = 0.02" \
  --set "loads=[{edge: top, kind: traction, value: [0, 12e6], from: 0.08, to: 0.02}]"
with pulled "loads.0.value: 1e\\+45 is .* times solid.young_modulus" \
  --set "loads=[{edge: top, kind: traction, value: [0, 1e45]}]"
with thrown "loads.0.value: 1e\\+09 is .* times the speed of sound" \
  --set "loads=[{edge: top, kind: velocity, value: [0, 1e9]}]"
with never "loads.0.rise = 1e\\+45 .*nothing would be loaded" \
  --set "loads=[{edge: top, kind: traction, value: [0, 12e6], rise: 1e45}]"
with rows "loads.0.rows = 1000: the plate has" \
  --set "loads=[{edge: top, kind: traction, value: [0, 12e6], rows: 1000}]"
with inert "time.end = .*passes .* of a particle until then" --set solid.density=1e45
with crack "follow.from.0. = 50 is outside the plate" --set "follow.from=[50, 20]"
with step "time.step = 1e-06 s is over the limit of the material" --set time.step=1e-6

# What touches the plate runs: a hole over its edge, a notch on it, a load on two columns.
"$build/bin/crack_branching" "$source/cases/crack_branching/crack_branching.yaml" --quiet \
  --out "$out/good" --set shape.particles=40 --set time.step=2e-7 --set time.end=4e-7 \
  --set "holes=[{centre: [0.101, 0.02], radius: 0.004}]" \
  --set "loads=[{edge: top, kind: traction, value: [0, 12e6], from: 0.09, to: 0.0975}]" ||
  { echo "FAIL: a good plate is refused"; failed=1; }
exit $failed
