#!/bin/bash
# tidy.sh [--all]: clang-tidy (.clang-tidy) on the product's files that changed since origin/main, or since the commit
# before where this is origin/main itself; --all: on every one. LibTorch's headers take minutes a file: what includes
# them stays out. A finding is an error.
set -euo pipefail
cd "$(dirname "$(readlink -f "$0")")/.."
cmake --preset dev >/dev/null  # only for its compile_commands.json: it names every file
with_torch=$(awk '!/^#/ && / torch( |$)/ { print "^" $1 "/" }' tests/layers.txt | paste -sd '|')
[ -n "$with_torch" ] || { echo "tidy.sh: tests/layers.txt names no folder with torch" >&2; exit 1; }
if [ "${1:-}" = --all ]; then
  changed=$(git ls-files app render ui retarget)
else
  head=$(git rev-parse HEAD)
  since=$(git merge-base origin/main HEAD 2>/dev/null || echo "$head")
  [ "$since" != "$head" ] || since=$(git rev-parse --verify --quiet HEAD~1 || echo "$head")
  changed=$(git diff --name-only --diff-filter=d "$since" -- app render ui retarget)
fi
files=()
for file in $(sed 's/\.hpp$/.cpp/' <<<"$changed" | grep '\.cpp$' | grep -vE "$with_torch" | sort -u); do
  [ -f "$file" ] && files+=("$file")
done
echo "clang-tidy on ${#files[@]} files"
[ ${#files[@]} -gt 0 ] || exit 0
printf '%s\n' "${files[@]}" | xargs -P "$(nproc)" -n 4 clang-tidy -p build-dev --quiet --warnings-as-errors='*' 2>/dev/null
