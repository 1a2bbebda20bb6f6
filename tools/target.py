#!/usr/bin/python3
"""Which setting that was measured reaches an error at the least cost?

usage: target.py FILE.yaml --target-error 2% [--set KEY=VALUE ...]   (./run scene FILE.yaml --target-error 2%)
Looks among the points that ./run trade has left (build/trade/trade.json, else docs/verification/trade) for
settings of scenes of the same kind: how fine the grid is, over what is thin, and `accuracy`. A setting
promises the largest error of the scenes of that kind, or of the next finer grid where that errs more: an
error that does not fall with the grid is no luck to count on. Of those that promise enough the cheapest is
taken. The --set arguments that bring the scene there go to standard output, all words to standard
error. Exit code 3 where nothing that was measured reaches it.
"""
import argparse
import json
import math
import re
import subprocess
import sys
from pathlib import Path

import yaml

import estimate

SOURCE = Path(__file__).resolve().parent.parent
# What --check says that was measured on scenes of a kind: the scenes of tools/trade.py, and how many cells
# or particles they have across what is thin (of particles: over the depth of the water), the most of them.
KINDS = {"drags of a cylinder at Re 20 and of an array in slow flow": (["cylinder", "array"], 15.0),
         "the tip of a plate bent by a stream": (["plate"], 8.0),
         "deflection and frequency of clamped beams": (["cantilever", "swing"], 20.0),
         "the front of a dam break of 20 particles' depth": (["dam break"], 20.0)}
# Values of knobs that make the grid finer: factor of the spacing.
GRIDS = {"grid": {"2 h": 2.0, "h": 1.0, "h/2": 0.5},
         "particle spacing": {"20 mm": 20 / 15, "12.5 mm": 12.5 / 15, "10 mm": 10 / 15}}


def measured(points, scenes):
    """[(name, factor, accuracy, error promised, core-seconds)] of settings that all these scenes have."""
    found = []

    def add(knob, value, factor, accuracy):
        here = [points.get(knob, {}).get(scene, {}).get(value, {}) for scene in scenes]
        if all("error" in p for p in here):
            found.append((f"{knob} {value}", factor, accuracy, max(abs(p["error"]) for p in here),
                          sum(p["core_seconds"] for p in here)))

    for knob, values in GRIDS.items():
        for value, factor in values.items():
            add(knob, value, factor, None)
    for value in ("quick", "standard", "careful"):
        add("accuracy", value, 1.0, value)
    # Finest first: what a finer grid of the scenes' own accuracy errs more, a coarser one promises, too.
    promised = []
    for name, factor, accuracy, error, cost in found:
        finer = [f for f in found if f[1] < 0.99 * factor]
        next_finer = max((f[1] for f in finer), default=None)
        error = max([error] + [f[3] for f in finer if f[1] == next_finer])
        promised.append((name, factor, accuracy, error, cost))
    return promised


def choose(promised, target):
    """The cheapest that promises enough; None."""
    enough = [p for p in promised if p[3] <= target]
    return min(enough, key=lambda p: p[4], default=None)


def fineness(told, scene, across):
    """Cells or particles across what is thin in this scene, by what --check says; `across` where it is the same."""
    for pattern in (r"coarser, ([0-9.e+]+) across", r"here ([0-9.e+]+)"):
        found = re.search(pattern, told)
        if found:
            return float(found[1])
    if (scene.get("fluid") or {}).get("model") != "particles":
        return across
    shapes = scene["fluid"].get("shape", [])
    boxes = [s["box"] for s in (shapes if isinstance(shapes, list) else [shapes]) if "box" in s]
    up = max(range(3), key=lambda d: abs((list(scene.get("gravity", [])) + [0, 0, 0])[d]))
    if not boxes:
        sys.exit("target.py: how deep the water is follows from fluid.shape boxes; this scene has none")
    depth = min(float(b["to"][up]) - float(b["from"][up]) for b in boxes)
    return depth * scene["domain"]["cells"][up] / float(scene["domain"]["length"][up])


def whole(scene, factor):
    """The factor of the spacing, or a little less, that leaves whole numbers of cells."""
    counts = [n for n in (scene.get("domain") or {}).get("cells", []) if n > 1]
    if not counts:
        return factor
    common = math.gcd(*counts)
    return common / math.ceil(common / factor - 1e-9)


def wanted(text):
    found = re.fullmatch(r"([0-9.]+(?:e[-+]?[0-9]+)?)\s*(%?)", text)
    value = float(found[1]) * (0.01 if found[2] else 1.0) if found else 0.0
    if not 0.0 < value < 1.0:
        sys.exit(f"target.py: --target-error {text}: must be a share or a percentage, as 0.02 or 2%")
    return value


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("file")
    parser.add_argument("--target-error", required=True)
    parser.add_argument("--program", default="build/bin/breakwater")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE")
    args, _ = parser.parse_known_args()
    target = wanted(args.target_error)
    command = [args.program, args.file, "--check", *(w for s in args.set for w in ("--set", s))]
    checked = subprocess.run(command, capture_output=True, text=True)
    if checked.returncode != 0:
        sys.exit(checked.stderr.strip() or f"target.py: --check ended with exit code {checked.returncode}")
    told = next(line for line in checked.stdout.splitlines() if line.startswith("accuracy: ") and "(" in line)
    kind = next((k for k in KINDS if k in told), None)
    if kind is None:
        print("target.py: no scene of this kind was measured, so that no setting is known to reach an error; "
              "./run scene FILE.yaml --estimate gives every number an error bar", file=sys.stderr)
        return 3
    scenes, across = KINDS[kind]
    kept = next(p for p in (Path("build/trade/trade.json"), SOURCE / "docs/verification/trade/trade.json")
                if p.is_file())
    promised = measured(json.loads(kept.read_text())["points"], scenes)
    print(f"measured on {kind}, {across:g} across what is thin or deep at h ({kept}):", file=sys.stderr)
    for name, _, _, error, cost in sorted(promised, key=lambda p: p[4]):
        print(f"  {name:24} promises {100 * error:6.2f} %   {cost:7.2f} core-s there", file=sys.stderr)
    taken = choose(promised, target)
    if taken is None:
        best = min(promised, key=lambda p: p[3])
        print(f"target.py: nothing that was measured reaches {100 * target:g} %; the best is {best[0]} with "
              f"{100 * best[3]:.2g} %. --estimate gives an error bar for your own scene", file=sys.stderr)
        return 3
    scene = estimate.merged(yaml.safe_load(Path(args.file).read_text()), args.set)
    factor = whole(scene, fineness(told, scene, across) * taken[1] / across)
    words = [f"accuracy={taken[2]}"] if taken[2] else []
    if abs(factor - 1.0) > 0.01:
        words += estimate.scaled(scene, factor)
        if (scene.get("fluid") or {}).get("model") == "particles":
            words = [w for w in words if not w.startswith("domain.length=")]  # their cells are as deep as given
        elif estimate.one_cell_deep(scene):
            print(f"the one cell in z goes with the others: forces, energies and flow rates are those of "
                  f"{factor:.4g} times the depth", file=sys.stderr)
    print(f"taken: {taken[0]}, the cheapest that promises {100 * target:g} %; for this scene "
          f"{' '.join(words) or 'as it stands'}", file=sys.stderr)
    print("\n".join(words))
    return 0


if __name__ == "__main__":
    sys.exit(main())
