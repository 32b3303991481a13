// What every panel gets besides the session, and the words that panels share.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "app/session/commands.hpp"
#include "app/session/session.hpp"
#include "ui/gui/ui.hpp"
#include "ui/widgets/icons.hpp"

namespace understudy::ui {

/// What a clip of a study shows.
struct TrialPicture {
  ImTextureID texture = nullptr;  ///< null: no picture (yet)
  float width = 0, height = 0;    ///< of the texture
  std::string text{};             ///< why there is none
};

/// A panel reads the session, draws, and pushes commands that run after the frame.
struct PanelContext {
  Ui& ui;
  app::CommandQueue& queue;
  const app::Commands& commands;  ///< labels and shortcuts
  /// The chosen trial of the open study at a share (0..1) of its clip; must not wait. Empty: there are none.
  std::function<TrialPicture(float share)> trial_picture = {};
  void ask(const std::string& name, app::Arguments arguments = {}) {
    queue.emplace_back(name, std::move(arguments));
  }
};

/// A value as an argument of a command: "0.25", "1e-05", never "0,25".
std::string argument(double value);
std::string on_off(bool on);

std::vector<std::string> joint_labels();
/// As commands name it: "left_wrist"; "all" below 0.
std::string joint_name(int joint);

/// "about 40 s left", "about 3 min left"; empty where it is not known.
std::string time_left(double seconds);
/// With few digits and its unit: "12.4 mm".
std::string figure(double value, const std::string& unit);
/// How far what was made is expected to be off: "± 3 cm", rounded up; "" for 0 metres.
std::string doubt_text(float doubt_m);

/// The selected take; null when there is none.
const app::Take* selected_take(const app::Session& session);
const app::TakeState* selected_state(const app::Session& session);
/// A section about the current take: "Result: adult"; without a take the words alone.
std::string take_title(const app::Session& session, const std::string& words);
/// Whether anything is open.
bool has_document(const app::Session& session);
/// The timeline's length: the frames known to come, or those made.
int known_frames(const app::Session& session);
double frames_per_second(const app::Session& session);

/// Whether a part of the window is shown: a panel (for those in the side panel: its tab), "side", or
/// "side_over", the side panel where it lies over the views for lack of room.
bool panel_shown(const app::Session& session, const std::string& panel);

/// Of the tools in menus and bars, in the order of app::Tool: all but the rest pose, which the target has.
constexpr std::array<Icon, 6> kToolIcons = {Icon::Camera, Icon::Skeleton, Icon::Move,
                                            Icon::Person, Icon::Brush,    Icon::Select};

/// Whether a command is possible now; menus and buttons are grey where it is not.
bool possible(const app::Session& session, const std::string& command);

}  // namespace understudy::ui
