"""The commands in READMEs, pages, heads of cases and ./run --help, each run with --check.

usage: examples.py SOURCE BUILD
Pages on adding something (docs/add-a-*.md) are run as a whole by tests/lint/pages.sh.
"""
import glob
import os
import re
import shlex
import subprocess
import sys

source, build = sys.argv[1:3]
os.chdir(source)
cases = sorted(os.path.basename(os.path.dirname(f)) for f in glob.glob("cases/*/*.yaml"))
programs = {c for c in cases if os.access(f"{build}/bin/{c}", os.X_OK)}
PLACEHOLDER = re.compile(r"[A-Z]{2,}|\.\.\.|\$")  # FILE.yaml, DIR, ...


def texts():
    """Name and text of everything that a user reads."""
    names = ["README.md", "CONTRIBUTING.md", "run"]
    for pattern in ("docs/*.md", "cases/*/README.md", "cases/*/*.c", "cases/*/*.h",
                    "cases/*/*.yaml", "modules/*/README.md"):
        names += glob.glob(pattern)
    for name in sorted(names):
        if not os.path.basename(name).startswith("add-a-"):
            with open(name, encoding="utf-8") as f:
                yield name, f.read()


def command_of(line):
    """The program and what follows it, of a line with a command; None: there is none."""
    m = re.search(r"(?:build/bin/|\./run )(\w+)([^`|#]*)", line)
    if m is None or m.group(1) not in programs:
        return None
    try:
        words = shlex.split(m.group(2), comments=True)
    except ValueError:
        return None
    return m.group(1), words


def runnable(program, words):
    """The words as a check: file and --set alone; None where a word is left to the reader."""
    keep, at = [], 0
    while at < len(words) and (words[at].startswith("--") or words[at].endswith(".yaml")):
        if words[at] == "--set" and at + 1 < len(words):
            keep += words[at:at + 2]
        elif words[at].endswith(".yaml"):
            keep.append(words[at])
        at += 2 if words[at] in ("--set", "--out", "--restart", "--stop-after") else 1
    if not any(w.endswith(".yaml") for w in keep):
        keep.insert(0, f"cases/{program}/{program}.yaml")
    return None if any(PLACEHOLDER.search(w) for w in keep) else keep


def main():
    seen, failed = {}, 0
    for name, text in texts():
        # Case files that are named have to be there.
        for path in re.findall(r"\bcases/[\w/]+\.yaml", text):
            if not os.path.exists(path):
                print(f"FAIL {name}: there is no {path}")
                failed += 1
        # Commands, and settings of a case in its own text.
        for line in text.splitlines():
            found = command_of(line)
            words = runnable(*found) if found else None
            if words is not None:
                seen[(found[0], *words)] = name
            own = name.split("/")[1] if name.startswith("cases/") else None
            if own in programs and found is None:
                for key in re.findall(r"--set ([\w.]+=[^\s`]+)", line):
                    if not PLACEHOLDER.search(key):
                        value = shlex.split(key)[0]
                        seen[(own, f"cases/{own}/{own}.yaml", "--set", value)] = name
    for (program, *words), name in sorted(seen.items()):
        done = subprocess.run([f"{build}/bin/{program}", *words, "--check", "--quiet"],
                              capture_output=True, text=True, check=False)
        shown = f"{program} {' '.join(words)}"
        if done.returncode != 0:
            print(f"FAIL {name}: {shown}: exit {done.returncode}: {done.stderr.strip()}")
            failed += 1
        else:
            print(f"ok   {name}: {shown}")
    if len(seen) < 10:
        print(f"FAIL: only {len(seen)} commands were found")
        failed += 1
    return 1 if failed else 0


sys.exit(main())
