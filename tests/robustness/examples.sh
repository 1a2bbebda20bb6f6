#!/bin/sh
# Commands printed in texts work: every case file they name is there, every program takes it with the
# options that stand behind it.
# usage: examples.sh SOURCE BUILD
exec /usr/bin/python3 "$1/tests/support/examples.py" "$1" "$2"
