#!/bin/bash
# check_layers.sh must take a tree that holds to layers.txt and find every way not to.
set -euo pipefail
checker=$(dirname "$(readlink -f "$0")")/check_layers.sh
tree=$(mktemp -d)
trap 'rm -rf "$tree"' EXIT

# put FILE INCLUDE: writes a file of one line, its folders too.
put() {
  mkdir -p "$tree/$(dirname "$1")"
  echo "#include $2" >"$tree/$1"
}
put retarget/pipeline/good.hpp '"retarget/math/types.hpp"'
put retarget/nn/modules/net.hpp '<torch/torch.h>'
put retarget/nn/facade.cpp '"retarget/nn/modules/net.hpp"'
put retarget/plugin/plugin.cpp '"retarget/training/trainer.hpp"'
put render/gl/functions.hpp '<GL/gl.h>'
put render/passes/mesh_pass.cpp '"render/gl/functions.hpp"'
put render/pose.cpp '"retarget/keypoints/flat_pose.hpp"'
put ui/viewport/pane.cpp '"app/session/session.hpp"'
put app/main.cpp '"app/cli/commands.hpp"'
"$checker" "$tree" >"$tree/said" || { echo "a clean tree is refused:"; cat "$tree/said"; exit 1; }
grep -qx 'Layers are clean.' "$tree/said"

# refuse FILE INCLUDE WHY: the checker must fail, name the file and say why.
refuse() {
  put "$1" "$2"
  ! "$checker" "$tree" >"$tree/said" || { echo "not found: $1 includes $2"; exit 1; }
  grep -q "^$1 includes .*$3" "$tree/said" || { echo "$1 includes $2, but it says:"; cat "$tree/said"; exit 1; }
  rm "$tree/$1"
}
refuse retarget/math/bad.hpp '"retarget/pipeline/good.hpp"' 'on floor 1, retarget/pipeline on floor 5'
refuse retarget/skeleton/bad.cpp '"retarget/geometry/mesh.hpp"' 'on floor 2, retarget/geometry on floor 2'
refuse retarget/nn/bad.cpp '"retarget/plugin/plugin.hpp"' 'on floor 9'
refuse retarget/pipeline/bad.hpp '<torch/torch.h>' 'may not include torch'
refuse retarget/base/bad.hpp '<Eigen/Core>' 'on floor 0, Eigen on floor 0'
refuse retarget/pipeline/bad.cpp '"render/camera.hpp"' 'on floor'
refuse retarget/motion/bad.cpp '"ui/gui/ui.hpp"' 'on floor'
refuse render/bad.cpp '"app/cli/job.hpp"' 'on floor'
refuse render/bad.cpp '"retarget/formats/ply.hpp"' 'no higher than floor 2'
refuse render/passes/bad.cpp '<imgui.h>' 'may not include imgui'
refuse app/run/bad.cpp '"app/session/session.hpp"' 'on floor'
refuse app/run/bad.cpp '"retarget/networks/networks.hpp"' 'no higher than floor 7'
refuse app/session/bad.cpp '"render/camera.hpp"' 'may not include render'
refuse app/session/bad.cpp '<GL/gl.h>' 'may not include gl'
refuse app/cli/bad.cpp '"retarget/nn/facade.hpp"' 'no higher'
refuse app/cli/bad.cpp '"ui/gui/ui.hpp"' 'may not include ui'
refuse app/cli/bad.cpp ' "retarget/unheard_of/x.hpp"' 'without a row'
refuse retarget/unheard_of/bad.cpp '"retarget/base/error.hpp"' 'no row'

# Only main() and the first window may change the environment.
echo '  setenv("LANG", "C", 1);' >>"$tree/app/main.cpp"
"$checker" "$tree" >"$tree/said" || { echo "main() may not change the environment:"; cat "$tree/said"; exit 1; }
echo '  setenv("LANG", "C", 1);' >"$tree/app/run/bad.cpp"
! "$checker" "$tree" >"$tree/said" || { echo "not found: the environment is changed beside threads"; exit 1; }
grep -q '^app/run/bad.cpp:1:.*setenv' "$tree/said"
rm "$tree/app/run/bad.cpp"

# A table of one's own: a folder that is free of LibTorch may not include one that is not, however low that stands.
printf '%s\n' '# comment' 'retarget/nn 0 torch' 'retarget/pipeline 1' 'render 2 gl' 'ui 3 app' 'app 4' \
  'retarget/plugin 5 torch' >"$tree/table"
put retarget/pipeline/bad.cpp '"retarget/nn/facade.hpp"'
! "$checker" "$tree" "$tree/table" >"$tree/said" || { echo "LibTorch comes in by the back door"; exit 1; }
grep -q 'retarget/pipeline is free of LibTorch' "$tree/said"
