#include "app/cli/preview.hpp"

#include <algorithm>
#include <cmath>

#include "render/image.hpp"
#include "retarget/base/error.hpp"

namespace understudy::app {

bool PreviewMoments::wanted(int64_t index) const {
  if (!count_ || *count_ <= shown_) return index % stride_ == 0;
  for (int64_t i = 0; i < shown_; ++i)
    if (index == i * (*count_ - 1) / (shown_ - 1)) return true;
  return false;
}

void PreviewMoments::add(int64_t index, render::SheetMoment moment) {
  kept_.emplace_back(index, std::move(moment));
  if (kept_.size() <= 2 * static_cast<size_t>(shown_)) return;
  stride_ *= 2;
  const auto off_stride = [this](const auto& kept) { return kept.first % stride_ != 0; };
  kept_.erase(std::remove_if(kept_.begin(), kept_.end(), off_stride), kept_.end());
}

std::vector<render::SheetMoment> PreviewMoments::take() {
  std::vector<render::SheetMoment> shown;
  const size_t count = std::min<size_t>(shown_, kept_.size());
  for (size_t i = 0; i < count; ++i) {
    const size_t at = count == 1 ? 0 : i * (kept_.size() - 1) / (count - 1);
    shown.push_back(std::move(kept_[at].second));
  }
  kept_.clear();
  return shown;
}

namespace {

/// Radians about +y that a body faces, 0 is +z: across its hips, turned by a right angle.
float heading_of(const Points& joints) {
  const Vec3 left = (joints.row(LeftHip) - joints.row(RightHip)).transpose();
  return std::atan2(-left.z(), left.x());
}

}  // namespace

void write_preview(const std::string& path, const std::vector<render::SheetMoment>& moments,
                   const std::string& title, int columns) {
  US_CHECK(!moments.empty(), path, ": there is no frame to show");
  render::SheetOptions options;
  options.title = title;
  options.columns = columns;
  for (const auto& moment : moments)
    if (moment.skeleton) {
      options.heading = heading_of(moment.skeleton->joints);
      break;
    }
  render::write_png(path, render::contact_sheet(moments, options));
}

}  // namespace understudy::app
