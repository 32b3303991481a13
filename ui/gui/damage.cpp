#include "ui/gui/damage.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace understudy::ui {
namespace {

constexpr size_t kMostRects = 12;
constexpr float kWaste = 3000;  // pixels that a join may add: about what a few triangles cost

float area(const Rect& r) {
  return r.empty() ? 0 : r.width() * r.height();
}

Rect join(const Rect& a, const Rect& b) {
  return {{std::min(a.min.x, b.min.x), std::min(a.min.y, b.min.y)},
          {std::max(a.max.x, b.max.x), std::max(a.max.y, b.max.y)}};
}

/// Whether the lists in both frames have the same order.
template <class Lists>
bool same_order(const Lists& before, const Lists& now) {
  size_t from = 0;
  for (const auto& list : now) {
    const auto is_it = [&](const auto& other) { return other.owner == list.owner; };
    const auto found = std::find_if(before.begin(), before.end(), is_it);
    if (found == before.end()) continue;
    const size_t at = found - before.begin();
    if (at < from) return false;
    from = at + 1;
  }
  return true;
}

}  // namespace

void add_rect(std::vector<Rect>& rects, const Rect& rect) {
  if (rect.empty()) return;
  const Rect whole{{std::floor(rect.min.x), std::floor(rect.min.y)},
                   {std::ceil(rect.max.x), std::ceil(rect.max.y)}};
  size_t best = rects.size();
  float least = rects.size() < kMostRects ? kWaste : INFINITY;
  for (size_t i = 0; i < rects.size(); ++i) {
    const float waste = area(join(rects[i], whole)) - area(rects[i]) - area(whole);
    if (waste < least) least = waste, best = i;
  }
  if (best == rects.size())
    rects.push_back(whole);
  else
    rects[best] = join(rects[best], whole);
}

Damage::List Damage::copy(const ImDrawList& list) {
  List copied;
  copied.owner = list._OwnerName != nullptr ? list._OwnerName : "";
  for (const ImDrawCmd& command : list.CmdBuffer) {
    if (command.ElemCount == 0) continue;
    Command& to = copied.commands.emplace_back();
    to.clip = {{command.ClipRect.x, command.ClipRect.y}, {command.ClipRect.z, command.ClipRect.w}};
    to.texture = command.GetTexID();
    to.triangles.resize(command.ElemCount / 3);
    const ImDrawIdx* index = list.IdxBuffer.Data + command.IdxOffset;
    for (Triangle& triangle : to.triangles)
      for (ImDrawVert& corner : triangle.corners) corner = list.VtxBuffer.Data[command.VtxOffset + *index++];
  }
  return copied;
}

Rect Damage::bounds(const Triangle& triangle) {
  const ImVec2 &a = triangle.corners[0].pos, &b = triangle.corners[1].pos, &c = triangle.corners[2].pos;
  return {{std::min({a.x, b.x, c.x}), std::min({a.y, b.y, c.y})},
          {std::max({a.x, b.x, c.x}), std::max({a.y, b.y, c.y})}};
}

void Damage::add_all(std::vector<Rect>& rects, const Command& command) {
  if (command.triangles.empty()) return;
  Rect all = bounds(command.triangles.front());
  for (const Triangle& triangle : command.triangles) all = join(all, bounds(triangle));
  add_rect(rects, intersection(all, command.clip));
}

void Damage::add_all(std::vector<Rect>& rects, const List& list) {
  for (const Command& command : list.commands) add_all(rects, command);
}

void Damage::compare(std::vector<Rect>& rects, const Command& before, const Command& now) {
  if (std::memcmp(&before.clip, &now.clip, sizeof before.clip) != 0 || before.texture != now.texture ||
      now.texture != nullptr) {
    add_all(rects, before), add_all(rects, now);
    return;
  }
  const auto same = [](const Triangle& a, const Triangle& b) { return std::memcmp(&a, &b, sizeof a) == 0; };
  const auto &old = before.triangles, &fresh = now.triangles;
  const size_t shared = std::min(old.size(), fresh.size());
  size_t front = 0, back = 0;
  while (front < shared && same(old[front], fresh[front])) ++front;
  while (back < shared - front && same(old[old.size() - 1 - back], fresh[fresh.size() - 1 - back])) ++back;
  const bool aligned = old.size() == fresh.size();
  for (size_t i = front; i < old.size() - back; ++i)
    if (!aligned || !same(old[i], fresh[i])) add_rect(rects, intersection(bounds(old[i]), now.clip));
  for (size_t i = front; i < fresh.size() - back; ++i)
    if (!aligned || !same(old[i], fresh[i])) add_rect(rects, intersection(bounds(fresh[i]), now.clip));
}

void Damage::compare(std::vector<Rect>& rects, const List& before, const List& now) {
  if (before.commands.size() != now.commands.size()) return add_all(rects, before), add_all(rects, now);
  for (size_t i = 0; i < now.commands.size(); ++i) compare(rects, before.commands[i], now.commands[i]);
}

std::vector<Rect> Damage::update(const ImDrawData& data) {
  std::vector<List> now;
  now.reserve(data.CmdListsCount);
  for (int i = 0; i < data.CmdListsCount; ++i) now.push_back(copy(*data.CmdLists[i]));
  std::vector<Rect> rects;
  if (before_.empty() || size_.x != data.DisplaySize.x || size_.y != data.DisplaySize.y ||
      !same_order(before_, now)) {
    rects.push_back({{0, 0}, data.DisplaySize});
  } else {
    const auto find = [](const std::vector<List>& lists, const std::string& owner) {
      return std::find_if(lists.begin(), lists.end(), [&](const List& list) { return list.owner == owner; });
    };
    for (const List& list : now) {
      const auto before = find(before_, list.owner);
      before == before_.end() ? add_all(rects, list) : compare(rects, *before, list);
    }
    for (const List& list : before_)
      if (find(now, list.owner) == now.end()) add_all(rects, list);
  }
  before_ = std::move(now), size_ = data.DisplaySize;
  const Rect display{{0, 0}, data.DisplaySize};
  for (Rect& rect : rects) rect = intersection(rect, display);
  rects.erase(std::remove_if(rects.begin(), rects.end(), [](const Rect& r) { return r.empty(); }),
              rects.end());
  return rects;
}

}  // namespace understudy::ui
