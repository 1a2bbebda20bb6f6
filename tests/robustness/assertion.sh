#!/bin/sh
# A test that fails on one of several ranks ends the whole run, and says where and why, although
# the other ranks wait for that one.
# usage: assertion.sh SOURCE BUILD
build=$2
work=$(mktemp -d) || exit 2
trap 'rm -rf "$work"' EXIT
complain() { echo "$1"; cat "$work/said"; exit 1; }

for np in 1 2 3; do
  code=0
  # ranks that wait for ever are ended here, however slow the machine
  timeout -k 10 600 mpirun -np $np "$build/bin/fails_on_one_rank" >"$work/said" 2>&1 || code=$?
  [ $code -ne 124 ] && [ $code -ne 137 ] || complain "$np ranks: they wait for the one that failed"
  [ $code -ne 0 ] || complain "$np ranks: the failure is not in the exit code"
  grep -q "on rank $((np - 1)) of $np, .*" "$work/said" && grep -q 'planted' "$work/said" ||
    complain "$np ranks: who failed, and why, is not said"
done
