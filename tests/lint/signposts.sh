#!/bin/sh
# Inside a function a reader finds signposts: before each step of the algorithm a line that says
# what state things are in or why the step is there. This lint can only count: it fails where a
# function of a module longer than 40 lines has no comment that stands on a line of its own, and
# lists those of more than 25 lines. Then it says how dense comments are in each module.
# A function is what lies between a { and a } that each stand alone at the beginning of a line.
# usage: signposts.sh SOURCE
cd "$1" || exit 2
# shellcheck disable=SC2016 # the program of awk
find modules -name '*.[ch]' | sort | xargs awk '
  function module(part) { split(FILENAME, part, "/"); return part[2] }
  /^{$/ { begin = FNR; head = before; posts = 0; next }
  begin && /^ *\/\*/ { posts++ }
  /^}$/ && begin {
    n = FNR - begin - 1
    if (n > 25 && posts == 0) {
      place = sprintf("%s:%d %s", FILENAME, begin, head)
      if (n > 40) { printf "FAIL no signpost in %d lines: %s\n", n, place; bad = 1 }
      else printf "no signpost in %d lines: %s\n", n, place
    }
    lines += n
    line[module()] += n
    begin = 0
  }
  { within = within || /\/\*/; if (begin && within) { notes++; note[module()]++ }
    if (/\*\//) within = 0 }
  { before = $0 }
  END {
    for (m in line) printf "%s: %.1f %% of the lines inside functions have a comment\n", m,
                           100 * note[m] / line[m] | "sort"
    close("sort")
    printf "all modules: %.1f %% of %d lines\n", lines ? 100 * notes / lines : 0, lines
    exit bad
  }'
