#!/usr/bin/python3
"""What accuracy costs: scenes with known answers, run with every value of a knob.

usage: trade.py [KNOB ... | --held-out] [--out FOLDER]     (./run trade [KNOB ...]; --list names the knobs)
Each scene of the table below has a reference that does not come from this code. Every value of a knob
gives an error against it and a cost in core-seconds (processor time on one rank: it hardly depends on
what else the machine does). Of the points of a scene those stand on the front that no other one beats
in both; the others are dominated, and are named. Writes FOLDER/trade.json and, for every knob,
FOLDER/KNOB.png; points that are there already, of the same commit, are not run again. --held-out runs eight
scenes that no preset was set by, and sees whether what --check promises holds for them.
"""
import argparse
import json
import math
import os
import re
import resource
import shutil
import subprocess
import sys
from pathlib import Path

import yaml

import estimate

CYLINDER = ["accuracy=standard", "watch=[]"]
# Scene: file, what is added to it, quantity and factor that make the number, reference, its source.
SCENES = {
    "cylinder": ("scenes/flow_past_cylinder/flow_past_cylinder.yaml", CYLINDER,
                 "drag.reaction.x", 30.0, 5.386,
                 "drag at Re 20, finite elements (data/confined_cylinder)"),
    "cylinder, probes": ("scenes/flow_past_cylinder/flow_past_cylinder.yaml", CYLINDER,
                         "drag.probe.x", 30.0, 5.386,
                         "drag at Re 20, finite elements (data/confined_cylinder)"),
    "array": ("bench/trade/array.yaml", [], "bulk", 1.0, 1 / 51.527,
              "flow through a square array of cylinders, a fifth solid, series (data/cylinder_array)"),
    "plate": ("bench/trade/plate.yaml", [], "tip.x", 1.0, 0.1737,
              "tip in a stream, finite elements (data/bending_plate)"),
    "raft": ("bench/trade/raft.yaml", [], "body.x - bulk", 1.0, 1 / 6 / 51.527,
             "free cylinders ahead of the fluid between them, series (data/cylinder_array)"),
    "cantilever": ("bench/trade/cantilever.yaml", [], "tip.y", -1.0, 0.02300,
                   "tip under a load, finite elements (data/clamped_beams)"),
    "swing": ("bench/trade/swing.yaml", [], "tip.y frequency", 1.0, 3.588,
              "lowest frequency, finite elements (data/clamped_beams)"),
    "dam break": ("scenes/dam_break/dam_break.yaml",
                  ["phases.0.until.time=0.4249", "gauges={water: {of: front}}", "watch=[]"],
                  "water", 1.0, 1.6,
                  "place of the front when it met the wall in the experiment (data/particle_fluid)"),
    "slosh": ("scenes/sloshing_tank/sloshing_tank.yaml",
              ["phases.0.until.time=3.16", "gauges={left: {of: depth, point: [0.05], width: 0.05}}", "watch=[]",
               "output.sample_every=0.04"],
              "left - 0.5", 1.0, 0.1914,
              "crest near the wall of a shaken tank, potential flow (data/particle_fluid)")}


