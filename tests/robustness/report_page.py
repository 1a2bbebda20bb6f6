"""tools/report.py on results made for this test: what it says, what browsers and screen readers are told.
usage: report_page.py SOURCE FOLDER. Where chromium is installed it draws and prints the page, too."""
import json
import shutil
import subprocess
import sys
from html.parser import HTMLParser
from pathlib import Path

source, folder = Path(sys.argv[1]), Path(sys.argv[2])
sys.path.insert(0, str(source / "tools"))
sys.dont_write_bytecode = True
import report
import report_parts

VOID = {"meta", "br", "link", "img", "line", "circle", "polyline"}
OPTIONAL = {"th", "td", "tr"}


class Page(HTMLParser):
    """Elements, their nesting, ids, links, and what would be fetched from elsewhere."""

    def __init__(self):
        super().__init__()
        self.open, self.tags, self.ids, self.links, self.outside, self.unnamed = [], {}, [], [], [], []

    def handle_starttag(self, tag, attributes):
        given = dict(attributes)
        self.tags[tag] = self.tags.get(tag, 0) + 1
        if "id" in given:
            self.ids.append(given["id"])
        if tag == "a" and given.get("href", "").startswith("#"):
            self.links.append(given["href"][1:])
        self.outside += [v for k, v in given.items() if k in ("src", "href") and not v.startswith(("#", "data:"))]
        if tag == "svg" and not (given.get("role") == "img" and given.get("aria-label")):
            self.unnamed.append(given)
        if tag not in VOID and tag not in OPTIONAL:
            self.open.append(tag)

    def handle_startendtag(self, tag, attributes):
        self.handle_starttag(tag, attributes)
        if tag not in VOID and tag not in OPTIONAL:
            self.open.pop()

    def handle_endtag(self, tag):
        if tag not in VOID and tag not in OPTIONAL:
            assert self.open.pop() == tag, f"</{tag}> closes another element"


# Results of two programs of the source: one passes, with an order and a curve, one fails; all others were not run.
programs = report.programs()
first, second = programs[0], programs[1]
row = {"claim": "a <claim>", "quantity": "drag", "measured": 1.01, "reference": 1.0, "error": 0.01, "tolerance": 0.05,
       "kind": "analytic", "source": "closed form", "pass": True}
order = dict(row, quantity="order", kind="order", measured=1.98, reference=2.0, error=0.02, tolerance=0.1)
curve = [dict(row, quantity="velocity", cells=n, measured=1 + 1 / n, error=1 / n) for n in (8, 16, 32)]
verification = folder / "verification"
verification.mkdir(parents=True)
(verification / f"{first}.json").write_text(json.dumps([row, order, *curve]))
(verification / f"{second}.json").write_text(json.dumps([dict(row, error=0.9, **{"pass": False})]))

# Kept: the drag was better, the order worse, another claim is gone.
report_parts.KEPT = folder / "kept.json"
found = report.collect(verification)
about = {"commit": "0123", "machine": "test", "time": "2026-01-01T00:00:00"}
report_parts.keep(found, about)
kept = json.loads(report_parts.KEPT.read_text())
key = {name: next(k for k in kept["claims"][first] if name in k) for name in ("drag", "order")}
kept["claims"][first][key["drag"]][0] = 0.001
kept["claims"][first][key["order"]][0] = 0.09
kept["claims"][first]["another"] = [0.1, 0.2]
report_parts.KEPT.write_text(json.dumps(kept))
_, change = report_parts.difference(found)
assert [c[1] for c in change["worse"]] == [key["drag"]], change["worse"]
assert [c[1] for c in change["better"]] == [key["order"]], change["better"]
assert change["gone"] == [(first, "another")] and not change["new"], change

text = report.page_of(found, about, "1 passed, 1 failed", verification)
(folder / "report.html").write_text(text)
page = Page()
page.feed(text)
assert not page.open, page.open
assert len(page.ids) == len(set(page.ids)), "an id twice"
assert set(page.links) <= set(page.ids), set(page.links) - set(page.ids)
assert not page.outside, f"not whole by itself: {page.outside}"
assert not page.unnamed, f"a picture without a name: {page.unnamed[:1]}"
assert "script" not in page.tags
for landmark in ("header", "nav", "main", "footer", "h1"):
    assert page.tags.get(landmark) == 1, landmark
assert page.tags["caption"] == page.tags["table"], "a table without a caption"
for words in ("a &lt;claim&gt;", "Failed, or not run", "not run", "Kalthoff-Winkler", "What accuracy costs",
              "map of where scenes hold", "why to this tolerance"):
    assert words in text, words
pictures = page.tags["svg"]
assert pictures > 20, pictures

if shutil.which("chromium"):
    browser = ["chromium", "--headless", "--no-sandbox", "--disable-gpu", f"--user-data-dir={folder}/browser"]
    address = f"file://{folder.resolve()}/report.html"
    done = subprocess.run([*browser, "--enable-logging=stderr", "--dump-dom", address], capture_output=True, text=True)
    # A browser that does not start here, for want of a sandbox or of memory, says nothing of pages.
    if done.returncode != 0 or "<html" not in done.stdout:
        print("chromium does not start here: the page was read without it")
    else:
        assert done.stdout.count("<svg") == pictures, "a picture is not there"
        assert "CONSOLE" not in done.stderr, done.stderr
        printed = folder / "report.pdf"
        subprocess.run([*browser, f"--print-to-pdf={printed}", address], check=True, capture_output=True)
        assert printed.read_bytes().startswith(b"%PDF") and printed.stat().st_size > 20000
    shutil.rmtree(folder / "browser", ignore_errors=True)
print(f"the report is whole: {pictures} pictures, {page.tags['table']} tables")
