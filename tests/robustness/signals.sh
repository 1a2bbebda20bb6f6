#!/bin/sh
# Every signal by which a shell, a batch system or a user ends a job is answered with a checkpoint,
# status `unfinished` and exit code 75; from there the run goes on.
# usage: signals.sh SOURCE BUILD
set -u
source=$1 build=$2
case=$source/tests/support/porous_small.yaml program=$build/bin/porous_breakup
out=$build/test_signals
failed=0
rm -rf "$out" && mkdir -p "$out"

wait_for() { # wait_for FILE: written by the run $run
  until [ -e "$1" ]; do
    kill -0 $run 2> /dev/null || { echo "FAIL: the run has ended early"; exit 1; }
    sleep 0.05
  done
}

expect() { # expect NAME: the run $run has ended in good order
  wait $run
  code=$?
  if [ $code -ne 75 ] || ! [ -e "$out/$1/checkpoint-last.h5" ] ||
    ! grep -q 'exit_code: 75' "$out/$1/run.yaml" || ! grep -q 'status: "unfinished"' "$out/$1/run.yaml"; then
    echo "FAIL $1: exit code $code"
    cat "$out/$1.txt"
    failed=1
  else
    echo "ok   $1: $(grep -m 1 unfinished: "$out/$1.txt")"
  fi
}

for signal in INT TERM HUP XCPU USR1 USR2; do
  "$program" "$case" --out "$out/$signal" --quiet --set breakage.steps=100000 \
    --set output.checkpoint_every=0 > "$out/$signal.txt" 2>&1 &
  run=$!
  wait_for "$out/$signal/checkpoint-deformation.h5"
  kill -$signal $run
  expect $signal
done
# It goes on from where it was, which depends on the machine: a step of breakage more than its history
# has, whose rows are a step apart. Breakage begins after 20 steps of 2 ms and 40 of 0.2 ms.
steps=$(tail -n 1 "$out/HUP/history.csv" | awk -F, '{ printf "%.0f", ($1 - 0.048) / 2e-4 + 1 }')
"$program" "$case" --out "$out/HUP" --quiet --restart "$out/HUP/checkpoint-last.h5" \
  --set breakage.steps="$steps" || { echo "FAIL: cannot go on to step $steps"; failed=1; }

# mpirun passes USR1 and USR2 on to its ranks.
mpirun -n 2 "$program" "$case" --out "$out/mpirun" --quiet --set breakage.steps=100000 \
  --set output.checkpoint_every=0 > "$out/mpirun.txt" 2>&1 &
run=$!
wait_for "$out/mpirun/checkpoint-deformation.h5"
kill -USR2 $run
expect mpirun
exit $failed
