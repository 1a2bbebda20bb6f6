#!/bin/sh
# The guide as a static site: every link of every page leads to a file of the site, elements close,
# no mark of Markdown is left over; a link that leads nowhere is refused.
# usage: guide_site.sh SOURCE BUILD
set -eu
source=$1 out=$2/test_guide_site
rm -rf "$out" && mkdir -p "$out"
/usr/bin/python3 "$source/tools/build_guide.py" "$source" "$out/site"
/usr/bin/python3 - "$out/site" "$source" <<'END'
import os, re, sys
from html.parser import HTMLParser
from pathlib import Path

class Page(HTMLParser):
    def __init__(self, path):
        super().__init__()
        self.path, self.open, self.links, self.ids, self.text = path, [], [], set(), []
    def handle_starttag(self, tag, attributes):
        given = dict(attributes)
        self.links += [given[k] for k in ("href", "src") if k in given]
        if "id" in given:
            self.ids.add(given["id"])
        if tag not in ("meta", "img"):
            self.open.append(tag)
    def handle_endtag(self, tag):
        assert self.open and self.open.pop() == tag, f"{self.path}: </{tag}> closes another element"
    def handle_data(self, data):
        if not {"pre", "code", "style"} & set(self.open):
            self.text.append(data)

pages = {}
for path in Path(sys.argv[1]).rglob("*.html"):
    pages[path.resolve()] = page = Page(path)
    page.feed(path.read_text())
    assert not page.open, f"{path}: {page.open} stay open"
    left = re.search(r"\]\(|```|\*\*|\0", " ".join(page.text))
    assert left is None, f"{path}: {left[0]} is left over"
links = 0
for path, page in pages.items():
    for link in page.links:
        if re.match(r"[a-z]+:", link):
            continue
        to, _, anchor = link.partition("#")
        target = (path.parent / to).resolve() if to else path
        assert target.is_file(), f"{path}: {link} leads nowhere"
        assert not anchor or anchor in pages[target].ids, f"{path}: {link} has no such place"
        links += 1
assert len(pages) >= 20 and links > 50, (len(pages), links)
named = {path.parent.name for path in pages if path.parent.parent.name == "scenes"}
there = {path.parent.name for path in Path(sys.argv[2], "scenes").glob("*/README.md")}
assert named == there, f"docs/guide/templates.md: {named ^ there}"
END
# A page with a wrong link.
mkdir -p "$out/wrong/docs/guide"
printf '# A page\n\nSee [that](nowhere.md).\n' >"$out/wrong/docs/guide/README.md"
if /usr/bin/python3 "$source/tools/build_guide.py" "$out/wrong" "$out/wrong-site" 2>"$out/log"; then
  echo "FAIL: a link that leads nowhere is taken"
  exit 1
fi
grep -q "docs/guide/README.md: there is no nowhere.md" "$out/log"
