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

# Killed in the second phase, after its last checkpoint, when the file of its end is to be written.
code=0
mpirun -n 2 -x LD_PRELOAD="$build/lib/libbad_disk.so" -x BAD_DISK="$out/killed" -x BAD_DISK_RANK=0 \
  -x BAD_DISK_ONLY=checkpoint-deformation -x BAD_DISK_AT=1 -x BAD_DISK_HOW=kill \
  "$build/bin/porous_breakup" "$case" --out "$out/killed" --quiet --set output.checkpoint_every=30 \
  2> "$out/killed.txt" || code=$?
[ $code -ne 0 ] && [ -e "$out/killed/checkpoint-last.h5" ] ||
  { cat "$out/killed.txt"; echo "the run was to be killed behind its checkpoint, exit code $code"; exit 1; }
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
