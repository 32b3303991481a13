#!/bin/bash
# screenshots/performance.sh [WHAT...]: makes the pictures of styles in this folder, 47 to 54. WHAT: studio (47 to 50), strips
# (51, 52), stimuli (53), figures (54); without one all.
# DATA: a data folder (see train --data) whose CMU jump and walk the strips show, and a jump of a child of eight;
# the figures are of its Kinder-Gator clips. Without it there are no figures, and one strip, of the bundled walk.
. "$(dirname "$0")/common.sh"

studio() {
  local name
  mkdir -p "$work/recordings/adults" "$work/recordings/children"  # what a style is taught from in picture 50
  for name in walk scan; do
    "$understudy" style "assets/samples/$name" --to old --strength 0.1 --out "$work/recordings/adults/$name.npz"
    "$understudy" style "assets/samples/$name" --to child --out "$work/recordings/children/$name.npz"
  done
  (cd "$work" && "$understudy" play "$OLDPWD/screenshots/performance.us" --out "$work")
  for name in 47_performance 48_style_wipe 49_style_trails 50_teach_style; do shown $name 1280; done
}

# performed NAME SOURCE TARGET [OPTION...]: $work/NAME.glb.
performed() {
  "$understudy" retarget --source "$2" --target "assets/samples/target_$3.glb" "${@:4}" --out "$work/$1.glb"
}

# three NAME SOURCE: by the adult, by the child, and by the child in the style and tempo of its body.
three() {
  performed "$1-adult" "$2" adult
  performed "$1-child" "$2" child
  performed "$1-styled" "$2" child --style child --tempo body
}

strips() {
  local walk=assets/samples/walk
  if [ -n "${DATA:-}" ]; then
    walk=$DATA/motion/main/cmu08/cmu_08_08_poses.npz
    three jump "$DATA/motion/main/cmu13/cmu_13_42_poses.npz"
    performed jump-real "$DATA/motion/main/fair1_8yr/fair1_jumping_poses.npz" child
    "$understudy" sheet "$work"/jump-{adult.glb@0.5,child.glb@0.5,styled.glb@0.4,real.glb@1.5} --seconds 1.84 \
      --captions "adult,child,in its style,real child" --out "$work/51_style_jump.png"
    shown 51_style_jump 1400
  fi
  three walk "$walk"
  "$understudy" sheet "$work"/walk-{adult,child,styled}.glb --seconds 1.84 --angle 60 --captions "adult,child,in its style" \
    --out "$work/52_style_walk.png"
  shown 52_style_walk 1400
}

stimuli() {
  "$understudy" study new --preset dong --out "$work/dong.study"
  "$understudy" sheet "$work/dong.study" --motion dance --from 2 --seconds 0 --out "$work/53_style_stimuli.png"
  shown 53_style_stimuli 1400
}

# figures: of 17 gestures of the arms, adults' in the style over children's.
figures() {
  local clip subject manner
  local arms='_[0-9]+_((raise|wave)_your|push|swipe|point|signal|throw|punch)'
  [ -n "${DATA:-}" ] || { echo "performance.sh: no figures without DATA" >&2; return; }
  for clip in "$DATA"/motion/kinder_gator/*/*.npz; do
    [[ $clip =~ $arms ]] || continue
    subject=$(basename "$(dirname "$clip")")
    [[ $clip == */kg_a* ]] && manner=adult || manner=child
    mkdir -p "$work/clips/$manner/$subject"
    ln -s "$(realpath "$clip")" "$work/clips/$manner/$subject/"
  done
  "$understudy" cases "$work/clips" --suite style --from adult --to child --out "$work/cases"
  "$understudy" eval "$work/cases" --style child --pictures "$work"
  cp "$work/style_figures.png" "${OUT:-screenshots}/54_style_figures.png"
}

[ $# -gt 0 ] || set -- studio strips stimuli figures
for what in "$@"; do
  case $what in
    studio | strips | stimuli | figures) $what ;;
    *) echo "performance.sh: no picture is called '$what'" >&2; exit 2 ;;
  esac
done
