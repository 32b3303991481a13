# screenshots/common.sh: what the scripts beside it begin with. Needs build/understudy, or $UNDERSTUDY, and what ./test installs
# (node, chromium). With the folder $OUT they make PNGs there, as tests do.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
understudy=${UNDERSTUDY:-$PWD/build/understudy}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# shown NAME WIDTH: from $work/NAME.png into this folder, smaller.
shown() {
  [ -z "${OUT:-}" ] || { cp "$work/$1.png" "$OUT/"; return; }
  node screenshots/smaller.mjs chromium "$2" "$work/$1.png"
  cp "$work/$1.webp" screenshots/
}
