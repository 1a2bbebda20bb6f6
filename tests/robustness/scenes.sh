#!/bin/sh
# Every template of scenes/ passes --check, runs in its short form (the line "# short:" of the file),
# and leaves numbers; what cannot be run is refused with key, value and remedy, and nothing is
# written; the JSON schema takes every template and refuses what the reader refuses.
# usage: scenes.sh SOURCE BUILD
set -eu
source=$1 build=$2
out=$build/test_scenes
rm -rf "$out" && mkdir -p "$out"
bad=0
complain() { echo "FAIL: $*"; bad=1; }

# ---- templates ----------------------------------------------------------------------------------
for file in "$source"/scenes/*/*.yaml; do
  name=$(basename "$file" .yaml)
  [ -f "$source/scenes/$name/README.md" ] || complain "$name has no README.md"
  short=$(sed -n 's/^# short: //p' "$file")
  [ -n "$short" ] || complain "$name has no line '# short:'"
  "$build/bin/breakwater" "$file" --check >"$out/check" 2>&1 ||
    complain "$name --check: $(tail -1 "$out/check")"
  # shellcheck disable=SC2046,SC2086 # a list of words without blanks
  set -- $(printf -- '--set %s ' $short)
  "$build/bin/breakwater" "$file" --out "$out/$name" "$@" >"$out/log" 2>&1 ||
    complain "$name: $(tail -1 "$out/log")"
  [ "$(wc -l <"$out/$name/history.csv")" -ge 3 ] || complain "$name: history.csv has no rows"
  ls "$out/$name"/*.pvd >/dev/null || complain "$name: no pictures"
done

# ---- refusals -----------------------------------------------------------------------------------
# refused SCENE KEY=VALUE PIECE: of the message
refused() {
  code=0
  "$build/bin/breakwater" "$source/scenes/$1/$1.yaml" --out "$out/refused" --set "$2" \
    >"$out/log" 2>&1 || code=$?
  [ "$code" -eq 2 ] || complain "$1 --set $2: exit code $code"
  grep -qF -- "$3" "$out/log" || complain "$1 --set $2: not '$3' but: $(cat "$out/log")"
}
beam=beam_under_load flow=flow_past_cylinder
refused $beam bodies.beam.material=wood "bodies.beam.material = wood: there is no such material"
refused $flow "bodies.cylinder.shape={cylinder: {centre: [4, 2], radius: 60}}" "it is 120 long along x"
refused $flow output.picture_every=1e-20 "output.picture_every = 1e-20: 2e+21 times to the end"
refused $flow output.checkpoint_every=inf "output.checkpoint_every = inf: must be a time"
refused $flow gauges.wake.every=1e-9 "gauges.wake.every = 1e-09: 2e+10 times to the end"
refused $beam output.picture_every=1e-9 "output.picture_every = 1e-09"
refused $beam bodies.beam.spacing=1 "bodies.beam: "
refused three_point_bending "bodies.left.held={side: y_lower}" "bodies.left.held: a fixed or presc"
refused $beam "watch={load: {mean: time}}" "watch.load: there is no such component; there are: load.x, "
refused $beam bodies.beam.motion=rigid "a rigid one has rigid.held"
refused falling_sphere fluid.film_roughness=0.1 "fluid.film_roughness = 0.1: must be at most a cell"
refused falling_sphere fluid.film_limit=0.01 "films have a fluid.film_roughness"
refused falling_sphere fluid.film_flux=true "films (fluid.film_roughness) between bodies that deform"
refused plate_in_channel fluid.eddy=wale "an eddy viscosity in two dimensions"
refused dam_break fluid.film_flux=true "its particles fill the gaps"
refused flow_past_cylinder fluid.film_roughness=1e-5 "films brake bodies that are rigid or deform"
refused flap_behind_cylinder fluid.film_least=-1 "films have a fluid.film_roughness"
refused falling_sphere gravity="[0, -1e45, 0]" "gravity: by 1e+45, ball falls"
refused falling_sphere phases.0.damp=1e45 "phases.0.damp = 1e+45 over"
refused falling_sphere bodies.ball.rigid.held=up "rigid.held = up: must be of x, y, z"
refused falling_sphere bodies.ball.material=wood "there is no such material, and no mass"

refused $beam bodies.beam.motion=breakable "materials.polymer has no fracture_energy"
refused $beam materials.polymer.law=magic "law = magic: not in this build; this build has: bond"
refused $beam materials.polymer.plastic=j2 "it belongs to law: correspondence, this is bond"
refused $beam materials.polymer.law=correspondence "poisson_ratio is missing"
refused cantilever numerics.surface_correction=energy "surface_correction = energy: it is of bonds"
refused cantilever materials.beam.poisson_ratio=0.4999 "keeps its volume"
refused soil_column materials.sand.dilation_angle=40 "is above friction_angle = 30"
refused $beam loads.0.on=plate "loads.0.on = plate: there is no such body; there are: beam"
refused $beam "loads.0={on: beam, kind: traction, where: crack, value: [0, 1]}" "a pressure alone fills cracks"
refused $beam "loads.0={on: beam, kind: pressure, where: crack, value: 1}" "beam has none to begin with"
refused hydraulic_crack "loads.0.where.box={from: [0.2, 0.2], to: [0.25, 0.25]}" "no crack of block begins in it"
refused $beam loads.0.where=top "loads.0.where.side = top: must be one of x_lower"
refused $beam "loads.0.where={side: x_upper, box: {from: [1, 1], to: [2, 2]}}" "nothing of beam is in it"
refused $flow numerics.step_share=0.9 "numerics.step_share = 0.9: with bodies in a flow at most 0.8"
refused $flow numerics.viscous=implicit "watch.drag.box.x: there is no such component"
refused $beam bodies.beam.spacing=1e-9 "sites; check the unit"
refused $beam bodies.beam.spaceing=1e-3 "did you mean bodies.beam.spacing?"
refused $beam gauges.tip.of=tension "gauges.tip.of = tension: there is no such quantity"
refused $beam gauges.tip.of=pressure "the scene has no fluid"
refused $beam "phases=[{until: {}}]" "phases.0.until: it ends never"
refused $beam contact.friction=0.3 "contact.friction = 0.3: in this build rigid bodies rub"
refused $beam "bodies.beam.held={by: wall}" "there is no such body that is fixed"
refused $beam numerics.memory=0.6 "numerics.memory = 0.6: must be >= 0 and <= 0.5"
refused $beam "watch.top={mean: time}" "watch.top: there is no gauge top"
refused $beam "gauges.3={name: fail, body: beam, of: failure}" "bodies.beam is elastic; make it breakable"
refused $beam "gauges.3={name: fail, body: beam, of: failure, strength: {by: mises}}" "strength.yield is missing"
refused $beam "gauges.3={name: fail, body: beam, of: failure, strength: {by: mises, yield: 1, flaw: 1}}" "does not read it"
refused kalthoff_winkler "bodies.plate.cracks=[{from: [1, 1], to: [2, 1]}]" "it is outside the body"
refused impact_on_plate "bodies.ball.shape={sphere: {centre: [0.05, 0.012], radius: 0.006}}" "overlap"
refused $beam materials.polymer.poisson_ratio=0.4 "bodies.beam, materials.polymer: "
refused $beam phases.0.damp=1e45 "phases.0.damp = 1e+45 over materials.polymer.density is the rate"
refused $beam loads.0.value=1e45 "loads.0.value: 1e+45 moves particles of beam by"
refused $beam gravity="[1e45, 0]" "gravity: by 1e+45, beam falls"
refused $beam bodies.beam.velocity="[1e45, 0]" "bodies.beam.velocity: 1e+45 is"
refused $beam materials.polymer.density=1e45 "materials.polymer: sound, of"
refused $beam loads.0.ramp=1e45 "loads.0.ramp = 1e+45 is"
refused flap_behind_cylinder materials.rubber.density=1e45 "1e+42 times"
refused $flow fluid.sides.x.lower.ramp=1e45 "fluid.sides.x.lower.ramp = 1e+45 is"
refused $flow fluid.start="{velocity: [1e45, 0, 0]}" "phases.0.until.time = 20 takes"
refused $flow fluid.viscosity=1e45 "phases.0.until.time = 20 takes"
refused $flow fluid.viscosity=1e-45 "the cell Reynolds number is 1e+44"
refused rock_from_image "bodies.rock.shape.0.image.coarsen=[25, 1, 1]" "there are 24 voxels along x"
refused rock_from_image "bodies.rock.shape.0.image.to=[25, 1, 1]" "has the voxels 0 to 23 along x"
refused $flow fluid.model=particles "fluid.sides: not with fluid.model: particles"
refused $flow "domain.cells=[120, 61, 1]" "cells are cubes"
refused $flow fluid.sides.x.lower.mean=-1 "nothing comes in through this inflow"
refused $flow "bodies.cylinder.velocity=[1, 0]" "a fixed body has no velocity"
refused $flow "bodies.cylinder.shape={cylinder: {centre: [40, 2], radius: 0.5}}" "outside the domain"
refused $flow "bodies.cylinder.shape={box: {from: [4, -1], to: [4.5, 5]}}" "they block the channel"
refused $flow "numerics.step=1" "the fluid and its sides at the start bear at most"
# An opening of one cell is a way, and told as too narrow.
"$build/bin/breakwater" "$source/scenes/$flow/$flow.yaml" --check \
  --set "bodies.cylinder.shape={box: {from: [4, -1], to: [4.5, 3.9333]}}" >"$out/log" 2>&1 ||
  complain "a narrow opening: $(tail -1 "$out/log")"
grep -q "upper wall in y is a gap of about 1.0 cells" "$out/log" || complain "no word of a narrow gap"
# told SCENE KEY=VALUE PIECE: of a warning; without a piece: there is none.
told() {
  "$build/bin/breakwater" "$source/scenes/$1/$1.yaml" --check --set "$2" >"$out/log" 2>&1 ||
    complain "$1 --set $2: $(tail -1 "$out/log")"
  grep "warning: " "$out/log" >"$out/warned" || :
  if [ -z "$3" ]; then [ ! -s "$out/warned" ]; else grep -qF -- "$3" "$out/warned"; fi ||
    complain "$1 --set $2: not '$3' but: $(cat "$out/warned")"
}
told notched_plate_ordinary numerics.horizon_ratio=4 ""
told notched_plate_ordinary numerics.horizon_ratio=6 "law ordinary cost was measured from 2 to 4"
told notched_plate_ordinary materials.glass.poisson_ratio=-0.25 "poisson_ratio = -0.25: what cracks"
told rubber_block bodies.block.spacing=5e-3 "bent 0.82, 0.96, 0.99 times"
told rubber_block "gauges.2={name: load, body: block, of: force_on_support}" "are added up"
told rubber_block \
  "gauges.2={name: load, body: block, of: force_on_support, region: {from: [0, 0], to: [0.1, 2e-3]}}" ""
[ ! -e "$out/refused/history.csv" ] || complain "a refused scene has written"

# ---- what is watched, and a slice, once more from the rows that were written ---------------------
sed -e "s/^gauges:/&\\n  cut: {slice: {axis: z, at: 0}, of: velocity, every: 1}/" \
  "$source/scenes/$flow/$flow.yaml" >"$out/watched.yaml"
"$build/bin/breakwater" "$out/watched.yaml" --out "$out/watched" --set watch.0.frequency=true \
  --set domain.cells="[60, 30, 1]" --set domain.length="[8, 4, 0.133333333333333]" \
  --set phases.0.until.time=1 --set output.sample_every=0.1 \
  --set watch.0.from=0.25 --set watch.1.from=0.25 \
  >"$out/log" 2>&1 || complain "watched: $(tail -1 "$out/log")"
grep -q "^drag.box.x  *mean (midrange) .*frequency .*whole period" "$out/log" || complain "watch: no line"
[ "$(cat "$out"/watched/cut-*.csv | wc -l)" -eq 1801 ] || complain "a slice is not 60 x 30 cells"
/usr/bin/python3 - "$out/watched" <<'END' || bad=1
import csv, sys
rows = [row for row in csv.DictReader(open(sys.argv[1] + "/history.csv"))]
def series(name):
    key = next(k for k in rows[0] if k.split("[")[0] == name)
    return [(float(r["time[T]"]), float(r[key])) for r in rows if float(r["time[T]"]) >= 0.25]
said = {r["gauge"]: float(r["mean"]) for r in csv.DictReader(open(sys.argv[1] + "/watch.csv"))}
x = [v for _, v in series("drag.box.x")]
y = series("dp")
area = sum((b[0] - a[0]) * (a[1] + b[1]) / 2 for a, b in zip(y, y[1:]))
for name, right in (("drag.box.x", (max(x) + min(x)) / 2), ("dp", area / (y[-1][0] - y[0][0]))):
    if abs(said[name] - right) > 1e-7 * abs(right):
        raise SystemExit(f"watch.{name}: mean {said[name]} for {right}")
END

# ---- parts of an image, and blocks of its voxels, counted by another hand ------------------------
rock=$source/scenes/rock_from_image
counted() {
  "$build/bin/breakwater" "$rock/rock_from_image.yaml" --check "$@" 2>&1 |
    sed -n 's/^solid .*rock: \([0-9]*\) particles.*/\1/p'
}
image=bodies.rock.shape.0.image
upper=$(counted --set "$image.from=[12, 0, 0]" --set "$image.flip=[true, false, false]")
lower=$(counted --set "$image.from=[0, 0, 0]" --set "$image.to=[12, 24, 24]")
blocks=$(counted --set "domain.cells=[24, 12, 12]" --set "$image.coarsen=[2, 2, 2]")
/usr/bin/python3 - "$rock/rock.nrrd" "$upper $lower $blocks" <<'END' || bad=1
import sys
voxel = open(sys.argv[1], "rb").read().split(b"\n\n", 1)[1]
N = range(24)
solid = {(i, j, k): voxel[i + 24 * (j + 24 * k)] >= 100 for i in N for j in N for k in N}
half = sum(s for (i, _, _), s in solid.items() if i >= 12)
eight = [(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)]
blocks = sum(sum(solid[i + x, j + y, k + z] for x, y, z in eight) >= 4
             for i in N[::2] for j in N[::2] for k in N[::2])
