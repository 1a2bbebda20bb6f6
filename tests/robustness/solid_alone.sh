#!/bin/sh
# A program of the solid alone links no fluid: neither FFTW nor the modules that need it.
# usage: solid_alone.sh SOURCE BUILD
set -eu
program=$2/bin/example_solid_only
ldd "$program" | grep -q 'libmpi' || { echo "FAIL: ldd says nothing of $program"; exit 1; }
if ldd "$program" | grep -i fftw; then echo "FAIL: it links FFTW"; exit 1; fi
ldd "$2/bin/breakwater" | grep -qi fftw || { echo "FAIL: breakwater links no FFTW: the test is blind"; exit 1; }
if nm "$program" | grep -E ' T bw_(ns|poisson|coupler|grid)_'; then
  echo "FAIL: it holds functions of the fluid"
  exit 1
fi
