#!/bin/sh
# What the pages docs/*.md show is what is there: a reader who does what a page says gets what it
# promises. A line of its own before a block of code says what the block is:
#   <!-- part of FILE -->   these lines stand in FILE, one after the other
#   <!-- all of FILE -->    (no block) the parts of FILE shown so far, in this order, are all of FILE but
#                           for empty lines
#   <!-- new file FILE -->  the reader writes this file, which is not there yet
#   <!-- run -->            the reader types these lines, after having written the new files so far
# Commands run in a copy of the project, so that they leave nothing here; each has to succeed.
# First planted pages have to be noticed.
# usage: pages.sh SOURCE
cd "$1" || exit 2
work=$(mktemp -d "${TMPDIR:-/tmp}/bw-pages.XXXXXX") || exit 2
trap 'rm -rf "$work"' EXIT

# A copy without builds and history; made when a page first needs it.
copy() {
  [ -d "$work/copy" ] && return
  mkdir "$work/copy"
  tar -cf - --exclude=./build --exclude='./build-*' --exclude=./.git . | tar -xf - -C "$work/copy"
}

# split PAGE: each directive of the page to $work/steps/NNN (one line), its block to NNN.block
split() {
  rm -rf "$work/steps"
  mkdir "$work/steps"
  awk -v to="$work/steps/" '
    block && /^ *```/ { block = 0; close(name ".block"); next }
    block { print > (name ".block"); next }
    /^<!-- .* -->$/ {
      name = sprintf("%s%03d", to, ++n)
      sub(/^<!-- /, ""); sub(/ -->$/, "")
      print > name; close(name); told = 1; next
    }
    /^ *```/ { if (told) { printf "" > (name ".block"); block = 1 } else skip = !skip; told = 0; next }
    /./ { told = 0 }' "$1"
}

# contains FILE BLOCK: the lines of BLOCK stand in FILE one after the other
contains() {
  awk 'NR == FNR { want[++n] = $0; next } { have[++m] = $0 }
       END {
         for (i = 0; i + n <= m; i++) {
           for (k = 1; k <= n && have[i + k] == want[k]; k++) ;
           if (k > n) exit 0
         }
         exit 1
       }' "$2" "$1"
}

# step PAGE WHAT FILE BLOCK: complains on standard output
step() {
  case $2 in
    part)
      [ -f "$3" ] || { echo "$1: there is no $3"; return; }
      contains "$3" "$4" || { echo "$1: a block that should be part of $3 is not:"; head -3 "$4"; }
      cat "$4" >>"$work/shown.$(echo "$3" | tr / +)" ;;
    all)
      grep -v '^ *$' "$3" >"$work/whole"
      grep -v '^ *$' "$work/shown.$(echo "$3" | tr / +)" 2>/dev/null | cmp -s - "$work/whole" ||
        echo "$1: the blocks that show $3 are not all of it" ;;
    new)
      copy
      [ ! -e "$work/copy/$3" ] || { echo "$1: the new file $3 is there already"; return; }
      mkdir -p "$(dirname "$work/copy/$3")"
      cp "$4" "$work/copy/$3" ;;
    run)
      copy
      (cd "$work/copy" && sh -e "$4") >"$work/said" 2>&1 ||
        { echo "$1: these commands fail:"; cat "$4"; tail -20 "$work/said"; } ;;
    *) echo "$1: what is <!-- $2 ... -->?" ;;
  esac
}

# check PAGE: complaints on standard output
check() {
  split "$1"
  rm -f "$work"/shown.*
  for told in "$work"/steps/[0-9][0-9][0-9]; do
    [ -f "$told" ] || continue
    read -r what second third <"$told"
    case $what in
      part | all) file=$third; [ "$second" = of ] || what="$what $second" ;;
      new) file=$third; [ "$second" = file ] || what="$what $second" ;;
      run) file= ;;
    esac
    [ "$what" = all ] || [ -f "$told.block" ] || { echo "$1: no block follows <!-- $what -->"; continue; }
    step "$1" "$what" "$file" "$told.block"
  done
}

# noticed TEXT WHAT: a page with that text makes the lint complain of WHAT
noticed() {
  printf '%b' "$1" >"$work/planted.md"
  check "$work/planted.md" | grep -q "$2" || { echo "not noticed: $2"; bad=1; }
}

bad=0
noticed '<!-- part of run -->\n```sh\n#!/bin/sh\nnot there\n```\n' 'should be part of run'
noticed '<!-- part of run -->\n```sh\n#!/bin/sh\n```\n\n<!-- all of run -->\n' 'not all of it'
noticed '<!-- new file run -->\n```sh\n#!/bin/sh\n```\n' 'is there already'
noticed '<!-- run -->\n```sh\nfalse\n```\n' 'commands fail'
noticed '<!-- run -->\n\ntext\n' 'no block follows'
for page in docs/*.md; do
  check "$page"
done >"$work/found"
cat "$work/found"
[ ! -s "$work/found" ] && exit $bad
exit 1
