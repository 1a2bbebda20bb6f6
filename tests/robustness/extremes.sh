#!/bin/sh
# tools/extremes.py tells what holds from what is told, refused, ended, wrong and late; its table can be
# read, its scenes pass --check; a unit of 2^20 gives the same bits; the kept results have no fault that is
# not known.
# usage: extremes.sh SOURCE BUILD
set -eu
cd "$1"
build=$2
PYTHONPATH=tools PYTHONDONTWRITEBYTECODE=1 /usr/bin/python3 - "$build" <<'END'
import json
import sys
from dataclasses import replace
from pathlib import Path

import extremes
import extremes_rows

build = Path(sys.argv[1])
program, folder = str(build / "bin" / "breakwater"), build / "test_extremes"
folder.mkdir(exist_ok=True)
extremes_rows.PROGRAM = program
rows = {row.name: row for row in extremes_rows.ROWS}
assert len(rows) == len(extremes_rows.ROWS), "two rows have the same name"
for row in rows.values():
    assert callable(row.scene) or Path(row.scene).is_file(), row.scene
    assert all(isinstance(word, str) for word in row.sets(row.inside)), row.name


def seen(row, x):
    kind, said, base, _ = extremes.run(program, row, row.inside, folder / "base")
    assert base is not None, f"{row.name}: {kind}: {said}"
    return extremes.look(program, row, x, base, {extremes.bare(s) for s in said}, folder / "run")["class"]


# A tolerance that nothing meets makes of a run that ends well one that is wrong, or told where it warns.
step, gap, still = rows["convective step"], rows["width of a slit"], rows["unit of length, still water"]
for row, x, expected in ((step, 0.02, "holds"), (step, 0.1, "refused"), (replace(step, tolerance=-1.0), 0.02, "WRONG"),
                         (rows["convective step, speeding up"], 0.15, "ends"),
                         (gap, 5.0, "holds"), (gap, 4.0, "told"), (still, 2.0 ** 20, "holds")):
    found = seen(row, x)
    assert found == expected, f"{row.name} at {x:g}: {found}, expected {expected}"

kept = json.loads(Path("docs/verification/extremes/extremes.json").read_text())
for name, row in kept["rows"].items():
    assert row["limit"] is not None and (row["known"] or not row["faults"]), f"{name}: {row}"
missing = set(rows) - set(kept["rows"])
assert not missing, f"rows that no kept result has: {missing}"
END
