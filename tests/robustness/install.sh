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
cmake -S "$work/user" -B "$work/user/build" -G Ninja -DCMAKE_PREFIX_PATH="$prefix" >"$work/log" 2>&1 &&
  cmake --build "$work/user/build" >>"$work/log" 2>&1 ||
  { cat "$work/log"; fail "a project by find_package"; }
for program in solid_only fluid_only from_cpp; do
  "$work/user/build/$program" >"$work/log" 2>&1 || { cat "$work/log"; fail "$program does not run"; }
done
for name in fftw hdf5 breakwater; do
  ! ldd "$work/user/build/solid_only" | grep -q "lib$name" ||
    fail "a program of the solid alone links lib$name"
done
ldd "$work/user/build/fluid_only" | grep -q libfftw || fail "ldd does not show what is linked"

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
