#!/bin/sh
# tools/trade.py knows what is dominated and what is not, and every file it names; the error that
# --check prints for an accuracy is not below what was measured (docs/verification/trade).
# What `accuracy` sets is what the rule of tools/presets.py gives, or a reason is named.
# usage: trade.sh SOURCE BUILD
set -eu
cd "$1"
build=$2
PYTHONPATH=tools PYTHONDONTWRITEBYTECODE=1 /usr/bin/python3 - "$build/bin/breakwater" <<'END'
import json
import re
import subprocess
import sys
from pathlib import Path

import trade

point = lambda error, cost: {"error": error, "core_seconds": cost}
found = trade.dominated({"a": point(0.1, 1), "b": point(-0.01, 4), "c": point(0.2, 2),
                         "d": {"core_seconds": 0.1, "failed": "no"}})
assert found == {"c": "a"}, found  # b errs less, a costs less, d ended

for name, (path, base, *_) in trade.SCENES.items():
    assert Path(path).is_file(), path
for knob, (scenes, values) in trade.KNOBS.items():
    for scene in scenes:
        for _, value in values:
            trade.settings(scene, value)  # every key of a scaled grid is there

kept = json.loads(Path("docs/verification/trade/trade.json").read_text())["points"]
alike = {"scenes/flow_past_cylinder/flow_past_cylinder.yaml": ["cylinder", "array"],
         "bench/trade/plate.yaml": ["plate"],
         "bench/trade/cantilever.yaml": ["cantilever", "swing"],
         "scenes/dam_break/dam_break.yaml": ["dam break"]}
# What was kept of scenes that no promise was set by: each holds, and all are there.
held = json.loads(Path("docs/verification/trade/held_out.json").read_text())
assert set(held) == set(trade.HELD_OUT) and len(held) >= 8, set(held) ^ set(trade.HELD_OUT)
for name, point in held.items():
    assert abs(point["error"]) <= point["promise"] or point["coarser"], f"{name}: {point}"
for path, scenes in alike.items():
    for accuracy in ("quick", "standard", "careful"):
        told = subprocess.run([sys.argv[1], path, "--check", "--set", f"accuracy={accuracy}"],
                              capture_output=True, text=True, check=True).stdout
        said = float(re.search(r"error measured: ([0-9.e-]+) %", told).group(1)) / 100
        most = max(abs(kept["accuracy"][scene][accuracy]["error"]) for scene in scenes)
        # two digits are printed
        assert said >= 0.95 * most, f"{path}, {accuracy}: {said} is printed, {most} was measured"
END
PYTHONDONTWRITEBYTECODE=1 /usr/bin/python3 tools/presets.py --check --program "$build/bin/breakwater" > /dev/null
