#!/bin/bash
# screenshots/marionette.sh [WHAT...]: makes the pictures of found bones and their motions in this folder, 61 to 64. WHAT: more (further
# motions of found bones, 61 and 62), keypoints (63: those that networks of a kind see in single scans of two bodies each), between
# (64: a network and even turns between two poses, and what the animal did); without one all. $WEIGHTS: another folder of weights.
. "$(dirname "$0")/common.sh"
weights=${WEIGHTS:+--weights $WEIGHTS}

more() {
  "$understudy" play screenshots/marionette.us --out "$work"
  mv "$work/ghosts.png" "$work/61_more_motion.png"
  mv "$work/between.png" "$work/62_between_frames.png"
  shown 61_more_motion 1440
  shown 62_between_frames 1440
}

# seen KIND SCANS FRAME [OPTION...]: the keypoints in one of the scans, as the next of $rigs.
seen() {
  local rig="$work/rig$((${#rigs[@]} + 1)).glb" scan
  scan=$(printf '%s/frame_%05d.ply' "$2" "$3")
  "$understudy" discover --source "$scan" --method slots --kind "$1" $weights "${@:4}" --out "$rig"
  rigs+=("$rig")
}

keypoints() {
  local -a rigs=()
  "$understudy" cases --suite creatures --out "$work/bodies" --cases 16 --frames 12 --points 8000
  for frame in 10 60; do seen person assets/samples/scan $frame --remove-floor --largest-part; done
  for frame in 4 16; do seen person assets/samples/walk $frame --remove-floor --largest-part; done
  for kind in quadruped hand; do
    for body in "$work/bodies/$kind"*; do
      for frame in 1 10; do seen "$kind" "$body/source" $frame; done
    done
  done
  "$understudy" sheet "${rigs[@]}" --bones --seconds 0 --columns 4 --out "$work/63_keypoints.png" \
    --title "Keypoints and trees that networks see in single scans: two people, two horses, two hands" \
    --captions "$(for kind in person horse hand; do printf '%s,' "one $kind"{,} "another $kind"{,}; done | sed 's/,$//')"
  shown 63_keypoints 1200
}

between() {
  local rig from=6 to=24
  "$understudy" cases --suite marionette-gaps --out "$work/gaps" --cases 3
  rig=$(echo "$work"/gaps/quadruped100*/rig.glb)
  for engine in vrnn slerp; do
    "$understudy" generate --rig "$rig" --between $from $to --frames $((to - from + 1)) --engine $engine $weights --out "$work/$engine.glb"
  done
  "$understudy" sheet "$rig@$(bc -l <<<"$from / 30")" "$work/vrnn.glb" "$work/slerp.glb" --bones --every 0.1 --seconds 0.61 \
    --captions "What it did,A network,Even turns" --title "Between two poses" --out "$work/64_between_poses.png"
  shown 64_between_poses 1440
}

[ $# -gt 0 ] || set -- more keypoints between
for what in "$@"; do
  case $what in
    more | keypoints | between) $what ;;
    *) echo "marionette.sh: no picture is called '$what'" >&2; exit 2 ;;
  esac
done