# Scenes with answers from elsewhere that no preset and no promise was set by: what --check promises has to hold
# for them. The beams by data/clamped_beams/beams_fem.py with these lengths; the rod by u = sigma L/E.
HELD_OUT = {
    "cylinder, Re 25": ("scenes/flow_past_cylinder/flow_past_cylinder.yaml", ["watch=[]", "fluid.viscosity=0.04"],
                        "drag.reaction.x", 30.0, 4.788, "drag, finite elements (data/confined_cylinder)"),
    "cylinder near the inflow": ("scenes/flow_past_cylinder/flow_past_cylinder.yaml",
                                 ["watch=[]", "bodies.cylinder.shape.0.cylinder.centre=[2,2]"],
                                 "drag.reaction.x", 30.0, 5.646, "drag, finite elements (data/confined_cylinder)"),
    "array, 0.1": ("bench/trade/array.yaml", ["bodies.cylinder.shape.0.cylinder.radius=0.178412", "domain.cells=[50,50,1]",
                                              "domain.length=[1,1,0.02]"],
                   "bulk", 1.0, 1 / 24.832, "flow through a tenth of cylinders, series (data/cylinder_array)"),
    "array, 0.4": ("bench/trade/array.yaml", ["bodies.cylinder.shape.0.cylinder.radius=0.356825", "domain.cells=[60,60,1]",
                                              "domain.length=[1,1,0.0166666666666667]"],
                   "bulk", 1.0, 1 / 217.894, "flow through two fifths of cylinders, series (data/cylinder_array)"),
    "long cantilever": ("bench/trade/cantilever.yaml",
                        ["bodies.beam.shape.0.box.to=[2,0.2]", "loads.0.value=[0,-1e6]", "loads.0.ramp=0.06",
                         "phases.0.until.time=0.1", "phases.0.damp=5e5", "output.sample_every=0.02",
                         "gauges.0.region={from: [1.98, 0], to: [2, 0.2]}"],
                        "tip.y", -5.0, 0.1815, "tip under a load, finite elements (data/clamped_beams)"),
    "short swing": ("bench/trade/swing.yaml",
                    ["bodies.plate.spacing=1e-3", "bodies.plate.shape.0.box={from: [-0.004, 0], to: [0.08, 0.02]}",
                     "bodies.plate.held.0.box={from: [-0.004, 0], to: [0, 0.02]}", "phases.0.until.time=0.25",
                     "gauges.0.region={from: [0.078, 0], to: [0.08, 0.02]}", "output.sample_every=5e-4"],
                    "tip.y frequency", 1.0, 21.60, "lowest frequency, finite elements (data/clamped_beams)"),
    "rod": ("bench/trade/cantilever.yaml", ["loads.0.value=[2.2e7,0]", "phases.0.damp=4e7",
                                            "gauges.0.region={from: [0.98, 0.09], to: [1, 0.11]}"],
            "tip.x", 1.0, 0.99e-3, "end of a rod under a pull, closed form"),
    "column": ("bench/trade/column.yaml", [], "water.height", 1 / 0.1143, 0.67,
               "height of a column at tau = 1.46, measured (data/particle_fluid)")}


def each(key, values):
    """One --set of a key for each value."""
    return [(str(v), [f"{key}={v}"]) for v in values]


