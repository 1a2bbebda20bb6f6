#!/usr/bin/python3
"""Ratio of the medians of two commits' times, with its 95 % interval.

usage: compare_speed.py FOLDER BENCH...
FOLDER holds a-BENCH-N.json and b-BENCH-N.json of the pairs N, as bench/ writes them. Every time that both
have (unit ms) is a line: median of A, median of B, B over A, its interval. The interval is that of a
bootstrap: pairs are drawn with replacement, 10000 times, from a fixed seed, and the 2.5 and 97.5 percent
points of the ratios of medians are taken; what disturbs the machine for longer than a run is in both of a
pair. Exit code 1 where an interval does not reach below 1.02.
"""
import glob
import json
import os
import random
import statistics
import sys

LIMIT, DRAWS = 1.02, 10000


def times_of(path):
    with open(path) as f:
        return {(r["case"], r["quantity"]): r["value"] for r in json.load(f) if r["unit"] == "ms"}


def interval(pairs):
    generator = random.Random(1)
    ratios = []
    for _ in range(DRAWS):
        drawn = generator.choices(pairs, k=len(pairs))
        a, b = zip(*drawn)
        ratios.append(statistics.median(b) / statistics.median(a))
    ratios.sort()
    return ratios[int(0.025 * DRAWS)], ratios[int(0.975 * DRAWS) - 1]


def main(folder, benches):
    slower = compared = 0
    print(f"{'time':44s} {'A [ms]':>9s} {'B [ms]':>9s} {'B/A':>7s}  95 % interval")
    for bench in benches:
        runs = []
        for path in sorted(glob.glob(os.path.join(folder, f"a-{bench}-*.json"))):
            runs.append((times_of(path), times_of(path.replace("a-" + bench, "b-" + bench))))
        for key in runs[0][0]:
            pairs = [(a[key], b[key]) for a, b in runs if key in a and key in b]
            if len(pairs) < len(runs):
                continue
            a, b = (statistics.median(side) for side in zip(*pairs))
            low, high = interval(pairs)
            too_slow = not low < LIMIT
            slower += too_slow
            compared += 1
            print(f"{bench + ' ' + key[0]:44s} {a:9.4g} {b:9.4g} {b / a:7.4f}  "
                  f"{low:.4f} to {high:.4f}{'  SLOWER' if too_slow else ''}")
    if compared == 0:
        print("no time that both commits measure", file=sys.stderr)
        return 2
    return 1 if slower else 0


if __name__ == "__main__":
    if len(sys.argv) < 3:
        print(__doc__, file=sys.stderr)
        sys.exit(2)
    sys.exit(main(sys.argv[1], sys.argv[2:]))
