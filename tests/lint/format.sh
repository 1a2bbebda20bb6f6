#!/bin/sh
# Every C file is formatted as .clang-format says.
# usage: format.sh SOURCE
cd "$1" || exit 2
command -v clang-format >/dev/null || { echo "clang-format is missing: ./run setup"; exit 1; }
files=$(find modules cases validation bench tests docs -name '*.[ch]' 2>/dev/null)
# shellcheck disable=SC2086 # a list of words
clang-format --dry-run --Werror $files 2>&1 | grep -E '(error|warning):' | cut -d : -f 1 |
  sort | uniq -c >"${TMPDIR:-/tmp}/bw-format.$$"
bad=0
if [ -s "${TMPDIR:-/tmp}/bw-format.$$" ]; then
  echo "not formatted (places, file); use clang-format -i FILE:"
  cat "${TMPDIR:-/tmp}/bw-format.$$"
  bad=1
fi
rm -f "${TMPDIR:-/tmp}/bw-format.$$"
exit $bad
