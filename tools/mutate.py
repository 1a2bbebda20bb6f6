#!/usr/bin/python3
"""Plants one bug at a time in modules/ and asks whether a test notices it.

usage: tools/mutate.py WORK TABLE COUNT [SEED]   draws mutants until TABLE (csv) has COUNT rows
       tools/mutate.py WORK TABLE survivors      tries those again that no unit test noticed

WORK is made: a clone of this repository's HEAD, built (release); the tree that you work in stays
as it is. The modules take turns, in each of them its sources, in each of those the kinds of changes,
so that all three are sampled evenly. A mutant that does not compile, or whose object is that of the
original to the byte, is put back and another one is drawn. The others meet the unit tests of their
module on one rank, those first whose names are nearest; survivors then meet them on several, the
module's quick validations, and the tests of whole runs."""
import csv
import hashlib
import os
import random
import re
import resource
import signal
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent.parent
HEAD = ["id", "file", "line", "kind", "before", "after", "verdict", "noticed by"]
SAME = slice(1, 6)  # the columns that say which mutant a row is
# Modules whose tests stand in the folder of another one, or whose claims have another name.
UNITS = {"pd_body": "solid", "pd_bond": "solid", "pd_contact": "solid", "solid_tools": "solid",
         "pd_state": "solid"}
CLAIMS = {"pd_body": "pd_bond", "pd_contact": "pd_bond", "solid": "pd_bond",
          "solid_tools": "pd_bond", "particles": "pd_bond", "shape": "coupler"}
WHOLE_RUNS = r"^(mpi|restart|robustness|example)\."
SECONDS = 120  # of a test program on a core; a mutant may hang

# kind, what is replaced, and by what.
RULES = [
    ("relation", r"(?<=[\w)\]] )(<=|>=|==|!=|<|>)(?= [\w(-])",
     {"<": "<=", "<=": "<", ">": ">=", ">=": ">", "==": "!=", "!=": "=="}),
    ("arithmetic", r"(?<=[\w)\]] )([+\-*/])(?= [\w(-])", {"+": "-", "-": "+", "*": "/", "/": "*"}),
    ("assignment", r"(?<= )(\+=|-=|\*=|/=)(?= )",
     {"+=": "-=", "-=": "+=", "*=": "/=", "/=": "*="}),
    ("logic", r"(?<= )(&&|\|\|)(?= )", {"&&": "||", "||": "&&"}),
    ("sign", r"(?<=[(\[=,?:] )-(?=[\w(])|(?<=[(\[])-(?=[\w(])|(?<=return )-(?=[\w(])", {"-": ""}),
    ("negation", r"!(?=[\w(])", {"!": ""}),
    ("integer", r"(?<![\w.])(\d+)(?![\w.])", lambda n: str(int(n) + 1)),
    ("constant", r"(?<![\w.])(\d+\.\d+(?:e-?\d+)?)(?![\w.])",
     lambda x: repr(float(x) * 1.25 if float(x) != 0.0 else 1.0)),
    ("minimum", r"\bf(?:min|max)(?=\()", {"fmin": "fmax", "fmax": "fmin"}),
]
TYPE = r"(?:unsigned|size_t|double|float|int|bool|char|long|bw_\w+|\w+_t)"
# A whole line that is one statement of a function and no declaration.
STATEMENT = re.compile(r"^ +(?!return|break|continue|goto|const |static |struct |enum |case |"
                       rf"BW_REQUIRE|else\b|{TYPE}\b[ *]+\w)[a-zA-Z_*(][^{{}}]*[=(][^{{}}]*;$")
# Up to the size of an array in a declaration: a larger one changes nothing.
DECLARED = re.compile(rf"\b(?:{TYPE}|const|restrict)\b[ *]+\w+(?:\[\w*\])*\[$")


def masked(text):
    """The text with comments, strings and preprocessor lines blanked; places stay as they are."""
    def blank(m):
        return re.sub(r"[^\n]", " ", m.group(0))
    text = re.sub(r'/\*.*?\*/|"(?:\\.|[^"\\])*"|\'(?:\\.|[^\'\\])*\'', blank, text, flags=re.S)
    return re.sub(r"^#(?:.*\\\n)*.*$", blank, text, flags=re.M)


