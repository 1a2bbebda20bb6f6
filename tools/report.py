#!/usr/bin/python3
"""What the validation programs found, on one page.

usage: report.py FOLDER      (FOLDER: build/verification)
Reads FOLDER/MODULE.CLAIM.json of every validation/MODULE/CLAIM.c, and how each program ended from
FOLDER/runs.tsv (written by ./run validate). Writes FOLDER/verification.json and FOLDER/report.html.
Curves: a program may leave MODULE.CLAIM*.csv there, x first; a column NAME_reference is drawn
beside the column NAME. Exit code 0 only when every claim passed and every program ran.
"""
import csv
import datetime
import html
import json
import math
import os
import platform
import subprocess
import sys
from pathlib import Path

SOURCE = Path(__file__).resolve().parent.parent
KNOWN = {"claim", "quantity", "measured", "reference", "error", "tolerance", "kind", "source", "pass"}


# ---- what was found -----------------------------------------------------------------------------

def programs():
    """All validation programs of the source, MODULE.CLAIM."""
    return sorted(f"{p.parent.name}.{p.stem}" for p in (SOURCE / "validation").glob("*/*.c")
                  if p.parent.name != "support")


def runs(folder):
    """How each program ended: {name: {form, ranks, code, seconds}}."""
    table = {}
    path = folder / "runs.tsv"
    for line in path.read_text().splitlines() if path.is_file() else []:
        name, form, ranks, code, seconds = line.split("\t")
        table[name] = {"form": form, "ranks": int(ranks), "code": int(code),
                       "seconds": int(seconds)}
    return table


def rows_of(path):
    """The rows a program wrote, or why there are none."""
    if not path.is_file():
        return None, "it wrote no file"
    try:
        rows = json.loads(path.read_text())
    except ValueError:
        return None, "its file breaks off: it did not end by itself"
    return (rows, None) if rows else (None, "it made no claim")


def collect(folder):
    ended, found = runs(folder), []
    # Every program of the source gets an entry, whether it ran or not: a missing one is seen.
    for name in programs():
        run = ended.get(name)
        item = {"program": name, "state": "not run", "why": None, "rows": [], "run": run}
        rows, why = rows_of(folder / f"{name}.json")
        if run is not None or (folder / f"{name}.json").is_file():
            item["rows"] = rows or []
            failed = [r for r in item["rows"] if not r["pass"]]
            # An exit code without a failed row: it crashed, or refused its input.
            if why is None and run is not None and run["code"] != 0 and not failed:
                why = f"it ended with exit code {run['code']}"
            item["why"] = why
            item["state"] = "failed" if failed or why else "passed"
        found.append(item)
    return found


def command(*words):
    try:
        return subprocess.run(words, capture_output=True, text=True, cwd=SOURCE).stdout.strip()
    except OSError:
        return ""


def processor():
    for line in Path("/proc/cpuinfo").read_text().splitlines():
        if line.startswith("model name"):
            return line.partition(":")[2].strip()
    return platform.machine()


def provenance():
    commit = command("git", "rev-parse", "--short=12", "HEAD") or "unknown"
    if command("git", "status", "--porcelain", "--untracked-files=no"):
        commit += " with local changes"
    return {"commit": commit, "machine": f"{platform.node()}, {processor()}, "
            f"{os.cpu_count()} threads, {platform.system()} {platform.release()}",
            "time": datetime.datetime.now().astimezone().isoformat(timespec="seconds")}


# ---- charts, as SVG -----------------------------------------------------------------------------

W, H, LEFT, TOP, RIGHT, BOTTOM = 460, 284, 62, 40, 12, 40
COLOURS = ["#1f5fa8", "#c0392b", "#2e8b57", "#8e44ad", "#d68910", "#16a085"]


def finite(x):
    return isinstance(x, (int, float)) and not isinstance(x, bool) and math.isfinite(x)


