// The scan's own skeleton in a view: its bones, its surface painted by them, what is found so far, and what
// of it is under the pointer.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "render/scene.hpp"
#include "ui/viewport/overlay.hpp"
#include "ui/viewport/panes.hpp"
#include "ui/viewport/surface_values.hpp"

namespace understudy::ui {

/// What an edit under the mouse makes of the found rig in the frame shown.
struct FoundPreview {
  std::shared_ptr<const RigPose> pose;      ///< null: as it is
  std::shared_ptr<const SkinWeights> skin;  ///< null: as it is
};

/// What is drawn of found bones, kept while its inputs stay the same.
struct BonesMemory {
  std::shared_ptr<const void> of;  ///< the rig, or what is found so far
  FoundPreview preview;
  int selected = -1, frame = -1;
  bool painting = false;
  std::shared_ptr<const app::ScanPicture> beside;  ///< the scan whose place is taken
  Vec3 offset = Vec3::Zero();
  RowMatrix weights;  ///< [V, J] of the rig
  render::SharedPoints colors, vertices, normals;
  std::shared_ptr<const Eigen::VectorXf> values;  ///< [V] of the chosen bone while it is painted; else null
  render::SharedFaces faces;
  float spacing = 0;
};

/// The found skeleton in a frame of the source: its joints, then where bones that carry no other end.
struct PosedBones {
  Points places;             ///< [J and tips, 3]
  std::vector<int> parents;  ///< as many
  int joints = 0;            ///< J
};
PosedBones posed_bones(const understudy::Rig& rig, const RigPose& pose);
/// None where none is found, hidden, or the frame is not one of the rig's.
std::optional<PosedBones> posed_bones(const app::Session& session, const PaneContent& pane, int frame,
                                      const FoundPreview& preview = {});

/// The 22 joints are hidden where the source is no person and has bones of its own.
bool hides_person(const app::Session& session);
/// Whether what was found, or is found so far, is drawn in the scan's place.
bool bones_hide_scan(const app::Session& session, const PaneContent& pane, int frame);

/// Where a body's surface is in a pose, shifted by the memory's offset.
void place_surface(const understudy::Rig& rig, const SkinWeights& skin, const RigPose& pose,
                   BonesMemory& memory);
struct BodyLook {
  Vec3 color = Vec3(0.77f, 0.74f, 0.71f);  ///< where the memory has none for each vertex
  float opacity = 1;
};
/// A body's surface, of which all but the pose is kept in the memory.
void add_surface(const Mesh& mesh, const BonesMemory& memory, const BodyLook& look, render::Scene& scene);
/// Each bone's colour, mixed by weights [V, J]; where one is chosen, its own alone. [V, 3]
Points surface_colors(const RowMatrix& weights, int selected);
struct BonesLook {
  int selected = -1;  ///< bright; -1: none
  bool x_ray = true;
  float thickness = 1;  ///< times the usual one
};
/// The bones of such a rig, where they are posed.
void add_bone_lines(const PosedBones& bones, const understudy::Rig& rig, const BonesLook& look,
                    render::Scene& scene);

/// What bones are drawn from; all of it is shifted by `aside`.
struct BonesInput {
  const app::Session& session;
  const PaneContent& pane;
  const PanePictures& pictures;
  const FoundPreview& preview;
  Vec3 aside = Vec3::Zero();
};
/// Adds the bones, the chosen one bright, and the painted surface to a scene.
void add_bones(const BonesInput& in, BonesMemory& memory, render::Scene& scene);

/// The bone seen nearest to a pixel, within `reach` pixels; -1: none.
int bone_at(const PaneView& view, const PosedBones& bones, const ImVec2& at, float reach);
/// The names of the chosen and the hovered bone, or of all, in the middle of each.
std::vector<Overlay::Label> bone_labels(const app::Session& session, const PaneView& view,
                                        const PosedBones& bones, int hovered);
/// "tail: hinge, turns 34°".
std::string bone_words(const app::Session& session, int joint);
/// Where each bone's middle is seen, by number; none of those that are not.
std::vector<std::pair<int, ImVec2>> bone_middles(const PaneView& view, const PosedBones& bones);

}  // namespace understudy::ui
