#!/bin/sh
# python/: the package reads what VTK and h5py read, writes scenes that run the same, says why a run
# failed, installs by pip; the notebooks run; watch.html follows a run; figures are at most six.
# usage: python.sh SOURCE BUILD
set -eu
source=$(cd "$1" && pwd) build=$(cd "$2" && pwd)
out=$build/test_python
rm -rf "$out" && mkdir -p "$out" && cd "$out"
BREAKWATER=$source BREAKWATER_PROGRAM=$build/bin/breakwater PYTHONDONTWRITEBYTECODE=1
export BREAKWATER BREAKWATER_PROGRAM PYTHONDONTWRITEBYTECODE

# ---- the package, as pip installs it ----
cp -r "$source/python" package
/usr/bin/python3 -m pip install --quiet --no-deps --no-build-isolation --no-index \
  --root-user-action=ignore --target installed ./package
PYTHONPATH=$out/installed /usr/bin/python3 "$source/tests/robustness/python_package.py"

# ---- the notebooks ----
for book in "$source"/python/notebooks/*.ipynb; do
  PYTHONPATH=$out/installed /usr/bin/python3 - "$book" <<'END_OF_CODE'
import json, sys
book = json.load(open(sys.argv[1]))
assert book["nbformat"] == 4
code = [c for c in book["cells"] if c["cell_type"] == "code"]
assert len(code) >= 2 and all(not c["outputs"] for c in code), "cells without outputs are wanted"
space = {}
for cell in code:
    exec(compile("".join(cell["source"]), sys.argv[1], "exec"), space)
END_OF_CODE
done

# ---- the page of a run ----
/usr/bin/python3 "$source/tests/robustness/watch_page.py" "$source" "$out"
