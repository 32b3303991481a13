#include "ui/panels/getting_started.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>

#include "retarget/base/fields.hpp"
#include "retarget/base/text.hpp"
#include "ui/panels/rows.hpp"

namespace understudy::ui {
namespace {

constexpr float kCardWidth = 300, kAway = 34, kRingAway = 4;  // at scale 1
using Before = GettingStartedState::Before;
using MarkNames = std::vector<std::string>;

bool has_opened(const app::Session& session, const Before& before) {
  const app::Document& now = session.document;
  const bool is_other = !now.source.path.empty() && now.source.path != before.document.source.path;
  return is_other || now.takes.size() > before.document.takes.size();
}

bool has_turned(const app::Session& session, const Before& before) {
  const auto& now = session.view.cameras;
  for (size_t i = 0; i < std::min(now.size(), before.cameras.size()); ++i)
    if (now[i].yaw != before.cameras[i].yaw || now[i].pitch != before.cameras[i].pitch) return true;
  return false;
}

bool has_fixed(const app::Session& session, const Before& before) {
  const app::Document &now = session.document, &then = before.document;
  if (!same(now.skeleton_edits, then.skeleton_edits)) return true;
  for (size_t k = 0; k < std::min(now.takes.size(), then.takes.size()); ++k)
    if (!same(now.takes[k].pose_edits, then.takes[k].pose_edits)) return true;
  return false;
}

bool has_compared(const app::Session& session, const Before& before) {
  return session.document.takes.size() > before.document.takes.size();
}

bool has_exported(const app::Session& session, const Before& before) {
  return std::any_of(session.notices.begin(), session.notices.end(), [&](const app::Notice& notice) {
    return notice.id > before.notices_made && starts_with(notice.offer.command, "file.show");
  });
}

MarkNames fix_widgets(const app::Session& session) {
  const bool chosen = session.tool == app::Tool::Joints || session.tool == app::Tool::Bones;
  return chosen ? MarkNames{"view.0", "views"} : MarkNames{"tools.joints", "menu.tools", "menu"};
}

struct Card {
  const char *title, *text;
  MarkNames (*widgets)(const app::Session&);  ///< marks; it points at the first that is to be seen
  bool (*done)(const app::Session&, const Before&);
};
constexpr std::array<Card, app::kGettingStartedCards> kCards = {{
    {"Open",
     "Click a sample, or open a scan or motion and a character to perform it. You can also drop files on "
     "this window.",
     [](const app::Session&) {
       return MarkNames{"start.sample.0", "start.open_source", "menu.file", "menu"};
     },
     has_opened},
    {"Look",
     "Drag in a view to turn it; the wheel zooms, the middle button moves. Space plays the motion. F1 "
     "explains whatever the pointer is on.",
     [](const app::Session&) {
       return MarkNames{"view.0", "views"};
     },
     has_turned},
    {"Fix",
     "Where a joint was found in the wrong place, choose this tool (W) and drag the joint in the source's "
     "view. The frames around follow, and the result with them.",
     fix_widgets, has_fixed},
    {"Compare",
     "Compare with\u2026 adds a second take, made with another method. Add target\u2026 lets another body "
     "perform the same motion. Both stand side by side.",
     [](const app::Session&) {
       return MarkNames{"menu.compare.add", "method.compare", "take.add", "menu.target", "menu"};
     },
     has_compared},
    {"Export",
     "Export\u2026 (Ctrl+E) writes an animated character that any engine opens, or BVH and other formats. "
     "Pictures and videos are there, too.",
     [](const app::Session&) {
       return MarkNames{"menu.dialog.open.export", "menu.file", "menu"};
     },
     has_exported},
}};

Before before_of(const app::Session& session) {
  return {session.document, session.view.cameras, session.notices_made};
}

/// Whether what was there before says nothing about now: all of it was closed, or another source was opened,
/// with cameras and edits of its own.
bool is_outdated(const app::Session& session, const GettingStartedState& state) {
  if (state.card == 1) return !has_document(session);
  return session.document.source.path != state.before.document.source.path;
}

/// What the card points at.
std::optional<Rect> pointed_at(const Ui& ui, const MarkNames& names) {
  for (const std::string& name : names) {
    const Mark* const mark = ui.find(name);
    if (mark != nullptr && !mark->visible.empty()) return mark->visible;
  }
  return std::nullopt;
}

/// How much of the card would lie over where heads are: about the middles of the views.
float over_heads(const std::vector<Rect>& views, float left, float width) {
  float over = 0;
  for (const Rect& view : views) {
    const float middle = view.at(0.5f, 0).x, half = 0.1f * view.height();
    over += std::max(0.f, std::min(left + width, middle + half) - std::max(left, middle - half));
  }
  return over;
}

/// The place nearest to `wanted` where a card below the top bar hides the least of heads.
float beside_heads(const std::vector<Rect>& views, float wanted, float width, float room) {
  float best = wanted;
  const auto is_better = [&](float x) {
    const float over = over_heads(views, x, width), least = over_heads(views, best, width);
    return over < least || (over == least && std::abs(x - wanted) < std::abs(best - wanted));
  };
  for (float x = 0; x <= room; x += 4)
    if (is_better(x)) best = x;
  return best;
}

std::vector<Rect> shown_views(const Ui& ui, const app::Session& session) {
  std::vector<Rect> views;
  for (size_t k = 0; k <= session.takes.size(); ++k)
    if (const Mark* const mark = ui.find("view." + std::to_string(k)); mark != nullptr)
      views.push_back(mark->rect);
  return views;
}

/// Beside the place where there is room, else over its right edge: between two figures.
Rect place_card(const ImVec2& display, const ImVec2& size, const Rect& at, float away,
                const std::vector<Rect>& views) {
  const auto kept_in = [](float value, float room) { return std::max(0.f, std::min(value, room)); };
  const float x = kept_in(at.at(0.5f, 0).x - size.x / 2, display.x - size.x - away / 2);
  const float y = kept_in(at.at(0, 0.5f).y - size.y / 2, display.y - size.y - away / 2);
  ImVec2 from{kept_in(at.max.x - size.x / 2, display.x - size.x - away / 2),
              std::max(0.f, at.max.y - size.y - away / 2)};
  const auto is_over = [&](const Rect& view) { return at.max.y + away < view.max.y; };
  const bool hides = std::any_of(views.begin(), views.end(), is_over);
  if (at.max.y + away + size.y < display.y)
    from = {hides ? beside_heads(views, x, size.x, display.x - size.x - away / 2) : x, at.max.y + away};
  else if (at.min.y - away - size.y > 0)
    from = {x, at.min.y - away - size.y};
  else if (at.max.x + away + size.x < display.x)
    from = {at.max.x + away, y};
  else if (at.min.x - away - size.x > 0)
    from = {at.min.x - away - size.x, y};
  return {from, {from.x + size.x, from.y + size.y}};
}

/// A window that takes no input, over everything: the ring, and an arrow from the card to it.
void draw_ring(Ui& ui, const Rect& at, const Rect& card) {
  const ImVec2 display = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({0, 0});
  ImGui::SetNextWindowSize(display);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0, 0});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 0);
  ImGui::Begin("##guide_ring", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoBackground | ImGuiWindowFlags_NoInputs |
                   ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoSavedSettings);
  ImGui::PopStyleVar(2);
  const float away = ui.px(kRingAway);
  const Rect ring = intersection({{at.min.x - away, at.min.y - away}, {at.max.x + away, at.max.y + away}},
                                 {{1, 1}, {display.x - 1, display.y - 1}});
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImU32 ink = color(ui.theme().accent);
  list.AddRect(ring.min, ring.max, ink, ui.px(6), 0, ui.px(2));
  const auto nearest = [](const Rect& rect, const ImVec2& to) {
    return ImVec2(std::clamp(to.x, rect.min.x, rect.max.x), std::clamp(to.y, rect.min.y, rect.max.y));
  };
  const ImVec2 from = nearest(card, ring.at(0.5f, 0.5f)), to = nearest(ring, from);
  const float length = std::hypot(to.x - from.x, to.y - from.y);
  if (length > ui.px(8)) {
    const ImVec2 d((to.x - from.x) / length, (to.y - from.y) / length);
    const float head = ui.px(9);
    const ImVec2 neck(to.x - head * d.x, to.y - head * d.y);
    list.AddLine(from, neck, ink, ui.px(2));
    list.AddTriangleFilled(to, {neck.x - 0.5f * head * d.y, neck.y + 0.5f * head * d.x},
                           {neck.x + 0.5f * head * d.y, neck.y - 0.5f * head * d.x}, ink);
  }
  ui.mark("guide.ring", ring);
  ImGui::End();
}

