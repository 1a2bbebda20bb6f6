#!/bin/sh
# The pages docs/*.md lead where they say.
# - Every row of the index in docs/theory.md names a file that exists and a function that is defined
#   in it.
# - Every function of ours and every file that theory, errata, sources and glossary name in backticks
#   is there, and a function with a file behind it in brackets is defined in that file.
# - Every ERRATA number that the code cites has an entry in docs/errata.md.
# - The table of who includes whom in docs/architecture.md is that of the sources.
# - Every author who is cited with a year has a line in docs/sources.md.
# First a planted row has to be noticed.
# usage: index.sh SOURCE
# shellcheck disable=SC2016 # backticks are Markdown's
cd "$1" || exit 2
work=$(mktemp -d) || exit 2
trap 'rm -rf "$work"' EXIT
: >"$work/bad"
complain() { echo "$1"; echo x >>"$work/bad"; }

# Words that are defined or declared somewhere: one list, so that looking is cheap.
grep -rhoE '[A-Za-z_][A-Za-z0-9_]*' modules cases validation tests docs/examples \
     --include='*.c' --include='*.h' | sort -u >"$work/words"

defined() { # defined FUNCTION FILE: a line there begins with a type and has the name behind it
  grep -qE "^[A-Za-z].*[ *]$1(\(|\[)" "$2"
}

index_rows() { # rows "function|file" of the index of a page
  sed -n '/^## Index/,$p' "$1" | grep -E '^\|.*\|.*`.*`.*\|.*`.*` *\|$' |
    sed -E 's/.*\| *`([^`]*)` *\| *`([^`]*)` *\|$/\1|\2/'
}

check_index() { # check_index PAGE: complaints on standard output
  index_rows "$1" | while IFS='|' read -r function file; do
    if [ ! -f "$file" ]; then echo "$1: the index names $file, which does not exist"
    elif ! defined "$function" "$file"; then echo "$1: $function is not defined in $file"
    fi
  done
}

planted=$work/planted.md
printf '## Index\n| a | b | `no_such_function` | `modules/core/bw_comm.c` |\n| a | b | `x` | `no/file.c` |\n' \
  >"$planted"
[ "$(check_index "$planted" | wc -l)" -eq 2 ] || complain "planted rows of the index were not noticed"

rows=$(index_rows docs/theory.md | wc -l)
[ "$rows" -ge 40 ] || complain "docs/theory.md: only $rows rows were read from the index"
check_index docs/theory.md >"$work/found"
while read -r line; do complain "$line"; done <"$work/found"

# Pairs "`function` (`file`)" of the errata.
tr '\n' ' ' <docs/errata.md | grep -oE '`[a-z0-9_]+` \(`[A-Za-z0-9_./-]+`\)' | tr -d '`()' | sort -u >"$work/pairs"
[ "$(wc -l <"$work/pairs")" -ge 20 ] || complain "docs/errata.md: too few functions were read"
while read -r function file; do
  [ ! -f "$file" ] || defined "$function" "$file" || echo "docs/errata.md: $function is not defined in $file"
done <"$work/pairs" >"$work/found"
while read -r line; do complain "$line"; done <"$work/found"

# Names in backticks.
for page in docs/theory.md docs/errata.md docs/sources.md docs/glossary.md; do
  grep -oE '`[^`]+`' "$page" | tr -d '`' | sort -u >"$work/names"
  grep -E '^(bw_|porous_|specimen_)[a-z0-9_]+$' "$work/names" | while read -r name; do
    grep -qx "$name" "$work/words" || echo "$page: there is no $name"
  done
  grep -E '^(modules|cases|validation|tests|data|docs|bench|tools)/[A-Za-z0-9_./-]+$' "$work/names" |
    while read -r name; do [ -e "$name" ] || echo "$page: there is no $name"; done
done >"$work/found"
while read -r line; do complain "$line"; done <"$work/found"

# Who includes whom: a table with one arrow less has to be noticed.
sed '0,/^    pd_body .* x/s/^\(    pd_body .*\) x/\1 ./' docs/architecture.md >"$work/architecture.md"
python3 tools/who_includes_whom.py "$work/architecture.md" >/dev/null &&
  complain "a planted error in the table of who includes whom was not noticed"
python3 tools/who_includes_whom.py docs/architecture.md >"$work/found" ||
  complain "$(cat "$work/found")"

# Cited numbers.
grep -rhoE 'ERRATA [0-9]+(, [0-9]+)*' modules cases validation tests bench data docs README.md 2>/dev/null |
  grep -oE '[0-9]+' | sort -un | while read -r n; do
    grep -qx "### ERRATA $n" docs/errata.md || echo "docs/errata.md has no entry $n, which is cited"
  done >"$work/found"
while read -r line; do complain "$line"; done <"$work/found"

# Cited authors: "Surname 1999", "Surname et al. 1999", "Surname & Other (1999)".
grep -rhoE "[A-Z][a-z]{2,}( et al\.|( &|,| and)( [A-Z][a-z]+)+)*,? \(?(19|20)[0-9]{2}\b" \
     modules cases validation data docs README.md --include='*.[ch]' --include='*.md' \
     --include='*.csv' --include='*.yaml' 2>/dev/null |
  grep -vE '^(January|February|March|April|May|June|July|August|September|October|November|December|Figure|Table|Copyright|University|Press|Wiley|Springer|Glasgow|Elsevier|Plenum|Pages?)' |
  sed -E 's/[ ,].*//' | sort -u | while read -r name; do
    grep -q "$name" docs/sources.md || echo "docs/sources.md does not name $name, who is cited with a year"
  done >"$work/found"
while read -r line; do complain "$line"; done <"$work/found"
[ ! -s "$work/bad" ]
