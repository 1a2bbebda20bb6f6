"""Parts of the report beside the claims: what accuracy costs, where it stops to hold, what a step costs,
the systems of the four documents, and what has changed since the report that is kept."""
import collections
import csv
import html
import json
import math
from pathlib import Path

from report_charts import chart, finite

SOURCE = Path(__file__).resolve().parent.parent
KEPT = SOURCE / "docs" / "verification" / "report" / "kept.json"
NOISE = 0.05  # of a tolerance: a claim whose error moves by less has not moved


def show(x):
    return "" if x is None else f"{x:.6g}" if finite(x) else html.escape(str(x))


def table(caption, head, rows):
    """Rows of cells that are HTML already; the first cell names its row."""
    cells = "".join(f'<th scope="col">{h}</th>' for h in head)
    body = "".join(f'<tr><th scope="row">{r[0]}</th>' + "".join(f"<td>{c}</td>" for c in r[1:]) + "</tr>"
                   for r in rows)
    return f"<table><caption>{caption}</caption><thead><tr>{cells}</tr></thead><tbody>{body}</tbody></table>"


def newest(made, kept):
    """The file that ./run has made here, or the one that is kept, and a word which."""
    for path, word in ((made, "measured here"), (kept, "kept")):
        if path.is_file():
            try:
                return json.loads(path.read_text()), word
            except ValueError:
                return None, f"{path.name} breaks off"
    return None, "not measured"


# ---- fronts -------------------------------------------------------------------------------------

def fronts(build):
    found, word = newest(build / "trade" / "trade.json", SOURCE / "docs/verification/trade/trade.json")
    if found is None:
        return f"<p>{word}: <code>./run trade</code></p>"
    out = [f"<p>Error against processor time, {word}, by {html.escape(found.get('program', ''))}: "
           "one curve for each scene with an answer from elsewhere.</p>"]
    for knob, scenes in found["points"].items():
        curves = [(scene, sorted((p["core_seconds"], abs(p["error"])) for p in points.values()
                                 if p.get("error")), False) for scene, points in scenes.items()]
        out.append(chart(knob, "core-seconds", [c for c in curves if c[1]], log_x=True, log_y=True))
    return held_out(build) + "".join(out)


def held_out(build):
    """Scenes that no promise of --check was set by."""
    found, word = newest(build / "trade" / "held_out.json", SOURCE / "docs/verification/trade/held_out.json")
    rows = [[html.escape(name), html.escape(p["source"]), f"{100 * p['promise']:.2g} %", f"{100 * p.get('error', math.nan):+.2g} %",
             '<span class="passed">yes</span>' if p["holds"] else '<span class="failed">NO</span>']
            for name, p in (found or {}).items()]
    return table(f"What --check promises, on scenes that it was not set by ({word})",
                 ["scene", "reference", "promised", "error", "holds"], rows)


# ---- extremes -----------------------------------------------------------------------------------

COLOURS = {"holds": "#2e8b57", "told": "#b9770e", "refused": "#1f5fa8", "ends": "#8e44ad", "dear": "#777777",
           "WRONG": "#c0392b", "LATE": "#d6458f", "CRASHES": "#000000"}


def map_of(found):
    """A line for each row, a dot for each run: how many decades from the harmless value, and what was seen."""
    names = list(found["rows"])
    w, left, step = 1000, 330, 17
    h = 50 + step * len(names)
    reach = max(abs(math.log10(p["x"] / found["rows"][n]["inside"])) for n in names
                for p in found["points"][n])
    at = lambda d: left + (w - left - 20) * (d + reach) / (2 * reach or 1)
    out = [f'<svg role="img" aria-label="map of where scenes hold" width="{w}" height="{h}" '
           f'viewBox="0 0 {w} {h}">']
    x = left
    for name, colour in COLOURS.items():
        out.append(f'<circle cx="{x}" cy="12" r="4" fill="{colour}"/><text x="{x + 8}" y="16">{name}</text>')
        x += 78
    for q, name in enumerate(names):
        y = 34 + step * q
        out.append(f'<text x="{left - 8}" y="{y + 4}" text-anchor="end">{html.escape(name)}</text>'
                   f'<line x1="{left}" x2="{w - 20}" y1="{y}" y2="{y}" class="g"/>')
        out += [f'<circle cx="{at(math.log10(p["x"] / found["rows"][name]["inside"])):.1f}" cy="{y}" r="4" '
                f'fill="{COLOURS[p["class"]]}"><title>{html.escape(name)}: {p["x"]:.4g} {p["class"]}</title></circle>'
                for p in found["points"][name]]
    out.append(f'<text x="{(left + w) / 2}" y="{h - 4}" text-anchor="middle">decades from the harmless value, '
               f"-{reach:.0f} to {reach:.0f}</text></svg>")
    return "".join(out)