def places(path):
    """All (offset, before, after, kind) of a source."""
    text = path.read_text()
    code, found = masked(text), []
    for kind, pattern, change in RULES:
        for m in re.finditer(pattern, code):
            line = code[code.rfind("\n", 0, m.start()) + 1:m.start()]
            if kind == "integer" and DECLARED.search(line):
                continue
            before = m.group(0)
            after = change(before) if callable(change) else change[before]
            found.append((m.start(), before, after, kind))
    at = 0
    for line in code.split("\n"):
        if STATEMENT.match(line) and line.count("(") == line.count(")"):
            found.append((at, text[at:at + len(line)], " ;", "deletion"))
        at += len(line) + 1
    return found


def limits():
    """A mutant may ask for all memory, or write for ever. Tests of signals want them as they are by
    default, not as nohup leaves them."""
    signal.signal(signal.SIGHUP, signal.SIG_DFL)
    resource.setrlimit(resource.RLIMIT_AS, (6 << 30, 6 << 30))
    resource.setrlimit(resource.RLIMIT_FSIZE, (1 << 30, 1 << 30))
    resource.setrlimit(resource.RLIMIT_CPU, (SECONDS, SECONDS + 1))


def run(work, command, seconds):
    """Output and exit code; what hangs is ended with all that it has started."""
    about = {"BW_SOURCE_DIR": str(work), "BW_BUILD_DIR": str(work / "build"),
             "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
    process = subprocess.Popen(command, cwd=work / "build", env={**os.environ, **about}, text=True,
                               errors="replace", stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                               preexec_fn=limits, start_new_session=True)
    try:
        return process.communicate(timeout=seconds)[0], process.returncode
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGKILL)
        return process.communicate()[0], 124


def build(work, targets):
    return run(work, ["ninja", *targets], 1800)[1] == 0


def tests(work, pattern, seconds):
    """The first test of ctest that fails; None when all pass."""
    out, code = run(work, ["ctest", "--stop-on-failure", "--timeout", str(seconds), "-R", pattern],
                    7200)
    failed = re.findall(r"^\s*\d+ - (\S+) \((.*)\)", out, flags=re.M)
    if failed:
        return f"{failed[0][0]} ({failed[0][1]})"
    return f"ctest ({code})" if code != 0 and "No tests were found" not in out else None


def programs(work, module):
    """The unit tests of a module."""
    folder = work / "tests/unit" / UNITS.get(module, module)
    return sorted(p.stem for p in folder.glob("test_*.c"))


def nearest_first(source, names):
    """The tests whose names share most words with the source's come first."""
    words = set(re.split(r"[_\W]", source.stem)) - {"bw", "pd", "ns", "solid"}
    return sorted(names, key=lambda name: (-len(words & set(name.split("_"))), name))


def digest(work, source):
    """Of what the compiler makes of a source; None for a header."""
    module = source.relative_to(work / "modules").parts[0]
    found = list((work / "build/CMakeFiles" / f"bw_{module}.dir").rglob(f"{source.name}.o"))
    return hashlib.sha256(found[0].read_bytes()).hexdigest() if found else None


def meets_units(work, source, module, original):
    """Verdict on the mutant that stands in the tree, and what noticed it."""
    for q, name in enumerate(nearest_first(source, programs(work, module))):
        if not build(work, [name]):
            return "does not build", ""
        if q == 0 and original is not None and digest(work, source) == original:
            return "same object", ""
        code = run(work, [f"bin/{name}"], 10 * SECONDS)[1]
        if code != 0:
            hangs = code in (124, -signal.SIGXCPU, -signal.SIGKILL)
            how = "hangs" if hangs else "signal" if code < 0 else "fails"
            return "unit", f"{name} ({how})"
    return "survives", ""


def meets_all(work, module):
    """The same for one that no unit test of its module has noticed on one rank."""
    unit, claim = UNITS.get(module, module), CLAIMS.get(module, module)
    build(work, programs(work, module))
    failed = tests(work, rf"^unit\.{unit}\..*np[2-9]$", 2 * SECONDS)
    if failed:
        return "unit", failed
    claims = (work / "validation" / claim).glob("*.c")
    build(work, sorted(f"val_{claim}_{p.stem}" for p in claims))
    failed = tests(work, rf"^validation\.{claim}\.", 4 * SECONDS)
    if failed:
        return "validation", failed
    build(work, [])
    failed = tests(work, WHOLE_RUNS, 4 * SECONDS)
    return ("whole run", failed) if failed else ("survives all", "")


