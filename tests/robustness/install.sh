#!/bin/sh
# What is installed is enough: into an empty prefix, then moved, and two projects that know nothing of
# the source build against it: one in C and C++ by find_package(Breakwater), one by pkg-config. A
# program of the solid alone links no FFTW, no HDF5 and no fluid; an installed program runs.
# usage: install.sh SOURCE BUILD
set -u
source=$1 build=$2
work=$(mktemp -d) || exit 2
trap 'rm -rf "$work"' EXIT
failed=0
fail() { echo "FAIL: $1"; failed=1; }

cmake --install "$build" --prefix "$work/first" >"$work/log" 2>&1 ||
  { cat "$work/log"; echo "FAIL: cmake --install"; exit 1; }
mv "$work/first" "$work/moved" # nothing in it may name the place where it was
prefix=$work/moved
pc=$(find "$prefix" -name breakwater.pc)
lib=$(dirname "$(dirname "$pc")")
[ -z "$(find "$prefix" -name '*internal*')" ] || fail "internal headers are installed"
for text in $(find "$prefix" -name '*.cmake' -o -name '*.pc'); do
  ! grep -HnF -e "$source" -e "$build" "$text" || fail "a path of the source is left in $text"
done

# ---- by find_package ----------------------------------------------------------------------------
cp -r "$source/tests/robustness/install" "$work/user"
cp "$source/docs/examples/solid_only.c" "$source/docs/examples/fluid_only.c" "$work/user"
# A law of one's own: the program that docs/add-a-law.md shows, with the law beside it.
cp "$source/tests/unit/solid/cubic_law.h" "$work/user"
awk '/new file: .*own_law.c/ { found = 1 } found && /^```$/ { exit }
     inside { sub(/"[^"]*cubic_law.h"/, "\"cubic_law.h\""); print } found && /^```c$/ { inside = 1 }' \
  "$source/docs/add-a-law.md" >"$work/user/own_law.c"
cmake -S "$work/user" -B "$work/user/build" -G Ninja -DCMAKE_PREFIX_PATH="$prefix" >"$work/log" 2>&1 &&
  cmake --build "$work/user/build" >>"$work/log" 2>&1 ||
  { cat "$work/log"; fail "a project by find_package"; }
for program in solid_only fluid_only own_law from_cpp; do
  "$work/user/build/$program" >"$work/log" 2>&1 || { cat "$work/log"; fail "$program does not run"; }
done
for name in fftw hdf5 breakwater; do
  ! ldd "$work/user/build/solid_only" | grep -q "lib$name" ||
    fail "a program of the solid alone links lib$name"
done
ldd "$work/user/build/fluid_only" | grep -q libfftw || fail "ldd does not show what is linked"

# What is compiled for blocks of another width than the library's is not linked.
lanes=$(sed -n 's/.*-DBW_PD_LANES=\([248]\).*/\1/p' "$pc")
if [ -n "$lanes" ]; then # else the processor decides at the start
  cmake -S "$work/user" -B "$work/user/other" -G Ninja -DCMAKE_PREFIX_PATH="$prefix" \
        -DOTHER_LANES=$((lanes == 8 ? 4 : 8)) >"$work/log" 2>&1
  cmake --build "$work/user/other" --target own_law >"$work/log" 2>&1 &&
    fail "a law for other blocks than the library's is linked"
  grep -q bw_pd_body_of_ "$work/log" || { cat "$work/log"; fail "not refused for its blocks"; }
fi

# ---- by pkg-config ------------------------------------------------------------------------------
# shellcheck disable=SC2046 # lists of words
cc -std=c11 "$work/user/fluid_only.c" -o "$work/by_pc" \
  $(PKG_CONFIG_PATH=$(dirname "$pc") pkg-config --cflags --libs breakwater) -lm >"$work/log" 2>&1 &&
  LD_LIBRARY_PATH=$lib "$work/by_pc" >>"$work/log" 2>&1 ||
  { cat "$work/log"; fail "a program by pkg-config"; }

# ---- the programs -------------------------------------------------------------------------------
cd "$work" && "$prefix/bin/box_flow" "$prefix"/share/breakwater/cases/box_flow/box_flow.yaml --check \
  >"$work/log" 2>&1 || { cat "$work/log"; fail "an installed program does not run its installed case"; }
exit $failed
