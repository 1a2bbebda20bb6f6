#!/bin/sh
# No status is lost: what a function returns as bw_status is looked at, in static functions and
# behind pointers too (clang, which knows the attribute of the type); no value is stored that nobody
# reads (clang's analysis of dead stores: a status overwritten by the next one); no status is cast
# away; and public functions say BW_MUST_CHECK, so that whoever includes them with gcc is warned.
# Each kind is planted first and must be seen. Every source that CMake compiles is looked at.
# usage: statuses.sh SOURCE BUILD
source=$1 build=$2 bad=0
work=$(mktemp -d) || exit 2
trap 'rm -rf "$work"' EXIT
complain() { bad=1; echo "$1"; }

command -v clang >/dev/null || { echo "clang is missing: ./run setup"; exit 1; }
list=$build/compile_commands.json
[ -f "$list" ] || { echo "there is no $list: configure first"; exit 1; }

# Flags and name of every source, once; not what concerns gcc's object file.
sed -n 's/^ *"command": "[^ ]* \(.*\)",$/\1/p' "$list" |
  sed 's/\\"/"/g; s/ -Werror / /; s/ -o [^ ]* -c / /' |
  awk '!seen[$NF]++' >"$work/sources"
[ -s "$work/sources" ] || complain "$list names no source"

# clang_says FILE: its complaints about the sources of a list, one of flags and name a line
clang_says() {
  # shellcheck disable=SC2016 # {} is for xargs
  xargs -P 2 -I{} sh -c 'clang -fsyntax-only -Wall -Wextra -Wunused-result {} 2>&1
    clang --analyze --analyzer-no-default-checks -Xclang -analyzer-output=text \
          -Xclang -analyzer-checker=deadcode.DeadStores {} 2>&1' <"$1" |
    grep -E '(warning|error):' | sort -u
}

# cast_away FILE...: lines that cast a status to void, a call or a variable of the same file
cast_away() {
  functions=$(cat "$@" | grep -oE '\bbw_status +[a-z_0-9]+\(' | sed 's/bw_status *//; s/(//' | sort -u |
              paste -s -d '|')
  for file; do
    variables=$(grep -oE '\bbw_status [a-z_0-9]+( |;|=|,|\))' "$file" |
                sed 's/bw_status //; s/[ ;=,)]//' | sort -u | paste -s -d '|')
    grep -nE "\\(void\\) *(($functions)\\(|(${variables:-no_status})\\b[^(])" "$file" |
      sed "s|^|$file: |"
  done
}

# unmarked HEADER...: declarations without BW_MUST_CHECK
unmarked() {
  awk '
    FNR == 1 { open = 0 }
    !open && /^bw_status +[a-z_0-9]+\(/ { open = 1; text = ""; at = FILENAME ":" FNR }
    open { text = text $0 }
    open && /[;{]/ {
      if (text ~ /;/ && text !~ /BW_MUST_CHECK/) print at ": " text
      open = 0
    }' "$@"
}

# ---- plants -----------------------------------------------------------------------------------
flags=$(grep '/modules/core/bw_status\.c$' "$work/sources" | sed 's/ [^ ]*$//')
# plant TEXT: a function of `x` and a pointer `by`, ending in TEXT; prints what clang says
plant() {
  cat >"$work/plant.c" <<END
#include "bw_status.h"
static bw_status f(int x)
{
  return x > 0 ? BW_OK : BW_EIO;
}
bw_status g(int x, bw_status (*by)(int));
bw_status g(int x, bw_status (*by)(int))
{
  $1
}
END
  echo "$flags $work/plant.c" >"$work/plants"
  clang_says "$work/plants"
}
# planted KIND TEXT WORDS: clang says WORDS about TEXT
planted() { plant "$2" | grep -q "$3" || complain "not seen: $1"; }

found=$(plant 'const bw_status st = f(x); return st == BW_OK ? by(x) : st;')
[ -z "$found" ] || complain "seen where nothing is wrong: $found"
planted "a dropped status of a static function" 'f(x); return by(x);' 'ignoring return value'
planted "a dropped status behind a pointer" 'by(x); return f(x);' 'ignoring return value'
planted "a status overwritten" 'bw_status st = f(x); st = by(x); return st;' 'never read'
planted "a status assigned and never looked at" 'bw_status st; st = f(x); return by(x);' 'never read'
printf 'static bw_status f(int x);\nvoid g(void)\n{\n  (void)f(1);\n}\n' >"$work/plant.c"
[ -n "$(cast_away "$work/plant.c")" ] || complain "not seen: a call cast away"
printf 'void g(void)\n{\n  const bw_status st = f(1);\n  (void)st;\n}\n' >"$work/plant.c"
[ -n "$(cast_away "$work/plant.c")" ] || complain "not seen: a variable cast away"
printf 'bw_status bw_x_create(int x,\n                      int y);\n' >"$work/plant.h"
[ -n "$(unmarked "$work/plant.h")" ] || complain "not seen: a declaration without BW_MUST_CHECK"

# ---- the tree ---------------------------------------------------------------------------------
found=$(clang_says "$work/sources")
[ -z "$found" ] || complain "$found"
cd "$source" || exit 2
files=$(find modules cases validation bench tests docs -name '*.[ch]' | sort)
# shellcheck disable=SC2086 # a list of words
found=$(cast_away $files)
[ -z "$found" ] || complain "statuses cast away:
$found"
# internal headers of modules are seen by this module alone, for which the type's attribute does
# shellcheck disable=SC2046 # a list of words
found=$(unmarked $(echo "$files" | grep -E '^(modules/[a-z_]*/bw_|cases|validation|bench|tests|docs).*\.h$'))
[ -z "$found" ] || complain "without BW_MUST_CHECK:
$found"
exit $bad
