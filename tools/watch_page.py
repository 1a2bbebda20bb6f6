#!/usr/bin/python3
"""FOLDER/watch.html: the history of a run as a page, rewritten while the run goes on.

usage: watch_page.py FOLDER [--while PID] [--every SECONDS]
A file for any browser, without a server and without scripts: curves are drawn in it, and it asks the
browser to read it again. With --while it is written again until that process has ended, and then a
last time without asking. Without: once.
"""
import argparse
import html
import math
import os
import time
from pathlib import Path

import history

WIDTH, HEIGHT, LEFT, BOTTOM = 520, 220, 78, 26
CURVES = ["#000000", "#1f5fa8", "#c03020", "#4a8a3a", "#8050a0", "#a07020"]
DASHES = ["", "7 3", "2 3", "9 3 2 3", "4 2", "1 2"]


def thin(points, most=400):
    """At most about so many points; the last one stays."""
    step = max(1, len(points) // most)
    kept = points[::step]
    return kept if not points or kept[-1] == points[-1] else kept + points[-1:]


def span(values):
    low, high = min(values), max(values)
    room = 0.05 * (high - low) or 0.05 * abs(high) or 1.0
    return low - room, high + room


def curve(points, k, to_x, to_y):
    """A line for each stretch without gaps (a value that was not measured is one)."""
    parts, part = [], []
    for t, x in points + [(math.nan, math.nan)]:
        if math.isfinite(x):
            part.append(f"{to_x(t):.1f},{to_y(x):.1f}")
        elif part:
            parts.append(part)
            part = []
    look = f'fill="none" stroke="{CURVES[k % 6]}" stroke-width="1.6"'
    dash = f' stroke-dasharray="{DASHES[k % 6]}"' if DASHES[k % 6] else ""
    return "".join(f'<polyline {look}{dash} points="{" ".join(p)}"/>' for p in parts)


def panel(one, head, rows):
    """One panel as a figure of HTML."""
    title, unit, curves = one
    values = [row[q] for row in rows for _, q in curves if math.isfinite(row[q])]
    caption = f"{html.escape(title)} [{html.escape(unit)}]"
    if not values or len(rows) < 2:
        return f"<figure><figcaption>{caption}</figcaption><p>nothing yet</p></figure>"
    (low, high), first, last = span(values), rows[0][0], rows[-1][0]

    def to_x(t):
        return LEFT + (t - first) / (last - first) * (WIDTH - LEFT - 8)

    def to_y(x):
        return 8 + (high - x) / (high - low) * (HEIGHT - BOTTOM - 8)

    lines = "".join(curve(thin([(row[0], row[q]) for row in rows]), k, to_x, to_y)
                    for k, (_, q) in enumerate(curves))
    marks = "".join(
        f'<line x1="{LEFT}" x2="{WIDTH - 8}" y1="{to_y(x):.1f}" y2="{to_y(x):.1f}" stroke="#ddd"/>'
        f'<text x="{LEFT - 6}" y="{to_y(x) + 4:.1f}" text-anchor="end">{x:.4g}</text>'
        for x in (low + (high - low) * f for f in (0.05, 0.5, 0.95)))
    marks += "".join(
        f'<text x="{to_x(t):.1f}" y="{HEIGHT - 8}" text-anchor="{side}">{t:.4g}</text>'
        for t, side in ((first, "start"), (last, "end")))
    now = ", ".join(f'<span style="color:{CURVES[k % 6]}">{html.escape(label)} '
                    f"{rows[-1][q]:.5g}</span>" for k, (label, q) in enumerate(curves))
    return (f'<figure><figcaption>{caption}: {now}</figcaption><svg width="{WIDTH}" '
            f'height="{HEIGHT}" viewBox="0 0 {WIDTH} {HEIGHT}">{marks}{lines}</svg></figure>')


def name_of(folder):
    """The scene's own name, from run.yaml."""
    try:
        for line in (folder / "run.yaml").read_text().splitlines():
            if line.startswith("name: "):
                return line[6:].strip().strip('"')
    except OSError:
        pass
    return folder.name


def page(folder, every):
    """The page; every: seconds until the browser reads it again, None: it does not."""
    try:
        head, rows = history.read(folder / "history.csv")
    except OSError:
        head, rows = [], []
    name = html.escape(name_of(folder))
    again = f'<meta http-equiv="refresh" content="{every:g}">' if every else ""
    state = f"running, read again every {every:g} s" if every else "not running"
    at = f"{len(rows)} rows, time {rows[-1][0]:.6g}" if rows else "no rows yet"
    figures = "\n".join(panel(one, head, rows) for one in history.panels(head))
    return ('<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8">' + again +
            f"<title>{name}</title><style>body{{font:14px sans-serif;margin:1em}}"
            "figure{display:inline-block;margin:0 1em 1em 0}svg{background:#fff}"
            "text{font-size:11px}figcaption{max-width:520px}</style></head>"
            f"<body><h1>{name}</h1><p>{state}; {at}; folder {html.escape(str(folder))}</p>\n"
            f"{figures}\n</body></html>\n")


def write(folder, every):
    """Beside and renamed: a browser never sees half of it."""
    if not folder.is_dir():
        return
    part = folder / "watch.html.part"
    part.write_text(page(folder, every))
    part.replace(folder / "watch.html")


def alive(pid):
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    except PermissionError:
        pass
    return True


def main():
    ask = argparse.ArgumentParser(usage=__doc__)
    ask.add_argument("folder", type=Path)
    ask.add_argument("--while", dest="pid", type=int)
    ask.add_argument("--every", type=float, default=2.0)
    asked = ask.parse_args()
    while asked.pid is not None and alive(asked.pid):
        write(asked.folder, asked.every)
        time.sleep(asked.every)
    write(asked.folder, None)


main()
