#!/bin/sh
# A restart is the same run. From every checkpoint the history goes on to the last bit, also where a
# damping ends; a finished run can be made longer; a case or program other than the one that wrote the
# checkpoint is refused with key and both values; what may change ends at the time that is asked for.
# usage: same_run.sh SOURCE BUILD
set -u
source=$1 build=$2
out=$build/test_same_run
failed=0
rm -rf "$out" && mkdir -p "$out"
. "$source/tests/support/refused.sh"

fail() { echo "FAIL $*"; failed=1; }
run() { "$@" --quiet > "$out/log" 2>&1 || { fail "$*"; cat "$out/log"; }; }
# tail_of WHOLE PART: the rows of PART are the last ones of WHOLE
tail_of() {
  rows=$(($(wc -l < "$out/$2/history.csv") - 1))
  [ $rows -gt 0 ] || fail "$2 has no rows"
  tail -n $rows "$out/$1/history.csv" > "$out/a"
  tail -n $rows "$out/$2/history.csv" > "$out/b"
  if cmp "$out/a" "$out/b"; then echo "ok   $2: $rows rows of $1"; else fail "$2 is not the end of $1"; fi
}
last_time() { tail -n 1 "$out/$1/history.csv" | cut -d, -f1; }

# A medium that is settled with damping, then breaks: every checkpoint.
porous() {
  name=$1
  shift
  run "$build/bin/porous_breakup" "$source/tests/support/porous_small.yaml" --out "$out/$name" \
    --set flow.steps=5 --set deformation.steps=40 --set output.checkpoint_every=10 "$@"
}
porous whole --set breakage.steps=36
porous base --set breakage.steps=25
porous settled --set breakage.steps=25 --restart "$out/base/checkpoint-deformation.h5"
tail_of base settled
porous held --set breakage.steps=25 --restart "$out/base/checkpoint-flow.h5"
tail_of base held
porous breaking --set breakage.steps=25 --restart "$out/base/checkpoint-last.h5"
tail_of base breaking
cp -r "$out/base" "$out/longer"
porous longer --set breakage.steps=36 --restart "$out/longer/checkpoint-breakage.h5"
cmp "$out/whole/history.csv" "$out/longer/history.csv" || fail "the longer run is another one"
grep -q '"breakage.steps is 36, was 25"' "$out/longer/run.yaml" || fail "the change is not listed"
# What ./run porous --full does: another fracture energy, from where nothing has broken.
porous weaker --set breakage.steps=2 --set solid.fracture_energy=0.012 \
  --restart "$out/base/checkpoint-deformation.h5"
grep -q '"solid.fracture_energy is 0.012, was' "$out/weaker/run.yaml" || fail "weaker is not listed"
mpirun -n 2 "$build/bin/porous_breakup" "$source/tests/support/porous_small.yaml" --quiet \
  --out "$out/complete" --set flow.steps=5 --set deformation.steps=40 --set breakage.steps=25 \
  --restart "$out/base/checkpoint-breakage.h5" || fail "a complete run"

# Another medium, material, kernel; a checkpoint behind the end; the same with --check.
other() { # other NAME PATTERN [arguments]
  name=$1 pattern=$2
  shift 2
  refused "$name" "$pattern" "$build/bin/porous_breakup" "$source/tests/support/porous_small.yaml" \
    --quiet --out "$out/refused" --restart "$out/base/checkpoint-deformation.h5" "$@"
}
steps="--set flow.steps=5 --set deformation.steps=40 --set breakage.steps=25"
# shellcheck disable=SC2086 # words
{
other medium "deformation.h5: medium.offset is \[0.5, 0.5, 0.25\], was \[0.5, 0.5, 0.5\]" $steps \
  --set "medium.offset=[0.5,0.5,0.25]"
other density "solid.density is 6000, was 3000" $steps --set solid.density=6000
other viscosity "fluid.viscosity is 0.01, was 0.001" $steps --set fluid.viscosity=1e-2 --check
other kernel "coupling.kernel is peskin4, was " $steps --set coupling.kernel=peskin4
other settling "deformation.settling_rate is 10, was 1000" $steps --set deformation.settling_rate=10
refused behind "checkpoint-last.h5: it is at 20 already, beyond breakage.steps = 19" \
  "$build/bin/porous_breakup" "$source/tests/support/porous_small.yaml" --quiet --out "$out/behind" \
  $steps --set breakage.steps=19 --restart "$out/base/checkpoint-last.h5"
}