right = f"{half} {sum(solid.values()) - half} {blocks}"
if sys.argv[2] != right:
    raise SystemExit(f"parts and blocks of the rock: {sys.argv[2]} particles for {right}")
END

# ---- help and schema ----------------------------------------------------------------------------
"$build/bin/breakwater" "$source/scenes/flap_behind_cylinder/flap_behind_cylinder.yaml" --check |
  grep -q "^coupling  *about [0-9]* sub-steps of the solid" || complain "--check: no sub-steps"
"$build/bin/breakwater" --help bodies.N.motion | grep -q breakable || complain "--help KEY"
[ "$("$build/bin/breakwater" --help bodies.flap.motion)" = \
  "$("$build/bin/breakwater" --help bodies.motion)" ] || complain "--help by name, without item"
"$build/bin/breakwater" --help bodies.flap.held.layers | grep -q "held.N.layers" ||
  complain "--help of an item of a named item"
"$build/bin/breakwater" --help bodiez.motion 2>/dev/null && complain "--help of a slip"
"$build/bin/breakwater" --schema >"$out/schema.json"
/usr/bin/python3 - "$out/schema.json" "$source"/scenes/*/*.yaml <<'END' || bad=1
import json, re, sys
import jsonschema, yaml
schema = json.load(open(sys.argv[1]))

class Numbers(yaml.SafeLoader):  # 1e-3 is a number and `on` a word, as they are to the reader
    yaml_implicit_resolvers = {first: [pair for pair in pairs if first in "tTfF" or "bool" not in pair[0]]
                               for first, pairs in yaml.SafeLoader.yaml_implicit_resolvers.items()}
Numbers.add_implicit_resolver("tag:yaml.org,2002:float",
    re.compile(r"^[-+]?(\d+(\.\d*)?|\.\d+)([eE][-+]?\d+)?$"), list("-+0123456789."))

# The schema itself is looked at once: that takes longer than all scenes.
kind = jsonschema.validators.validator_for(schema)
kind.check_schema(schema)
validator = kind(schema)
for path in sys.argv[2:]:
    scene = yaml.load(open(path), Numbers)
    for error in validator.iter_errors(scene):
        raise SystemExit(f"the schema refuses {path}: {error.json_path}: {error.message}")
    for change in ({"spaceing": 1}, {"accuracy": "best"}, {"bodies": {"a": {"motion": "flies"}}},
                   {"phases": {"until": {"steps": 0}}}, {"output": {"sample_every": -1}},
                   {"gravity": [0, 0, 0, 1]}):
        if validator.is_valid({**scene, **change}):
            raise SystemExit(f"the schema takes {change}")
END
exit $bad
