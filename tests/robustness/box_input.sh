#!/bin/sh
# What users of flow solvers stumble on is refused at the start, by key, value and remedy.
# usage: box_input.sh SOURCE BUILD
set -u
source=$1 build=$2
out=$build/test_box_input
program=$build/bin/box_flow
failed=0
rm -rf "$out" && mkdir -p "$out"
. "$source/tests/support/refused.sh"

channel=$source/cases/box_flow/poiseuille.yaml duct=$source/cases/box_flow/duct.yaml
cavity=$source/cases/box_flow/box_flow.yaml
# with NAME PATTERN FILE --set ...
with() {
  name=$1 pattern=$2 file=$3
  shift 3
  refused "$name" "$pattern" "$program" "$file" --quiet --out "$out/$name" "$@"
}
# edited NAME PATTERN FILE SED
edited() {
  sed "$4" "$3" > "$out/$1.yaml"
  with "$1" "$2" "$out/$1.yaml"
}

# Impossible values.
with negative_viscosity "fluid.viscosity.*-1" "$cavity" --set fluid.viscosity=-1
with no_viscosity "fluid.viscosity.*0" "$cavity" --set fluid.viscosity=0
with nan_viscosity "fluid.viscosity.*nan" "$cavity" --set fluid.viscosity=.nan
with infinite_velocity "velocity.*inf" "$cavity" --set "sides.y.upper.velocity=[.inf, 0, 0]"
with negative_length "domain.length.*-4" "$channel" --set "domain.length=[-4, 1, 1]"
with zero_cells "domain.cells.*0" "$channel" --set "domain.cells=[64, 0, 1]"
with one_cell "1 cell in x" "$channel" --set "domain.cells=[1, 32, 1]"
with negative_cfl "time.limit_share.*-0.5" "$channel" --set time.limit_share=-0.5
with large_cfl "time.limit_share.*1.5" "$channel" --set time.limit_share=1.5
with negative_end "time.end.*-1" "$channel" --set time.end=-1

# Names and keys.
edited missing_viscosity "fluid.viscosity" "$channel" '/viscosity/d'
edited missing_side "sides.x.upper.kind" "$channel" '/upper: {kind: outflow}/d'
edited unknown_key "viscocity.*did you mean.*viscosity" "$channel" 's/viscosity:/viscocity:/'
edited unknown_kind "outflw.*did you mean.*outflow" "$channel" 's/kind: outflow/kind: outflw/'
with unknown_profile "parabolic.*poiseuille" "$channel" --set sides.x.lower.profile=parabolic
with unknown_forcing "flowrate.*did you mean.*flow_rate" "$duct" --set forcing.kind=flowrate

# Contradictions.
with half_periodic "sides.x.*lower is periodic and upper is outflow" "$channel" \
  --set sides.x.lower="{kind: periodic}"
with z_in_2d "sides.z is given" "$duct" --set "domain.cells=[4, 32, 1]"
with no_z_in_3d "sides.z is missing" "$channel" --set "domain.cells=[64, 32, 8]"
with z_velocity_in_2d "velocity.*along z" "$cavity" --set "sides.y.upper.velocity=[1, 0, 1]"
with blowing_wall "x lower side: a wall moves tangentially" "$cavity" \
  --set "sides.x.lower.velocity=[1, 0, 0]"
with moving_outflow "sides.x.upper.velocity.*outflow" "$channel" \
  --set "sides.x.upper.velocity=[1, 0, 0]"
with two_velocities "sides.x.lower.velocity.*poiseuille" "$channel" \
  --set "sides.x.lower.velocity=[1, 0, 0]"
with no_bulk_velocity "sides.x.lower: bulk_velocity is missing" "$channel" \
  --set sides.x.lower="{kind: inflow, profile: poiseuille}"
with bulk_velocity_of_uniform "bulk_velocity is given with the profile uniform" "$channel" \
  --set sides.x.lower.profile=uniform
with profile_of_wall "sides.y.lower: profile and bulk_velocity belong to an inflow" "$channel" \
  --set sides.y.lower.profile=poiseuille
with no_section "needs walls at rest" "$channel" --set sides.y.lower.kind=free_slip \
  --set sides.y.upper.kind=free_slip
with forced_inflow "forcing is gradient, but sides.x is not periodic" "$channel" \
  --set "forcing={kind: gradient, value: 1}"
