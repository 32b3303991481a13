#include "app/session/kept_owners.hpp"

#include <zlib.h>

#include <algorithm>

#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"

namespace understudy::app {

std::shared_ptr<const KeptOwners> KeptOwners::of(const Points& scan, const SceneFrame& scene, int person) {
  if (scene.owner.empty() && scene.alone == person) return nullptr;
  auto kept = std::make_shared<KeptOwners>();
  std::vector<uint8_t> plain;
  for (Eigen::Index v = 0; v < scan.rows(); ++v) {
    if (!scan.row(v).allFinite()) continue;
    const int owner = scene.owner.empty() ? scene.alone : scene.owner[static_cast<size_t>(v)];
    auto at = std::find(kept->ids_.begin(), kept->ids_.end(), owner);
    if (at == kept->ids_.end()) at = kept->ids_.insert(at, owner);
    plain.push_back(static_cast<uint8_t>(at - kept->ids_.begin()));
    if (owner <= People::kScenery) continue;
    Box& box = kept->people_.try_emplace(owner, Box{scan.row(v), scan.row(v)}).first->second;
    box.low = box.low.cwiseMin(scan.row(v).transpose());
    box.high = box.high.cwiseMax(scan.row(v).transpose());
  }
  US_CHECK(kept->ids_.size() < 256, "there are too many people in a scan");
  kept->count_ = ssize(plain);
  uLongf size = compressBound(static_cast<uLong>(plain.size()));
  kept->packed_.resize(size);
  const int failed =
      compress2(kept->packed_.data(), &size, plain.data(), static_cast<uLong>(plain.size()), 1);
  US_CHECK(failed == Z_OK, "there is not enough memory to keep who is in a scan");
  kept->packed_.resize(size);
  kept->packed_.shrink_to_fit();
  return kept;
}

std::vector<int> KeptOwners::owners(const Points& vertices) const {
  const auto finite = [&](Eigen::Index v) { return vertices.row(v).allFinite(); };
  int64_t count = 0;
  for (Eigen::Index v = 0; v < vertices.rows(); ++v) count += finite(v) ? 1 : 0;
  if (count != count_) return {};
  std::vector<uint8_t> plain(static_cast<size_t>(count_));
  uLongf size = static_cast<uLongf>(plain.size());
  const int failed = uncompress(plain.data(), &size, packed_.data(), static_cast<uLong>(packed_.size()));
  if (failed != Z_OK || ssize(plain) != static_cast<std::ptrdiff_t>(size)) return {};
  std::vector<int> result(static_cast<size_t>(vertices.rows()), People::kNobody);
  size_t next = 0;
  for (Eigen::Index v = 0; v < vertices.rows(); ++v)
    if (finite(v)) result[static_cast<size_t>(v)] = ids_[plain[next++]];
  return result;
}

}  // namespace understudy::app
