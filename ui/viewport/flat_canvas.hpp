// A pane that is a canvas: the pose picture that export writes, over the picture it stands in, and what the
// mouse does there.
#pragma once

#include <optional>
#include <string>
#include <utility>

#include "render/gl/object.hpp"
#include "render/image.hpp"
#include "ui/panels/panel.hpp"
#include "ui/viewport/overlay.hpp"
#include "ui/viewport/panes.hpp"

namespace understudy::ui {

/// A point of the source's performer while it is dragged, and where it is then, pixels of the canvas.
using MovedPoint = std::pair<int, Vec2>;

/// The canvas of a pane: of the source, or of its first take; unknown as long as nothing is read.
Canvas canvas_of_pane(const app::Session& session, const PaneContent& pane);
/// What is on it in the frame shown: of the source all faintly, the performer in OpenPose's colours; of a
/// take the very picture that is exported, where it is black the reference's own picture, dimmed. At most
/// kLargestPicture wide and high. Empty: there is none.
render::Image canvas_picture(const app::Session& session, const PaneContent& pane,
                             const std::optional<MovedPoint>& moved = {});
constexpr int kLargestPicture = 2048;

/// Where the whole canvas lies on the screen, so that `view` of it is in the pane.
Rect canvas_place(const Rect& pane, const Canvas& canvas, const app::CanvasView& view);

/// One pane's.
class FlatCanvas {
 public:
  /// Uses the item just made, which is the pane's.
  void interact(const app::Session& session, const PaneContent& pane, const Rect& rect,
                PanelContext& context);
  /// Draws into `part` of the pane. Marks: "view.0.point.NAME" of those that
  /// can be dragged, "view.0.person.N" over people.
  void draw(const app::Session& session, const PaneContent& pane, const Rect& rect, const Rect& part,
            PanelContext& context);
  bool busy() const { return dragged_.has_value(); }

 private:
  void show_picture(const app::Session& session, const PaneContent& pane);
  void draw_points(const app::Session& session, const PaneContent& pane, const Rect& place,
                   PanelContext& context);
  void draw_words(const app::Session& session, const PaneContent& pane, const Rect& place, const Rect& part,
                  PanelContext& context);
  void steer(const app::Session& session, const PaneContent& pane, const Rect& rect, const Pointer& now,
             PanelContext& context);
  void use_left(const app::Session& session, const PaneContent& pane, const Rect& rect, const Pointer& now,
                PanelContext& context);
  void drag(int frame, const Pointer& now, const Rect& place, const Canvas& canvas, PanelContext& context);

  std::optional<render::gl::Texture> texture_;
  std::string shown_;  // what the texture is of
  render::Image image_;
  std::optional<MovedPoint> dragged_;
  bool is_moved_ = false;
  int hovered_ = -1;  // point
};

}  // namespace understudy::ui
