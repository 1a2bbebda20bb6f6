#!/usr/bin/python3
"""The user's guide as a static site: docs/guide and all pages of Markdown that it leads to.

usage: build_guide.py SOURCE TARGET
Every page NAME.md becomes TARGET/.../NAME.html under the path it has in the source; files that pages
link to are copied; folders lead to their README. A link that leads nowhere is an error.
It knows the Markdown that these pages use: headings, paragraphs, lists, tables, fenced and indented
code, links, images, emphasis, code in a line, HTML anchors.
"""
import html
import os
import re
import shutil
import sys
from pathlib import Path

START = ["docs/guide/README.md"]
STYLE = ("body{font:16px/1.5 sans-serif;max-width:52em;margin:2em auto;padding:0 1em}"
         "table{border-collapse:collapse}td,th{border:1px solid #bbb;padding:.2em .6em;"
         "text-align:left}pre{background:#f4f4f4;padding:.7em;overflow:auto}code{background:#f4f4f4}"
         "img{max-width:100%}nav{font-size:14px}")


class Site:
    """Pages that are done, and those that have been linked to."""

    def __init__(self, source, target):
        self.source, self.target = source, target
        self.waiting, self.done, self.wrong = list(START), {}, []

    def link(self, page, to):
        """The address of a link of a page, as seen from its place in the site."""
        if re.match(r"[a-z]+:", to):
            return to
        path, _, anchor = to.partition("#")
        mark = "#" + anchor if anchor else ""
        if not path:
            self.anchors.append((page, page, anchor))
            return mark
        full = (self.source / page).parent / path
        if full.is_dir() and (full / "README.md").is_file():
            full = full / "README.md"
        inside = os.path.relpath(full, self.source)
        if not full.is_file() or inside.startswith(".."):
            self.wrong.append(f"{page}: there is no {to}")
            return to
        if full.suffix != ".md":
            (self.target / inside).parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(full, self.target / inside)
            return os.path.relpath(inside, Path(page).parent) + mark
        if inside not in self.done and inside not in self.waiting:
            self.waiting.append(inside)
        if anchor:
            self.anchors.append((page, inside, anchor))
        return os.path.relpath(Path(inside).with_suffix(".html"), Path(page).parent) + mark

    def inline(self, page, text):
        """Code, images, links and emphasis of one line of text."""
        kept = []

        def keep(piece):
            kept.append(piece)
            return f"\0{len(kept) - 1}\0"

        text = re.sub(r"(`+)(.+?)\1", lambda m: keep(f"<code>{html.escape(m[2].strip())}</code>"), text)
        text = re.sub(r"<a id=\"[\w-]+\"></a>", lambda m: keep(m[0]), text)
        text = re.sub(r"!\[([^\]]*)\]\(([^)\s]+)\)",
                      lambda m: keep(f'<img src="{html.escape(self.link(page, m[2]))}" '
                                     f'alt="{html.escape(m[1])}">'), text)
        text = re.sub(r"\[([^\]]+)\]\(([^)\s]+)\)",
                      lambda m: keep(f'<a href="{html.escape(self.link(page, m[2]))}">') +
                      m[1] + keep("</a>"), text)
        text = html.escape(text, quote=False)
        text = re.sub(r"\*\*(.+?)\*\*", r"<b>\1</b>", text)
        text = re.sub(r"(?<![\w*])\*(?!\s)(.+?)(?<!\s)\*(?![\w*])", r"<i>\1</i>", text)
        while "\0" in text:
            text = re.sub(r"\0(\d+)\0", lambda m: kept[int(m[1])], text)
        return text

    def row(self, page, line, tag):
        # A bar in code is no border.
        cells = re.split(r"\|(?=(?:[^`]*`[^`]*`)*[^`]*$)", line.strip().strip("|"))
        return "<tr>" + "".join(f"<{tag}>{self.inline(page, c.strip())}</{tag}>"
                                for c in cells) + "</tr>"

    def block(self, page, lines):
        """Lines without an empty one between them, as HTML."""
        first = lines[0]
        if re.match(r"#+ ", first):
            level = len(first) - len(first.lstrip("#"))
            name = re.sub(r"[^\w\- ]", "", first.lstrip("# ").lower()).replace(" ", "-")
            head = f'<h{level} id="{name}">{self.inline(page, first.lstrip("# "))}</h{level}>'
            return head + ("\n" + self.block(page, lines[1:]) if lines[1:] else "")
        if first.lstrip().startswith("|") and len(lines) > 1 and re.match(r"\s*\|[\s:|-]+$", lines[1]):
            return ("<table>" + self.row(page, first, "th") +
                    "".join(self.row(page, line, "td") for line in lines[2:]) + "</table>")
        mark = re.match(r"(\s*)([-*]|\d+\.) ", first)
        if mark:
            items = []
            for line in lines:
                again = re.match(r"\s*([-*]|\d+\.) (.*)", line)
                items.append(again[2]) if again else items.append(items.pop() + " " + line.strip())
            kind = "ol" if mark[2][0].isdigit() else "ul"
            return (f"<{kind}>" + "".join(f"<li>{self.inline(page, i)}</li>" for i in items) +
                    f"</{kind}>")
        return f"<p>{self.inline(page, ' '.join(line.strip() for line in lines))}</p>"

    def body(self, page, text):
        out, lines, code, fence = [], [], [], None

        def flush():
            if lines:
                out.append(self.block(page, lines[:]))
                lines.clear()
            while code and not code[-1].strip():
                code.pop()
            if code:
                out.append("<pre>" + html.escape("\n".join(code)) + "</pre>")
                code.clear()

        for line in text.splitlines():
            if fence is not None and line.strip() == fence:
                out.append("<pre>" + html.escape("\n".join(code)) + "</pre>")
                code.clear()
                fence = None
            elif fence is not None:
                code.append(line)
            elif line.lstrip().startswith("```"):
                flush()
                fence = "```"
            elif not lines and line.startswith("    "):
                code.append(line[4:])
            elif not line.strip() and code:
                code.append("")
            elif not line.strip():
                flush()
            else:
                if code:
                    flush()
                lines.append(line)
        flush()
        return "\n".join(out)

    def make(self, page):
        text = (self.source / page).read_text()
        title = html.escape(re.sub(r"[`*]", "", text.partition("\n")[0].lstrip("# ")))
        home = os.path.relpath("docs/guide/README.html", Path(page).parent)
        # Anchors are looked at when all pages are done.
        self.done[page] = None
        content = (f'<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8"><title>{title}'
                   f"</title><style>{STYLE}</style></head><body>\n"
                   f'<nav><a href="{home}">Guide</a></nav>\n{self.body(page, text)}\n'
                   "</body></html>\n")
        self.done[page] = set(re.findall(r'id="([^"]+)"', content))
        path = (self.target / page).with_suffix(".html")
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(content)

    def build(self):
        self.anchors = []
        while self.waiting:
            self.make(self.waiting.pop(0))
        self.wrong += [f"{page}: {to} has no #{anchor}" for page, to, anchor in self.anchors
                       if anchor not in self.done[to]]


def main():
    if len(sys.argv) != 3:
        sys.exit("usage: build_guide.py SOURCE TARGET")
    site = Site(Path(sys.argv[1]).resolve(), Path(sys.argv[2]))
    site.build()
    if site.wrong:
        sys.exit("\n".join(site.wrong))
    (site.target / "index.html").write_text(
        '<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8"><title>Breakwater</title>'
        '<meta http-equiv="refresh" content="0; url=docs/guide/README.html"></head>'
        '<body><a href="docs/guide/README.html">The guide</a></body></html>\n')
    print(f"{len(site.done)} pages in {site.target}/index.html")


main()
