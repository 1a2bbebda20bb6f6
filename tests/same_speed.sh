#!/bin/sh
# Is commit B slower than commit A? Builds both with the same compiler and runs the benchmarks `solid` and
# `coupled` of both in turn, so that whatever else the machine does falls on both alike. Prints for each
# time the ratio of medians, B over A, with its 95 % interval.
# usage: tests/same_speed.sh A B [PAIRS [BENCH...]]
#   A, B    commits by any name that git takes; "." is the working tree with its changes
#   PAIRS   runs of each side; default 15. With one more that warms up it takes about 15 s a pair
#   BENCH   names of bench/*.c; default: solid coupled
# Set BW_SAME to a folder to keep trees and builds, as for same_bits.sh. Exit code: 0 the interval of every
# ratio reaches below 1.02, 1 that of some does not, 2 something could not be run.
set -eu
source=$(cd "$(dirname "$0")/.." && pwd)
[ $# -ge 2 ] || { sed -n 's/^# usage: /usage: /p' "$0" >&2; exit 2; }
# shellcheck source=tests/support/two_commits.sh
. "$source/tests/support/two_commits.sh"

a=$(commit_of "$1")
b=$(commit_of "$2")
pairs=${3:-15}
case $pairs in *[!0-9]* | '') die "PAIRS is $pairs, not a whole number" ;; esac
[ "$pairs" -ge 6 ] || die "PAIRS is $pairs: fewer than 6 pairs have no interval of 95 %"
shift 2
[ $# -eq 0 ] || shift
[ $# -gt 0 ] || set -- solid coupled
tree_at a "$a"
tree_at b "$b"
targets=
for bench; do targets="$targets bench_$bench"; done
for side in a b; do
  # shellcheck disable=SC2086 # a list of words
  build_at $side $targets
done

# measure SIDE BENCH NAME: the rows of this run go to $work/speed/SIDE-BENCH-NAME.json
measure() {
  (cd "$work/$1" && BW_BUILD_DIR=$work/$1/build mpirun -n 2 "build/bin/bench_$2") \
    >"$work/speed.log" 2>&1 || { cat "$work/speed.log" >&2; die "bench $2 of side $1 failed"; }
  mv "$work/$1/build/bench/$2.json" "$work/speed/$1-$2-$3.json"
}

rm -rf "$work/speed"
mkdir -p "$work/speed"
for bench; do
  for pair in $(seq 0 "$pairs"); do # the first one warms up
    # who comes first changes from pair to pair: a drift of the machine falls on both
    if [ $((pair % 2)) -eq 0 ]; then order="a b"; else order="b a"; fi
    for side in $order; do measure "$side" "$bench" "$pair"; done
  done
  rm -f "$work/speed/"?-"$bench"-0.json
done
/usr/bin/python3 "$source/tests/support/compare_speed.py" "$work/speed" "$@"
