#!/bin/sh
# Files of a module that need each other in a circle cannot be read, tested or replaced one by one. No
# module of the solid has one, nor has what it stands on; `knotted` names the modules whose files still
# call each other.
# usage: circles.sh SOURCE BUILD
set -u
source=$1 build=$2 bad=0
knotted=' core coupler ns_channel pd_interface pd_material rigid scene ulph '

# needs ARCHIVE: a line "file other" for every file that uses a function of another file of the archive
needs() {
  nm -A "$1" | awk '
    { split($1, part, ":"); file = part[2]; name = $NF; type = $(NF - 1) }
    type ~ /^[TDBRC]$/ { home[name] = file; print file, file }
    type == "U" { user[++n] = file; used[n] = name }
    END { for (q = 1; q <= n; q++)
            if (used[q] in home && home[used[q]] != user[q]) print user[q], home[used[q]] }' | sort -u
}

while IFS='|' read -r name _; do
  name=$(echo "$name" | tr -d ' ')
  case $name in '#'* | '') continue ;; esac
  case $knotted in *" $name "*) continue ;; esac
  archive=$build/lib/libbw_$name.a
  [ -f "$archive" ] || { echo "$name: there is no $archive: build first"; bad=1; continue; }
  loops=$(needs "$archive" | LC_ALL=C tsort 2>&1 >/dev/null)
  [ -z "$loops" ] || { bad=1; echo "$name: files that need each other in a circle:"; echo "$loops"; }
done <"$source/tests/lint/modules.txt"
exit $bad
