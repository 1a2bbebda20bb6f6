#!/bin/sh
# The pages on adding things work as they are printed: what they show is put into a copy of the tree,
# built and run, see pages.py. Without optimisation, so that it builds in a minute.
# usage: pages.sh SOURCE BUILD [PAGE ...]
source=$1
shift 2
work=$(mktemp -d) || exit 2
trap 'rm -rf "$work"' EXIT
mkdir "$work/tree"
(cd "$source" && tar cf - CMakeLists.txt CMakePresets.json LICENSE README.md bench cases cmake data docs \
   modules packages.txt run tests tools validation) | (cd "$work/tree" && tar xf -) || exit 2
export BW_SOURCE_DIR="$work/tree" BW_BUILD_DIR="$work/tree/build"
# The pages say `cmake --build build`: new files of theirs are found when it configures again.
cmake -S "$work/tree" -B "$work/tree/build" -G Ninja -DCMAKE_BUILD_TYPE=Debug -DBW_SANITIZE=OFF \
      -DCMAKE_C_FLAGS=-O1 >"$work/configure" 2>&1 || { cat "$work/configure"; exit 1; }
/usr/bin/python3 "$source/tests/lint/pages.py" "$source" "$work" "$@"
