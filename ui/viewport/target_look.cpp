#include "ui/viewport/target_look.hpp"

#include <algorithm>
#include <chrono>
#include <vector>

#include "retarget/base/error.hpp"
#include "retarget/base/log.hpp"
#include "retarget/geometry/ambient_occlusion.hpp"
#include "retarget/geometry/cloud_normals.hpp"

namespace understudy::ui {
namespace {

constexpr size_t kKept = 8;  // targets; a document rarely shows more

using Look = std::shared_ptr<const TargetLook>;

/// Makes a part of a look; a target of which it cannot be made is drawn without.
template <class Part>
void attempt(const Part& part) {
  if (const std::string problem = failure_of(part); !problem.empty())
    log::warn("the shading of a target: " + problem);
}

/// All but `ambient`, within some hundredths of a second.
Look plain_look_of(const Target& target) {
  const Mesh& mesh = target.mesh;
  TargetLook look;
  app::PosedPicture rest;
  rest.vertices = mesh.vertices;
  attempt([&] {
    if (mesh.is_cloud()) {
      look.spacing = point_spacing(mesh.vertices);
    } else {
      rest.normals = vertex_normals(mesh.vertices, mesh.faces);
      look.closed = is_closed(mesh.faces);
    }
    rest.offsets = Points::Zero(mesh.vertices.rows(), 3);
  });
  look.rest = std::make_shared<const app::PosedPicture>(std::move(rest));
  return std::make_shared<const TargetLook>(std::move(look));
}

Look shaded_look_of(const Look& plain, const Target& target) {
  TargetLook look = *plain;
  look.shaded = true;
  attempt([&] {
    if (!target.mesh.is_cloud() && look.rest->normals.rows() > 0)
      look.ambient = ambient_occlusion(target.mesh.vertices, target.mesh.faces, look.rest->normals);
  });
  return std::make_shared<const TargetLook>(std::move(look));
}

bool is_ready(const std::future<Look>& look) {
  return look.valid() && look.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

}  // namespace

bool same_surface(const Target* a, const Target* b) {
  if (a == nullptr || b == nullptr) return a == b;
  const Faces &f = a->mesh.faces, &g = b->mesh.faces;
  return a->mesh.vertices.rows() == b->mesh.vertices.rows() && f.rows() == g.rows() &&
         std::equal(f.data(), f.data() + f.size(), g.data());
}

TargetLooks::Entry& TargetLooks::entry_of(const std::shared_ptr<const Target>& target) {
  const auto found =
      std::find_if(entries_.begin(), entries_.end(), [&](const Entry& e) { return e.target == target; });
  if (found != entries_.end()) {
    entries_.splice(entries_.begin(), entries_, found);
    return entries_.front();
  }
  const auto alike = std::find_if(entries_.begin(), entries_.end(), [&](const Entry& e) {
    return e.look != nullptr && same_surface(e.target.get(), target.get()) &&
           e.target->mesh.vertices == target->mesh.vertices;
  });
  Entry entry;
  entry.target = target;
  if (alike != entries_.end()) entry.look = alike->look;
  entries_.push_front(std::move(entry));
  if (entries_.size() > kKept) entries_.pop_back();
  return entries_.front();
}

Look TargetLooks::of(const std::shared_ptr<const Target>& target) {
  if (target == nullptr) return nullptr;
  Entry& entry = entry_of(target);
  take_in(entry, false);
  const bool shaded = entry.look != nullptr && entry.look->shaded;
  if (shaded || entry.shaded.valid()) return entry.look;
  if (entry.look != nullptr) {
    entry.shaded = std::async(std::launch::async,
                              [target, plain = entry.look] { return shaded_look_of(plain, *target); });
    return entry.look;
  }
  std::promise<Look> early;
  entry.plain = early.get_future();
  entry.shaded = std::async(std::launch::async, [target, early = std::move(early)]() mutable {
    const Look plain = plain_look_of(*target);
    early.set_value(plain);
    return shaded_look_of(plain, *target);
  });
  return nullptr;
}

Look TargetLooks::plain_of(const std::shared_ptr<const Target>& target) {
  if (target == nullptr) return nullptr;
  Entry& entry = entry_of(target);
  take_in(entry, false);
  if (entry.look == nullptr && !entry.plain.valid())
    entry.plain = std::async(std::launch::async, [target] { return plain_look_of(*target); });
  return entry.look;
}

void TargetLooks::forget() {
  entries_.remove_if([this](Entry& entry) {
    take_in(entry, false);
    return !entry.plain.valid() && !entry.shaded.valid();
  });
}

void TargetLooks::wait() {
  for (Entry& entry : entries_) take_in(entry, true);
}

int64_t TargetLooks::arrived() const {
  int64_t count = taken_in_;
  for (const Entry& entry : entries_) count += is_ready(entry.plain) + is_ready(entry.shaded);
  return count;
}

void TargetLooks::take_in(Entry& entry, bool wait) {
  for (std::future<Look>* coming : {&entry.plain, &entry.shaded}) {
    if (!coming->valid() || (!wait && !is_ready(*coming))) continue;
    entry.look = coming->get();
    ++taken_in_;
  }
}

}  // namespace understudy::ui
