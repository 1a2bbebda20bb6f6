#!/bin/sh
# One of two ranks runs out of memory, at places spread over a whole run: both end with the status of
# that and say so (a status on which ranks had not agreed would leave the other one waiting), or the
# run does without what was refused and ends well.
# usage: no_memory.sh SOURCE BUILD
source=$1 build=$2 bad=0
work=$(mktemp -d) || exit 2
trap 'rm -rf "$work"' EXIT

complain() { bad=1; echo "$1"; cat "$work/said"; }

# run AT [arguments]: on two ranks, the AT-th array refused on the second one
run() {
  at=$1
  shift
  rm -rf "$work/out"
  # ranks that wait for ever are ended here, however slow the machine
  NO_MEMORY_AT=$at timeout -k 10 600 mpirun -np 2 -x LD_PRELOAD="$build/lib/libno_memory.so" \
    -x NO_MEMORY_AT -x NO_MEMORY_RANK=1 -x NO_MEMORY_COUNT="$work/count" \
    "$@" --quiet --out "$work/out" >"$work/said" 2>&1
}

# spread NAME PLACES [arguments]
spread() {
  name=$1 places=$2
  shift 2
  run 0 "$@" || { complain "$name: fails with all the memory it asks for"; return; }
  arrays=$(cat "$work/count")
  [ "$arrays" -gt "$places" ] || { complain "$name: only $arrays arrays are counted"; return; }
  failed=0
  for place in $(seq 1 "$places"); do
    at=$(((2 * place - 1) * arrays / (2 * places) + 1)) code=0
    run $at "$@" || code=$?
    case $code in
      0) ;;
      3)
        failed=$((failed + 1))
        grep -q "no memory" "$work/said" || complain "$name, array $at: why is not said" ;;
      124 | 137) complain "$name, array $at of $arrays: a rank waits for the other" ;;
      *) complain "$name, array $at of $arrays: exit code $code" ;;
    esac
  done
  echo "$name: $arrays arrays; of $places refused, $failed ended the run"
  [ $failed -gt $((places / 2)) ] || complain "$name: hardly any refusal ended the run"
}

spread plate 8 "$build/bin/notched_plate" "$source/cases/notched_plate/notched_plate.yaml" \
  --set shape.particles=10 --set time.step=600e-9 --set time.end=12e-6 --set output.picture_every=5
spread porous 12 "$build/bin/porous_breakup" "$source/tests/support/porous_small.yaml" \
  --set flow.steps=2 --set deformation.steps=2 --set breakage.steps=3 --set solid.contact=true \
  --set output.picture_every=2 --set output.checkpoint_every=2
exit $bad