class Axis:
    """Values to pixels; logarithmic when asked for."""

    def __init__(self, values, low, high, log=False):
        self.log = log
        v = [math.log10(x) if log else x for x in values]
        # A margin on both sides; a single value gets an axis of some width.
        self.a, self.b = min(v), max(v)
        pad = 0.06 * (self.b - self.a) or 0.1 * abs(self.a) or 1.0
        self.a, self.b, self.low, self.high = self.a - pad, self.b + pad, low, high

    def __call__(self, x):
        v = math.log10(x) if self.log else x
        return self.low + (v - self.a) / (self.b - self.a) * (self.high - self.low)

    def ticks(self):
        # Decades, thinned out when there are many, filled with 2 and 5 when there are few.
        if self.log:
            decades = range(math.floor(self.a), math.ceil(self.b) + 1)
            thin = max(1, len(decades) // 6)
            factors = (1, 2, 5) if self.b - self.a < 2 else (1,)
            every = [m * 10.0 ** d for d in decades if d % thin == 0 for m in factors]
            return [t for t in every if self.a <= math.log10(t) <= self.b]
        # Steps of 1, 2 or 5 times a power of ten, about five of them.
        raw = (self.b - self.a) / 5
        step = 10 ** math.floor(math.log10(raw))
        step *= next(m for m in (1, 2, 5, 10) if m * step >= raw)
        return [i * step for i in range(math.ceil(self.a / step),
                                        math.floor(self.b / step) + 1)]


def chart(title, x_label, curves, log_x=False, log_y=False):
    """curves: [(name, [(x, y)], dashed)]. Nothing when nothing can be drawn."""
    # What a logarithm cannot take is left out, as is what is not finite.
    curves = [(n, [(x, y) for x, y in p if finite(x) and finite(y) and (x > 0 or not log_x)
                   and (y > 0 or not log_y)], d) for n, p, d in curves]
    every = [q for _, p, _ in curves for q in p]
    if len(every) < 2:
        return ""
    ax = Axis([x for x, _ in every], LEFT, W - RIGHT, log_x)
    ay = Axis([y for _, y in every], H - BOTTOM, TOP, log_y)
    out = [f'<svg width="{W}" height="{H}" viewBox="0 0 {W} {H}"><text x="{LEFT}" y="16" '
           f'class="t">{html.escape(title)}</text>']
    for t in ax.ticks():
        out.append(f'<line x1="{ax(t):.1f}" x2="{ax(t):.1f}" y1="{TOP}" y2="{H - BOTTOM}" class="g"/>'
                   f'<text x="{ax(t):.1f}" y="{H - BOTTOM + 14}" text-anchor="middle">{t:g}</text>')
    for t in ay.ticks():
        out.append(f'<line y1="{ay(t):.1f}" y2="{ay(t):.1f}" x1="{LEFT}" x2="{W - RIGHT}" class="g"/>'
                   f'<text y="{ay(t) + 4:.1f}" x="{LEFT - 5}" text-anchor="end">{t:g}</text>')
    # References are dashed and grey; few points are marked one by one.
    for q, (name, points, dashed) in enumerate(curves):
        colour = "#333333" if dashed else COLOURS[q % len(COLOURS)]
        path = " ".join(f"{ax(x):.1f},{ay(y):.1f}" for x, y in points)
        style = ' stroke-dasharray="5 4"' if dashed else ""
        out.append(f'<polyline points="{path}" fill="none" stroke="{colour}" '
                   f'stroke-width="1.8"{style}/>')
        if len(points) <= 40:
            out += [f'<circle cx="{ax(x):.1f}" cy="{ay(y):.1f}" r="3" fill="{colour}"/>'
                    for x, y in points]
        out.append(f'<text x="{LEFT + 110 * q}" y="{TOP - 9}" style="fill:{colour}">'
                   f'{"- - " if dashed else "&#8212; "}{html.escape(name)}</text>')
    out.append(f'<text x="{(LEFT + W - RIGHT) / 2}" y="{H - 6}" text-anchor="middle">'
               f'{html.escape(x_label)}</text></svg>')
    return "".join(out)


def parameter_of(rows):
    """The extra member that differs from row to row, a number: what a quantity is drawn against."""
    names = [k for k in rows[0] if k not in KNOWN and all(finite(r.get(k)) for r in rows)]
    return next((k for k in names if len({r[k] for r in rows}) == len(rows)), None)


def families(rows):
    """Rows of the same quantity and the same words, which differ in a number."""
    groups = {}
    for r in rows:
        # Rows that differ in words are other families, rows that differ in a number are a curve.
        words = tuple(str(v) for k, v in sorted(r.items()) if k not in KNOWN and isinstance(v, str))
        groups.setdefault((r["quantity"],) + words, []).append(r)
    for key, members in groups.items():
        if len(members) >= 2 and (x := parameter_of(members)):
            yield ", ".join(key), x, sorted(members, key=lambda r: r[x])


def charts_of(item, folder):
    out = []
    for title, x, rows in families(item["rows"]):
        out.append(chart(title, x, [("measured", [(r[x], r["measured"]) for r in rows], False),
                                    ("reference", [(r[x], r["reference"]) for r in rows], True)]))
        out.append(chart(f"error of {title}", x, [("error", [(r[x], r["error"]) for r in rows],
                                                   False)],
                         log_x=min(r[x] for r in rows) > 0, log_y=True))
    for path in sorted(folder.glob(f"{item['program']}*.csv")):
        out += curves_of(path)
    return "".join(out)


def number(text):
    try:
        return float(text)
    except ValueError:
        return math.nan


def curves_of(path):
    with open(path, newline="") as file:
        rows = [r for r in csv.reader(file) if r]
    head, data = rows[0], rows[1:]
    column = {name: [number(r[q]) for r in data if q < len(r)] for q, name in enumerate(head)}
    x = column[head[0]]
    for name in head[1:]:
        if name.endswith("_reference") and name[:-len("_reference")] in column:
            continue
        pair = [(name, list(zip(x, column[name])), False)]
        if f"{name}_reference" in column:
            pair.append(("reference", list(zip(x, column[f"{name}_reference"])), True))
        yield chart(f"{path.stem}: {name}", head[0], pair)


# ---- the page -----------------------------------------------------------------------------------

STYLE = """body{font:14px/1.45 sans-serif;margin:2em auto;max-width:1150px;color:#222}
table{border-collapse:collapse;width:100%}td,th{padding:3px 8px;border-bottom:1px solid #ddd;
text-align:left;vertical-align:top}td.n{text-align:right;font-family:monospace;white-space:nowrap}
.passed{color:#1e7d34}.failed{color:#b3202a;font-weight:bold}.not{color:#8a6d00;font-weight:bold}
svg{margin:8px 14px 8px 0}svg text{font:11px sans-serif;fill:#333}svg .t{font-weight:bold}
svg .g{stroke:#e4e4e4}h2{margin-top:2em;border-top:2px solid #ccc;padding-top:.6em}"""


def show(x):
    return "" if x is None else f"{x:.6g}" if finite(x) else html.escape(str(x))


def row_html(r):
    extra = ", ".join(f"{k} = {show(v)}" for k, v in r.items() if k not in KNOWN)
    state = "passed" if r["pass"] else "failed"
    if r["tolerance"] is None and r["pass"]:
        verdict = '<td>reported only</td>'
    else:
        verdict = f'<td class="{state}">{"yes" if r["pass"] else "NO"}</td>'
    return (f'<tr><td>{html.escape(r["claim"])}<br><small>{html.escape(r["quantity"])}'
            f'{"; " + html.escape(extra) if extra else ""}</small></td>'
            f'<td class="n">{show(r["reference"])}</td><td class="n">{show(r["measured"])}</td>'
            f'<td class="n">{show(r["error"])}</td><td class="n">{show(r["tolerance"])}</td>'
            f'{verdict}<td>{html.escape(r["kind"])}: {html.escape(r["source"])}</td></tr>')


def how(item):
    run = item["run"]
    text = f"{run['form']} form, {run['ranks']} ranks, {run['seconds']} s" if run else ""
    return html.escape("; ".join(t for t in (text, item["why"]) if t))


def section(item, folder):
    rows = "".join(row_html(r) for r in item["rows"])
    table = ("<table><tr><th>claim<th>expected<th>measured<th>error<th>tolerance<th>holds"
             f"<th>reference</tr>{rows}</table>") if rows else ""
    return (f'<h2 id="{item["program"]}">{item["program"]}: <span class="{item["state"].split()[0]}">'
            f'{item["state"]}</span></h2><p>{how(item)}</p>{charts_of(item, folder)}{table}')


def overview(found):
    lines = []
    for item in found:
        hold = sum(r["pass"] for r in item["rows"])
        lines.append(f'<tr><td><a href="#{item["program"]}">{item["program"]}</a></td>'
                     f'<td class="{item["state"].split()[0]}">{item["state"]}</td>'
                     f'<td>{hold} of {len(item["rows"])}</td><td>{how(item)}</td></tr>')
    return ("<table><tr><th>program<th>state<th>claims that hold<th>run</tr>"
            f"{''.join(lines)}</table>")


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    folder = Path(sys.argv[1])
    found, about = collect(folder), provenance()
    by_state = {s: [i["program"] for i in found if i["state"] == s]
                for s in ("passed", "failed", "not run")}
    summary = ", ".join(f"{len(names)} {state}" for state, names in by_state.items())
    result = dict(about, passed=by_state["passed"], failed=by_state["failed"],
                  not_run=by_state["not run"], programs=found)
    (folder / "verification.json").write_text(json.dumps(result, indent=1) + "\n")
    page = (f'<!doctype html><meta charset="utf-8"><title>Breakwater: verification</title>'
            f'<style>{STYLE}</style><h1>Breakwater: verification</h1><p>{summary}</p>'
            f'<p>commit {html.escape(about["commit"])}<br>{html.escape(about["machine"])}<br>'
            f'{about["time"]}</p>{overview(found)}{"".join(section(i, folder) for i in found)}')
    (folder / "report.html").write_text(page)
    print(f"verification: {summary}; see {folder}/report.html")
    for item in found:
        if item["state"] != "passed":
            print(f"  {item['state']}: {item['program']} {item['why'] or ''}".rstrip())
    # Only when all have run and passed is the exit code 0.
    return 0 if not by_state["failed"] and not by_state["not run"] else 1


sys.exit(main())
