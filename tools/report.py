#!/usr/bin/python3
"""What the validation programs found, on one page.

usage: report.py FOLDER [--keep]      (FOLDER: build/verification)
Reads FOLDER/MODULE.CLAIM.json of every validation/MODULE/CLAIM.c, and how each program ended from
FOLDER/runs.tsv (written by ./run validate). Writes FOLDER/verification.json and FOLDER/report.html.
Curves: a program may leave MODULE.CLAIM*.csv there, x first; a column NAME_reference is drawn
beside the column NAME. What accuracy costs, where scenes stop to hold and what steps cost come from
what ./run trade, extremes and bench left beside FOLDER, else from what docs/verification keeps; the page
also has the systems of the four documents (docs/systems.csv) and what has moved since the report that is
kept (docs/verification/report; --keep keeps this one). It needs no other file and no script.
Exit code 0 only when every claim passed and every program ran.
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

import report_parts as parts
from report_charts import chart, finite
from report_parts import show

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


# ---- charts of a program ------------------------------------------------------------------------

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

STYLE = """body{font:14px/1.45 sans-serif;margin:2em auto;padding:0 1em;max-width:1150px;color:#222}
table{border-collapse:collapse;width:100%;margin:1em 0}caption{text-align:left;font-weight:bold;padding:4px 0}
td,th{padding:3px 8px;border-bottom:1px solid #ddd;text-align:left;vertical-align:top}th[scope=row]{font-weight:normal}
td.n{text-align:right;font-family:monospace;white-space:nowrap}
.passed{color:#1e7d34}.failed{color:#b3202a;font-weight:bold}.not,.no{color:#765a00;font-weight:bold}
svg{margin:8px 14px 8px 0;max-width:100%}svg text{font:11px sans-serif;fill:#333}svg .t{font-weight:bold}
svg .g{stroke:#e4e4e4}h2{margin-top:2em;border-top:2px solid #ccc;padding-top:.6em}h3{margin-top:1.6em}
pre{white-space:pre-wrap;background:#f6f6f6;padding:.6em}.skip{position:absolute;left:-999em}.skip:focus{left:0}
nav li{display:inline-block;margin-right:1.2em}nav ul{padding:0}
@media print{body{margin:0;max-width:none;font-size:10px}nav,.skip{display:none}svg,tr,pre{break-inside:avoid}
details>*{display:block}a{color:inherit;text-decoration:none}}"""


def row_html(r):
    extra = ", ".join(f"{k} = {show(v)}" for k, v in r.items() if k not in KNOWN)
    state = "passed" if r["pass"] else "failed"
    if r["tolerance"] is None and r["pass"]:
        verdict = '<td>reported only</td>'
    else:
        verdict = f'<td class="{state}">{"yes" if r["pass"] else "NO"}</td>'
    return (f'<tr><th scope="row">{html.escape(r["claim"])}<br><small>{html.escape(r["quantity"])}'
            f'{"; " + html.escape(extra) if extra else ""}</small></th>'
            f'<td class="n">{show(r["reference"])}</td><td class="n">{show(r["measured"])}</td>'
            f'<td class="n">{show(r["error"])}</td><td class="n">{show(r["tolerance"])}</td>'
            f'{verdict}<td>{html.escape(r["kind"])}: {html.escape(r["source"])}</td></tr>')


def how(item):
    run = item["run"]
    text = f"{run['form']} form, {run['ranks']} ranks, {run['seconds']} s" if run else ""
    return html.escape("; ".join(t for t in (text, item["why"]) if t))


def head_of(program):
    """What the program's first comment says: claim, reference, how it is measured, why this tolerance."""
    module, claim = program.split(".", 1)
    text = (SOURCE / "validation" / module / f"{claim}.c").read_text().partition("*/")[0]
    lines = [line.removeprefix("/*").removeprefix(" *").removeprefix(" ") for line in text.splitlines()]
    return "\n".join(line for line in lines if not line.startswith(("BUILD", "TEST"))).strip()


def section(item, folder):
    rows = "".join(row_html(r) for r in item["rows"])
    table = ("<table><caption>Claims</caption><thead><tr><th scope=\"col\">claim<th scope=\"col\">expected"
             "<th scope=\"col\">found<th scope=\"col\">error<th scope=\"col\">tolerance<th scope=\"col\">holds"
             f"<th scope=\"col\">reference</tr></thead><tbody>{rows}</tbody></table>") if rows else ""
    return (f'<h3 id="{item["program"]}">{item["program"]}: <span class="{item["state"].split()[0]}">'
            f'{item["state"]}</span></h3><p>{how(item)}</p><details><summary>what is claimed, against what, and why '
            f'to this tolerance</summary><pre>{html.escape(head_of(item["program"]))}</pre></details>'
            f'{charts_of(item, folder)}{table}')


def module_title(name):
    """The first line of the module's README: what it solves."""
    path = SOURCE / "modules" / name / "README.md"
    return path.read_text().partition("\n")[0].lstrip("# ") if path.is_file() else name


def overview(found):
    lines = []
    for item in found:
        hold = sum(r["pass"] for r in item["rows"])
        lines.append([f'<a href="#{item["program"]}">{item["program"]}</a>',
                      f'<span class="{item["state"].split()[0]}">{item["state"]}</span>',
                      f'{hold} of {len(item["rows"])}', how(item)])
    return parts.table("All programs", ["program", "state", "claims that hold", "run"], lines)


def trouble(found):
    """What failed and what was not run, first."""
    rows = [[f'<a href="#{i["program"]}">{i["program"]}</a>', i["state"], how(i),
             "; ".join(html.escape(r["quantity"]) for r in i["rows"] if not r["pass"])]
            for i in found if i["state"] != "passed"]
    return parts.table("Failed, or not run", ["program", "state", "why", "claims that fail"], rows) if rows else \
        "<p>Every program ran, and every claim holds.</p>"


def orders(found):
    """Orders of convergence of all programs in one table."""
    rows = [[f'<a href="#{i["program"]}">{i["program"]}</a>', html.escape(r["claim"]), show(r["reference"]),
             show(r["measured"]), "yes" if r["pass"] else "NO"]
            for i in found for r in i["rows"] if r["kind"] == "order"]
    return parts.table("Orders of convergence", ["program", "claim", "expected", "found", "holds"], rows)


def by_module(found, folder):
    out = []
    for module in sorted({i["program"].split(".")[0] for i in found}):
        of = [section(i, folder) for i in found if i["program"].split(".")[0] == module]
        out.append(f'<section aria-labelledby="m-{module}"><h2 id="m-{module}">{html.escape(module_title(module))}'
                   f'</h2>{"".join(of)}</section>')
    return "".join(out)


def page_of(found, about, summary, folder):
    build = folder.resolve().parent
    named = [("failed", "Failed and not run", trouble(found)),
             ("moved", "Since the kept report", parts.compared(found)),
             ("systems", "Systems of the four documents", parts.systems(found)),
             ("overview", "All programs", overview(found)), ("orders", "Orders", orders(found)),
             ("fronts", "What accuracy costs", parts.fronts(build)),
             ("extremes", "Where it stops to hold", parts.extremes(build)),
             ("cost", "What a step costs", parts.cost(build))]
    links = "".join(f'<li><a href="#{name}">{title}</a></li>' for name, title, _ in named)
    links += "".join(f'<li><a href="#m-{m}">{m}</a></li>' for m in sorted({i["program"].split(".")[0] for i in found}))
    body = "".join(f'<section aria-labelledby="{name}"><h2 id="{name}">{title}</h2>{text}</section>'
                   for name, title, text in named)
    return (f'<!doctype html><html lang="en"><head><meta charset="utf-8"><title>Breakwater: verification</title>'
            f'<meta name="viewport" content="width=device-width"><style>{STYLE}</style></head><body>'
            f'<a class="skip" href="#main">to the report</a><header><h1>Breakwater: verification</h1><p>{summary}</p>'
            f'<p>commit {html.escape(about["commit"])}<br>{html.escape(about["machine"])}<br>{about["time"]}</p>'
            f'</header><nav aria-label="Parts of the report"><ul>{links}</ul></nav><main id="main">{body}'
            f'{by_module(found, folder)}</main><footer><p>Written by tools/report.py.</p></footer></body></html>\n')


def main():
    if len(sys.argv) not in (2, 3) or sys.argv[2:] not in ([], ["--keep"]):
        sys.exit(__doc__)
    folder = Path(sys.argv[1])
    found, about = collect(folder), provenance()
    by_state = {s: [i["program"] for i in found if i["state"] == s]
                for s in ("passed", "failed", "not run")}
    summary = ", ".join(f"{len(names)} {state}" for state, names in by_state.items())
    result = dict(about, passed=by_state["passed"], failed=by_state["failed"],
                  not_run=by_state["not run"], programs=found)
    (folder / "verification.json").write_text(json.dumps(result, indent=1) + "\n")
    (folder / "report.html").write_text(page_of(found, about, summary, folder))
    if sys.argv[2:]:
        parts.keep(found, about)
    print(f"verification: {summary}; see {folder}/report.html")
    for item in found:
        if item["state"] != "passed":
            print(f"  {item['state']}: {item['program']} {item['why'] or ''}".rstrip())
    # Only when all have run and passed is the exit code 0.
    return 0 if not by_state["failed"] and not by_state["not run"] else 1


if __name__ == "__main__":
    sys.exit(main())