with two_steps "time.step is 0.001 and time.limit_share is 0.5" "$channel" --set time.step=0.001 \
  --set time.limit_share=0.5
with odd_samples "time.end is 10, no whole number of output.sample_every, 0.3" "$channel" \
  --set output.sample_every=0.3

with two_grids "domain.stretch is 1 and domain.faces is .*faces.txt" "$channel" \
  --set domain.stretch=1 --set domain.faces=faces.txt
echo "0 0.5 0.9 1.1" > "$out/faces.txt"
with faces_beyond "faces.txt" "$channel" --set "domain.cells=[64, 3, 1]" \
  --set domain.faces="$out/faces.txt"

# What enters has to leave.
with no_outflow "more volume enters than leaves; add an outflow" "$channel" \
  --set sides.x.upper.kind=wall
with no_inflow "outflow but no inflow" "$channel" --set sides.x.lower="{kind: wall}"
with wrong_way "sides.x.lower: nothing comes in.*bulk_velocity is -1.*positive" "$channel" \
  --set sides.x.lower.bulk_velocity=-1
with wrong_way_upper "sides.x.upper: nothing comes in.*bulk_velocity is 2.*negative" "$channel" \
  --set sides.x.upper="{kind: inflow, profile: poiseuille, bulk_velocity: 2}"
with no_stream "sides.x.lower: nothing comes in.*velocity is 0" "$cavity" \
  --set sides.x.lower.kind=inflow
with unequal "5 more volume enters than leaves" "$channel" \
  --set sides.x.upper="{kind: inflow, profile: poiseuille, bulk_velocity: -2}" \
  --set sides.x.lower.bulk_velocity=3

# Numbers that cannot be meant.
with tiny_step "time.step = 1e-300: too small" "$cavity" --set time.step=1e-300
with endless "1e\\+30 times time.step.*more than the 1e\\+12 that anybody can wait for" "$cavity" \
  --set time.step=1e-30 --set time.end=1 --set output.sample_every=1
with tiny_interval "more than the 1e\\+12" "$cavity" --set output.sample_every=1e-40
with too_many_cells "domain.cells.0 = 3000000000: too large; in size at most 2147483647" "$cavity" \
  --set "domain.cells=[3000000000, 16, 1]"
with flat_cells "times as long in x as in y .*take more cells in x" "$cavity" --check \
  --set "domain.length=[1e9, 1, 1]"
with thick "time.end = 60 takes .* steps .*fluid.viscosity, is too large" "$cavity" --check \
  --set fluid.viscosity=1e45
with thin "cell Reynolds number is .*rounding hides the viscosity" "$cavity" --check \
  --set fluid.viscosity=1e-45
with fast_start "a speed of sides, forcing or start" "$cavity" --check \
  --set "start.velocity=[1e45, 0, 0]"
with far_too_fast "a speed of sides.* is too large for the cells" "$cavity" \
  --set "domain.cells=[16, 16, 1]" --set time.end=2 --set "sides.y.upper.velocity=[1e22, 0, 0]"
with long_path "has [0-9]+ bytes, 186 at most" "$cavity" --out "$out/$(printf 'a%.0s' $(seq 230))"

# Steps that are too long, from the start and on the way.
with too_long "time.step = 0.1 is over the limit at rest, with the speed of walls and inflows" \
  "$channel" --set time.step=0.1
with grows_too_fast "is over the limit" "$cavity" --set "domain.cells=[16, 16, 1]" \
  --set fluid.viscosity=0.01 --set "sides.y.upper.velocity=[60, 0, 0]" --set time.step=0.01 \
  --set output.sample_every=0.1 --set time.end=2 --set output.picture_every=0
refused too_many_ranks "ranks" mpirun -n 4 "$program" "$channel" --out "$out/ranks" --quiet \
  --set "domain.cells=[64, 2, 1]"

# Restarts that do not fit.
"$program" "$channel" --out "$out/good" --quiet --set time.end=0.5 || { echo "FAIL good"; exit 1; }
good=$out/good/checkpoint.h5
with no_restart "absent.h5" "$channel" --restart "$out/absent.h5"
with other_grid "checkpoint.h5" "$channel" --restart "$good" --set "domain.cells=[32, 32, 1]"
with other_samples "output.sample_every is 0.25, was 0.5" "$channel" --restart "$good" \
  --set output.sample_every=0.25
exit $failed
