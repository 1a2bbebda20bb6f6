#!/usr/bin/python3
"""Where does it hold, and what does a user see beyond?

usage: extremes.py [ROW ...] [--out FOLDER]     (./run extremes [ROW ...]; --list names the rows)
Every row of the table below is a scene of seconds, one number of it that is driven to an extreme, and an
error against something known: a closed form, an invariant, or the scene's own value where the number
is harmless. Real runs of the program look where the error goes beyond its tolerance: first at the end
of the range, then by bisection; more runs on either side see that nothing else is there. A run
  holds     ends with exit code 0 and an error within the tolerance,
  is told   errs more, and a warning said so,
  ends      stops by itself with a message and an exit code that is not 0,
  is refused  before it begins, with key, value and remedy,
  is dear   takes more processor time than the row allows,
  is WRONG  ends with exit code 0, errs more, and says nothing: a fault,
  is LATE   refused by the run, but not by --check: a fault,
  CRASHES   ends by a signal, or without a word: a fault.
Writes FOLDER/extremes.json and FOLDER/extremes.png. Runs that are there already, of the same program and
the same table, are not run again. Exit code 1 where a run was wrong or crashed that is not listed as known.
"""
import argparse
import hashlib
import json
import math
import os
import resource
import shutil
import signal
import subprocess
import sys
from pathlib import Path

import extremes_rows
import history

FAULTS = ("WRONG", "LATE", "CRASHES")
CLOSE = 1.1  # ratio of the two ends of a bisection that is close enough


class Values:
    """history.csv of a run: columns by their names without the unit."""

    def __init__(self, folder):
        head, rows = history.read(Path(folder) / "history.csv")
        self.head, self.rows = head, rows
        self.at = {name.partition("[")[0]: k for k, name in enumerate(head)}

    def column(self, name):
        return [row[self.at[name]] for row in self.rows]

    def last(self, name):
        return self.rows[-1][self.at[name]]

    def first(self, name):
        return self.rows[0][self.at[name]]


def limited(seconds):
    def before():
        resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds + 5))
    return before


def run(program, row, x, folder):
    """(class, message, values, seconds of processor time) of one run."""
    shutil.rmtree(folder, ignore_errors=True)
    path, sets = row.scene(x, Path(folder).parent) if callable(row.scene) else (row.scene, [])
    command = [program, str(path), "--out", str(folder)]
    for word in sets + row.sets(x):
        command += ["--set", word]
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    done = subprocess.run(command, capture_output=True, text=True, preexec_fn=limited(row.seconds))
    spent = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before
    lines = [line for line in done.stderr.splitlines() + done.stdout.splitlines() if line.strip()]
    errors = [line for line in lines if "error:" in line]
    told = [line.partition("warning: ")[2] for line in lines if "warning:" in line]
    told += [line.rpartition("; ")[2].rstrip(") sets") for line in lines if "; this scene is coarser" in line]
    if done.returncode in (75, -signal.SIGXCPU, -signal.SIGKILL):
        return "dear", f"more than {row.seconds} s of processor time", None, spent
    if done.returncode == 0:
        return "ran", told, Values(folder), spent
    if done.returncode < 0 or done.returncode > 128 or not errors:
        return "CRASHES", f"exit code {done.returncode}: {(lines or ['no word'])[-1]}", None, spent
    message = errors[-1].partition("error: ")[2]
    if done.returncode != 2:
        return "ends", message, None, spent
    checked = subprocess.run(command + ["--check"], capture_output=True, text=True, preexec_fn=limited(20))
    return ("refused" if checked.returncode == 2 else "LATE"), message, None, spent


def look(program, row, x, base, usual, folder):
    """A point of the map: {x, class, error, message, core_seconds}. What is said of the harmless run, too,
    is no word about this one."""
    kind, said, values, spent = run(program, row, x, folder)
    point = {"x": x, "class": kind, "message": said, "core_seconds": round(spent, 2)}
    if values is not None:
        new = [text for text in said if bare(text) not in usual]
        error = row.error(values, x, base)
        fits = math.isfinite(error) and abs(error) <= row.tolerance
        point["error"] = error if math.isfinite(error) else str(error)
        point["class"] = "holds" if fits else "told" if new else "WRONG"
        point["message"] = " | ".join(new)
    return point


def bare(text):
    """A warning without its numbers."""
    return "".join(c for c in text if not c.isdigit())[:40]


def explore(program, row, points, folder, keep):
    """All runs of a row; points: those that are there already, by x."""
    base, usual = None, set()

    def at(x):
        nonlocal base, usual
        known = next((p for p in points if math.isclose(p["x"], x, rel_tol=1e-9)), None)
        if known is None:
            if base is None:
                kind, said, base, _ = run(program, row, row.inside, folder / "base")
                if base is None:
                    sys.exit(f"extremes.py: {row.name}: where it should hold it {kind}: {said}")
                usual = {bare(text) for text in said}
            known = look(program, row, x, base, usual, folder / "run")
            points.append(known)
            keep()
        return known

    if at(row.inside)["class"] != "holds":
        return None
    if row.values:
        fine = [at(x)["class"] == "holds" for x in row.values]
        return row.outside if all(fine) else row.values[fine.index(False) - 1]
    good, bad = row.inside, row.outside
    if at(bad)["class"] == "holds":
        return bad
    for _ in range(12):
        if max(good / bad, bad / good) < CLOSE:
            break
        middle = math.sqrt(good * bad)
        good, bad = (middle, bad) if at(middle)["class"] == "holds" else (good, middle)
    # On either side a few more: does it hold everywhere before, and is the end clear everywhere behind?
    for part in (0.33, 0.67):
        for one, other in ((row.inside, good), (bad, row.outside)):
            at(one * (other / one) ** part)
    return good


