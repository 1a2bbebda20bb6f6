#!/bin/sh
# The coupled case gives the same answer on 1, 2, 3 and 4 ranks: 1e-10 before the first bond
# breaks, the same broken bonds for the hundred steps after.
# usage: rank_independence.sh SOURCE BUILD
set -eu
source=$1 build=$2
out=$build/test_ranks
rm -rf "$out"
for np in 1 2 3 4; do
  mpirun -n $np "$build/bin/porous_breakup" "$source/tests/support/porous_small.yaml" \
    --out "$out/np$np" --quiet
done
for np in 2 3 4; do
  /usr/bin/python3 "$source/tests/support/compare_history.py" "$out/np1/history.csv" \
    "$out/np$np/history.csv" 1e-10 100
done
# The comparison must have seen bonds break, or it proves nothing of the second half.
tail -n 1 "$out/np1/history.csv" | awk -F, '$6 <= 0 { print "no bond broke"; exit 1 }'
