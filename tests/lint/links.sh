#!/bin/sh
# A module includes and calls only the modules its row in modules.txt names, and of those only
# what is public (no bw_MODULE__name).
# usage: links.sh SOURCE BUILD
source=$1 build=$2 bad=0
table=$source/tests/lint/modules.txt
work=$(mktemp -d) || exit 2
trap 'rm -rf "$work"' EXIT

complain() { bad=1; echo "$1"; }

rows() { sed 's/#.*//' "$table" | grep '|'; }
names() { rows | cut -d '|' -f 1 | tr -d ' '; }

# Who defines which symbol, who has which header: lines "NAME MODULE".
for module in $(names); do
  archive=$build/lib/libbw_$module.a
  [ -f "$archive" ] || { echo "there is no $archive: build first"; exit 1; }
  nm --extern-only --defined-only "$archive" | awk -v m="$module" 'NF == 3 {print $3, m}'
done >"$work/symbols"
for module in $(names); do
  find "$source/modules/$module" -name '*.h' | sed "s|.*/||; s|\$| $module|"
done >"$work/headers"

# Every folder of modules/ has a row.
for folder in "$source"/modules/*/; do
  names | grep -qx "$(basename "$folder")" ||
    complain "modules/$(basename "$folder") has no row in tests/lint/modules.txt"
done

# CMakeLists.txt links what the row says, no more and no less. Rows "NAME MODULE MODULE ...", sorted.
linked() {
  tr '\n' ' ' <"$source/CMakeLists.txt" | grep -oE 'bw_module\([^)]*\)' |
    sed -E 's/bw_module\(//; s/ (PRIVATE_LIBS|OPTIONS) .*//; s/ DEPENDS//; s/\)//' | ordered
}
ordered() {
  while read -r name depends; do
    # shellcheck disable=SC2046 # a list of words
    echo "$name" $(echo "$depends" | tr -s ' ' '\n' | sort)
  done | sort
}
linked >"$work/linked"
rows | sed -E 's/\|[^|]*\|/ /' | ordered >"$work/named"
diff "$work/linked" "$work/named" >"$work/differ" ||
  complain "CMakeLists.txt (<) links other modules than tests/lint/modules.txt (>) names:
$(cat "$work/differ")"

# owner_check MODULE ALLOWED FILE WHAT: the names on standard input belong to allowed modules
owner_check() {
  while read -r name; do
    owner=$(awk -v n="$name" '$1 == n {print $2; exit}' "$3")
    case " $1 $2 " in
      *" $owner "*) ;;
      *) [ -z "$owner" ] || complain "$1 $4 $name of $owner, which its row does not name" ;;
    esac
    case $name in
      bw_*__*) [ "$owner" = "$1" ] || complain "$1 $4 $name, internal to $owner" ;;
    esac
  done
}

check() { # check MODULE ALLOWED
  grep -rhoE '^ *# *include +"[^"]+"' "$source/modules/$1" --include='*.[ch]' |
    sed 's/.*"\(.*\)"/\1/; s|.*/||' | sort -u >"$work/included"
  owner_check "$1" "$2" "$work/headers" includes <"$work/included"
  nm --undefined-only "$build/lib/libbw_$1.a" | awk '$1 == "U" && $2 ~ /^bw_/ {print $2}' |
    sort -u >"$work/undefined"
  owner_check "$1" "$2" "$work/symbols" calls <"$work/undefined"
}

rows >"$work/rows"
while IFS='|' read -r name _ depends; do
  check "$(echo "$name" | tr -d ' ')" "$(echo "$depends" | tr -s ' ')"
done <"$work/rows"
exit $bad
