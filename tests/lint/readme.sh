#!/bin/sh
# The code that a README shows is code that builds: each block of C in README.md and
# modules/*/README.md stands, line for line, in the file named above it ("From `docs/...c`:"), but
# for the indentation. Blocks that name no file are listed.
# usage: readme.sh SOURCE
cd "$1" || exit 2
bad=0
for page in README.md modules/*/README.md; do
  # shellcheck disable=SC2016 # the program of awk
  awk -v page="$page" '
    function bare(s) { sub(/^ +/, "", s); sub(/ +$/, "", s); return s }
    function load(name, line) {
      whole = "\n"
      while ((getline line < name) > 0) whole = whole bare(line) "\n"
      close(name)
      return whole != "\n"
    }
    match($0, /`[A-Za-z0-9_\/.-]+\.[ch]`:/) { file = substr($0, RSTART + 1, RLENGTH - 3) }
    /^#/ { file = "" }
    /^```c$/ { inside = 1; block = "\n"; at = NR; next }
    /^```/ && inside {
      inside = 0
      if (file == "") printf "%s:%d: C without the file it is from\n", page, at
      else if (!load(file)) { printf "FAIL %s:%d: there is no %s\n", page, at, file; bad = 1 }
      else if (index(whole, block) == 0) {
        printf "FAIL %s:%d: not in %s:%s", page, at, file, block
        bad = 1
      }
    }
    inside { block = block bare($0) "\n" }
    END { exit bad }' "$page" || bad=1
done
exit $bad
