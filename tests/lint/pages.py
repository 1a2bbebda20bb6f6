#!/usr/bin/python3
"""Do what the pages docs/add-*.md say, to a copy of the tree: usage: pages.py SOURCE WORK [--apply] [PAGE ...]

Every block of code on these pages stands under one line that says what it is:
  <!-- part of: FILE -->               the block is the text of these lines of FILE
  <!-- new file: FILE -->              the block is a whole new file; a further block goes on with it
  <!-- in FILE, before: LINE -->       the block goes before the one line of FILE that begins so,
  <!-- in FILE, after: LINE -->        behind it, or takes its place
  <!-- in FILE, instead of: LINE -->
  <!-- run -->                         commands, in the root of the tree
  <!-- prints -->                      lines that the last commands print, among others
and by themselves <!-- copy: FROM to TO --> copies a folder, <!-- all of: FILE --> says that the parts of
FILE shown so far are all of it but for empty lines. First all pages are applied to the copy of the
tree in WORK, which has to be there; then, unless --apply is given, what they run is run, page by page.
"""
import pathlib
import re
import shutil
import subprocess
import sys

WHAT = re.compile(r"<!-- *(part of|all of|new file|copy): *(.+?) *-->|<!-- *in (\S+), (before|after|instead of): (.+?) *-->|"
                  r"<!-- *(run|prints) *-->")


class Wrong(Exception):
    pass


def blocks_of(text):
    """(what, argument, lines) of every directive; None for what: a block that says nothing of itself"""
    found, pending, inside, lines = [], None, None, []
    for number, line in enumerate(text.split("\n"), 1):
        if inside is not None:
            if line.strip() == "```":
                found.append((inside[0], inside[1], lines, inside[2]))
                inside, lines = None, []
            else:
                lines.append(line)
            continue
        if line.lstrip().startswith("```"):
            if line != line.lstrip():
                raise Wrong(f"line {number}: a block of code that is set in; begin it at the margin")
            if pending is None:
                raise Wrong(f"line {number}: a block of code that does not say what it is")
            inside, pending = (*pending, number), None
            continue
        match = WHAT.fullmatch(line.strip())
        if match:
            if pending is not None:
                raise Wrong(f"line {number}: the directive before has no block of code")
            a = match.groups()
            if a[0] in ("copy", "all of"):
                found.append((a[0], a[1], [], number))
            else:
                pending = (a[0], a[1]) if a[0] else (a[3], (a[2], a[4])) if a[2] else (a[5], None)
        elif line.strip().startswith("<!--"):
            raise Wrong(f"line {number}: not understood: {line.strip()}")
        elif line.strip():
            pending = None
    if inside is not None:
        raise Wrong("the last block of code does not end")
    return found


def one_line(lines, begin, where):
    hits = [i for i, line in enumerate(lines) if line.strip().startswith(begin)]
    if len(hits) != 1:
        raise Wrong(f"{where}: {len(hits)} lines begin with: {begin}")
    return hits[0]


def contains(lines, part):
    n = len(part)
    return any(lines[i:i + n] == part for i in range(len(lines) - n + 1))


def apply(tree, blocks):
    made, shown = set(), {}
    for what, argument, lines, number in blocks:
        where = f"line {number}"
        if what == "part of":
            if not contains((tree / argument).read_text().split("\n"), lines):
                raise Wrong(f"{where}: these lines are not in {argument}")
            shown.setdefault(argument, []).extend(s for s in lines if s.strip())
        elif what == "all of":
            if shown.get(argument) != [s for s in (tree / argument).read_text().split("\n") if s.strip()]:
                raise Wrong(f"{where}: the parts shown are not all of {argument}")
        elif what == "copy":
            source, target = (s.strip() for s in argument.split(" to "))
            shutil.copytree(tree / source, tree / target, dirs_exist_ok=True)
        elif what == "new file":
            path = tree / argument
            path.parent.mkdir(parents=True, exist_ok=True)
            if argument not in made and path.exists():
                raise Wrong(f"{where}: {argument} is there already")
            with open(path, "a", encoding="utf-8") as out:
                out.write("\n".join(lines) + "\n")
            made.add(argument)
        elif what in ("before", "after", "instead of"):
            path = tree / argument[0]
            if not path.exists():
                raise Wrong(f"{where}: there is no {argument[0]}")
            text = path.read_text().split("\n")
            at = one_line(text, argument[1], f"{where}: {argument[0]}")
            text[at + (what == "after"):at + (what != "before")] = lines
            path.write_text("\n".join(text))


def run(tree, blocks):
    said = ""
    for what, _, lines, number in blocks:
        if what == "run":
            done = subprocess.run(["sh", "-e", "-c", "\n".join(lines)], cwd=tree, text=True,
                                  stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
            said = done.stdout
            if done.returncode != 0:
                raise Wrong(f"line {number}: ended with {done.returncode}:\n{said[-3000:]}")
        elif what == "prints":
            missing = [s for s in lines if s.strip() and s.strip() not in said]
            if missing:
                raise Wrong(f"line {number}: not printed: {missing[0]}\nbut:\n{said[-3000:]}")


def check_itself(work):
    """Pages that are wrong have to be noticed, else the silence of this program means nothing."""
    tree = work / "planted"
    tree.mkdir(parents=True)
    (tree / "a.c").write_text("int a;\nint b;\n")
    planted = {"nothing said": "```c\nint a;\n```\n",
               "other text": "<!-- part of: a.c -->\n```c\nint c;\n```\n",
               "not all": "<!-- part of: a.c -->\n```c\nint a;\n```\n<!-- all of: a.c -->\n",
               "no such line": "<!-- in a.c, after: int c -->\n```c\nint d;\n```\n",
               "two such lines": "<!-- in a.c, after: int -->\n```c\nint d;\n```\n",
               "fails": "<!-- run -->\n```sh\nfalse\n```\n",
               "prints something else": "<!-- run -->\n```sh\necho a\n```\n<!-- prints -->\n```\nb\n```\n"}
    for name, text in planted.items():
        try:
            blocks = blocks_of(text)
            apply(tree, blocks)
            run(tree, blocks)
        except Wrong:
            continue
        raise SystemExit(f"a planted page was not noticed: {name}")
    shutil.rmtree(tree)


def main():
    source, work = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
    check_itself(work)
    tree = work / "tree"
    names = [name for name in sys.argv[3:] if name != "--apply"]
    pages = [source / "docs" / (name + ".md") for name in names] or \
        sorted((source / "docs").glob("add-*.md"))
    bad, read = [], {}
    for page in pages:
        try:
            read[page] = blocks_of(page.read_text())
            apply(tree, read[page])
        except (Wrong, OSError) as wrong:
            bad.append(f"docs/{page.name}: {wrong}")
            read.pop(page, None)
    for page, blocks in read.items():
        try:
            if "--apply" not in sys.argv:
                run(tree, blocks)
            did = "fits the tree" if "--apply" in sys.argv else "done as it says"
            print(f"docs/{page.name}: {len(blocks)} blocks, {did}")
        except Wrong as wrong:
            bad.append(f"docs/{page.name}: {wrong}")
    print("\n".join(bad))
    return 1 if bad else 0


sys.exit(main())
