// Builds the renderer's scene from the session and the cache's frames. No GL, no ImGui calls.
#pragma once

#include <iterator>
#include <map>
#include <memory>
#include <optional>
#include <utility>

#include "render/scene.hpp"
#include "ui/viewport/bones_view.hpp"
#include "ui/viewport/made_motions_view.hpp"
#include "ui/viewport/panes.hpp"
#include "ui/viewport/second_body_view.hpp"
#include "ui/viewport/surface_values.hpp"
#include "ui/viewport/target_look.hpp"

namespace understudy::ui {

/// The edit under the mouse, shown before its command runs.
struct EditPreview {
  std::optional<Joints> source_joints;  ///< in place of the extracted ones
  std::optional<Joints> take_joints;    ///< in place of those of the pane's first take (or of its T-pose)
  std::optional<Box> crop;              ///< in place of the document's
  int crop_face = -1;                   ///< the one under the pointer, in the order of kBoxSides
  std::optional<render::GizmoView> gizmo;
  FoundPreview found;
};

/// A surface's colours, kept while their inputs stay the same.
struct SurfaceColours {
  std::vector<float> settings;
  std::vector<std::shared_ptr<const void>> kept;  ///< the inputs: one and the same has not changed
  SurfaceValues values;
  render::SharedPoints colors;
};
/// A scan as it is shown, and whose its points are, kept while its inputs stay the same.
struct ShownScan {
  std::shared_ptr<const app::ScanPicture> whole, shown;
  std::shared_ptr<const app::KeptOwners> kept;
  enum class Part { Whole, People, Person } part = Part::Whole;
  int alone = 0;           ///< whose all of it is, where others come later or have left; 0: nobody's
  std::vector<int> owner;  ///< of each vertex shown, as KeptOwners::owners; empty: they are not told apart
};
/// Points of what stands aside, kept while they and its place stay the same.
struct MovedPoints {
  render::SharedPoints in_place, moved;
  Vec3 aside = Vec3::Zero();
};

/// Values by key from one build of a scene to the next. What a build does not ask for is dropped at its end.
template <class Key, class Value>
class KeptValues {
 public:
  Value& operator[](const Key& key) {
    Entry& entry = entries_[key];
    entry.used = true;
    return entry.value;
  }
  void drop_unused() {
    for (auto it = entries_.begin(); it != entries_.end();)
      it = std::exchange(it->second.used, false) ? std::next(it) : entries_.erase(it);
  }
  size_t size() const { return entries_.size(); }
  /// Null where it is not kept.
  const Value* find(const Key& key) const {
    const auto found = entries_.find(key);
    return found == entries_.end() ? nullptr : &found->second.value;
  }

 private:
  struct Entry {
    Value value;
    bool used = false;
  };
  std::map<Key, Entry> entries_;
};

/// Whose points stand aside: those of a take by its number, of ghosts by theirs.
enum class MovedLayer { Scan, CroppedAway, Take, ScanGhost, TakeGhost };
/// One for each pane.
struct SceneMemory {
  KeptValues<int, SurfaceColours> colours;  ///< by take, -1 the scan
  KeptValues<std::pair<MovedLayer, int>, MovedPoints> moved;
  ShownScan scan;
  KeptValues<int, ShownScan> ghosts;  ///< by their number
  BonesMemory bones, second;          ///< the found body, and the one that performs what it does
  KeptValues<const app::GeneratedMotion*, BonesMemory> made;  ///< the found body in motions that were made
};

struct SceneInput {
  const app::Session& session;
  const PaneContent& pane;
  const PanePictures& pictures;
  const std::vector<std::shared_ptr<const TargetLook>>& looks;  ///< as pane.takes; null: not there yet
  const EditPreview& preview;
  ThemeKind theme = ThemeKind::Dark;
};

/// A pane's scene and the meaning of its colours.
struct PaneScene {
  render::Scene scene;
  Legend legend;
  std::shared_ptr<const Eigen::VectorXf> values;  ///< of the first surface, for the tip under the pointer
  int values_take = -1;                           ///< whose surface; -1 the scan
};

/// Follows View and Layers: surfaces and their colouring, skeletons, trails, ghosts, ground, the crop box
/// while that tool is active. What is not there yet is left out.
PaneScene build_scene(const SceneInput& input, SceneMemory& memory);

/// The middles of a box's faces, [6, 3], in the order of kBoxSides.
Points face_centres(const Box& box);
/// What is behind everything in that theme.
render::BackgroundView background_of(ThemeKind theme);
/// The light of a view: the usual one, turned and dimmed.
render::LightView light_of(const app::LightLook& look);

}  // namespace understudy::ui
