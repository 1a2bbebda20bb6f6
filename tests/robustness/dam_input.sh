#!/bin/sh
# What users of a particle fluid stumble on is refused at the start, by value and remedy.
# usage: dam_input.sh SOURCE BUILD
set -u
source=$1 build=$2
out=$build/test_dam_input
program=$build/bin/dam_break
failed=0
rm -rf "$out" && mkdir -p "$out"
. "$source/tests/support/refused.sh"

case=$source/cases/dam_break/dam_break.yaml
# with NAME PATTERN --set ...
with() {
  name=$1 pattern=$2
  shift 2
  refused "$name" "$pattern" "$program" "$case" --quiet --check --out "$out/$name" "$@"
}

with slow_sound "sound_speed = 20: it must be at least 34.3" \
  --set fluid.sound_speed=20
with slow_for_weight "it must be at least 17.15" --set fluid.speed=0.1 --set fluid.sound_speed=15
with negative_spacing "fluid.spacing.*-1" --set fluid.spacing=-1
with odd_spacing "tank.size.0. is 1.605, no whole number of fluid.spacing, 0.016: take 1.6" \
  --set fluid.spacing=0.016
with outside "water.0: from 0 to 2 in direction 0, but the tank is from 0 to 1.605" \
  --set 'water=[{lower: [0, 0, 0], upper: [2, 0.3, 0]}]'
with turned "water.0: lower.1. is 0.3 and upper.1. is 0" \
  --set 'water=[{lower: [0, 0.3, 0], upper: [0.6, 0, 0]}]'
with no_water "water" --set 'water=[]'
with too_little "thinner than a particle: they are 0.015 apart" --set 'water=[{lower: [0, 0, 0], upper: [0.001, 0.001, 0]}]'
with huge_tank "is 3e.09 spacings of 0.015, more than 2" --set tank.size='[45000000, 0.6, 0]' \
  --set 'gauges=[{name: a, kind: depth, at: [1, 0, 0]}]'
with thin_wall "obstacles.0 is 0.03 thick in direction 0, thinner than 3 spacings" \
  --set 'obstacles=[{lower: [1, -0.06, 0], upper: [1.03, 0.1, 0]}]'
with odd_samples "time.end is 1.2, no whole number of output.sample_every, 0.07" \
  --set output.sample_every=0.07
with gauge_outside "gauges.0.at: 3 in direction 0 is not in the tank" \
  --set 'gauges=[{name: a, kind: depth, at: [3, 0, 0]}]'
with gauge_name "has a comma" --set 'gauges=[{name: "a,b", kind: depth, at: [1, 0, 0]}]'
with unknown_gauge "kind" --set 'gauges=[{name: a, kind: deepth, at: [1, 0, 0]}]'
with no_solid "gauges.0.kind: it tells how the solid moves, but there is none" \
  --set 'gauges=[{name: a, kind: aside, lower: [0, 0, 0], upper: [1, 0.1, 0]}]'
case=$source/cases/dam_break/gate.yaml
with coarse_solid "apart and the fluid's 0.002; the solid has to be as fine or finer by a whole" \
  --set solid.spacing=0.0015
with shaken_solid "motion: a tank that moves does not move the solid" \
  --set 'motion={amplitude: [0.01, 0, 0], period: 1}'
with solid_outside "solid.parts.0: from 0.3 to 0.9 in direction 0" \
  --set 'solid.parts=[{lower: [0.3, 0, 0], upper: [0.9, 0.1, 0]}]'
with stiff_solid "solid sub-steps, more than 1000000" --check --set solid.young=1e45
with heavy_solid "times as dense as the fluid" --check --set solid.density=1e45
with thick "phases.0.until.time = 0.4 takes .* steps of" --check --set fluid.viscosity=1e45
with no_young "solid.young" --set solid.young=-1
with soft_bonds "nu = 0.47, but bonds fix it to 1/4" --set solid.law=bond
case=$source/cases/dam_break/dam_break.yaml
with long_steps "time.step_share" --set time.step_share=3
with strong_diffusion "fluid.delta" --set fluid.delta=0.5
exit $failed
