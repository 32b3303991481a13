#!/bin/bash
# tidy.sh: clang-tidy (.clang-tidy) on the product's files, a folder's together, as the preset release compiles them.
# LibTorch's headers take minutes: folders that include them stay out. A finding is an error.
set -euo pipefail
cd "$(dirname "$(readlink -f "$0")")/.."
cmake --preset release >/dev/null  # only for its compile_commands.json: it names every file that is compiled
with_torch=$(awk '!/^#/ && / torch( |$)/ { print "/" $1 "/" }' tests/layers.txt | paste -sd '|')
[ -n "$with_torch" ] || { echo "tidy.sh: tests/layers.txt names no folder with torch" >&2; exit 1; }
sed -n 's/^  "file": "\(.*\)".*/\1/p' build/compile_commands.json | grep -E "^$PWD/(build/)?(app|render|ui|retarget)/" |
  grep -vE "$with_torch|torch_pch" | xargs -P "$(nproc)" -n 1 clang-tidy -p build --quiet --warnings-as-errors='*' \
    --header-filter="^$PWD/(app|render|ui|retarget)/" 2>/dev/null
