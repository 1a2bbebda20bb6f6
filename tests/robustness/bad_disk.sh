#!/bin/sh
# A run that is killed while it writes, or whose disk is full or locked, or loses what was not brought
# to it, goes on from its last checkpoint and ends with the bytes of one that nothing happened to.
# The long form: tests/support/bad_disk.py SOURCE BUILD 100
# usage: bad_disk.sh SOURCE BUILD
exec /usr/bin/python3 "$1/tests/support/bad_disk.py" "$1" "$2" 5 1 box porous_2 scene
