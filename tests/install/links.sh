#!/bin/bash
# Every relative link in the documentation leads to a file. Argument: source folder.
set -euo pipefail
cd "$1"
broken=0
while IFS=: read -r page link; do
  target=$(dirname "$page")/$(sed -E 's/^\]\(([^)#]*).*/\1/' <<<"$link")
  [[ -e $target ]] || { echo "$page: $target does not exist"; broken=1; }
done < <(grep -oE '\]\([^)#:]+[)#]' README.md docs/*.md)
exit $broken
