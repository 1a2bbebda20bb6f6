#!/usr/bin/python3
"""Who includes whom: a table of the modules, read from their #include lines.

usage: who_includes_whom.py [PAGE [--write]]
Rows include columns. Modules stand in the order of tests/lint/modules.txt, in which each may include
only those above it: so nobody includes in a circle, and the program fails where somebody does.
With a PAGE (docs/architecture.md) it compares the table there with the sources and fails where they
differ, or with --write puts the present one in its place; without one it prints the table."""
import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
INCLUDE = re.compile(r'^ *# *include +"([^"]+)"', re.MULTILINE)


def arrows():
    """{module: modules whose headers its files include}"""
    files = {}
    for folder in sorted((ROOT / "modules").iterdir()):
        files[folder.name] = sorted(folder.glob("*.[ch]"))
    owner = {f.name: module for module, all_of in files.items() for f in all_of if f.suffix == ".h"}
    found = {}
    for module, all_of in files.items():
        names = {Path(name).name for f in all_of for name in INCLUDE.findall(f.read_text())}
        found[module] = {owner[name] for name in names if name in owner} - {module}
    return found


def order(known):
    """The modules as tests/lint/modules.txt lists them: each after all that it includes."""
    rows = (ROOT / "tests/lint/modules.txt").read_text().splitlines()
    modules = [row.split("|")[0].strip() for row in rows if "|" in row and not row.startswith("#")]
    if sorted(modules) != sorted(known):
        sys.exit("tests/lint/modules.txt does not have the modules that there are")
    for q, module in enumerate(modules):
        later = known[module] - set(modules[:q])
        if later:
            sys.exit(f"{module} includes what stands below it in tests/lint/modules.txt: {later}")
    return modules


def table(known):
    modules = order(known)
    wide = max(map(len, modules))
    lines = [" " * (wide + 3) + "".join(f"{q + 1:3d}" for q in range(len(modules)))]
    for q, module in enumerate(modules):
        marks = "".join("  x" if m in known[module] else "  ." for m in modules[:q])
        lines.append(f"{module:<{wide}} {q + 1:2d}{marks}")
    return lines


def main():
    lines = table(arrows())
    if len(sys.argv) < 2:
        print("\n".join(lines))
        return 0
    page = Path(sys.argv[1])
    text, now = page.read_text(), "\n".join("    " + line for line in lines) + "\n"
    if now in text:
        return 0
    if "--write" in sys.argv[2:]:
        page.write_text(re.sub(r"^     [ 0-9]+\n(    \w+ +\d+(  [x.])*\n)+", now, text, flags=re.MULTILINE))
        return 0
    print(f"{page}: the table of who includes whom is not that of the sources; --write mends it:")
    print(now, end="")
    return 1


sys.exit(main())
