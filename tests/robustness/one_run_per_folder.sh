#!/bin/sh
# A folder belongs to one run: a second one is refused, by whatever way it comes, and told who holds
# the folder; a killed run does not stand in the way; a user's own files are not replaced.
# usage: one_run_per_folder.sh SOURCE BUILD
set -u
source=$1 build=$2
case=$source/tests/support/porous_small.yaml
out=$build/test_one_run
program=$build/bin/porous_breakup
failed=0
rm -rf "$out" && mkdir -p "$out"
. "$source/tests/support/refused.sh"
short="--set flow.steps=4 --set deformation.steps=4 --set breakage.steps=4"

# A long run, looked at while it goes on.
"$program" "$case" --out "$out/two" --quiet --set breakage.steps=100000 > "$out/first.txt" 2>&1 &
first=$!
until [ -e "$out/two/checkpoint-last.h5" ]; do
  kill -0 $first 2> /dev/null || { cat "$out/first.txt"; echo "FAIL: the first run ended"; exit 1; }
  sleep 0.05
done
last=$out/two/checkpoint-last.h5
refused in_use "is in use: process $first on " "$program" "$case" --out "$out/two" --quiet --restart "$last"
refused in_use_2 "is in use: process $first on " "$program" "$case" --out "$out/two" --quiet --overwrite
refused in_use_3 "is in use: process $first on " \
  mpirun -n 2 "$program" "$case" --out "$out/two" --quiet
# A copy of the folder is not in use.
cp -r "$out/two" "$out/copy"
# shellcheck disable=SC2086 # a list of words
"$program" "$case" --out "$out/copy" --quiet --overwrite $short || { echo "FAIL copy"; failed=1; }
[ -e "$out/copy/run.lock" ] && { echo "FAIL: the lock file of a run that has ended"; failed=1; }

# Killed: the lock goes with the process, and the run goes on.
kill -9 $first
wait $first 2> /dev/null
[ -e "$out/two/run.lock" ] || { echo "FAIL: nothing to stand in the way"; failed=1; }
"$program" "$case" --out "$out/two" --quiet --restart "$out/two/checkpoint-flow.h5" \
  --set breakage.steps=2 || { echo "FAIL: after a kill"; failed=1; }

# A table of the user's own.
mkdir "$out/own" && echo "my own table" > "$out/own/history.csv"
refused own "holds history.csv, which is no result" "$program" "$case" --out "$out/own" --quiet
refused own_2 "holds history.csv" "$program" "$case" --out "$out/own" --quiet --overwrite
refused own_3 "holds history.csv" "$program" "$case" --out "$out/own" --quiet --restart "$last"
[ "$(cat "$out/own/history.csv")" = "my own table" ] && [ "$(ls "$out/own")" = history.csv ] ||
  { echo "FAIL: the user's folder has changed"; failed=1; }
exit $failed