FLOWS, COUPLED, SOLIDS = ["cylinder", "plate", "raft"], ["plate", "raft"], ["cantilever", "swing"]
PARTICLES = ["dam break", "slosh"]
ALL = ["cylinder", "array", "plate", "raft", "cantilever", "swing", "dam break", "slosh"]
# Half of the spacing over the first third of a beam, at its clamp; from where to where.
CLAMP = {"cantilever": ("beam", [-0.04, 0], [0.34, 0.2]), "swing": ("plate", [-0.008, 0], [0.066, 0.02])}
# Knob: scenes, and (name of the value, its --set arguments); a number alone scales the spacing, SINGLE takes
# the program in single precision, FINE_CLAMP refines at the clamp.
SINGLE, FINE_CLAMP = "single precision", "fine clamp"
KNOBS = {
    "accuracy": (ALL, each("accuracy", ["quick", "standard", "careful"])),
    "grid": (["cylinder", "array", "plate", "raft", "cantilever", "swing"],
             [("2 h", 2.0), ("h", 1.0), ("h/2", 0.5)]),
    "precision": (ALL, [("double", []), ("single", [SINGLE])]),
    "kernel": (["cylinder", "array", "plate", "raft"], each("numerics.kernel", ["hat2", "roma3", "peskin4"])),
    "forcing_iterations": (FLOWS, each("numerics.forcing_iterations", [1, 2, 3, 4])),
    "memory": (FLOWS, each("numerics.memory", [0, 0.1, 0.2, 0.4])),
    "retraction": (FLOWS, [("best", [])] + each("numerics.retraction", [0, 0.25, 0.5])),
    "step_share": (["cylinder", "plate", "raft", "swing", "cantilever"],
                   each("numerics.step_share", [0.8, 0.6, 0.4, 0.2])),
    "step_share of particles": (PARTICLES, each("numerics.step_share", [0.95, 0.8, 0.6, 0.3])),
    "viscous": (FLOWS, each("numerics.viscous", ["explicit", "implicit_y", "implicit"])),
    "probe_length": (["cylinder, probes", "plate", "raft"], each("numerics.probe_length", [1, 1.5, 2, 3])),
    "probe_profile": (["cylinder, probes", "plate", "raft"], each("numerics.probe_profile", ["linear", "quadratic"])),
    "marker_spacing": (COUPLED, each("numerics.marker_spacing", [0, 0.5, 1, 2])),
    "load": (COUPLED, each("numerics.load", ["probes", "reaction"])),
    "load_relaxation": (COUPLED, [("measured", [])] + each("numerics.load_relaxation", [0.003, 0.01, 0.03, 0.1, 0.3])),
    "virtual_mass": (COUPLED, each("numerics.virtual_mass", [0, 0.5, 1, 2])),
    "coupling_iterations": (COUPLED, each("numerics.coupling_iterations", [1, 5, 20])),
    "coupling_residual": (COUPLED, [(f"{r:g}", ["numerics.coupling_iterations=20", f"numerics.coupling_residual={r:g}"])
                                    for r in (1e-2, 1e-3, 1e-4, 1e-5)]),
    "solid_share": (COUPLED, each("numerics.solid_share", [0.9, 0.8, 0.5, 0.25])),
    "horizon_ratio": (SOLIDS + COUPLED, each("numerics.horizon_ratio", [2, 3, 4, 5])),
    "surface_correction": (SOLIDS + COUPLED,
                           each("numerics.surface_correction", ["none", "volume", "energy", "tensor"])),
    "volume_fraction": (SOLIDS, each("numerics.volume_fraction", ["none", "linear", "exact"])),
    "calibration": (SOLIDS, [(f"{c}, {s}", [f"numerics.calibration={c}", f"numerics.surface_correction={s}"])
                             for c in ("none", "lattice") for s in ("volume", "tensor")]),
    "levels": (SOLIDS, [("h", []), ("h, half at the clamp", [FINE_CLAMP]), ("h/2", 0.5)]),
    "family_reach": (SOLIDS, each("numerics.family_reach", ["half_cell", "horizon"])),
    "disorder": (SOLIDS, [("lattice", []),
                          ("cloud of 0.3", ["numerics.disorder=0.3",
                                            "numerics.surface_correction=volume"])]),
    "integrator": (["swing", "cantilever"], each("numerics.integrator", ["verlet", "rk3"])),
    "law": (SOLIDS, [(law, [f"materials.{m}.law={law}" for m in ("@",)])
                     for law in ("bond", "ordinary", "correspondence")]),
    "particle spacing": (["dam break"], [
        (f"{h:g} mm", ["domain.length=[1.6,0.9,1]", f"domain.cells=[{1600 / h:.0f},{900 / h:.0f},1]"])
        for h in (20.0, 12.5, 10.0)]),
    "particle spacing, slosh": (["slosh"], [
        (f"{h:g} mm", [f"domain.cells=[{1725 / h:.0f},{1000 / h:.0f},1]"]) for h in (25.0, 12.5)]),
    "sound_speed": (["dam break"], each("numerics.sound_speed", [35, 50, 70])),
    "artificial_viscosity": (PARTICLES, each("numerics.artificial_viscosity", [0, 0.01, 0.02, 0.05])),
    "wall_viscosity": (PARTICLES, each("numerics.wall_viscosity", [0, 0.05, 0.1, 0.2])),
    "density_diffusion": (PARTICLES, each("numerics.density_diffusion", [0.05, 0.1, 0.2])),
    "shifting": (PARTICLES, [("default", [])] + each("numerics.shifting", [0])),
    "iterations x relaxation": (COUPLED, [
        (f"{n}, {w}", [f"numerics.coupling_iterations={n}", f"numerics.load_relaxation={w}"])
        for n in (1, 5, 20) for w in (0.003, 0.03, 0.1, 0.3)]),
    "grid x horizon": (SOLIDS, [(f"{h} h, {m}", [h, f"numerics.horizon_ratio={m}"])
                                for h in (2.0, 1.0) for m in (2, 3, 4)])}


