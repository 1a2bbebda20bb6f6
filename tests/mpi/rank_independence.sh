#!/bin/sh
# The coupled case gives the same answer on 1, 2, 3 and 4 ranks: 1e-10 before the first bond
# breaks, the same broken bonds for the hundred steps after. The densities of stress and strain
# before are the same to the last digit, and their integral is one.
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
  cmp "$out/np1/stress-deformation.csv" "$out/np$np/stress-deformation.csv"
done
# The comparison must have seen bonds break, or it proves nothing of the second half.
tail -n 1 "$out/np1/history.csv" | awk -F, '$6 <= 0 { print "no bond broke"; exit 1 }'
awk -F, 'NR == 1 { split($0, word, "range: "); split(word[2], outside, " ") }
  NR == 3 { first = $1 } NR == 4 { width = $1 - first }
  NR > 2 { for (c = 2; c <= 4; c++) sum[c] += $c }
  END { for (c = 2; c <= 4; c++) { gap = width * sum[c] + outside[c - 1] - 1
          if (gap > 1e-3 || gap < -1e-3) { print "density " c ": integral off by " gap; exit 1 } } }' \
  "$out/np1/stress-breakage.csv"
