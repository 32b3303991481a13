#!/bin/bash
# screenshots/marionette.sh: makes the pictures of further motions of found bones in this folder, 61 and 62.
. "$(dirname "$0")/common.sh"
"$understudy" play screenshots/marionette.us --out "$work"
mv "$work/ghosts.png" "$work/61_more_motion.png"
mv "$work/between.png" "$work/62_between_frames.png"
shown 61_more_motion 1440
shown 62_between_frames 1440
