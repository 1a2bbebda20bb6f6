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

# Killed in the second phase, after its last checkpoint, at its end at the latest: the
# file it is to write next is a pipe that nobody reads, at which the run waits until it is killed.
mpirun -n 2 "$build/bin/porous_breakup" "$case" --out "$out/killed" --quiet \
  --set output.checkpoint_every=30 &
mpi=$!
until [ -e "$out/killed/run.yaml" ]; do # a folder is the run's own from here on
  kill -0 $mpi 2>/dev/null || { echo "the run ended before it began"; exit 1; }
  sleep 0.1
done
mkfifo "$out/killed/checkpoint-deformation.h5.part"
until [ -e "$out/killed/checkpoint-last.h5" ]; do # whole, once it has its name
  kill -0 $mpi 2>/dev/null || { echo "the run ended before it could be killed"; exit 1; }
  sleep 0.1
done
kill -9 $mpi
wait $mpi 2>/dev/null || true
while pkill -9 -f "$out/killed"; do sleep 0.1; done
rm "$out/killed/checkpoint-deformation.h5.part"
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
