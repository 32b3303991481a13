// The views: panes with what the session holds, drawn by the renderer, and what the mouse does in them.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "ui/viewport/hand.hpp"
#include "ui/viewport/overlay.hpp"
#include "ui/viewport/pane.hpp"
#include "ui/viewport/view_menu.hpp"

namespace understudy::ui {

/// Owns the pictures of the panes. Make, use and destroy it with one GL context current (a null one will do).
class Views {
 public:
  /// Fills what is left of the current window with the panes of the layout. Redraws a pane only when
  /// its content, camera or size has changed. Marks: "view.0" the source, "view.1" the first take
  /// ..., with "view.0.cube" (.front ... .bottom), "view.wipe" the line of a wipe, "view.legend",
  /// "view.warning", "view.tip", "view.0.person.N", "view.bone.J". Throws Error where the
  /// context's messages are fatal.
  void draw(const app::Session& session, app::FrameCache& cache, PanelContext& context);

  /// Drops everything shown: the document was closed.
  void forget();
  /// Whether something is still being made or was drawn as a draft only: draw again soon.
  bool waiting() const;
  /// Whether the surface of this take was in the last frame drawn: as loaded, in T-pose or performing.
  bool shows_take(int k) const;
  /// Grows when the background has made something to draw that is not part of the session.
  int64_t arrived() const { return looks_.arrived(); }
  /// Pictures of panes drawn since the start; for tests and figures.
  int64_t drawn() const { return drawn_; }

 private:
  struct Frame {
    const app::Session& session;
    app::FrameCache& cache;
    PanelContext& context;
  };
  void prepare(const Frame& f, size_t count);
  void place_legend(const Frame& f, Rect& area);
  void draw_row(const Frame& f, const std::vector<PaneContent>& contents, const Rect& area);
  void draw_canvas(const Frame& f, Pane& pane, const PaneContent& content, const Rect& rect);
  void draw_wipe(const Frame& f, const std::vector<PaneContent>& contents, const Rect& area);
  void draw_flat_wipe(const Frame& f, const std::vector<PaneContent>& contents, const Rect& area);
  static void draw_wipe_line(const Frame& f, const Rect& area, float line);
  static float wipe_line(const Frame& f, const Rect& area);
  void set_up(const Frame& f, Pane& pane, const PaneContent& content, const PaneView& view);
  void interact(const Frame& f, Pane& pane);
  void use_cube(const Frame& f, Pane& pane, const Rect& part);
  void choose_person(const Frame& f, const Pane& pane, const Pointer& now);
  void activate(const Frame& f, const Pane& pane);
  void ask_what_to_do(const Frame& f, const Pane& pane, const Pointer& now);
  void draw_menu(const Frame& f);
  /// A pane as the person that the tool is about is seen in it.
  static PaneView tool_view(const app::Session& session, const Pane& pane);
  void point_camera(const Frame& f, const Pane& pane, const render::Camera& camera);
  void turn_light(const Frame& f, const Pointer& now);
  void steer(const Frame& f, Pane& pane, const Pointer& pointer, bool free_left);
  bool waits(const Pane& pane) const;
  void make_picture(const Frame& f, Pane& pane);
  void draw_picture(const Frame& f, Pane& pane);
  static bool is_live(const app::Session& session);
  bool steering() const;
  bool moving(const app::Session& session) const;
  void show(const Frame& f, Pane& pane, const Rect& part, bool right);
  void describe(const app::Session& session, const Pane& pane, const Theme& look, Overlay& overlay) const;
  int bone_at_pointer(const app::Session& session, const Pane& pane) const;
  void label_bones(const app::Session& session, const Pane& pane, Overlay& overlay) const;
  std::string words_at_pointer(const app::Session& session, const Pane& pane) const;
  void draw_brush(const Frame& f, const Pane& pane);
  void mark_rings(const Frame& f, const Pane& pane) const;
  static void mark_bones(const Frame& f, const Pane& pane);
  static void mark_made_motions(const Frame& f, const Pane& pane, Overlay& overlay);
  void keep_view_when_following_changes(const Frame& f);

  std::optional<render::Renderer> renderer_,
      sketcher_;  ///< of the settings' quality, and for while things move
  int samples_ = 0;
  std::vector<std::unique_ptr<Pane>> panes_;
  TargetLooks looks_;
  Hand hand_;
  Pointer pointer_;        ///< of the pane that it is in
  Pane* under_ = nullptr;  ///< which
  app::Tool tool_ = app::Tool::Look;
  ViewMenuPlace menu_;  ///< of the menu that is open
  std::optional<bool> followed_;
  bool legend_beside_ = false;  ///< the joints' colours stand beside the views, not in each
  bool performing_ = false;     ///< a step of the map: what moves is never drawn finely
  bool hold_ = false;           ///< cameras stay for this frame as they were
  int64_t drawn_ = 0;
  /// The only pane that may draw a new picture now, -1: all may. Where frames come one after the other while
  /// the pointer moves, each draw is of one pane, so that what the pointer does is shown soon; one pane alone
  /// draws every second time.
  int turn_ = -1;
};

}  // namespace understudy::ui
