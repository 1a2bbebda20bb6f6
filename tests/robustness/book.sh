#!/bin/sh
# A coupling that makes energy is stopped with what, since when and a remedy, exit code 6, and the
# last good state on disk; one that holds is left alone. The plate, coarse, loaded by the reaction
# all at once (bad) and slowly (good).
# TEST timeout=300
set -u
