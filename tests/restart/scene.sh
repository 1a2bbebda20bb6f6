#!/bin/sh
# A scene stopped and gone on with tells the same history to the last bit, and on other ranks the
# same to round-off: solids that break, several solids in contact, a body in a flow, a gate in a fluid of particles,
# rigid bodies beside others that bend and break.
# usage: scene.sh SOURCE BUILD
set -eu
source=$1 build=$2
out=$build/test_scene_restart
rm -rf "$out" && mkdir -p "$out"

# same NAME RANKS END HALF [arguments]: to END at once, and to HALF and on
same() {
  name=$1 ranks=$2 end=$3 half=$4
  shift 4
  scene="mpirun -n $ranks $build/bin/breakwater $source/scenes/$name/$name.yaml --quiet"
  $scene --out "$out/$name-whole" --set phases.0.until.time="$end" "$@"
  $scene --out "$out/$name-half" --set phases.0.until.time="$half" "$@"
  $scene --out "$out/$name-half" --set phases.0.until.time="$end" \
    --restart "$out/$name-half/checkpoint-last.h5" "$@"
  cmp "$out/$name-whole/history.csv" "$out/$name-half/history.csv"
}
# behind NAME END [arguments]: a checkpoint behind the end that is asked for is refused
behind() {
  name=$1 end=$2
  shift 2
  "$build/bin/breakwater" "$source/scenes/$name/$name.yaml" --quiet --out "$out/$name-half" "$@" \
    --set phases.0.until.time="$end" \
    --restart "$out/$name-half/checkpoint-last.h5" 2> "$out/behind.txt" && exit 1
  grep -q "already, beyond phases.until.time = $end" "$out/behind.txt" || { cat "$out/behind.txt"; exit 1; }
}
# On one rank: on several the books are summed in another order after a restart.
same kalthoff_winkler 1 30e-6 20e-6 --set bodies.plate.spacing=2e-3 --set output.picture_every=0 \
  --set output.sample_every=5e-6
same beam_under_load 1 2e-3 1e-3 --set bodies.beam.spacing=4e-3 --set output.sample_every=2e-4
behind beam_under_load 0.0005 --set bodies.beam.spacing=4e-3 --set output.sample_every=2e-4
same impact_on_plate 1 60e-6 40e-6 --set bodies.plate.spacing=2e-3 --set bodies.ball.spacing=2e-3 \
  --set output.picture_every=0 --set output.sample_every=5e-6
same flow_past_cylinder 2 2 1 --set "domain.cells=[64, 32, 1]" --set "domain.length=[8, 4, 0.125]" \
  --set output.picture_every=0

# shellcheck disable=SC2086 # words
crack="--set bodies.block.spacing=1e-2 --set loads.0.value=2e7 --set loads.0.ramp=0 --set output.picture_every=0"
same hydraulic_crack 1 6e-5 2e-5 $crack
same falling_sphere 2 0.1 0.05 --set "domain.cells=[25, 40, 25]" --set output.picture_every=0

gate="--set domain.cells=[100,75,1] --set bodies.gate.spacing=0.002 --set bodies.gate.held.0.layers=2 \
  --set bodies.gate.shape.0.box.to=[0.106,0.084] --set output.sample_every=1e-3 --set output.picture_every=0"
# shellcheck disable=SC2086 # words
same dam_break_on_a_gate 1 4e-3 2e-3 $gate

# Another number of ranks: sums are in another order, and nothing else differs.
mpirun -n 3 "$build/bin/breakwater" "$source/scenes/impact_on_plate/impact_on_plate.yaml" --quiet \
  --out "$out/three" --set phases.0.until.time=60e-6 --set bodies.plate.spacing=2e-3 \
  --set bodies.ball.spacing=2e-3 --set output.picture_every=0 --set output.sample_every=5e-6
mpirun -n 3 "$build/bin/breakwater" "$source/scenes/hydraulic_crack/hydraulic_crack.yaml" --quiet \
  --out "$out/three_crack" --set phases.0.until.time=6e-5 $crack
# One rank and three of many bodies, and three that go on from the checkpoint of one: alone, and in a flow.
# many NAME HALF
many() {
  several="$build/bin/breakwater $source/tests/support/$1.yaml --quiet"
  $several --out "$out/$1-1"
  mpirun -n 3 $several --out "$out/$1-3"
  $several --out "$out/$1-half" --set phases.0.until.time="$2"
  mpirun -n 3 $several --out "$out/$1-half" --restart "$out/$1-half/checkpoint-last.h5"
}
many several_bodies 30e-6
many bodies_in_a_flow 0.1
cat >"$out/compare.py" <<'END'
import csv, sys
a, b = (list(csv.reader(open(path))) for path in sys.argv[1:])
assert a[0] == b[0] and len(a) == len(b) >= 5
# a component that is nothing but rounding is measured by its vector
gauge = [name.split(".")[0].split("[")[0] for name in a[0]]
columns = list(zip(*([float(x or 0) for x in row] for row in a[1:])))
most = [max(abs(x) for x in column) for column in columns]
largest = [max(m for m, other in zip(most, gauge) if other == own) for own in gauge]
for one, other in zip(a[1:], b[1:]):
    for x, y, scale in zip(*([float(x or 0) for x in row] for row in (one, other)), largest):
        # 1e-16 of a sum of some thousand bonds, grown over some hundred steps
        assert abs(x - y) <= 1e-9 * scale, (one, other)
END
# A fluid of particles and a gate in it, on three ranks.
# shellcheck disable=SC2086 # words
mpirun -n 3 "$build/bin/breakwater" "$source/scenes/dam_break_on_a_gate/dam_break_on_a_gate.yaml" \
  --quiet --out "$out/gate-3" --set phases.0.until.time=4e-3 $gate
for pair in dam_break_on_a_gate-whole:gate-3 impact_on_plate-whole:three hydraulic_crack-whole:three_crack \
            several_bodies-1:several_bodies-3 several_bodies-1:several_bodies-half \
            bodies_in_a_flow-1:bodies_in_a_flow-3 bodies_in_a_flow-1:bodies_in_a_flow-half; do
  /usr/bin/python3 "$out/compare.py" "$out/${pair%:*}/history.csv" "$out/${pair#*:}/history.csv"
done
