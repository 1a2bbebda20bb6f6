"""tools/watch_page.py on a run that goes on and ends; figures of plot_history.py; open.pvsm.
usage: watch_page.py SOURCE FOLDER. Where chromium is installed it draws the page, too."""
import os
import shutil
import subprocess
import sys
import xml.etree.ElementTree as xml
from html.parser import HTMLParser
from pathlib import Path

source, folder = Path(sys.argv[1]), Path(sys.argv[2])
page = folder / "page"
page.mkdir()
table = page / "history.csv"
(page / "run.yaml").write_text('name: "a <run>"\n')


class Reader(HTMLParser):
    """What a browser would be told."""

    def __init__(self):
        super().__init__()
        self.refresh, self.curves, self.text, self.open = None, [], "", []

    def handle_starttag(self, tag, attributes):
        given = dict(attributes)
        if tag == "meta" and given.get("http-equiv") == "refresh":
            self.refresh = float(given["content"])
        if tag == "polyline":
            self.curves.append([tuple(map(float, p.split(","))) for p in given["points"].split()])
        if tag not in ("meta", "line", "polyline"):
            self.open.append(tag)

    def handle_startendtag(self, tag, attributes):
        if tag == "polyline":
            self.handle_starttag(tag, attributes)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag, f"</{tag}> closes another element"

    def handle_data(self, data):
        self.text += data


def read():
    reader = Reader()
    reader.feed((page / "watch.html").read_text())
    assert not reader.open, reader.open
    return reader


def watch(*arguments):
    return subprocess.Popen([sys.executable, source / "tools/watch_page.py", page, *arguments])


def wait_for(what):
    for _ in range(6000):
        if (page / "watch.html").is_file() and what(read()):
            return
        subprocess.run(["sleep", "0.1"])
    raise SystemExit("FAIL: watch.html has not followed the run")


# A run: a process that lives, and a table that grows, with a row that is half written.
running = subprocess.Popen(["sleep", "1000"])
table.write_text("time[T],a.x[L],a.y[L],b[-]\n0,1,2,\n1,2,4,5\n2,3,")
watcher = watch("--while", str(running.pid), "--every", "0.1")
wait_for(lambda r: "2 rows" in r.text)
assert read().refresh == 0.1 and "a <run>" in read().text
table.write_text("time[T],a.x[L],a.y[L],b[-]\n0,1,2,\n1,2,4,5\n2,3,6,6\n")
wait_for(lambda r: "3 rows" in r.text)
running.kill()
running.wait()
assert watcher.wait() == 0
last = read()
assert last.refresh is None and "not running" in last.text
# x, y of one panel, b of another without its first value; straight lines stay straight, up is up.
assert [len(c) for c in last.curves] == [3, 3, 2], last.curves
(x0, y0), (x1, y1), (x2, y2) = last.curves[0]
assert abs(x1 - (x0 + x2) / 2) < 0.11 and abs(y1 - (y0 + y2) / 2) < 0.11 and y2 < y0
assert last.curves[1][2][1] < y2  # 6 is above 3
if shutil.which("chromium"):
    done = subprocess.run(
        ["chromium", "--headless", "--no-sandbox", "--disable-gpu", "--dump-dom",
         f"--user-data-dir={folder}/browser", f"file://{page}/watch.html"],
        capture_output=True, text=True)
    # A browser that does not start here, for want of a sandbox or of memory, says nothing of pages.
    if done.returncode != 0 or "<html" not in done.stdout:
        print("chromium does not start here: the page was read without it")
    else:
        assert done.stdout.count("<polyline") == 3, done.stdout
    shutil.rmtree(folder / "browser", ignore_errors=True)

# Figures: a panel each up to six, shared beyond.
plot = [sys.executable, source / "tools/plot_history.py", page]
(page / "reference.csv").write_text("column,value,source\na.y,3,measured\n")
subprocess.run([*plot, page / "reference.csv"], check=True, capture_output=True)
assert sorted(os.listdir(page / "figures")) == ["a.png", "b.png"]
shutil.rmtree(page / "figures")
many = [f"g{q}[U{q}]" for q in range(20)]
table.write_text("\n".join([",".join(["time[T]", *many]), *(",".join([str(r)] * 21) for r in (1, 2, 3))]))
subprocess.run(plot, check=True, capture_output=True)
assert len(os.listdir(page / "figures")) == 5  # four panels each

# ParaView's state: every proxy that is named is there, and the series exist.
for run in (folder / "out/one", folder / "out/flow"):
    state = xml.parse(run / "open.pvsm").getroot().find("ServerManagerState")
    made = {p.get("id") for p in state.findall("Proxy")}
    assert made >= {p.get("value") for p in state.findall("Proxy/Property/Proxy")}
    assert made == {i.get("id") for i in state.findall("ProxyCollection/Item")}
    files = [e.get("value") for e in state.findall("Proxy/Property[@name='FileName']/Element")]
    assert files and all(Path(f).is_file() for f in files), files
print("the page follows a run; figures and ParaView's state are as they should be")
