#!/usr/bin/env bash
# The commands that a newcomer begins with do what they say: quickstart, with its page, and the page of figure 10.
#   first_steps.sh SOURCE
set -euo pipefail
cd "$1"
mkdir -p out
rm -f out/circle.html out/figure10.html
tools/quickstart | tee out/quickstart.txt
grep -q 'file://.*/out/circle.html' out/quickstart.txt
tools/figure10
for page in out/circle.html out/figure10.html; do
    [ "$(wc -c <$page)" -gt 50000 ] || { echo "$page is not whole" >&2; exit 1; }
done
