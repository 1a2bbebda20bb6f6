#!/bin/sh
# Bad input gets one clear line that says what, where and what would be right; exit code not 0.
# usage: bad_input.sh SOURCE BUILD
set -u
source=$1 build=$2
case=$source/tests/support/porous_small.yaml
out=$build/test_bad_input
program=$build/bin/porous_breakup
failed=0
rm -rf "$out" && mkdir -p "$out"

. "$source/tests/support/refused.sh"
run() { "$program" "$@" --quiet; }
with() { name=$1; pattern=$2; shift 2; refused "$name" "$pattern" run "$case" --out "$out/$name" "$@"; }

sed '/viscosity/d' "$case" > "$out/missing.yaml"
sed 's/viscosity/viscocity/' "$case" > "$out/misspelt.yaml"
sed 's/viscosity: .*/viscosity: thick/' "$case" > "$out/mistyped.yaml"
sed 's/cells: .*/cells: [32, 16/' "$case" > "$out/broken.yaml"
refused no_file "absent.yaml" run "$out/absent.yaml"
refused missing "fluid.viscosity" run "$out/missing.yaml" --out "$out/m1"
refused misspelt "viscocity.*did you mean.*viscosity" run "$out/misspelt.yaml" --out "$out/m2"
refused mistyped "fluid.viscosity.*thick" run "$out/mistyped.yaml" --out "$out/m3"
refused broken "broken.yaml:[0-9]+" run "$out/broken.yaml" --out "$out/m4"
refused no_argument "CASE.yaml" run
refused unknown_option "--sett" run "$case" --sett a=b
with negative "fluid.viscosity.*-1" --set fluid.viscosity=-1
with unknown_key "solid.youngs_modulus.*did you mean.*young_modulus" --set solid.youngs_modulus=1
with word "solid.integrator.*euler" --set solid.integrator=euler
with not_cubes "cubes" --set "domain.cells=[32, 16, 20]"
with beyond_outflow "medium.length.*outflow" --set medium.length=0.19
with pitch "pitch" --set medium.pitch=0.03
# Porosity 0.02: the pores do not join; porosity 1: nothing is left.
with closed_pores "radius_over_pitch = 0.168.*larger pores" --set medium.radius_over_pitch=0.168
with no_solid "radius_over_pitch = 0.9.*no particle" --set medium.radius_over_pitch=0.9
with too_large_step "flow.time_step = 0.5 s is over the fluid.s limit" --set flow.time_step=0.5
# Numbers that cannot be meant, each with what it would lead to and the limit; --check says so, too.
with no_stream "fluid.bulk_velocity = 1e-300: too small" --set fluid.bulk_velocity=1e-300
with no_stiffness "solid.young_modulus = 1e-300: too small" --set solid.young_modulus=1e-300
with too_soft "0.0001 of the stream's dynamic pressure" --set solid.young_modulus=1e-3
with too_stiff "which rounding hides" --check --set solid.young_modulus=1e17 \
  --set solid.density=1e18 --set flow.time_step=1e-3 --set deformation.time_step=1e-3
with stiffer "1.13e.12 solid sub-steps of .*more than 1000000" --check --set solid.young_modulus=1e30
with long_memory "coupling.memory = 0.6: must be >= 0 and <= 0.5" --set coupling.memory=0.6
with retraction "coupling.retraction = 2.5: must be >= -2 and <= 2" --set coupling.retraction=2.5
with unsafe "solid sub-steps of .*solid_safety 1e-09.*more than 1000000" --check \
  --set coupling.solid_safety=1e-9
with settling "deformation.settling_rate = 1e\\+45 1/s is .*beyond which nothing moves" --check \
  --set deformation.settling_rate=1e45
with settled "flow.settled = 2: must be >= 0 and <= 1" --set flow.settled=2
with gravity "coupling.gravity: by .* falls .* cells in a step" --check \
  --set "coupling.gravity=[0, 1e45, 0]"
with density "density is 1e\\+45, 1e\\+42 times that of the fluid" --check --set solid.density=1e45
with no_restart "absent.h5" --restart "$out/absent.h5"
refused too_many_ranks "ranks" mpirun -n 8 "$program" "$case" --out "$out/ranks" --quiet \
  --set "domain.cells=[8, 4, 4]" --set medium.length=0.025 --set medium.pitch=0.1

# Checkpoints that are not what they should be. A good one first.
"$program" "$case" --out "$out/good" --quiet --set flow.steps=2 --set deformation.steps=0 \
  --set breakage.steps=0 || { echo "FAIL the good run"; exit 1; }
good=$out/good/checkpoint-flow.h5
head -c 20000 "$good" > "$out/truncated.h5"
cp "$case" "$out/foreign.h5"
cp "$good" "$out/flipped.h5"
size=$(wc -c < "$good")
printf '\377\377\377\377\377\377\377\377' |
  dd of="$out/flipped.h5" bs=1 seek=$((size / 2)) conv=notrunc 2> /dev/null
with truncated "truncated.h5" --restart "$out/truncated.h5"
with foreign "foreign.h5" --restart "$out/foreign.h5"
with flipped "flipped.h5" --restart "$out/flipped.h5"
with other_size "checkpoint-flow.h5" --restart "$good" --set "domain.cells=[64, 32, 32]"

# A folder that cannot be written, and one that holds another run: nothing in it changes.
touch "$out/a_file"
refused unwritable "a_file" run "$case" --out "$out/a_file/below"
before=$(ls -l --time-style=full-iso "$out/good" | cksum)
refused overwrite "good" run "$case" --out "$out/good"
after=$(ls -l --time-style=full-iso "$out/good" | cksum)
[ "$before" = "$after" ] || { echo "FAIL overwrite: files of the other run changed"; failed=1; }
exit $failed
