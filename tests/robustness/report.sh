#!/bin/sh
# tools/report.py: one page that is whole by itself, with landmarks and a name for every picture, in a browser, too, where
# there is one; what is worse or better than in the kept report.
# usage: report.sh SOURCE BUILD
set -eu
rm -rf "$2/test_report" && mkdir -p "$2/test_report"
exec /usr/bin/python3 "$1/tests/robustness/report_page.py" "$1" "$2/test_report"
