#!/bin/bash
# Fails when a layer includes a higher one: retarget core <- pipeline <- nn, training; core <- render;
# core, pipeline <- app/run <- app/session <- ui <- app/studio; app/main.cpp knows all. LibTorch only in nn and
# training.
# check_layers.sh [ROOT]: the tree to check, by default the one that this script is in.
set -euo pipefail
cd "${1:-$(dirname "$0")/..}"
status=0

# refuse FOLDER... -- REGEX: no file in the folders may include what the regex matches.
refuse() {
  local folders=() hits
  while [ "$1" != "--" ]; do [ -d "$1" ] && folders+=("$1"); shift; done
  [ ${#folders[@]} -eq 0 ] && return 0
  hits=$(grep -rnE --include='*.hpp' --include='*.cpp' "^ *#include *[<\"]($2)" "${folders[@]}" |
    grep -v '^retarget/plugin/' || true)  # the plug-in hands all that needs LibTorch to the program
  [ -z "$hits" ] && return 0
  echo "A layer reaches up (${folders[*]} may not include $2):"
  echo "$hits"
  status=1
}

torch='torch/|ATen/|c10/'
upper='render/|app/|ui/'
methods='retarget/(networks|nn|training|motion_space|marionette|style|pose2d)/'
refuse retarget -- "$upper|GL/|EGL/|GLES|imgui"
refuse retarget/base retarget/math retarget/geometry retarget/skeleton -- \
  "retarget/(body|formats|metrics|pipeline)/|$methods|$torch"
refuse retarget/base -- "retarget/(math|geometry|skeleton)/|Eigen/"
refuse retarget/math -- "retarget/(geometry|skeleton)/"
refuse retarget/geometry -- "retarget/skeleton/"
refuse retarget/body retarget/formats retarget/metrics -- "retarget/pipeline/|$methods|$torch"
refuse retarget/pipeline -- "$methods|$torch"
refuse retarget/editing -- "retarget/(body|formats|metrics)/|$methods|$torch"
refuse retarget/nn -- "retarget/training/"
refuse render -- "app/|ui/|retarget/pipeline/|$methods|$torch|imgui"
refuse app -- "$torch|retarget/(nn/modules|training)/"
refuse app/run app/session -- "ui/|app/(cli|studio)/"
refuse app/cli -- "ui/"
refuse app/run -- "app/(cli|session)/|render/|retarget/(networks|nn)/"
refuse app/session -- "app/cli/|render/|$methods|imgui|GL/"
refuse app/studio -- "app/cli/|$methods"
refuse ui -- "app/(cli|studio)/|$methods|$torch"
# A header that makes its includers compile LibTorch belongs in nn/modules or training.
headers=$(grep -rlE --include='*.hpp' "^ *#include *[<\"]($torch)" retarget | grep -vE '^retarget/(nn/modules/|nn/weights_file|training/)' || true)
if [ -n "$headers" ]; then
  echo "These headers make their includers compile LibTorch:"
  echo "$headers"
  status=1
fi
[ $status -eq 0 ] && echo "Layers are clean."
exit $status
