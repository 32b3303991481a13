#!/bin/bash
# screenshots/flat.sh [WHAT...]: makes the pictures of 2D poses in this folder, 55 to 60. WHAT: dance (55), crowd (56), turn (57),
# engines (58), studio (59), lifted (60); without one all.
# DATA: a data folder (see train --data) whose CMU dance turns in picture 57, and whose people are in 58; without
# it there is no 58, and the built-in dance in 57.
. "$(dirname "$0")/common.sh"
samples=$PWD/assets/samples

# The bundled dance by the girl of the bundled picture, in it.
dance() {
  "$understudy" retarget --source "$samples/poses" --target "$samples/reference.json" --out "$work/girl.json"
  cp "$samples/reference.png" "$work/girl.png"
  "$understudy" sheet "$samples/poses" "$work/girl.json" --every 0.29 --columns 11 --captions "the dance,the girl of the picture" \
    --out "$work/55_flat_dance.png"
  shown 55_flat_dance 1400
}

# The same film cut off at the knees, the dancer hidden for most of a second by who walks by.
crowd() {
  mkdir "$work/crowd"
  node -e '
    const fs = require("fs"), [from, to] = process.argv.slice(1);
    fs.readdirSync(from).sort().forEach((name, frame) => {
      const json = JSON.parse(fs.readFileSync(`${from}/${name}`));
      for (const person of json.people) {
        const points = person.pose_keypoints_2d;
        for (let i = 0; i < points.length; i += 3)
          if (points[i + 1] > 500) points.fill(0, i, i + 3);
      }
      if (frame < 8 || frame >= 64) json.people.splice(1, 1);
      if (frame >= 42 && frame < 66) json.people.splice(0, 1);
      fs.writeFileSync(`${to}/${name}`, JSON.stringify(json));
    });' "$samples/poses" "$work/crowd"
  "$understudy" retarget --source "$work/crowd" --target "$samples/reference.json" --out "$work/girl.json"
  cp "$samples/reference.png" "$work/girl.png"
  "$understudy" sheet "$work/crowd" "$work/girl.json" --every 0.29 --columns 11 --captions "cut and crowded,the girl of the picture" \
    --out "$work/56_flat_crowd.png"
  shown 56_flat_crowd 1400
}

# Control pictures of who turns: the face goes, and comes back.
turn() {
  local dance=$samples/scan
  [ -z "${DATA:-}" ] || dance=$DATA/motion/main/cmu05/cmu_05_03_poses.npz
  "$understudy" export --source "$dance" --target "$samples/target_adult.glb" --format poses --out "$work/turn" --canvas 480x480 \
    --depth --normals --stick-width 6
  "$understudy" sheet "$work"/turn{,_depth,_normals} --every 0.36 --columns 11 --captions "poses,depth,normals" \
    --out "$work/57_flat_turn.png"
  shown 57_flat_turn 1400
}

# Six odd people whom nothing was learned from, by every engine.
engines() {
  [ -n "${DATA:-}" ] || { echo "flat.sh: no engines without DATA" >&2; return; }
  "$understudy" cases "$DATA" --suite pose2d-odd --cases 6 --out "$work/cases"
  "$understudy" eval "$work/cases" --filter picture --pictures "$work"
  mv "$work/flat_cases.png" "$work/58_flat_engines.png"
  shown 58_flat_engines 1200
}

# The bundled dance lifted onto the bundled targets.
lifted() {
  local who
  for who in adult child; do
    "$understudy" retarget --source "$samples/poses" --target "$samples/target_$who.glb" --out "$work/$who.glb"
  done
  "$understudy" sheet "$work"/{adult,child}.glb --every 0.29 --columns 11 --angle 0 --out "$work/60_flat_lifted.png"
  shown 60_flat_lifted 1400
}

# In the studio's window.
studio() {
  "$understudy" play screenshots/flat.us --out "$work"
  shown 59_flat_studio 1280
}

[ $# -gt 0 ] || set -- dance crowd turn engines studio lifted
for what in "$@"; do
  case $what in
    dance | crowd | turn | engines | studio | lifted) $what ;;
    *) echo "flat.sh: no picture is called '$what'" >&2; exit 2 ;;
  esac
done