def prepare(work):
    """The clone, built as it is; what is mutated later is compared with these objects."""
    if not (work / "build/build.ninja").exists():
        subprocess.run(["git", "clone", "--quiet", "--shared", str(HERE), str(work)], check=True)
        subprocess.run(["cmake", "--preset", "release"], cwd=work, check=True,
                       stdout=subprocess.DEVNULL)
    subprocess.run(["git", "checkout", "--quiet", "."], cwd=work, check=True)
    if not build(work, []):
        sys.exit(f"mutate.py: {work} does not build as it is")
    return {p: digest(work, p) for p in sorted((work / "modules").rglob("*.[ch]"))}


def sound(work):
    """Do all unit tests pass while nothing is changed? Else what they notice means nothing."""
    for source in sorted((work / "tests/unit").glob("*/test_*.c")):
        if run(work, [f"bin/{source.stem}"], 10 * SECONDS)[1] != 0:
            sys.exit(f"mutate.py: {source.stem} fails as it is")


def draw(sources, rng):
    """Sources in a random order, again and again, one of each module in a round, each with its places
    that were not drawn yet: the kinds in turn, those of a kind in a random order."""
    left = {}
    for p in sources:
        by_kind = {}
        for place in places(p):
            by_kind.setdefault(place[3], []).append(place)
        for some in by_kind.values():
            rng.shuffle(some)
        turns = [(q + rng.random(), place) for some in by_kind.values()
                 for q, place in enumerate(some)]
        left[p] = [place for _, place in sorted(turns, reverse=True)]
    rounds = {}
    for p in rng.sample(sources, len(sources)):
        rounds.setdefault(p.parent.name, []).append(p)
    while any(left.values()):
        for some in rng.sample(list(rounds.values()), len(rounds)):
            some.append(some.pop(0))
            if left[some[-1]]:
                yield some[-1], left[some[-1]]


def planted(path, place, text, judge):
    """The judgement on a source with one place changed; it is as it was afterwards."""
    at, before, after, _ = place
    path.write_text(text[:at] + after + text[at + len(before):])
    try:
        return judge()
    finally:
        path.write_text(text)


def sample(work, table, count, seed):
    original = prepare(work)
    if not table.exists():
        sound(work)
    done = list(csv.DictReader(table.open())) if table.exists() else []
    known = {tuple(r[k] for k in HEAD[SAME]) for r in done}
    with table.open("a", newline="") as file:
        out = csv.DictWriter(file, HEAD)
        if not done:
            out.writeheader()
        for path, left in draw(list(original), random.Random(seed)):
            text, module = path.read_text(), path.relative_to(work / "modules").parts[0]
            # Until one compiles to something else.
            while left and len(done) < count:
                place = left.pop()
                line = str(text.count("\n", 0, place[0]) + 1)
                row = dict(zip(HEAD, (len(done) + 1, str(path.relative_to(work)), line, place[3],
                                      place[1].strip(), place[2].strip())))
                if tuple(row[k] for k in HEAD[SAME]) in known:
                    break
                row["verdict"], row["noticed by"] = planted(
                    path, place, text, lambda: meets_units(work, path, module, original[path]))
                if row["verdict"] in ("does not build", "same object"):
                    continue
                done.append(row)
                out.writerow(row)
                file.flush()
                print(*(row[k] for k in HEAD), sep="  ", flush=True)
                break
            if len(done) >= count:
                return


def place_of(row, path, text):
    """Where a row of the table stands in its source."""
    return next(p for p in places(path)
                if [p[3], p[1].strip(), p[2].strip()] == [row[k] for k in HEAD[3:6]] and
                text.count("\n", 0, p[0]) + 1 == int(row["line"]))


def survivors(work, table):
    prepare(work)
    rows = list(csv.DictReader(table.open()))
    for row in [r for r in rows if r["verdict"] == "survives"]:
        path = work / row["file"]
        text, module = path.read_text(), path.relative_to(work / "modules").parts[0]
        row["verdict"], row["noticed by"] = planted(path, place_of(row, path, text), text,
                                                    lambda: meets_all(work, module))
        print(*(row[k] for k in HEAD), sep="  ", flush=True)
        with table.open("w", newline="") as file:
            out = csv.DictWriter(file, HEAD)
            out.writeheader()
            out.writerows(rows)


def main():
    if len(sys.argv) < 4:
        sys.exit(__doc__)
    work, table = Path(sys.argv[1]).resolve(), Path(sys.argv[2])
    if sys.argv[3] == "survivors":
        return survivors(work, table)
    return sample(work, table, int(sys.argv[3]), int(sys.argv[4]) if len(sys.argv) > 4 else 1)


main()
