# shellcheck shell=sh disable=SC2154 # $source is that of who sources this
# Sourced by tests/same_bits.sh and tests/same_speed.sh: two commits, each with its tree and its build.
# Sets $work, a folder that BW_SAME may keep from an earlier comparison. Needs git, cmake, python3.

work=${BW_SAME:-}
if [ -z "$work" ]; then
  work=$(mktemp -d "${TMPDIR:-/tmp}/bw-same.XXXXXX")
  trap 'rm -rf "$work"' EXIT
fi
mkdir -p "$work"
work=$(cd "$work" && pwd)

# The processes of mpirun share the cores; it also runs as root.
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
export OMPI_MCA_rmaps_base_oversubscribe=1 OMPI_MCA_mpi_yield_when_idle=1
export OMPI_MCA_btl_vader_single_copy_mechanism=none OMPI_MCA_hwloc_base_binding_policy=none

die() { echo "$*" >&2; exit 2; }

# commit_of WORD: the full name of a commit; "." is the working tree with its changes (files that git
# does not know yet are left out).
commit_of() {
  if [ "$1" = . ]; then
    changed=$(git -C "$source" stash create)
    git -C "$source" rev-parse "${changed:-HEAD}"
  else
    git -C "$source" rev-parse --verify --quiet "$1^{commit}" || die "$1: git knows no such commit"
  fi
}

# tree_at SIDE COMMIT: $work/SIDE becomes a tree of that commit. A tree of an earlier comparison is
# moved on, so that only what differs is built again. A clone that borrows the objects, and no work tree
# of git's own: the repository of the user keeps no trace of it.
tree_at() {
  if [ ! -d "$work/$1/.git" ]; then
    git clone --quiet --shared --no-checkout "$source" "$work/$1" || die "$work/$1: git clone failed"
  fi
  git -C "$work/$1" checkout --quiet --force --detach "$2" || die "$work/$1: no tree of $2"
}

# build_at SIDE TARGET...: configured with the release preset if it is not yet, then built.
build_at() {
  side=$1
  shift
  (cd "$work/$side" && { [ -f build/build.ninja ] || cmake --preset release; } &&
    cmake --build build --target "$@") >"$work/$side.log" 2>&1 || {
    tail -n 20 "$work/$side.log" >&2
    die "$work/$side: the build failed, see $work/$side.log"
  }
}