void ask_for_card(PanelContext& context, int card) {
  if (card <= app::kGettingStartedCards) return context.ask("help.getting_started", {std::to_string(card)});
  context.ask("help.getting_started", {"off"});
  context.ask("notice", {"That was all. Help > Getting started shows the cards again."});
}

void draw_words(PanelContext& context, const Card& card, int number) {
  Ui& ui = context.ui;
  {
    const FontScope strong(ui.fonts().strong);
    ImGui::TextUnformatted(card.title);
  }
  ImGui::SameLine();
  hint(ui, std::to_string(number) + " of " + std::to_string(app::kGettingStartedCards));
  ImGui::PushTextWrapPos(0);
  ImGui::TextUnformatted(card.text);
  ImGui::PopTextWrapPos();
  ImGui::Dummy({0, ui.px(2)});
  const bool is_last = number == app::kGettingStartedCards;
  ButtonRow buttons(2);
  ButtonOptions skip, next;
  skip.look = ButtonLook::Quiet, skip.tooltip = "Hides the cards. Help > Getting started shows them again";
  next.look = ButtonLook::Main;
  if (buttons.add(ui, "guide.skip", "Skip", skip)) context.ask("help.getting_started", {"off"});
  if (buttons.add(ui, "guide.next", is_last ? "Done" : "Next", next)) ask_for_card(context, number + 1);
}

