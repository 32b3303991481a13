#include "ui/gui/focus.hpp"

#include <imgui_internal.h>

#include <algorithm>
#include <utility>

#include "ui/gui/ui.hpp"

namespace understudy::ui {
namespace {

using render::InputEvent;
using render::Key;
using Kind = InputEvent::Kind;

bool is_arrow(Key key) {
  return key == Key::Left || key == Key::Right || key == Key::Up || key == Key::Down;
}

bool is_alt(Key key) {
  return key == Key::LeftAlt || key == Key::RightAlt;
}

bool typing() {
  const ImGuiContext& context = *ImGui::GetCurrentContext();
  return context.ActiveId != 0 && context.ActiveId == context.InputTextState.ID;
}

ImVec4 edges(const ImRect& rect) {
  return {rect.Min.x, rect.Min.y, rect.Max.x, rect.Max.y};
}

/// What the press of a key does to a widget, in the next frame.
void use(ImGuiID id, bool typed) {
  ImGuiContext& context = *ImGui::GetCurrentContext();
  context.NavNextActivateId = id;
  context.NavNextActivateFlags = typed ? ImGuiActivateFlags_PreferInput : ImGuiActivateFlags_None;
}

}  // namespace

void Focus::add(const std::string& name, bool typed) {
  const ImGuiContext& context = *ImGui::GetCurrentContext();
  const ImGuiLastItemData& item = context.LastItemData;
  ImGuiWindow* const window = context.CurrentWindow;
  constexpr ImGuiItemFlags kPassedBy = ImGuiItemFlags_Disabled | ImGuiItemFlags_NoTabStop;
  const bool reachable = item.ID != 0 && (item.InFlags & kPassedBy) == 0 && !window->Hidden;
  if (reachable)
    drawing_.push_back({item.ID, name, window, edges(item.Rect), edges(window->ClipRect), typed});
}

const Focus::Stop* Focus::current() const {
  const auto found =
      std::find_if(finished_.begin(), finished_.end(), [&](const Stop& stop) { return stop.id == id_; });
  if (!shown_ || found == finished_.end()) return nullptr;
  const ImGuiWindow* const dialog = ImGui::GetTopMostPopupModal();  // what is behind it waits
  return dialog == nullptr || found->window->RootWindow == dialog ? &*found : nullptr;
}

std::string Focus::name() const {
  const Stop* const stop = current();
  return stop != nullptr ? stop->name : "";
}

const ImVec4* Focus::place() const {
  const Stop* const stop = current();
  return stop != nullptr ? &stop->rect : nullptr;
}

bool Focus::in_menu() {
  const auto& open = ImGui::GetCurrentContext()->OpenPopupStack;
  return !open.empty() &&
         (open.back().Window == nullptr || (open.back().Window->Flags & ImGuiWindowFlags_Modal) == 0);
}

bool Focus::take(const InputEvent& event) {
  follow_alt(event);
  if (event.kind == Kind::MouseMove && in_menu()) by_keys_ = false;
  if (event.kind == Kind::MouseButton && event.pressed) shown_ = by_keys_ = false;
  return event.kind == Kind::Key && event.pressed && take_key(event);
}

/// Alt alone, with nothing else between its press and its release.
void Focus::follow_alt(const InputEvent& event) {
  if (event.kind == Kind::MouseMove) return;
  const bool is_key = event.kind == Kind::Key && is_alt(event.key);
  if (is_key && event.repeated) return;
  const render::Modifiers& held = event.modifiers;
  if (is_key && !event.pressed && alt_alone_) alt_tapped_ = by_keys_ = true;
  alt_alone_ = is_key && event.pressed && !held.shift && !held.control && !held.super;
}

bool Focus::take_key(const InputEvent& event) {
  const render::Modifiers& held = event.modifiers;
  if (held.control || held.alt || held.super) {
    by_keys_ = true;  // a shortcut may open a menu
    return false;
  }
  const ImGuiContext& context = *ImGui::GetCurrentContext();
  const bool lists = in_menu();
  if (event.key == Key::Tab) {
    if (!lists) step_ = held.shift ? -1 : 1, by_keys_ = true;
    return true;
  }
  if (event.key == Key::Escape && !typing()) {
    if (lists)
      closing_ = true;
    else
      shown_ = false;
    return lists;  // it closes one menu and nothing else
  }
  if (lists && is_arrow(event.key) && context.NavDisableHighlight && context.NavId != 0) {
    by_keys_ = true;  // the first one shows where one is
    return true;
  }
  const bool uses = event.key == Key::Enter || event.key == Key::KeypadEnter || event.key == Key::Space;
  if (!uses || event.repeated || held.shift || typing()) return false;
  const Stop* const stop = current();
  if (lists ? context.NavDisableHighlight || context.NavId == 0 : stop == nullptr) return false;
  by_keys_ = true;
  use(lists ? context.NavId : stop->id, !lists && stop->typed);
  return true;
}

/// A text that is left notices it only now.
void Focus::begin_frame() {
  drawing_.clear();
  if (std::exchange(cleared_, false)) ImGui::ClearActiveID();
  const int open = ImGui::GetCurrentContext()->OpenPopupStack.Size;
  if (std::exchange(closing_, false) && open > 0) ImGui::ClosePopupToLevel(open - 1, true);
}

void Focus::go() {
  const ImGuiWindow* const dialog = ImGui::GetTopMostPopupModal();
  std::vector<const Stop*> order;
  for (const Stop& stop : drawing_)
    if (dialog == nullptr || stop.window->RootWindow == dialog) order.push_back(&stop);
  if (order.empty()) return;
  const ImGuiID active = ImGui::GetActiveID();
  const auto at = [&](ImGuiID id) {
    return std::find_if(order.begin(), order.end(), [&](const Stop* stop) { return stop->id == id; });
  };
  auto from = at(active);
  if (from == order.end()) from = at(id_);
  const auto count = static_cast<long>(order.size()), here = static_cast<long>(from - order.begin());
  const long next = from != order.end() ? (here + step_ + count) % count : step_ > 0 ? 0 : count - 1;
  const Stop& stop = *order[static_cast<size_t>(next)];
  id_ = stop.id, shown_ = true;
  cleared_ = active != 0, settling_ = true;
  if (stop.typed) use(stop.id, true);
  ImGui::ScrollToRect(stop.window, {{stop.rect.x, stop.rect.y}, {stop.rect.z, stop.rect.w}},
                      ImGuiScrollFlags_KeepVisibleEdgeY);
}

void Focus::await_dialog() {
  constexpr int kMostFrames = 10;  // where none comes
  awaiting_ = kMostFrames, awaited_ = ImGui::GetFrameCount();
}

void Focus::follow_dialog() {
  if (awaiting_ == 0 || ImGui::GetFrameCount() == awaited_) return;
  const ImGuiContext& context = *ImGui::GetCurrentContext();
  const ImGuiWindow* const dialog = ImGui::GetTopMostPopupModal();
  const bool is_there = dialog != nullptr && dialog->Active && !dialog->Appearing && !dialog->Hidden;
  const bool asks_for_text = context.NavMoveSubmitted || context.NavNextActivateId != 0;
  awaiting_ = is_there && !asks_for_text ? 0 : awaiting_ - 1;
}

void Focus::finish_frame(const Ui& ui) {
  settling_ = false;
  follow_dialog();
  if (step_ != 0) go();
  if (wanted_text_ != 0) use(wanted_text_, true), settling_ = true;
  wanted_text_ = 0, step_ = 0, alt_tapped_ = false;
  std::swap(drawing_, finished_);
  // Where the widget is gone the ring goes too, and does not come back with it.
  const auto is_it = [&](const Stop& stop) { return stop.id == id_; };
  shown_ = shown_ && std::any_of(finished_.begin(), finished_.end(), is_it);
  ImGuiContext& context = *ImGui::GetCurrentContext();
  const int popups = context.OpenPopupStack.Size;
  if (by_keys_ && in_menu()) {
    if (context.NavId != 0) context.NavDisableHighlight = false;
    if (popups > popups_) context.NavDisableMouseHover = true;  // the pointer rests where it happens to be
  }
  popups_ = popups;
  if (!in_menu()) draw_ring(ui);
}

void Focus::draw_ring(const Ui& ui) const {
  const Stop* const stop = current();
  if (stop == nullptr) return;
  const float away = ui.px(2), width = ui.px(2), reach = away + width;
  ImDrawList& list = *ImGui::GetForegroundDrawList();
  list.PushClipRect({stop->clip.x - reach, stop->clip.y - reach},
                    {stop->clip.z + reach, stop->clip.w + reach});
  list.AddRect({stop->rect.x - away, stop->rect.y - away}, {stop->rect.z + away, stop->rect.w + away},
               color(ui.theme().accent_hover), ImGui::GetStyle().FrameRounding + away, 0, width);
  list.PopClipRect();
}

}  // namespace understudy::ui
