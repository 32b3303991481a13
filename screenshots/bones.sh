#!/bin/bash
# screenshots/bones.sh [WHAT...]: makes the pictures of found bones in this folder, 34 to 46. WHAT: a kind of creature, person, edit
# (before and after), gait (one animal's on another), three (a found rig in three.js), real; without one all but that.
# real: of a real sequence in the folder $REAL; its picture and rig go to out/bones.
. "$(dirname "$0")/common.sh"
kinds=(arm lamp excavator hand quadruped insect bird snake)
# scans_of SUITE KIND: the folder of a made case, for as many cases as show all kinds once.
scans_of() {
  [ -d "$work/$1" ] || "$understudy" cases --suite "$1" --out "$work/$1" --cases ${#kinds[@]} --frames 24 --points 5000 >&2
  echo "$work/$1/$2"*
}

# found NAME SCANS [OPTION...]: $work/NAME.glb, and its picture $work/NAME.png, titled so.
found() {
  ln -sfn "$(realpath "$2")" "$work/$1"
  "$understudy" discover --source "$work/$1" "${@:3}" --out "$work/$1.glb" --preview "$work/$1.png"
}

# shown_as PICTURE NAME: the same under another name.
shown_as() {
  mv "$work/$1.png" "$work/$2.png"
  shown "$2" 1200
}

edit() {
  "$understudy" play screenshots/edit_bones.us --out "$work"
  shown_as before 43_bones_before
  shown_as after 44_bones_after
}

gait() {
  local pair
  pair=$(scans_of creatures-pairs quadruped)
  found one "$pair/source"
  found other "$pair/target"
  "$understudy" discover --rig "$work/one.glb" --perform "$work/other.glb" --out "$work/gait.glb" --preview "$work/gait.png"
  shown_as gait 45_gait
}

three() {
  [ -f "$work/quadruped.glb" ] || found quadruped "$(scans_of creatures quadruped)/source"
  echo "[{\"file\": \"$work/quadruped.glb\", \"clip\": 0, \"times\": [0.4], \"out\": \"$work/three\"}]" >"$work/jobs.json"
  node tests/interop/three_play.mjs build/interop chromium "$work/jobs.json" >"$work/said.json"
  cp "$work/three.png" screenshots/46_three.png
}

real() {
  mkdir -p out/bones
  found "$(basename "$REAL")" "$REAL"
  cp "$work/$(basename "$REAL")".{glb,png} out/bones/
}

[ $# -gt 0 ] || set -- "${kinds[@]}" person edit gait three ${REAL:+real}
for what in "$@"; do
  case $what in
    person)
      found person assets/samples/scan --remove-floor --largest-part
      shown_as person 42_bones_person
      ;;
    edit | gait | three | real) $what ;;
    *)
      number=34
      for kind in "${kinds[@]}"; do
        if [ "$kind" = "$what" ]; then break; fi
        number=$((number + 1))
      done
      [ "$number" -lt $((34 + ${#kinds[@]})) ] || { echo "bones.sh: no picture is called '$what'" >&2; exit 2; }
      found "$what" "$(scans_of creatures "$what")/source"
      shown_as "$what" "${number}_bones_$what"
      ;;
  esac
done
