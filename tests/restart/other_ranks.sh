#!/bin/sh
# A run killed (-9) in the middle and restarted on another number of ranks tells the same history
# as one that was left alone: 1e-10 until the first bond breaks, the same broken bonds after.
# usage: other_ranks.sh SOURCE BUILD
set -eu
source=$1 build=$2
case=$source/tests/support/porous_small.yaml
out=$build/test_restart
rm -rf "$out"
mpirun -n 2 "$build/bin/porous_breakup" "$case" --out "$out/whole" --quiet
compare() {
  /usr/bin/python3 "$source/tests/support/compare_history.py" "$out/whole/history.csv" \
    "$out/$1/history.csv" 1e-10 100
}

# Killed in the second phase as soon as its checkpoint is there.
mpirun -n 2 "$build/bin/porous_breakup" "$case" --out "$out/killed" --quiet &
mpi=$!
until [ -e "$out/killed/checkpoint-flow.h5" ]; do sleep 0.1; done
sleep 0.5
kill -9 $mpi 2>/dev/null || { echo "the run ended before it could be killed"; exit 1; }
wait $mpi 2>/dev/null || true
pkill -9 -f "$out/killed" 2>/dev/null || true
sleep 0.5
mpirun -n 3 "$build/bin/porous_breakup" "$case" --out "$out/killed" --quiet \
  --restart "$out/killed/checkpoint-last.h5"
compare killed

# Stopped in good order, at the end of the first phase, and gone on from there on one rank.
mkdir "$out/phases"
head -n 1 "$out/whole/history.csv" > "$out/phases/history.csv"
mpirun -n 1 "$build/bin/porous_breakup" "$case" --out "$out/one" --quiet \
  --restart "$out/whole/checkpoint-flow.h5"
# Its history begins where the restart did: compare the tail of the whole run with it.
rows=$(($(wc -l < "$out/one/history.csv") - 1))
tail -n $rows "$out/whole/history.csv" >> "$out/phases/history.csv"
/usr/bin/python3 "$source/tests/support/compare_history.py" "$out/phases/history.csv" \
  "$out/one/history.csv" 1e-10 100
