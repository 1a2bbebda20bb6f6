#!/bin/sh
# Every program of tests/ and validation/ says in its head on how many ranks it runs, and a head that
# cannot be read stops the configuration with a line that names the file. Heads are broken one at a
# time in a copy of the tree.
# usage: heads.sh SOURCE
source=$1 bad=0
work=$(mktemp -d) || exit 2
trap 'rm -rf "$work"' EXIT
mkdir "$work/tree"
(cd "$source" && tar -cf - --exclude=./build --exclude='./build-*' --exclude=./out --exclude=./.git .) |
  tar -xf - -C "$work/tree" || exit 2
cd "$work/tree" || exit 2

configure() { cmake --preset release >"$work/said" 2>&1; }
complain() { bad=1; echo "$1"; cat "$work/said"; }

# As they are: every test of a program is there on every number of ranks that its head names.
configure || { complain "the tree as it is cannot be configured"; exit 1; }
ctest --test-dir build -N | sed -n 's/^ *Test *#[0-9]*: *\([a-z]*\.[^ ]*\)\.np\([0-9]*\)$/\1 \2/p' |
  sort >"$work/tests"
for file in tests/unit/*/test_*.c validation/*/*.c docs/examples/*.c; do
  case $file in
    validation/support/*) continue ;;
    tests/unit/*) name=unit.$(echo "$file" | cut -d / -f 3,4 | tr / .) ;;
    validation/*) name=validation.$(echo "$file" | cut -d / -f 2,3 | tr / .) ;;
    *) name=example.$(basename "$file") ;;
  esac
  for np in $(sed -n 's|^ \* TEST .*ranks=\([0-9,]*\).*|\1|p' "$file" | tr ',' ' '); do
    echo "${name%.c} $np"
  done
done | sort >"$work/heads"
cmp -s "$work/heads" "$work/tests" || {
  diff "$work/heads" "$work/tests" >"$work/said"
  complain "heads (<) and tests (>) differ"
}

# broken FILE SED WHAT: with FILE changed by SED the configuration stops and says WHAT of FILE
broken() {
  cp "$1" "$work/kept"
  sed -i "$2" "$1"
  if cmp -s "$1" "$work/kept"; then complain "$1: '$2' changes nothing"; fi
  if configure; then
    complain "$1 with '$2': configured nevertheless"
  elif ! grep -qF "$1: $3" "$work/said"; then
    complain "$1 with '$2': stopped, but not because of '$3'"
  fi
  cp "$work/kept" "$1"
}

unit=tests/unit/grid/test_transpose.c
claim=validation/poisson/residual.c
broken $unit '/\* TEST/s|TEST.*|*/|' 'has no line'
broken $unit 's/ranks=[0-9,]*//' 'has no line'
broken $unit 's/\* TEST/* y or z. TEST/' 'TEST and BUILD begin a line of their own'
broken $unit 's/ranks=/ranks: /' 'TEST is followed by words key=value'
broken $unit 's/\* TEST ranks/* TEST: ranks/' 'TEST is followed by words key=value'
broken $unit 's/ranks=[0-9,]*/& two/' 'TEST is followed by words key=value'
broken $unit 's/ranks=[0-9,]*/ranks=1,two/' 'TEST ranks=1,two must be whole numbers'
broken $unit 's/ranks=[0-9,]*/& ranks=2/' 'TEST says ranks twice'
broken $unit 's/ranks=[0-9,]*/& rank=2/' 'TEST has the keys ranks, timeout and args, not rank'
broken $unit 's/ranks=[0-9,]*/& timeout=60/' 'TEST timeout=60 must be seconds, 600 at least'
broken $unit 's/ranks=[0-9,]*/& timeout=1h/' 'TEST timeout=1h must be seconds'
broken $claim '/\* TEST/{p;s/ \*\/$//}' 'a second line of TEST'
broken $claim 's/BUILD modules=grid/& timeout=900/' 'BUILD has the keys modules, libs and case, not timeout'
broken $claim 's/BUILD modules=grid/&,gird/' 'BUILD modules=gird: there is no such module'
broken $claim 's/BUILD modules=grid/& case=porus/' 'BUILD case=porus: there is no such folder of cases/'
exit $bad
