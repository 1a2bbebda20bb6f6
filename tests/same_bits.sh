#!/bin/sh
# Do two commits compute the same, to the last bit? Builds both with the same compiler, runs set-ups with
# both and compares all numbers they write: histories, tables, the final checkpoints and pictures. What
# they are compared with is the other commit, on this machine, now; no results are stored.
# usage: tests/same_bits.sh A B [SET-UP...]
#   A, B     commits by any name that git takes; "." is the working tree with its changes
#   SET-UP   names of the files tests/same_bits/*.yaml without their ending; default: all of them
# Each commit runs its own copy of tests/same_bits, so that programs and keys may have other names; one
# that has none (it is older than this script) runs the copy beside this script. The first line of a
# set-up says which program runs it and on how many ranks.
# Set BW_SAME to a folder to keep trees, builds and results: the next comparison then builds only what has
# changed since. Otherwise all of it is in a temporary folder that is removed at the end.
# Prints one line per set-up. Exit code: 0 all the same, 1 some differ, 2 something could not be run.
set -eu
source=$(cd "$(dirname "$0")/.." && pwd)
[ $# -ge 2 ] || { sed -n 's/^# usage: /usage: /p' "$0" >&2; exit 2; }
# shellcheck source=tests/support/two_commits.sh
. "$source/tests/support/two_commits.sh"

a=$(commit_of "$1")
b=$(commit_of "$2")
shift 2
tree_at a "$a"
tree_at b "$b"

# set_ups SIDE: the folder of set-ups that this side runs
set_ups() {
  if [ -d "$work/$1/tests/same_bits" ]; then echo "$work/$1/tests/same_bits"
  else echo "$source/tests/same_bits"; fi
}
word() { # word FILE KEY: a word of its first line
  sed -n "1s/.* $2=\([^ ]*\).*/\1/p" "$1"
}

names=$*
[ -n "$names" ] || names=$(cd "$(set_ups b)" && printf '%s\n' *.yaml | sed 's/\.yaml$//')
for side in a b; do
  programs=
  for name in $names; do
    file=$(set_ups $side)/$name.yaml
    [ -f "$file" ] || die "$name: there is no $file"
    programs="$programs $(word "$file" program)"
  done
  # shellcheck disable=SC2086,SC2046 # a list of words
  build_at $side $(printf '%s\n' $programs | sort -u)
done

# Both sides run in one folder, so that the paths that they write down are the same.
run_at() { # run_at SIDE NAME: results in $work/out/SIDE/NAME
  folder=$work/run out=$work/out/$1/$2
  rm -rf "$folder" "$out"
  mkdir -p "$work/out/$1"
  cp -r "$(set_ups "$1")" "$folder"
  file=$folder/$2.yaml
  (cd "$folder" && mpirun -n "$(word "$file" ranks)" \
    "$work/$1/build/bin/$(word "$file" program)" "$file" --out "$folder/out" --quiet) \
    >"$out.log" 2>&1 || { cat "$out.log" >&2; die "$2: the run of side $1 failed"; }
  mv "$folder/out" "$out"
}

code=0
for name in $names; do
  run_at a "$name"
  run_at b "$name"
  result=0
  found=$(/usr/bin/python3 "$source/tests/support/compare_bits.py" \
    "$work/out/a/$name" "$work/out/b/$name") || result=$?
  case $result in
    0) echo "$name: same ($found)" ;;
    1) echo "$name: $found"; code=1 ;;
    *) die "$name: the results could not be compared" ;;
  esac
done
exit $code
