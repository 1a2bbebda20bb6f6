#!/bin/sh
# What a run has paid for survives the end of its process and of its disk: killed (-9) at many places,
# also in the middle of writing, and stopped by a disk that takes no more, it goes on from its newest
# checkpoint to the same history. A folder that cannot be written is refused.
# usage: power_cut.sh SOURCE BUILD
set -u
source=$1 build=$2
out=$build/test_power_cut
failed=0
rm -rf "$out" && mkdir -p "$out"
. "$source/tests/support/refused.sh"
# Everything is written in every step.
porous() {
  "$build/bin/porous_breakup" "$source/tests/support/porous_small.yaml" --quiet --set flow.steps=3 \
    --set deformation.steps=3 --set breakage.steps=8 --set output.sample_every=1 \
    --set output.checkpoint_every=1 --set output.picture_every=1 --set output.keep_every=1 "$@"
}
newest() { # of the checkpoints; half-written ones have another name
  # shellcheck disable=SC2012 # names of our own
  (cd "$1" && ls -t checkpoint-*.h5 2> /dev/null | head -n 1)
}
porous --out "$out/whole" || { echo "FAIL: the whole run"; exit 1; }

# Killed when so many files are in the folder, at times that no clock decides.
for files in 4 8 12 18 24 28; do
  name=$out/killed-$files
  porous --out "$name" > "$name.txt" 2>&1 &
  run=$!
  # shellcheck disable=SC2012 # names of our own
  until [ "$(ls "$name" 2> /dev/null | wc -l)" -ge $files ] || ! kill -0 $run 2> /dev/null; do :; done
  kill -9 $run 2> /dev/null
  wait $run 2> /dev/null
  checkpoint=$(newest "$name")
  if [ -n "$checkpoint" ]; then
    porous --out "$name" --restart "$name/$checkpoint" > "$name.txt" 2>&1
  else
    porous --out "$name" --overwrite > "$name.txt" 2>&1
  fi || { echo "FAIL killed at $files files: cannot go on from '$checkpoint'"; cat "$name.txt"; failed=1; }
  if cmp "$out/whole/history.csv" "$name/history.csv" && [ -z "$(find "$name" -name '*.part')" ]; then
    echo "ok   killed at $files files, on from '$checkpoint'"
  else
    ls "$name"
    failed=1
  fi
done

# A disk that is full: a file longer than this cannot be written, by the picture or the checkpoint.
for kib in 40 300; do
  name=$out/full-$kib
  porous --out "$name" --set deformation.steps=0 --set breakage.steps=0 || failed=1
  cp "$name/checkpoint-flow.h5" "$out/before.h5"
  # Ignored, a limit of files is an error of the disk and no signal; blocks of 512 bytes.
  (trap '' XFSZ && ulimit -f $((2 * kib)) && porous --out "$name" --restart "$name/checkpoint-flow.h5") \
    > "$name.txt" 2>&1
  code=$?
  if [ $code -eq 0 ] || [ $code -ge 128 ] || ! grep -q "error: .*$name/" "$name.txt"; then
    echo "FAIL full at $kib KiB: exit $code"
    cat "$name.txt"
    failed=1
  else
    echo "ok   full at $kib KiB: $(grep -m 1 error: "$name.txt")"
  fi
  cmp "$out/before.h5" "$name/checkpoint-flow.h5" || { echo "FAIL: the good checkpoint is lost"; failed=1; }
  porous --out "$name" --restart "$name/$(newest "$name")" > "$name.txt" 2>&1 &&
    cmp "$out/whole/history.csv" "$name/history.csv" ||
    { echo "FAIL full at $kib KiB: cannot go on"; cat "$name.txt"; failed=1; }
done

# A folder that nobody can write, and one that is none.
refused not_a_folder "cannot make the folder /proc/breakwater" porous --out /proc/breakwater
refused file_in_the_way "in the way" porous --out "$out/before.h5/results"
exit $failed