def summary(row, points, limit):
    inside = [p for p in points if p["class"] == "holds"]
    beyond = sorted({p["class"] for p in points} - {"holds"})
    default = row.default
    margin = max(limit / default, default / limit) if limit and default else None
    return {"limit": limit, "reached": limit == row.outside, "beyond": beyond, "margin": margin,
            "largest_error": max((abs(p["error"]) for p in inside), default=None),
            "faults": [p["x"] for p in points if p["class"] in FAULTS]}


def tell(row, points, found):
    print(f"\n{row.name}: {row.what}")
    print(f"  holds: {row.claim}, to {100 * row.tolerance:.3g} %")
    for p in sorted(points, key=lambda p: p["x"], reverse=row.outside < row.inside):
        error = f"{100 * p['error']:+10.3g} %" if isinstance(p.get("error"), float) else " " * 12
        print(f"    {p['x']:12.5g} {p['class']:8} {error}  {p['message'][:110]}")
    if found["limit"] is None:
        print("  does not hold where it should")
    elif found["reached"]:
        print(f"  holds to the end of the range, {row.outside:g}")
    else:
        print(f"  holds to {found['limit']:.4g}; then: {', '.join(found['beyond'])}")


COLOURS = {"holds": "#2e8b57", "told": "#d68910", "refused": "#1f5fa8", "ends": "#8e44ad", "dear": "#888888",
           "WRONG": "#c0392b", "LATE": "#e377c2", "CRASHES": "#000000"}


def figure(rows, kept, path):
    """One line per row: how far from the harmless value, in decades, and what was seen there."""
    lines = []
    for name in COLOURS:
        lines.append(f"${name} << E")
        for q, row in enumerate(rows):
            for p in kept.get(row.name, []):
                if p["class"] == name:
                    lines.append(f"{math.log10(p['x'] / row.inside)} {len(rows) - q}")
        lines.append("E")
    tics = ", ".join(f'"{row.name}" {len(rows) - q}' for q, row in enumerate(rows))
    lines += [f"set terminal pngcairo size 1000,{120 + 26 * len(rows)} noenhanced font 'sans,11'",
              f"set output '{path}'", f"set ytics ({tics})", f"set yrange [0.3:{len(rows) + 0.7}]",
              "set xlabel 'decades from the harmless value'", "set grid lc rgb '#dddddd'",
              "set key outside top horizontal"]
    parts = [f"${name} using 1:2 with points pt 7 ps 1.1 lc rgb '{colour}' title '{name}'"
             for name, colour in COLOURS.items()
             if any(p["class"] == name for row in rows for p in kept.get(row.name, []))]
    lines.append("plot " + ", \\\n ".join(parts))
    done = subprocess.run(["gnuplot"], input="\n".join(lines) + "\n", text=True, capture_output=True)
    if done.returncode != 0:
        sys.exit(f"extremes.py: gnuplot made no figure:\n{done.stderr}")


def state_of(program):
    """What kept runs belong to: the program, the table, the scenes."""
    seen = hashlib.sha256()
    for path in [Path(extremes_rows.__file__), *sorted(Path("bench/extremes").glob("*.yaml"))]:
        seen.update(path.read_bytes())
    version = subprocess.run([program, "--version"], capture_output=True, text=True).stdout.strip()
    return version, seen.hexdigest()[:12]


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("rows", nargs="*", metavar="ROW")
    parser.add_argument("--out", default="build/extremes")
    parser.add_argument("--program", default="build/bin/breakwater")
    parser.add_argument("--list", action="store_true")
    args = parser.parse_args()
    rows, extremes_rows.PROGRAM = extremes_rows.ROWS, args.program
    if args.list:
        for row in rows:
            print(f"{row.name:34} {row.inside:10.4g} to {row.outside:10.4g}   {row.what}")
        return 0
    names = [row.name for row in rows]
    for name in args.rows:
        if name not in names:
            sys.exit(f"extremes.py: there is no row '{name}'; there are: {', '.join(names)}")
    out = Path(args.out)
    out.mkdir(parents=True, exist_ok=True)
    os.environ.setdefault("OMPI_MCA_hwloc_base_binding_policy", "none")
    version, table = state_of(args.program)
    file = out / "extremes.json"
    kept = json.loads(file.read_text()) if file.is_file() else {}
    if (kept.get("program"), kept.get("table")) != (version, table):
        kept = {"program": version, "table": table, "points": {}, "rows": {}}
    bad = False
    for row in rows:
        if args.rows and row.name not in args.rows:
            continue
        points = kept["points"].setdefault(row.name, [])
        limit = explore(args.program, row, points, out / "runs",
                        lambda: file.write_text(json.dumps(kept, indent=1) + "\n"))
        found = summary(row, points, limit)
        kept["rows"][row.name] = dict(found, what=row.what, claim=row.claim, tolerance=row.tolerance,
                                      inside=row.inside, outside=row.outside, default=row.default,
                                      known=row.known)
        tell(row, points, found)
        bad = bad or limit is None or (bool(found["faults"]) and not row.known)
    file.write_text(json.dumps(kept, indent=1) + "\n")
    figure([row for row in rows if row.name in kept["points"]], kept["points"], out / "extremes.png")
    print(f"\nwritten to {file}")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
