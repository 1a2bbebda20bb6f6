#!/bin/sh
# Damaged checkpoints are refused in our own words: HDF5's error stack does not reach the user.
# usage: checkpoint_quiet.sh SOURCE BUILD
set -eu
build=$2
BW_BUILD_DIR=$build/checkpoint_quiet
export BW_BUILD_DIR
output=$(mpirun -np 2 "$build/bin/test_checkpoint_damage" 2>&1) || { echo "$output"; exit 1; }
case $output in
  *HDF5-DIAG*) echo "$output"; echo "HDF5's own messages are printed"; exit 1 ;;
esac
