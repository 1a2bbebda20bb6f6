#!/usr/bin/python3
"""Do two history.csv tell the same run?

usage: compare_history.py A B TOLERANCE [STEPS_AFTER]
Until the first bond breaks every column agrees to TOLERANCE times its scale, the largest value of
that column (of the vector, for the components of one) in A, but for what tells how the work is divided. For STEPS_AFTER rows after that
(default 100) the number of broken bonds is the same. Exit code 1 and one line where not.
"""
import csv
import sys

DIVISION = ("markers_most_over_mean[-]",)  # depends on the number of ranks by itself


def read(path):
    with open(path) as f:
        rows = list(csv.reader(f))
    return rows[0], [[float(x) if x else None for x in row] for row in rows[1:]]


def scales(names, rows):
    """Largest magnitude per column; one for x, y, z of the same vector, one for all energies."""
    def group(name):
        if name.startswith(("energy", "dissipated", "work")):
            return "energy"
        return name.replace("_x[", "[").replace("_y[", "[").replace("_z[", "[")
    largest = {}
    for q, name in enumerate(names):
        top = max((abs(row[q]) for row in rows if row[q] is not None), default=0.0)
        largest[group(name)] = max(largest.get(group(name), 0.0), top)
    return [largest[group(name)] for name in names]


def main(path_a, path_b, tolerance, after=100):
    names, a = read(path_a)
    names_b, b = read(path_b)
    if names != names_b or len(a) != len(b):
        sys.exit(f"{path_a} and {path_b}: {len(a)} and {len(b)} rows, or other columns")
    broken = names.index("broken_bonds[-]")
    first = next((q for q, row in enumerate(a) if row[broken] > 0), len(a))
    scale, worst = scales(names, a[:first]), (0.0, "", 0)
    for q in range(first):
        for c, name in enumerate(names):
            if name in DIVISION:
                continue
            if (a[q][c] is None) != (b[q][c] is None):
                sys.exit(f"{name} is measured in one of the two at row {q}")
            if a[q][c] is None:
                continue
            error = abs(a[q][c] - b[q][c]) / scale[c] if scale[c] > 0 else abs(b[q][c])
            worst = max(worst, (error, name, q))
    print(f"before breaking: {first} rows, worst {worst[0]:.2e} in {worst[1]} at row {worst[2]}")
    if not worst[0] <= tolerance:
        sys.exit(f"differs by {worst[0]:.2e} > {tolerance:g} in {worst[1]} at row {worst[2]}")
    rows = range(first, min(len(a), first + after))
    for q in rows:
        if a[q][broken] != b[q][broken]:
            sys.exit(f"row {q}: {a[q][broken]:.0f} and {b[q][broken]:.0f} broken bonds")
    print(f"after: {len(rows)} rows, the same broken bonds (last {a[-1][broken]:.0f})")
    if first == len(a):
        print("nothing broke")
    return first < len(a)


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2], float(sys.argv[3]), *map(int, sys.argv[4:]))
