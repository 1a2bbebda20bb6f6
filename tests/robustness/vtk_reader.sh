#!/bin/sh
# VTK's own readers (those of ParaView) see in our files what test_vtk wrote.
# usage: vtk_reader.sh SOURCE BUILD
set -eu
source=$1 build=$2
BW_VTK_TEST_DIR=$build/vtk_reader
export BW_VTK_TEST_DIR
rm -rf "$BW_VTK_TEST_DIR"
mpirun -np 2 "$build/bin/test_vtk"
/usr/bin/python3 "$source/tests/robustness/vtk_reader.py" "$BW_VTK_TEST_DIR"
