// What is shown and how: saved with the document, but no part of its result and not undone.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "retarget/math/types.hpp"

namespace understudy::app {

enum class Layout {
  SideBySide,  ///< the source, then each take
  Single,      ///< one pane: the active one
  Overlay,     ///< source and takes in one space
  Wipe         ///< the first take left of a line, the second right of it, in one pane
};

/// What colours a surface.
enum class Colouring {
  Plain,
  Weights,     ///< skin weights: of View::weights_joint (viridis), or of all joints (categories)
  Offsets,     ///< length of the pose-corrective offsets, mm
  Error,       ///< distance to the truth, mm
  Difference,  ///< distance to the same vertex of the first take, mm
  Confidence,  ///< extraction confidence of the nearest joint (the source's scan)
  Doubt        ///< how far a vertex is bound by the shape alone, %
};

/// An orbit camera, as render's: yaw and pitch in radians, distance in metres.
struct CameraState {
  Vec3 target = Vec3(0, 0.9f, 0);
  float yaw = 0.55f, pitch = 0.18f, distance = 4.2f, fov = 0.5f;
  bool orthographic = false;
};

/// What a pane draws.
struct Layers {
  bool surface = true;       ///< the scan, or the target's mesh
  bool as_points = false;    ///< a scan that has faces as points all the same
  bool skeleton = true;      ///< extracted joints, or the target's
  bool x_ray = true;         ///< the skeleton shines through; off: depth-tested
  bool joint_names = false;  ///< all names; the hovered joint's is always shown
  bool ground = true;
  bool trails = false;  ///< paths of View::trail_joints
  bool ghosts = false;  ///< past and coming frames, faint
  Colouring colouring = Colouring::Plain;
};

struct View {
  Layout layout = Layout::SideBySide;
  bool linked = true;                               ///< panes share camera 0
  std::vector<CameraState> cameras{CameraState{}};  ///< one a pane; missing ones are like the first
  bool follow = true;                               ///< the camera goes with the pelvis over the floor
  float turntable_deg_s = 0;                        ///< degrees a second that the camera turns by itself
  Layers source, take;
  int active_pane = 0;                    ///< 0 the source, k the take k - 1
  int weights_joint = -1;                 ///< -1: all joints
  std::vector<int> trail_joints{20, 21};  ///< wrists
  int ghost_count = 3, ghost_step = 8;    ///< to each side; frames between two
  float error_scale_mm = 50;              ///< upper end of the scales of errors, offsets and differences
  float wipe = 0.5f;                      ///< the wipe's line, share of the width
  std::string metric = "confidence";      ///< the one in the timeline
};

/// Pane by pane: the source and the takes, as the layout says.
int pane_count(const View& view, int takes);

}  // namespace understudy::app
