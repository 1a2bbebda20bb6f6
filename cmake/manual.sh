#!/bin/sh
# The manual page of a program is what it says to --help, whose first line is "NAME: what it is".
# usage: manual.sh HELP2MAN VERSION PROGRAM PAGE
what=$("$3" --help | sed -n '1s/^[^:]*: *//p')
"$1" --no-info --name="${what:-a program of Breakwater}" --version-string="$2" --output="$4" "$3" &&
  gzip -9nf "$4"
