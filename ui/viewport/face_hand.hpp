// The marks of a target's face in its pane: where they are seen, and dragging one over the head.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "app/session/commands.hpp"
#include "retarget/pose2d/face_marks.hpp"
#include "ui/viewport/overlay.hpp"

namespace understudy::ui {

struct HandPlace;

class FaceHand {
 public:
  /// Handles the pointer in this frame. True when it is about a mark; false when the camera may have it.
  bool work(const HandPlace& place, const Pointer& pointer, app::CommandQueue& queue);
  void let_go();
  bool busy() const { return grip_.has_value(); }
  /// What is under the pointer or dragged: "left eye"; else empty.
  std::string tip() const;

  /// Those that the pane's camera sees, as a pose picture would have them, with the drag; none in a pane that
  /// does not show the target's T-pose. Marks: "view.1.face.left_eye".
  std::vector<Overlay::Handle> handles(const app::Session& session, const PaneContent& pane,
                                       const PaneView& view) const;

 private:
  std::array<Vec3, kFaceMarkNames.size()> places(const app::Session& session, int take) const;
  void drag(const HandPlace& place, const Pointer& pointer);
  void finish(const HandPlace& place, app::CommandQueue& queue);

  int hovered_ = -1;  // a FaceMark
  struct Grip {
    FaceMove move;
    ImVec2 start, off;  // pixels; off: of the mark from the pointer
    bool is_moved = false;
  };
  std::optional<Grip> grip_;
};

}  // namespace understudy::ui