void draw_guide_card(const app::Session& session, PanelContext& context, GettingStartedState& state) {
  Ui& ui = context.ui;
  const Card& card = kCards[state.card - 1];
  const ImVec2 display = ImGui::GetIO().DisplaySize;
  const ImVec2 size(std::min(ui.px(kCardWidth), display.x), state.height);
  const std::optional<Rect> at = pointed_at(ui, card.widgets(session));
  const Rect middle{{0, display.y / 2}, {display.x, display.y / 2 + 1}};
  const Rect place = place_card(display, size, at.value_or(middle), ui.px(kAway), shown_views(ui, session));
  if (at && state.height > 0) draw_ring(ui, *at, place);
  ImGui::SetNextWindowPos(place.min);
  ImGui::SetNextWindowSize({size.x, 0});
  const ColorScope background(ImGuiCol_WindowBg, ui.theme().raised),
      border(ImGuiCol_Border, ui.theme().accent);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, std::max(1.f, ui.px(1)));
  ImGui::Begin("##guide_card", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoSavedSettings);
  ImGui::PopStyleVar();
  draw_words(context, card, state.card);
  state.height = ImGui::GetWindowSize().y;
  const ImVec2 from = ImGui::GetWindowPos(), whole = ImGui::GetWindowSize();
  const Rect window{from, {from.x + whole.x, from.y + whole.y}};
  ui.mark("guide.card", window);
  ui.explain({window, "Getting started", card.text});
  ImGui::End();
}

}  // namespace

void draw_getting_started(const app::Session& session, PanelContext& context, GettingStartedState& state,
                          bool hidden) {
  const int card = std::clamp(session.settings.getting_started, 0, app::kGettingStartedCards);
  if (card != state.card) {
    // What the program was started with was opened, too.
    const bool at_start = state.card < 0 && card == 1;
    state.before = at_start ? Before() : before_of(session);
    state.card = card;
  } else if (is_outdated(session, state)) {
    state.before = before_of(session);
  }
  if (card == 0) return;
  if (kCards[card - 1].done(session, state.before)) return ask_for_card(context, card + 1);
  if (!hidden) draw_guide_card(session, context, state);
}

}  // namespace understudy::ui
