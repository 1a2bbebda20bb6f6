#!/bin/sh
# What the build accepts, works; what it cannot do, it refuses when it is configured. The build for
# any processor of the kind (BW_NATIVE=OFF) is made where the compiler differs most: the modules with
# vectors. A precision that is none is refused.
# usage: portable.sh SOURCE BUILD
set -u
source=$1 build=$2/test_portable
failed=0
rm -rf "$build" && mkdir -p "$build"
cmake -S "$source" -B "$build/any" -G Ninja -DCMAKE_BUILD_TYPE=Release -DBW_NATIVE=OFF \
  > "$build/any.txt" 2>&1 &&
  cmake --build "$build/any" --target box_flow bw_ibm_mdf bw_probe bw_solid >> "$build/any.txt" 2>&1 ||
  { tail -n 20 "$build/any.txt"; echo "FAIL: BW_NATIVE=OFF does not build"; failed=1; }
[ ! -x "$build/any/bin/box_flow" ] ||
  "$build/any/bin/box_flow" "$source/cases/box_flow/box_flow.yaml" --check --quiet || failed=1
for precision in half Double "" quad; do
  if cmake -S "$source" -B "$build/none" -G Ninja -DBW_PRECISION="$precision" > "$build/none.txt" 2>&1 ||
    ! grep -q "must be double or single" "$build/none.txt"; then
    echo "FAIL: BW_PRECISION='$precision' is accepted"
    failed=1
  fi
done
exit $failed
