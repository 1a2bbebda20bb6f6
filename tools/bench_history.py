"""Adds a benchmark's times to build/bench/history.jsonl, and compares them with earlier runs.

usage: bench_history.py build/bench/NAME.json

A line of the history is a run: benchmark, commit, machine, time, and its rows. Only runs of the same
machine are compared: its name, its processor, its number of cores. A row is printed when it lies
outside of all earlier ones by more than their spread, and 5 % at least: what a shared machine does to a
time by itself is no news.
"""
import datetime
import json
import os
import platform
import statistics
import subprocess
import sys

LEAST = 0.05  # a smaller change is not told


def machine():
    model = platform.processor()
    if os.path.exists("/proc/cpuinfo"):
        with open("/proc/cpuinfo") as f:
            model = next((s.split(":")[1].strip() for s in f if s.startswith("model name")), model)
    return f"{platform.node()}, {model}, {os.cpu_count()} cores"


def commit():
    """The short name of the commit, with + where the tree has changes."""
    done = subprocess.run(["git", "describe", "--always", "--dirty=+"], capture_output=True, text=True)
    return done.stdout.strip() or "no repository"


def earlier_runs(path, benchmark, here):
    if not os.path.exists(path):
        return []
    with open(path) as f:
        runs = [json.loads(line) for line in f if line.strip()]
    return [r for r in runs if r["benchmark"] == benchmark and r["machine"] == here]


def compare(key, value, runs):
    """A line about a value that left the range of its earlier ones; None: nothing to tell."""
    before = [r["rows"][key] for r in runs if r["rows"].get(key)]
    if not before or not value:
        return None
    middle, spread = statistics.median(before), max(before) - min(before)
    if abs(value - middle) <= max(LEAST * abs(middle), spread):
        return None
    return f"{key}: {value:.4g}, {value / middle:.2f} of the median of {len(before)} earlier runs"


def main(path):
    with open(path) as f:
        rows = {f"{r['case']} {r['quantity']}": r["value"] for r in json.load(f)}
    history = os.path.join(os.path.dirname(path), "history.jsonl")
    benchmark = os.path.basename(path).removesuffix(".json")
    run = {"benchmark": benchmark, "commit": commit(), "machine": machine(),
           "time": datetime.datetime.now().isoformat(timespec="seconds"), "rows": rows}
    runs = earlier_runs(history, benchmark, run["machine"])
    for key, value in rows.items():
        news = compare(key, value, runs)
        if news:
            print(f"changed: {news}")
    if runs:
        print(f"compared with {len(runs)} earlier runs on this machine, the last of {runs[-1]['commit']}")
    with open(history, "a") as f:
        f.write(json.dumps(run) + "\n")


if __name__ == "__main__":
    main(sys.argv[1])
