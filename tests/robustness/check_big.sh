#!/bin/sh
# --check of runs that no machine here could hold: it tells the memory of a rank and takes none of
# it. The address space is limited to what one field of the fluid alone would exceed.
# usage: check_big.sh SOURCE BUILD
set -u
source=$1 build=$2
out=$build/test_check_big
failed=0
rm -rf "$out" && mkdir -p "$out"

# big NAME MIB PROGRAM FILE [arguments]: the run would take more than MIB
big() {
  name=$1 least=$2 program=$3 file=$4
  shift 4
  # 3 GB of addresses: a field of 1024^3 cells has 8.
  (ulimit -v 3000000 && exec "$build/bin/$program" "$source/$file" --check --out "$out/$name" "$@") \
    > "$out/$name.txt" 2>&1
  code=$?
  told=$(sed -n 's/.*about \([0-9.e+]*\) MiB for each of .*/\1/p' "$out/$name.txt" | tail -n 1)
  if [ $code -eq 0 ] && awk "BEGIN { exit !(${told:-0} > $least && ${told:-0} < 1000 * $least) }"; then
    echo "ok   $name: $told MiB"
  else
    echo "FAIL $name: exit $code, memory '$told' MiB, expected more than $least"
    tail -n 4 "$out/$name.txt"
    failed=1
  fi
}
small="--set flow.time_step=1e-6 --set deformation.time_step=1e-6 --set breakage.time_step=1e-6"
# shellcheck disable=SC2086 # words
big porous 80000 porous_breakup cases/porous_breakup/s3.yaml $small \
  --set "domain.cells=[1536, 1024, 1024]" --set "domain.length=[0.15, 0.1, 0.1]"
big plate_in_stream 9000 bending_plate cases/bending_plate/bending_plate.yaml \
  --set "physics.channel.cells=[18000, 6000]" --set physics.plate.particles_across=1000 \
  --set time.step=1e-6
big branching 300000 crack_branching cases/crack_branching/crack_branching.yaml \
  --set shape.particles=60000 --set time.step=4e-10
big box 40000 box_flow cases/box_flow/duct.yaml --set "domain.cells=[1024, 1024, 1024]"
big channel 40000 channel_turbulence cases/channel_turbulence/channel_turbulence.yaml \
  --set "domain.cells=[1024, 1024, 1024]"
big cylinder 100000 cylinder_drag cases/cylinder_drag/cylinder_drag.yaml --set until.latest=1 \
  --set cylinder.cells_per_diameter=200 --set cylinder.blockage=0.02 --set cylinder.upstream=200 \
  --set cylinder.downstream=800
big tank 100000 dam_break cases/dam_break/dam_break.yaml --set fluid.spacing=0.000015 \
  --set "gauges=[{name: a, kind: depth, at: [1, 0, 0]}]"
# Scenes: a sphere of a million markers, a wall of particles, a flap.
big sphere 40000 breakwater scenes/falling_sphere/falling_sphere.yaml \
  --set "domain.cells=[1000, 1600, 1000]"
big flap 9000 breakwater scenes/flap_behind_cylinder/flap_behind_cylinder.yaml \
  --set "domain.cells=[50000, 8200, 1]" --set "domain.length=[2.5, 0.41, 5e-5]" \
  --set bodies.flap.spacing=5e-5 --set bodies.cylinder.spacing=5e-5
big ball 9000 breakwater scenes/impact_on_plate/impact_on_plate.yaml \
  --set bodies.ball.spacing=1e-6 --set bodies.plate.spacing=1e-6
exit $failed