def extremes(build):
    found, word = newest(build / "extremes" / "extremes.json",
                         SOURCE / "docs/verification/extremes/extremes.json")
    if found is None:
        return f"<p>{word}: <code>./run extremes</code></p>"
    rows = []
    for name, r in found["rows"].items():
        limit = "does not hold" if r["limit"] is None else \
            f"{'all of it, ' if r['reached'] else ''}to {show(r['limit'])}"
        rows.append([html.escape(name), html.escape(r["what"]), f"{show(r['inside'])} to {show(r['outside'])}",
                     f"{html.escape(r['claim'])}, to {100 * r['tolerance']:.3g} %", limit,
                     ", ".join(r["beyond"]) or "-", show(r["margin"] and round(r["margin"], 2)),
                     f'<span class="failed">{len(r["faults"])}</span>' if r["faults"] else "0"])
    return (f"<p>{word.capitalize()}, by {html.escape(found.get('program', ''))}.</p>{map_of(found)}"
            + table("Extremes", ["row", "number", "from, to", "holds", "it holds", "beyond",
                                 "limit over default", "faults"], rows))


# ---- cost ---------------------------------------------------------------------------------------

def cost(build):
    rows = []
    for path in sorted((build / "bench").glob("*.json")):
        try:
            made = json.loads(path.read_text())
        except ValueError:
            continue
        for r in made if isinstance(made, list) else []:
            rows.append([f"{path.stem}: {html.escape(str(r.get('case', '')))}", html.escape(str(r.get("quantity", ""))),
                         f"{show(r.get('value'))} {html.escape(str(r.get('unit', '')))}",
                         html.escape(str(r.get("rival") or "")), show(r.get("ratio_to_rival"))])
    if not rows:
        return "<p>Not measured here: <code>./run bench</code>. README.md has the numbers of quiet cores.</p>"
    return table("What was measured on this machine", ["benchmark", "quantity", "value", "rival", "over the rival"], rows)


# ---- the documents' systems ---------------------------------------------------------------------

def systems(found):
    """docs/systems.csv: document, system, programs (of validation/) that check it, where it is kept, what is open."""
    states = {item["program"]: item["state"] for item in found}
    with open(SOURCE / "docs" / "systems.csv", newline="") as file:
        given = list(csv.DictReader(file))
    rows = []
    for r in given:
        names = r["programs"].split()
        seen = [states.get(n, "no such program") for n in names]
        links = ", ".join(f'<a href="#{n}">{n}</a>: <span class="{s.split()[0]}">{s}</span>'
                          for n, s in zip(names, seen))
        rows.append([html.escape(r["document"]), html.escape(r["system"]), links or "-", html.escape(r["kept"]) or "-",
                     html.escape(r["open"]) or "-"])
    return table("Systems of POROUS, FSI, ADAPT and ULPH (docs/sources.md names them)",
                 ["document", "system", "checked by", "kept results", "what is open"], rows)


# ---- since the kept report ----------------------------------------------------------------------

def claims(found):
    """{(program, what): (error, tolerance, pass)} of what has a tolerance."""
    known = {"measured", "reference", "error", "tolerance", "kind", "source", "pass"}
    all_of, seen = {}, collections.Counter()
    for item in found:
        for r in item["rows"]:
            if not finite(r["tolerance"]) or not finite(r["error"]):
                continue
            what = "; ".join(str(v) if k in ("claim", "quantity") else f"{k} {show(v)}"
                             for k, v in r.items() if k not in known)
            same = seen[item["program"], what]
            seen[item["program"], what] += 1
            all_of[item["program"], what + (f" #{same}" if same else "")] = (r["error"], r["tolerance"], r["pass"])
    return all_of


def keep(found, about):
    """Write the report that later ones are compared with."""
    kept = {}
    for (program, what), (error, tolerance, _) in claims(found).items():
        kept.setdefault(program, {})[what] = [float(f"{error:.4g}"), float(f"{tolerance:.4g}")]
    KEPT.parent.mkdir(parents=True, exist_ok=True)
    KEPT.write_text(json.dumps(dict(about, claims=kept), indent=0) + "\n")


def difference(found):
    """What is worse, better, new and gone since the kept report; None where none is kept."""
    if not KEPT.is_file():
        return None
    kept = json.loads(KEPT.read_text())
    now, before = claims(found), {(p, w): v for p, rows in kept["claims"].items() for w, v in rows.items()}
    ran = {item["program"] for item in found if item["rows"]}
    change = {"worse": [], "better": [], "new": [k for k in now if k not in before],
              "gone": [k for k in before if k[0] in ran and k not in now],
              "not run": [k for k in before if k[0] not in ran]}
    for key in now.keys() & before.keys():
        (error, tolerance, _), old = now[key], before[key][0]
        moved = abs(error) - abs(old)
        # Errors of round-off move by themselves: what is far within its tolerance is left out, too.
        if abs(moved) > NOISE * tolerance:
            change["worse" if moved > 0 else "better"].append((*key, old, error, tolerance))
    return kept, {k: sorted(v) for k, v in change.items()}


def compared(found):
    result = difference(found)
    if result is None:
        return "<p>No report is kept to compare with.</p>"
    kept, change = result
    rows = [[html.escape(p), html.escape(w), f'<span class="{"failed" if word == "worse" else "passed"}">{word}</span>',
             show(old), show(error), show(tolerance)]
            for word in ("worse", "better") for p, w, old, error, tolerance in change[word]]
    counts = ", ".join(f"{len(change[word])} {word}" for word in change)
    text = (f"<p>Beside the report of {html.escape(kept['time'][:10])}, commit {html.escape(kept['commit'])}: {counts}. "
            f"An error has moved when it did by more than {100 * NOISE:.0f} % of its tolerance.</p>")
    return text + (table("What has moved", ["program", "claim", "", "error then", "error now", "tolerance"], rows)
                   if rows else "")
