#!/bin/sh
# --target-error takes the cheapest setting that promises enough, refuses what nothing reaches, and brings a scene
# to the fineness of what was measured; the updates that --check promises are those that the run makes.
# usage: target.sh SOURCE BUILD
set -eu
cd "$1"
build=$2
PYTHONPATH=tools PYTHONDONTWRITEBYTECODE=1 /usr/bin/python3 - "$build" <<'END'
import re
import subprocess
import sys

import target

program, out = sys.argv[1] + "/bin/breakwater", sys.argv[1] + "/test_target"
point = lambda error, cost: {"error": error, "core_seconds": cost}
points = {"grid": {"a": {"2 h": point(0.01, 1), "h": point(-0.04, 4), "h/2": point(0.002, 30)}},
          "accuracy": {"a": {"quick": point(0.03, 3), "careful": {"failed": "no"}}}}
promised = {p[0]: p[3] for p in target.measured(points, ["a"])}
# What a coarser grid has by luck it does not promise; what failed promises nothing.
assert promised == {"grid 2 h": 0.04, "grid h": 0.04, "grid h/2": 0.002, "accuracy quick": 0.03}, promised
taken = lambda e: (target.choose(target.measured(points, ["a"]), e) or [None])[0]
assert (taken(0.05), taken(0.035), taken(0.01), taken(0.001)) == ("grid 2 h", "accuracy quick", "grid h/2", None)
assert target.wanted("2%") == target.wanted("0.02") == 0.02


def asked(*words):
    return subprocess.run([sys.executable, "tools/target.py", *words, "--program", program], capture_output=True,
                          text=True)


# A cantilever of half the fineness comes back to that of the measured one; a kind that nobody measured does not.
done = asked("bench/trade/cantilever.yaml", "--target-error", "6%", "--set", "bodies.beam.spacing=0.04")
spacing = float(re.search(r"spacing=([0-9.e-]+)", done.stdout)[1])
assert done.returncode == 0 and spacing <= 0.0101, done
assert asked("bench/trade/cantilever.yaml", "--target-error", "0.01%").returncode == 3
assert asked("scenes/falling_sphere/falling_sphere.yaml", "--target-error", "2%").returncode == 3


def updates(*words):
    text = subprocess.run([program, *words], capture_output=True, text=True, check=True).stdout
    line = [line for line in text.splitlines() if line.startswith("cost ")][-1]
    return [float(x) for x in re.findall(r"([0-9.e+]+) (?:updates )?of (?:cells|markers|particles)", line)]


# Where the stream is not squeezed between bodies, steps are those of the start but for some per cent.
for scene in ("vortex", "outflow", "slit", "plug", "still", "blocks"):
    path = f"bench/extremes/{scene}.yaml"
    told, made = updates(path, "--check"), updates(path, "--out", f"{out}/{scene}", "--overwrite")
    for promise, found in zip(told, made):
        assert abs(promise - found) <= 0.1 * found, f"{scene}: {told} are promised, {made} were made"
END
