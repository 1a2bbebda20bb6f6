#!/usr/bin/python3
"""How far are the numbers of a scene from those of an infinitely fine grid?

usage: estimate.py FILE.yaml [--out FOLDER] [--grids N] [--ranks N] [--set KEY=VALUE ...]
Runs the scene on N grids (3, or 2), the coarsest first and the file's own last. Each is coarser than
the next by the same whole ratio of cells where there is one, else by nearly the same. The spacing of
bodies and a fixed step go with the cells. In two dimensions the depth of the one cell goes with them,
too: forces, energies and flow rates are told for the depth of the file. For the last value of every gauge, and for what `watch` asks,
it prints the value of the finest grid, the observed order of convergence, the value extrapolated to
spacing 0, and an error bar (grid convergence index: Celik et al., J. Fluids Eng. 130 (2008) 078001),
and writes them to FOLDER/estimate.csv.

Of the values f1, f2, f3 on spacings h1 < h2 < h3, with r21 = h2/h1, r32 = h3/h2, e21 = f2 - f1,
e32 = f3 - f2, the order p solves
  p ln r21 = ln|e32/e21| + ln((r21^p - s)/(r32^p - s)),   s = the sign of e32/e21,
the extrapolated value is f1 - e21/(r21^p - 1), the error bar 1.25 |e21|/(r21^p - 1). Where the values
turn back (s < 0), where the order lies outside 0.5 to 3, and with two grids, it is not known: the bar is
then three times that of the order expected, at least the range of the values, and a word says so.
"""
import argparse
import csv
import math
import subprocess
import sys
from pathlib import Path

import yaml

import history

LEAST, MOST = 0.5, 3.0      # orders that are believed
SAFE, UNSURE = 1.25, 3.0    # factors of safety, order known and not known (Roache 1994)
OF_DEPTH = ("M L/T2", "M L2/T2", "L3/T")  # units of what is proportional to the depth


def order_of(f, h):
    """(p, s) of three values f on three spacings h, finest first; p is None where there is none."""
    e21, e32 = f[1] - f[0], f[2] - f[1]
    if e21 == 0 or e32 == 0:
        return None, 0
    r21, r32, s = h[1] / h[0], h[2] / h[1], math.copysign(1.0, e32 / e21)
    p = abs(math.log(abs(e32 / e21))) / math.log(r21)
    for _ in range(200):
        try:
            q = math.log((r21 ** p - s) / (r32 ** p - s))
        except (ValueError, ZeroDivisionError, OverflowError):
            return None, s
        new = (math.log(abs(e32 / e21)) + q) / math.log(r21)
        if abs(new - p) < 1e-10:
            return new, s
        p = 0.5 * (p + new)
    return None, s


def judged(f, h, expected):
    """Order, extrapolated value, error bar and a word about them; f, h: two or three, finest first."""
    e21, r21, width = f[1] - f[0], h[1] / h[0], max(f) - min(f)
    if width <= 1e-12 * max(abs(x) for x in f):
        return None, f[0], width, "the same on all grids"
    p, s = order_of(f, h) if len(f) > 2 else (None, 1)
    if p is not None and s > 0 and LEAST <= p <= MOST:
        rest = e21 / (r21 ** p - 1)
        word = "" if abs(p - expected) <= 0.6 else f"order {expected:g} was expected"
        return p, f[0] - rest, SAFE * abs(rest), word
    bar = max(UNSURE * abs(e21) / (r21 ** expected - 1), width)
    if len(f) == 2:
        word = f"two grids: order {expected:g} is assumed"
    elif s < 0:
        word = "turns back with the grid: no order; refine further"
    else:
        word = "no order that is believed; refine further"
    return p if s > 0 else None, f[0], bar, word


