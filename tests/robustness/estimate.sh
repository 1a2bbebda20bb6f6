#!/bin/sh
# tools/estimate.py finds the order, the limit and the error bar of values whose convergence is known,
# says where there is none, and does it for a scene: a flow that starts in a channel, which the
# fluid follows to second order, so that energy per depth is the same.
# usage: estimate.sh SOURCE BUILD
set -eu
source=$1 build=$2
out=$build/test_estimate
rm -rf "$out" && mkdir -p "$out"
bad=0
complain() { echo "FAIL: $*"; bad=1; }

# ---- values that are known ----------------------------------------------------------------------
PYTHONPATH=$source/tools PYTHONDONTWRITEBYTECODE=1 /usr/bin/python3 - <<'END' || bad=1
import math
from estimate import judged, ratios
def near(a, b, e=1e-6): return abs(a - b) <= e * max(1, abs(b))
h = [1, 1.4, 2]
for p, c in ((1, 0.3), (2, -0.2), (1.7, 5.0)):  # f = 7 + c h^p
    order, limit, bar, word = judged([7 + c * x ** p for x in h], h, 2)
    assert near(order, p) and near(limit, 7) and near(bar, 1.25 * abs(c)), (p, order, limit, bar)
    assert (word == "") == (abs(p - 2) <= 0.6), word
order, limit, bar, word = judged([7, 7.2, 7.1], h, 2)          # turns back
assert order is None and limit == 7 and bar >= 0.2 and "turns back" in word
order, limit, bar, word = judged([7, 7.2, 7.2001], h, 2)       # comes from nowhere
assert bar >= 0.2001 and "refine" in word
order, limit, bar, word = judged([3.0, 3.0, 3.0], h, 1)
assert bar == 0 and "same" in word
order, limit, bar, word = judged([7.3, 7.6], [1, 2], 1)        # of order 1: three times the rest
assert order is None and near(bar, 0.9) and "assumed" in word
found = ratios([120, 60, 1], 3)
assert all(abs(60 / x - round(60 / x)) < 1e-9 for x in found), found
try:
    ratios([101, 40, 1], 3)
    raise AssertionError("cells without a common divisor were taken")
except SystemExit as refusal:
    assert "101, 40" in str(refusal)
END

# ---- a scene ------------------------------------------------------------------------------------
cat >"$out/channel.yaml" <<'END'
name: channel
domain: {length: [0.5, 1, 0.0416666666666667], cells: [12, 24, 1]}
fluid:
  density: 1
  viscosity: 0.05
  sides:
    x: {lower: {kind: periodic}, upper: {kind: periodic}}
    y: {lower: {kind: wall}, upper: {kind: wall}}
  forcing: {kind: gradient, axis: x, value: 1}
phases: {name: start, until: 1}
gauges: {flow: {of: [bulk_velocity, kinetic_energy]}}
output: {sample_every: 1}
END
/usr/bin/python3 "$source/tools/estimate.py" "$out/channel.yaml" --program "$build/bin/breakwater" \
  --out "$out/estimate" >"$out/log" 2>&1 || complain "$(tail -2 "$out/log")"
# u = sum 4/(0.05 (k pi)^3) (1 - exp(-0.05 (k pi)^2)) sin(k pi y), k odd: mean 0.66365 at t = 1
grep '^flow.bulk_velocity' "$out/estimate/estimate.csv" | awk -F, '
  {ok = $5 > 1.8 && $5 < 2.2 && ($6 - 0.663650)^2 < 1e-8} END {exit !ok}' ||
  complain "not of second order: $(grep '^flow.bulk' "$out/log")"
grep '^flow.kinetic' "$out/estimate/estimate.csv" | awk -F, '{ok = $5 > 1.8 && $5 < 2.2} END {exit !ok}' ||
  complain "energy is not for one depth: $(grep '^flow.kinetic' "$out/log")"
/usr/bin/python3 "$source/tools/estimate.py" "$out/channel.yaml" --program "$build/bin/breakwater" \
  --out "$out/estimate" >"$out/log" 2>&1 && complain "results were overwritten"
exit $bad
