#!/bin/sh
# A folder belongs to one run: a second one is refused, by whatever way it comes, and told who holds
# the folder; a killed run does not stand in the way; a user's own files are not replaced.
# usage: one_run_per_folder.sh SOURCE BUILD
set -u
source=$1 build=$2
case=$source/cases/box_flow/box_flow.yaml
out=$build/test_one_run
program=$build/bin/box_flow
failed=0
rm -rf "$out" && mkdir -p "$out"
. "$source/tests/support/refused.sh"
box="--quiet --set domain.cells=[16,16,1] --set output.sample_every=1 --set output.checkpoint_every=1"
short="$box --set time.end=2"
long="$box --set time.end=1000000"

# A long run, looked at while it goes on.
# shellcheck disable=SC2086 # lists of words, here and below
"$program" "$case" --out "$out/two" $long > "$out/first.txt" 2>&1 &
first=$!
until [ -e "$out/two/checkpoint.h5" ]; do
  kill -0 $first 2> /dev/null || { cat "$out/first.txt"; echo "FAIL: the first run ended"; exit 1; }
  sleep 0.05
done
last=$out/two/checkpoint.h5
refused in_use "is in use: process $first on " "$program" "$case" --out "$out/two" $long --restart "$last"
refused in_use_2 "is in use: process $first on " "$program" "$case" --out "$out/two" $long --overwrite
refused in_use_3 "is in use: process $first on " \
  mpirun -n 2 "$program" "$case" --out "$out/two" $long
# A copy of the folder is not in use.
cp -r "$out/two" "$out/copy"
"$program" "$case" --out "$out/copy" --overwrite $short || { echo "FAIL copy"; failed=1; }
[ -e "$out/copy/run.lock" ] && { echo "FAIL: the lock file of a run that has ended"; failed=1; }

# Killed: the lock goes with the process, and the run goes on.
kill -9 $first
wait $first 2> /dev/null
[ -e "$out/two/run.lock" ] || { echo "FAIL: nothing to stand in the way"; failed=1; }
end=$(($(tail -n 1 "$out/two/history.csv" | cut -d, -f1) + 2))
"$program" "$case" --out "$out/two" $box --set time.end=$end --restart "$last" ||
  { echo "FAIL: after a kill"; failed=1; }

# A table of the user's own.
mkdir "$out/own" && echo "my own table" > "$out/own/history.csv"
refused own "holds history.csv, which is no result" "$program" "$case" --out "$out/own" --quiet
refused own_2 "holds history.csv" "$program" "$case" --out "$out/own" --quiet --overwrite
refused own_3 "holds history.csv" "$program" "$case" --out "$out/own" $box --set time.end=$end \
  --restart "$last"
[ "$(cat "$out/own/history.csv")" = "my own table" ] && [ "$(ls "$out/own")" = history.csv ] ||
  { echo "FAIL: the user's folder has changed"; failed=1; }
exit $failed
