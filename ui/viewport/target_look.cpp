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

/// A target that cannot be shaded is drawn without.
std::shared_ptr<const TargetLook> guarded_look(const Target& target) {
  try {
    return std::make_shared<const TargetLook>(look_of(target));
  } catch (const Error& error) {
    log::warn(std::string("the shading of a target: ") + error.what());
    TargetLook plain;
    plain.rest.vertices = target.mesh.vertices;
    return std::make_shared<const TargetLook>(std::move(plain));
  }
}

}  // namespace

bool is_closed(const Faces& faces) {
  std::vector<uint64_t> edges;
  edges.reserve(static_cast<size_t>(faces.size()));
  for (Eigen::Index f = 0; f < faces.rows(); ++f)
    for (int k = 0; k < 3; ++k) {
      const auto a = static_cast<uint64_t>(faces(f, k)), b = static_cast<uint64_t>(faces(f, (k + 1) % 3));
      edges.push_back(std::min(a, b) << 32 | std::max(a, b));
    }
  std::sort(edges.begin(), edges.end());
  for (size_t i = 0; i < edges.size();) {
    size_t end = i;
    while (end < edges.size() && edges[end] == edges[i]) ++end;
    if (end - i != 2) return false;
    i = end;
  }
  return !edges.empty();
}

TargetLook look_of(const Target& target) {
  TargetLook look;
  look.rest.vertices = target.mesh.vertices;
  look.rest.offsets = Points::Zero(target.mesh.vertices.rows(), 3);
  if (target.mesh.is_cloud()) {
    look.spacing = point_spacing(target.mesh.vertices);
    return look;
  }
  look.rest.normals = vertex_normals(target.mesh.vertices, target.mesh.faces);
  look.closed = is_closed(target.mesh.faces);
  look.ambient = ambient_occlusion(target.mesh.vertices, target.mesh.faces, look.rest.normals);
  return look;
}

bool same_surface(const Target* a, const Target* b) {
  if (a == nullptr || b == nullptr) return a == b;
  const Faces &f = a->mesh.faces, &g = b->mesh.faces;
  return a->mesh.vertices.rows() == b->mesh.vertices.rows() && f.rows() == g.rows() &&
         std::equal(f.data(), f.data() + f.size(), g.data());
}

std::shared_ptr<const TargetLook> TargetLooks::of(const std::shared_ptr<const Target>& target) {
  if (target == nullptr) return nullptr;
  auto found =
      std::find_if(entries_.begin(), entries_.end(), [&](const Entry& e) { return e.target == target; });
  if (found == entries_.end()) {
    const auto alike = std::find_if(entries_.begin(), entries_.end(), [&](const Entry& e) {
      return e.look != nullptr && same_surface(e.target.get(), target.get()) &&
             e.target->mesh.vertices == target->mesh.vertices;
    });
    const auto known = alike != entries_.end() ? alike->look : nullptr;
    entries_.emplace_front();
    found = entries_.begin();
    found->target = target, found->look = known;
    if (known == nullptr)
      found->coming = std::async(std::launch::async, [target] { return guarded_look(*target); });
    if (entries_.size() > kKept) entries_.pop_back();
  } else {
    entries_.splice(entries_.begin(), entries_, found);
  }
  take_in(*found, false);
  return found->look;
}

void TargetLooks::wait() {
  for (Entry& entry : entries_) take_in(entry, true);
}

void TargetLooks::take_in(Entry& entry, bool wait) {
  if (!entry.coming.valid()) return;
  if (!wait && entry.coming.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
  entry.look = entry.coming.get();
}

}  // namespace understudy::ui
