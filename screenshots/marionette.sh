#!/bin/bash
# screenshots/marionette.sh [WHAT...]: makes the pictures of found bones and their motions in this folder, 61 to 64.
# WHAT: more (further motions of found bones, 61 and 62), keypoints (63: those that networks of a kind see in single
# scans of two bodies each), between (64: a network and even turns between two poses, and what the animal did); without
# one all. $WEIGHTS: another folder of weights.
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
  seen person assets/samples/scan 10 --remove-floor --largest-part
  seen person assets/samples/walk 4 --remove-floor --largest-part
  for kind in quadruped hand; do
    for body in "$work/bodies/$kind"*; do seen "$kind" "$body/source" 10; done
  done
  "$understudy" sheet "${rigs[@]}" --bones --seconds 0 --out "$work/63_keypoints.png" \
    --title "What networks see in one scan: two people, two horses, two hands" \
    --captions "A person,Another,A horse,Another,A hand,Another"
  shown 63_keypoints 1200
}

between() {
  local rig from=6 to=24  # at 30 frames/s: 0.2 s to 0.8 s
  "$understudy" cases --suite marionette-gaps --out "$work/gaps" --cases 3
  rig=$(echo "$work"/gaps/quadruped100*/rig.glb)
  for engine in vrnn slerp; do
    "$understudy" generate --rig "$rig" --between $from $to --frames $((to - from + 1)) --engine $engine $weights \
      --out "$work/$engine.glb"
  done
  "$understudy" sheet "$rig@0.2" "$work/vrnn.glb" "$work/slerp.glb" --bones --every 0.1 \
    --seconds 0.61 --out "$work/64_between_poses.png" \
    --captions "What it did,A network,Even turns" --title "Between two poses"
  shown 64_between_poses 1440
}

[ $# -gt 0 ] || set -- more keypoints between
for what in "$@"; do
  case $what in
    more | keypoints | between) $what ;;
    *) echo "marionette.sh: no picture is called '$what'" >&2; exit 2 ;;
  esac
done
