#!/bin/sh
# No function beyond 120 lines, no file beyond 400, no line beyond 100 columns (clang-format holds that
# for code, but leaves comments as they are); functions beyond 60 lines are listed.
# A function is what lies between a { and a } that each stand alone at the beginning of a line.
# usage: length.sh SOURCE
cd "$1" || exit 2
# shellcheck disable=SC2016 # the program of awk
find modules cases validation bench tests docs -name '*.[ch]' 2>/dev/null | sort | xargs awk '
  function file_end() {
    if (lines > 400) { printf "FAIL file of %d lines: %s\n", lines, file; bad = 1 }
  }
  FNR == 1 { if (file != "") file_end(); file = FILENAME }
  { lines = FNR }
  length($0) > 100 { printf "FAIL line of %d columns: %s:%d\n", length($0), FILENAME, FNR; bad = 1 }
  /^{$/ { begin = FNR; head = before }
  /^}$/ && begin {
    n = FNR - begin - 1
    if (n > 120) { printf "FAIL function of %d lines: %s:%d %s\n", n, FILENAME, begin, head; bad = 1 }
    else if (n > 60) printf "long function, %d lines: %s:%d %s\n", n, FILENAME, begin, head
    begin = 0
  }
  { before = $0 }
  END { file_end(); exit bad }'