def ratios(cells, grids):
    """Factors of the spacing, coarsest first, that leave whole numbers of cells in every direction."""
    wanted = [2.0, 1.0] if grids == 2 else [2.0, math.sqrt(2.0), 1.0]
    counts = [n for n in cells if n > 1]
    if not counts:
        return [2.0, 1.5, 1.0] if grids == 3 else wanted
    common = math.gcd(*counts)
    allowed = [common / k for k in range(max(1, common // 3), common + 1)]
    found = [min(allowed, key=lambda a, w=w: abs(math.log(a / w))) for w in wanted]
    if len(set(found)) < grids or min(a / b for a, b in zip(found, found[1:])) < 1.15:
        sys.exit(f"estimate.py: domain.cells = {list(cells)} have the common divisor {common}: no "
                 "coarser grids with whole numbers of cells; give cells with a common divisor of 4 or "
                 "more (100 and 40, not 101 and 40)")
    return found


def one_cell_deep(scene):
    """Is it a flow in two dimensions, whose cell is as deep as it is wide?"""
    cells = (scene.get("domain") or {}).get("cells", [])
    return len(cells) > 2 and cells[2] == 1


def scaled(scene, factor):
    """--set arguments that make the scene coarser by a factor."""
    words = []
    if "domain" in scene:
        cells = [n if n == 1 else round(n / factor) for n in scene["domain"]["cells"]]
        words.append(f"domain.cells={cells}".replace(" ", ""))
        if one_cell_deep(scene):
            length = list(scene["domain"]["length"])
            length[2] *= factor
            words.append(f"domain.length={length}".replace(" ", ""))
    bodies = scene.get("bodies") or {}
    if isinstance(bodies, list):
        bodies = {b["name"]: b for b in bodies}
    for name, body in bodies.items():
        if "spacing" in body:
            words.append(f"bodies.{name}.spacing={float(body['spacing']) * factor!r}")
    if "step" in (scene.get("numerics") or {}):
        words.append(f"numerics.step={float(scene['numerics']['step']) * factor!r}")
    if not words:
        sys.exit("estimate.py: the scene has neither domain.cells nor a body with a spacing: there is no "
                 "grid to make coarser")
    return words


def expected_order(scene):
    """2 of a fluid alone; 1 where a body's surface is met by cells or particles."""
    return 1.0 if scene.get("bodies") else 2.0


def merged(scene, sets):
    """The scene with --set KEY.PATH=VALUE applied, as far as its grid is concerned."""
    for word in sets:
        path, _, text = word.partition("=")
        *parents, last = path.split(".")
        here = scene
        for key in parents:
            here = here[int(key)] if isinstance(here, list) and key.isdigit() else here.setdefault(key, {})
        if isinstance(here, list):
            here[int(last)] = yaml.safe_load(text)
        else:
            here[last] = yaml.safe_load(text)
    return scene


def values_of(folder, depth):
    """{name: value}: the last row of history.csv, and watch.csv where there is one; what is proportional
    to the depth is divided by `depth`."""
    head, rows = history.read(folder / "history.csv")
    if not rows:
        sys.exit(f"estimate.py: {folder}/history.csv has no row: the run wrote no gauge")
    per = {}
    for name in head[1:]:
        own, _, unit = name.partition("[")
        per[own] = depth if unit.rstrip("]") in OF_DEPTH else 1.0
    found = {name: x / per[name.partition("[")[0]] for name, x in zip(head[1:], rows[-1][1:])}
    watch = folder / "watch.csv"
    if watch.is_file():
        with open(watch, newline="") as file:
            for row in csv.DictReader(file):
                for key in ("mean", "amplitude", "frequency[1/T]"):
                    part = 1.0 if key.startswith("frequency") else per[row["gauge"]]
                    found[f"{row['gauge']} {key}"] = float(row[key]) / part
    return {name: x for name, x in found.items() if math.isfinite(x)}


def run(args, sets, folder, depth):
    command = ["mpirun", "-np", str(args.ranks), args.program, args.file, "--out", str(folder), "--quiet"]
    for word in sets:
        command += ["--set", word]
    code = subprocess.run(command).returncode
    if code != 0:
        sys.exit(f"estimate.py: the run with {' '.join(sets)} ended with exit code {code}; nothing is "
                 "estimated")
    return values_of(folder, depth)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("file")
    parser.add_argument("--out", default="out/estimate")
    parser.add_argument("--grids", type=int, choices=(2, 3), default=3)
    parser.add_argument("--ranks", type=int, default=1)
    parser.add_argument("--program", default="build/bin/breakwater")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE")
    args = parser.parse_args()
    scene = merged(yaml.safe_load(Path(args.file).read_text()), args.set)
    factors = ratios((scene.get("domain") or {}).get("cells", []), args.grids)
    out = Path(args.out)
    if out.exists():
        sys.exit(f"estimate.py: {out} is there already: remove it, or name another folder by --out")
    found = []
    for number, factor in enumerate(factors):
        sets = args.set + (scaled(scene, factor) if factor != 1.0 else [])
        print(f"grid {number + 1} of {len(factors)}: spacing times {factor:.4g}", flush=True)
        depth = factor if one_cell_deep(scene) else 1.0
        found.append(run(args, sets, out / f"grid-{number + 1}", depth))
    expected = expected_order(scene)
    h, found = factors[::-1], found[::-1]
    rows = []
    for name in found[0]:
        if all(name in grid for grid in found):
            f = [grid[name] for grid in found]
            rows.append((name, f, *judged(f, h, expected)))
    print(f"{'quantity':34} {'finest grid':>13} {'order':>6} {'extrapolated':>13} {'error bar':>10}")
    for name, f, p, limit, bar, word in rows:
        order = f"{p:.2f}" if p is not None else "-"
        print(f"{name:34} {f[0]:13.6g} {order:>6} {limit:13.6g} {bar:10.2g}  {word}")
    with open(out / "estimate.csv", "w", newline="") as file:
        table = csv.writer(file)
        table.writerow(["quantity", *(f"spacing times {x:.6g}" for x in h), "order", "extrapolated",
                        "error bar", "note"])
        for name, f, p, limit, bar, word in rows:
            table.writerow([name, *map(repr, f), "" if p is None else repr(p), repr(limit), repr(bar), word])
    print(f"written to {out}/estimate.csv")


if __name__ == "__main__":
    main()