# Another box, lid, stretching or viscosity; another step ends at the end.
box() {
  name=$1
  shift
  run "$build/bin/box_flow" "$source/cases/box_flow/box_flow.yaml" --out "$out/$name" \
    --set "domain.cells=[16,16,1]" --set output.sample_every=0.1 "$@"
}
box box --set time.end=0.2
box box_step --set time.end=0.4 --set time.step=0.01 --restart "$out/box/checkpoint.h5"
[ "$(last_time box_step)" = 0.4 ] || fail "another step ends at $(last_time box_step)"
for s in "domain.length=[2, 1, 1]" "sides.y.upper.velocity=[-1, 0, 0]" domain.stretch=2 \
  fluid.viscosity=1 output.sample_every=0.2 "start.velocity=[1, 0, 0]"; do
  value=$(echo "${s#*=}" | sed 's/[][]/\\&/g')
  refused "box-${s%%=*}" "checkpoint.h5: ${s%%=*} is $value, was " "$build/bin/box_flow" \
    "$source/cases/box_flow/box_flow.yaml" --quiet --out "$out/refused" --set "domain.cells=[16,16,1]" \
    --set output.sample_every=0.1 --set time.end=0.4 --set "$s" --restart "$out/box/checkpoint.h5"
done
refused box_back "it is at 0.2 already, beyond time.end = 0.1" "$build/bin/box_flow" \
  "$source/cases/box_flow/box_flow.yaml" --quiet --out "$out/behind" --set "domain.cells=[16,16,1]" \
  --set output.sample_every=0.1 --set time.end=0.1 --restart "$out/box/checkpoint.h5"

# Statistics of one Reynolds number.
channel="$build/bin/channel_turbulence $source/cases/channel_turbulence/channel_turbulence.yaml \
  --set domain.cells=[8,8,8] --set time.spin_up=0 --set time.interval=0.25"
run $channel --set time.statistics=0.5 --out "$out/channel"
run $channel --set time.statistics=0.75 --out "$out/channel_on" --restart "$out/channel/checkpoint.h5"
[ "$(last_time channel_on)" = 0.75 ] || fail "statistics end at $(last_time channel_on)"
# shellcheck disable=SC2086 # words
{
refused reynolds "fluid.reynolds is 100, was " $channel --quiet --out "$out/refused" \
  --set time.statistics=1 --set fluid.reynolds=100 --restart "$out/channel/checkpoint.h5"
refused stretch "domain.stretch is 2, was " $channel --quiet --out "$out/refused" \
  --set time.statistics=1 --set domain.stretch=2 --restart "$out/channel/checkpoint.h5"
}

# The plate counts steps: another step is refused; how often rows are written changes nothing.
plate="$build/bin/bending_plate $source/cases/bending_plate/bending_plate.yaml \
  --set physics.channel.cells=[45,15] --set physics.plate.particles_across=5 --set time.step=1.6e-3"
run $plate --set time.end=0.016 --set output.sample_every=5 --out "$out/plate"
run $plate --set time.end=0.0128 --set output.sample_every=2 --out "$out/plate_half"
run $plate --set time.end=0.016 --set output.sample_every=1 --out "$out/plate_on" \
  --restart "$out/plate_half/checkpoint-last.h5"
[ "$(tail -n 1 "$out/plate/history.csv")" = "$(tail -n 1 "$out/plate_on/history.csv")" ] ||
  fail "the end of the plate depends on how often rows are written"
# shellcheck disable=SC2086 # words
refused plate_step "time.step is 0.0008, was 0.0016" $plate --quiet --out "$out/refused" \
  --set time.step=0.8e-3 --set time.end=0.16 --restart "$out/plate_half/checkpoint-last.h5"

# Other programs' checkpoints.
refused box_of_porous "written by porous_breakup, this is box_flow" "$build/bin/box_flow" \
  "$source/cases/box_flow/box_flow.yaml" --quiet --out "$out/refused" \
  --restart "$out/base/checkpoint-deformation.h5"
# shellcheck disable=SC2086 # words
refused plate_of_porous "written by porous_breakup, this is bending_plate" $plate --quiet \
  --out "$out/refused" --set time.end=0.1 --restart "$out/base/checkpoint-deformation.h5"
refused drag_of_box "cylinder_drag writes no checkpoints" "$build/bin/cylinder_drag" \
  "$source/cases/cylinder_drag/cylinder_drag.yaml" --quiet --out "$out/refused" \
  --restart "$out/box/checkpoint.h5"
! [ -e "$out/refused" ] || fail "a refused run has touched its folder"
exit $failed
