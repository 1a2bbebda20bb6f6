"""history.csv as plot_history.py and watch_page.py read it: panels of columns that belong together."""
import csv
import re


def split(column):
    """'ball.velocity.x[L/T]' -> ('ball.velocity', 'x', 'L/T'), 'force_x[N]' -> ('force', 'x', 'N')"""
    name, _, unit = column.partition("[")
    stem, mark, part = name.rpartition(".") if "." in name else name.rpartition("_")
    if not mark or part not in ("x", "y", "z") and "." not in name:
        stem, part = name, ""
    return stem, part, unit.rstrip("]")


def read(path):
    """Columns and rows of numbers, NaN where nothing was measured; a row that is still being written
    is left out."""
    with open(path, newline="") as file:
        table = list(csv.reader(file))
    head = table[0] if table else []
    rows = []
    for row in table[1:]:
        try:
            numbers = [float(x or "nan") for x in row]
        except ValueError:
            continue
        if len(numbers) == len(head):
            rows.append(numbers)
    return head, rows


def panels(head):
    """[(title, unit, [(label, number of the column)])]: columns of one gauge and unit together."""
    found = {}
    for q, column in enumerate(head[1:], start=1):
        stem, part, unit = split(column)
        found.setdefault((stem, unit), []).append((part or stem, q))
    return [(stem, unit, curves) for (stem, unit), curves in found.items()]


def file_name(text):
    """A text as a name of a file."""
    return re.sub(r"[^A-Za-z0-9_-]", "_", text)
