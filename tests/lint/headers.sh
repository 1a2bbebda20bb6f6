#!/bin/sh
# Every public header (modules/*/bw_*.h) compiles alone, without a warning, as C11 and as C++17;
# gives its functions C linkage; and needs no mpi.h, but for the one that hands out a communicator
# and the one that core and grid send messages with. Headers that are installed include no others.
# usage: headers.sh SOURCE
cd "$1" || exit 2
may_need_mpi='modules/core/bw_comm_mpi.h modules/core/bw_message.h'
work=$(mktemp -d) || exit 2
trap 'rm -rf "$work"' EXIT
bad=0

complain() { bad=1; echo "$1"; }

folders=
for folder in modules/*/; do folders="$folders -I $folder"; done

# compile HEADER STANDARD COMPILER FLAGS...: a program that includes nothing else
compile() {
  header=$1 standard=$2
  shift 2
  # shellcheck disable=SC2086 # a list of flags
  printf '#include "%s"\ntypedef int not_empty;\n' "$(basename "$header")" |
    "$@" -std="$standard" -Wall -Wextra -Wpedantic -Werror -D_POSIX_C_SOURCE=200809L \
         $folders -fsyntax-only - >"$work/said" 2>&1 ||
    complain "$header does not compile alone as $standard:
$(cat "$work/said")"
}

# Does the header include mpi.h, by whatever way?
needs_mpi() {
  # shellcheck disable=SC2086 # a list of flags
  printf '#include "%s"\n' "$1" | mpicc $folders -I . -M -x c - 2>"$work/said" | tr ' ' '\n' |
    grep -qE '(^|/)mpi\.h$'
}

for header in modules/*/bw_*.h; do
  c=${CC:-cc} cxx=${CXX:-c++}
  case " $may_need_mpi " in
    *" $header "*) c=mpicc cxx=mpicxx ;;
    *) ! needs_mpi "$header" || complain "$header includes mpi.h: only $may_need_mpi may" ;;
  esac
  compile "$header" c11 "$c" -x c
  compile "$header" c++17 "$cxx" -x c++ -DOMPI_SKIP_MPICXX -DMPICH_SKIP_MPICXX
  # What begins in the first column and ends in `);` or an attribute declares a function.
  if grep -qE '^[^#/ ].*(\);|BW_MUST_CHECK;|BW_PRINTF\([0-9, ]*\);)' "$header" &&
     ! grep -qE '^(BW_BEGIN_DECLS|extern "C" \{)' "$header"; then
    complain "$header declares functions without BW_BEGIN_DECLS ... BW_END_DECLS (bw_decls.h)"
  fi
done

# What is installed: public headers, and those that cmake/install.cmake names for authors of laws.
{ ls modules/*/bw_*.h; grep -oE 'modules/[a-z_]+/[a-z_]+\.h' cmake/install.cmake; } >"$work/installed"
while read -r header; do
  grep -ohE '^ *# *include +"[^"]+"' "$header" | sed 's/.*"\(.*\)"/\1/' | while read -r included; do
    grep -q "/$included\$" "$work/installed" ||
      echo "$header is installed and includes $included, which is not: see cmake/install.cmake"
  done
done <"$work/installed" >"$work/missing"
[ ! -s "$work/missing" ] || complain "$(cat "$work/missing")"
exit $bad