def settings(scene, value):
    """--set arguments of a value on a scene, and the factor of its spacing."""
    path, base, *_ = SCENES[scene]
    words = [value] if isinstance(value, float) else [w for w in value if w != SINGLE]
    factor = math.prod(w for w in words if isinstance(w, float))
    if FINE_CLAMP in words:
        body, lower, upper = CLAMP[scene]
        words[words.index(FINE_CLAMP)] = f"bodies.{body}.levels=[{{level: 1, from: {lower}, to: {upper}}}]"
    parsed = yaml.safe_load(Path(path).read_text())
    material = next(iter(parsed.get("materials") or {"": None}))
    sets = base + [w.replace("@", material) for w in words if not isinstance(w, float)]
    if factor != 1.0:
        sets += estimate.scaled(estimate.merged(parsed, base), factor)
    # The state-based laws keep surfaces whole by themselves, and take Poisson's ratio by name.
    if any(w.endswith(("law=ordinary", "law=correspondence")) for w in sets):
        sets += [f"materials.{material}.poisson_ratio=0.3333333", "numerics.surface_correction=none"]
    return sets, factor, estimate.one_cell_deep(parsed)


def single_precision():
    """The program in single precision, built where it is not yet."""
    for command in (["cmake", "--preset", "single"],
                    ["cmake", "--build", "build-single", "-j", "2", "--target", "breakwater"]):
        if subprocess.run(command, capture_output=True).returncode != 0:
            sys.exit(f"trade.py: precision: {' '.join(command)} failed; run it by hand to see why")
    return "build-single/bin/breakwater"


def number(values, quantity):
    """A quantity, or a difference of two, one of which may be a number: body.x - bulk, left - 0.5."""
    def one(name):
        return next((x for full, x in values.items() if full.partition("[")[0] == name), None)

    terms = [one(name) for name in quantity.split(" - ")]
    terms = [float(name) if x is None else x for name, x in zip(quantity.split(" - "), terms)]
    return terms[0] - sum(terms[1:])


