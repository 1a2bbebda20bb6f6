#!/bin/sh
# The pages on adding things fit the tree: what they show of files is there, and what they put in has its
# place. In a second; pages.sh builds and runs them.
# usage: recipes.sh SOURCE
work=$(mktemp -d) || exit 2
trap 'rm -rf "$work"' EXIT
mkdir "$work/tree"
(cd "$1" && tar cf - CMakeLists.txt bench cases cmake docs modules tests tools validation) |
  (cd "$work/tree" && tar xf -) || exit 2
/usr/bin/python3 "$1/tests/lint/pages.py" "$1" "$work" --apply
