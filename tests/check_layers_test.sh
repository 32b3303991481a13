#!/bin/bash
# check_layers.sh must find a layer that reaches up, and take a tree that does not.
set -euo pipefail
checker=$(dirname "$(readlink -f "$0")")/check_layers.sh
tree=$(mktemp -d)
trap 'rm -rf "$tree"' EXIT
mkdir -p "$tree/retarget/pipeline" "$tree/retarget/math" "$tree/render"
echo '#include "retarget/math/types.hpp"' >"$tree/retarget/pipeline/good.hpp"
"$checker" "$tree" >/dev/null || { echo "a clean tree is refused"; exit 1; }
for bad in 'retarget/pipeline #include <torch/torch.h>' 'retarget/math #include "retarget/pipeline/good.hpp"' \
           'render #include "app/cli/job.hpp"'; do
  echo "${bad#* }" >"$tree/${bad%% *}/bad.hpp"
  ! "$checker" "$tree" >/dev/null || { echo "not found: $bad"; exit 1; }
  rm "$tree/${bad%% *}/bad.hpp"
done