def measure(scene, value, folder, program):
    """{error, cost, ...} of one run; one that fails is a point without an error."""
    path, _, quantity, scale, reference, _ = SCENES[scene]
    sets, factor, flat = settings(scene, value)
    if not isinstance(value, float) and SINGLE in value:
        program = single_precision()
    command = [program, path, "--out", str(folder), "--quiet"]
    for word in sets:
        command += ["--set", word]
    shutil.rmtree(folder, ignore_errors=True)
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run(command, capture_output=True, text=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    point = {"set": sets, "core_seconds": after.ru_utime - before.ru_utime}
    if done.returncode != 0:
        point["failed"] = (done.stderr or done.stdout).strip().splitlines()[-1]
        return point
    values = estimate.values_of(folder, factor if flat else 1.0)
    point["found"] = scale * number(values, quantity)
    point["error"] = point["found"] / reference - 1
    return point


def dominated(points):
    """{name: name of one that is no worse in both and better in one}; failed runs are left out."""
    good = {n: p for n, p in points.items() if "error" in p}
    beaten = {}
    for n, p in good.items():
        for m, q in good.items():
            # Two per cent of an error, and five of a cost, are taken for the same.
            worse = (abs(p["error"]) >= 0.98 * abs(q["error"])
                     and p["core_seconds"] >= 1.05 * q["core_seconds"])
            if n != m and worse:
                beaten[n] = m
    return beaten


def figure(knob, scenes, path):
    """Error against cost, one curve per scene; a panel of gnuplot."""
    blocks, parts = [], []
    for q, (scene, points) in enumerate(scenes.items()):
        good = [(p["core_seconds"], abs(p["error"]), n) for n, p in points.items() if "error" in p]
        if not good:
            continue
        blocks += [f"$d{q} << E"] + [f'{c} {max(e, 1e-6)} "{n}"' for c, e, n in good] + ["E"]
        parts += [f"$d{q} using 1:2 with linespoints lw 2 pt 7 lc {q + 1} title '{scene}'",
                  f"$d{q} using 1:2:3 with labels left offset 0.7,0.5 font ',9' tc lt {q + 1} notitle"]
    lines = blocks + ["set terminal pngcairo size 800,560 noenhanced font 'sans,11'",
                      f"set output '{path}'", "set logscale xy", "set grid lc rgb '#dddddd'",
                      "set offsets graph 0.05, graph 0.2, graph 0.1, graph 0.1",
                      f"set title '{knob}'", "set xlabel 'core-seconds'", "set ylabel 'error'",
                      "set format y '%.0e'", "set key outside top", "plot " + ", \\\n ".join(parts)]
    done = subprocess.run(["gnuplot"], input="\n".join(lines) + "\n", text=True, capture_output=True)
    if done.returncode != 0:
        sys.exit(f"trade.py: gnuplot made no figure of {knob}:\n{done.stderr}")


def tell(knob, scenes):
    print(f"\n{knob}")
    for scene, points in scenes.items():
        beaten = dominated(points)
        print(f"  {scene}: {SCENES[scene][5]}")
        for name, p in points.items():
            if "failed" in p:
                print(f"    {name:24} {'-':>9} {p['core_seconds']:9.2f} core-s   ended: {p['failed'][:90]}")
                continue
            word = f"dominated by {beaten[name]}" if name in beaten else "on the front"
            print(f"    {name:24} {100 * p['error']:+8.3f} % {p['core_seconds']:9.2f} core-s   {word}")


def held_out(out, program):
    """Does what --check promises hold for scenes that no promise was set by? Exit code 1 where it does not."""
    found, bad = {}, 0
    SCENES.update(HELD_OUT)
    for scene, (path, base, _, _, _, source) in HELD_OUT.items():
        sets = base + ["accuracy=standard"]
        command = [program, path, "--check"] + [word for s in sets for word in ("--set", s)]
        told = subprocess.run(command, capture_output=True, text=True, check=True).stdout
        promise = float(re.search(r"error measured: ([0-9.e-]+) %", told).group(1)) / 100
        coarser = "this scene is coarser" in told
        point = measure(scene, ["accuracy=standard"], out / "runs" / "run", program)
        holds = abs(point.get("error", math.inf)) <= promise
        bad += not holds and not coarser
        found[scene] = dict(point, promise=promise, coarser=coarser, holds=holds, source=source)
        print(f"{scene:26} promised {100 * promise:5.2f} %   error {100 * point.get('error', math.nan):+6.2f} %   "
              f"{point['core_seconds']:6.2f} core-s   {'holds' if holds else 'DOES NOT HOLD'}"
              f"{'; told to be coarser' if coarser else ''}", flush=True)
    (out / "held_out.json").write_text(json.dumps(found, indent=1) + "\n")
    return 1 if bad else 0


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("knobs", nargs="*", metavar="KNOB")
    parser.add_argument("--out", default="build/trade")
    parser.add_argument("--program", default="build/bin/breakwater")
    parser.add_argument("--list", action="store_true")
    parser.add_argument("--held-out", action="store_true")
    args = parser.parse_args()
    if args.list:
        for knob, (scenes, values) in KNOBS.items():
            print(f"{knob:24} {', '.join(n for n, _ in values)}   ({', '.join(scenes)})")
        return
    for knob in args.knobs:
        if knob not in KNOBS:
            sys.exit(f"trade.py: there is no knob {knob}; there are: {', '.join(KNOBS)}")
    out = Path(args.out)
    (out / "runs").mkdir(parents=True, exist_ok=True)
    os.environ.setdefault("OMPI_MCA_hwloc_base_binding_policy", "none")
    if args.held_out:
        sys.exit(held_out(out, args.program))
    commit = subprocess.run([args.program, "--version"], capture_output=True, text=True).stdout.strip()
    kept = json.loads((out / "trade.json").read_text()) if (out / "trade.json").is_file() else {}
    if kept.get("program") != commit:
        kept = {"program": commit, "points": {}}
    for knob in args.knobs or KNOBS:
        scenes, values = KNOBS[knob]
        found = kept["points"].setdefault(knob, {})
        for scene in scenes:
            points = found.setdefault(scene, {})
            for name, value in values:
                if name not in points:
                    points[name] = measure(scene, value, out / "runs" / "run", args.program)
                    (out / "trade.json").write_text(json.dumps(kept, indent=1))
        figure(knob, found, out / (knob.replace(" ", "_") + ".png"))
        tell(knob, found)
    print(f"\nwritten to {out}/trade.json")


if __name__ == "__main__":
    main()
