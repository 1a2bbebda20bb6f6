#!/bin/sh
# Every global symbol of a module begins with one of its prefixes, and no module keeps state in a
# variable of the file (but for the two that core has reasons for) or ends the program.
# usage: symbols.sh SOURCE BUILD
source=$1 build=$2 bad=0

complain() { bad=1; echo "$1:"; echo "$2"; }

# Written once by a signal handler; the text that goes with a returned status, per thread.
allowed_state='^(core requested|core last_message)$'

check() { # check MODULE PREFIXES
  archive=$build/lib/libbw_$1.a
  if [ ! -f "$archive" ]; then
    complain "$1" "there is no $archive: build first"
    return
  fi
  pattern=$(echo "$2" | sed 's/ *$//; s/  */|/g')
  names=$(nm --extern-only --defined-only "$archive" | awk 'NF == 3 {print $3}' |
          grep -vE "^($pattern)")
  [ -z "$names" ] || complain "$1: global symbols that do not begin with $pattern" "$names"
  # constant tables of addresses are in .data.rel.ro: no state
  state=$(objdump -t "$archive" |
          awk '{for (f = 2; f < NF; f++)
                  if ($f ~ /^\.t?(data|bss)$/ && $NF !~ /^\./) {
                    sub(/\.[0-9]+$/, "", $NF); print $NF; break}}' |
          sed "s/^/$1 /" | grep -vE "$allowed_state")
  [ -z "$state" ] || complain "$1: state in variables of the file" "$state"
  ends=$(nm -u "$archive" | awk '{print $2}' | grep -xE '_?exit|_Exit|abort|quick_exit' | sort -u)
  [ -z "$ends" ] || complain "$1: ends the program instead of returning a status" "$ends"
}

while IFS='|' read -r name prefixes _; do
  case $name in '#'* | '') continue ;; esac
  check "$(echo "$name" | tr -d ' ')" "$(echo "$prefixes" | sed 's/^ *//')"
done <"$source/tests/lint/modules.txt"
exit $bad
