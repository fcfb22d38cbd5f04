#!/usr/bin/env bash
# The commands that a newcomer begins with do what they say: quickstart, with its page, and the page of figure 10.
#   first_steps.sh SOURCE
set -euo pipefail
cd "$1"
mkdir -p out
rm -f out/circle.html out/figure10.html
tools/quickstart 2>&1 | tee out/quickstart.txt
grep -q 'file://.*/out/circle.html' out/quickstart.txt
tail -2 out/quickstart.txt | grep -q 'lineshaft new mine'
tail -1 out/quickstart.txt | grep -q 'the course .*programs/01_axis.yaml'
if grep -iE 'warning|built without' out/quickstart.txt; then echo "that reads like a failure" >&2; exit 1; fi
grep -q '"runs_first":true' out/circle.html || { echo "the tables come before the circle" >&2; exit 1; }
tools/figure10
for page in out/circle.html out/figure10.html; do
    [ "$(wc -c <$page)" -gt 50000 ] || { echo "$page is not whole" >&2; exit 1; }
done
