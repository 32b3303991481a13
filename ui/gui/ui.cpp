#include "ui/gui/ui.hpp"

#include <imgui_internal.h>

#include <algorithm>
#include <iterator>
#include <utility>

namespace understudy::ui {

Rect intersection(const Rect& a, const Rect& b) {
  return {{std::max(a.min.x, b.min.x), std::max(a.min.y, b.min.y)},
          {std::min(a.max.x, b.max.x), std::min(a.max.y, b.max.y)}};
}

void Ui::mark(const std::string& name) {
  const ImGuiContext& context = *ImGui::GetCurrentContext();
  const ImGuiLastItemData& item = context.LastItemData;
  add(name, {item.Rect.Min, item.Rect.Max},
      (item.InFlags & ImGuiItemFlags_Disabled) == 0 && !context.CurrentWindow->Hidden);
}

void Ui::mark(const std::string& name, const Rect& rect) {
  add(name, rect, (ImGui::GetCurrentContext()->CurrentItemFlags & ImGuiItemFlags_Disabled) == 0);
}

const Mark* Ui::find(const std::string& name) const {
  const auto found = finished_at_.find(name);
  return found == finished_at_.end() ? nullptr : &finished_[found->second];
}

void Ui::explain(Explanation explanation) {
  const ImGuiWindow& window = *ImGui::GetCurrentContext()->CurrentWindow;
  explanation.place = intersection(explanation.place, {window.ClipRect.Min, window.ClipRect.Max});
  const bool says = !explanation.text.empty() && !explanation.place.empty() && !window.Hidden;
  if (says) explaining_.push_back(std::move(explanation));
}

std::optional<Explanation> Ui::explanation_at(const ImVec2& at) const {
  std::vector<Explanation> here;
  std::copy_if(explained_.rbegin(), explained_.rend(), std::back_inserter(here),
               [&](const Explanation& one) { return one.place.contains(at); });
  const auto area = [](const Rect& rect) { return rect.width() * rect.height(); };
  std::stable_sort(here.begin(), here.end(),
                   [&](const Explanation& a, const Explanation& b) { return area(a.place) < area(b.place); });
  if (here.empty()) return std::nullopt;
  const auto named =
      std::find_if(here.begin(), here.end(), [](const Explanation& one) { return !one.title.empty(); });
  if (named != here.end()) here.front().title = named->title;
  return here.front();
}

bool Ui::claim_dialog(const std::string& name) {
  const int frame = ImGui::GetFrameCount();
  if (dialog_ != name && dialog_frame_ >= frame - 1) return false;
  dialog_ = name, dialog_frame_ = frame;
  return true;
}

void Ui::add(const std::string& name, const Rect& rect, bool enabled) {
  ImGuiWindow& window = *ImGui::GetCurrentContext()->CurrentWindow;
  const auto [at, is_new] = drawing_at_.try_emplace(name, drawing_.size());
  if (is_new) drawing_.emplace_back();
  drawing_[at->second] = {name, rect, intersection(rect, {window.ClipRect.Min, window.ClipRect.Max}),
                          enabled};
  if (name != reveal_) return;
  reveal_.clear();
  ImGui::ScrollToRect(&window, ImRect(rect.min, rect.max));
}

void Ui::finish_frame() {
  std::swap(drawing_, finished_);
  std::swap(drawing_at_, finished_at_);
  std::swap(explaining_, explained_);
  explaining_.clear();
  drawing_.clear();
  drawing_at_.clear();
  moves_ = std::exchange(drawing_moves_, false);
}

}  // namespace understudy::ui
