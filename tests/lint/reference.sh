#!/bin/sh
# Doxygen builds the reference of all public headers (modules/*/bw_*.h) without a warning: every
# function, type, struct member and macro in them is explained. First it has to notice what a header
# made for the purpose leaves unexplained, so that silence means something.
# usage: reference.sh SOURCE BUILD
cd "$1" || exit 2
command -v doxygen >/dev/null || { echo "doxygen is missing: ./run setup"; exit 1; }
work=$(mktemp -d) || exit 2
trap 'rm -rf "$work"' EXIT

reference() { # reference INPUT...: warnings on standard output
  { cat docs/Doxyfile; echo "INPUT = $*"; echo "SEARCHENGINE = NO"; } |
    BW_REFERENCE=$work doxygen - 2>&1
}

cat >"$work/bw_planted.h" <<'END'
/* bw_planted.h -- made to be incomplete.
 *
 *   a + b < c   a formula, and names that mean something to Doxygen: @x \y #z */
#pragma once
#include "bw_comm.h" /* not said of anything */
#ifdef __cplusplus
extern "C" {
#endif

typedef struct bw_opaque bw_opaque;

/* Explained. */
typedef struct {
  double explained, too; /* both [L] */
  int planted_member;
} bw_planted_struct;

/* Explained, and the next one with it. */
bw_status bw_planted_one(const bw_opaque *o,
                         int n) BW_MUST_CHECK;
void bw_planted_two(bw_opaque *o); /* Local. */

int bw_planted_function(int a);
#define BW_PLANTED_MACRO 1

static inline int bw_planted_inline(int a) /* Local. */
{
  return a; /* not said of anything */
}
#ifdef __cplusplus
}
#endif
END
reference "$work/bw_planted.h" >"$work/planted"
bad=0
for name in planted_member bw_planted_function BW_PLANTED_MACRO bw_planted_inline; do
  grep -q "$name.* is not documented" "$work/planted" ||
    { echo "doxygen did not notice that $name is not explained"; bad=1; }
done
found=$(grep -c 'is not documented' "$work/planted")
[ "$found" -eq 4 ] || { echo "4 things are not explained, doxygen found $found:"; cat "$work/planted"; bad=1; }

reference modules docs/reference.dox >"$work/found" || bad=1
sed "s|$PWD/||" "$work/found" | sort -u
exit $bad
