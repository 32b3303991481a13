#include "app/cli/flat_pictures.hpp"

#include <algorithm>
#include <filesystem>

#include "render/contact_sheet.hpp"
#include "render/image.hpp"
#include "render/pose_cell.hpp"
#include "retarget/base/log.hpp"
#include "retarget/metrics/keypoint_metrics.hpp"

namespace understudy::app {
namespace {

constexpr int kCellHeight = 220;

/// Around the poses, as high and wide as a cell.
FlatBox cell_view(const std::vector<FlatPose>& poses, int width) {
  const FlatBox view = render::view_of(poses);
  if (view.isEmpty()) return view;
  const float aspect = static_cast<float>(kCellHeight) / static_cast<float>(width);
  const float across = std::max(view.sizes().x(), view.sizes().y() / aspect);
  const Vec2 half(across / 2, across * aspect / 2), middle = view.center();
  return {middle - half, middle + half};
}

render::Image alone(const FlatPose& pose, int width) {
  render::PoseCell cell;
  cell.performer = pose;
  return render::pose_cell(cell, cell_view({pose}, width), width, kCellHeight);
}

render::PictureRow row_of(const FlatMoment& moment, int width) {
  std::vector<FlatPose> all = {moment.truth, centred_on(moment.one_frame, moment.truth)};
  all.reserve(2 + moment.engines.size());
  for (const auto& [name, pose] : moment.engines) all.push_back(centred_on(pose, moment.truth));
  const FlatBox view = cell_view(all, width);
  render::PoseCell cell;
  cell.truth = moment.truth;
  render::PictureRow row{moment.name, {alone(moment.source, width), alone(moment.reference, width)}};
  const auto add = [&](const FlatPose& pose) {
    cell.performer = pose;
    row.pictures.push_back(render::pose_cell(cell, view, width, kCellHeight));
  };
  add(all[1]);
  cell.left = all[1];
  add(all[2]);
  cell.left.reset();
  for (size_t k = 2; k < all.size(); ++k) add(all[k]);
  return row;
}

}  // namespace

void write_flat_pictures(const std::string& folder, const std::vector<FlatMoment>& moments) {
  if (moments.empty()) return;
  const auto& engines = moments[0].engines;
  std::vector<std::string> headers = {"source", "reference", "ratios of one frame",
                                      "one frame | " + engines[0].first};
  headers.reserve(headers.size() + engines.size());
  for (const auto& [name, pose] : engines) headers.push_back(name);
  render::StripOptions options;
  options.width = 1600;
  options.columns = static_cast<int>(headers.size());
  const int width = render::picture_width(options, options.columns);
  std::vector<render::PictureRow> rows;
  rows.reserve(moments.size());
  for (const FlatMoment& moment : moments) rows.push_back(row_of(moment, width));
  std::filesystem::create_directories(folder);
  render::write_png(folder + "/flat_cases.png", render::picture_sheet(rows, headers, options));
  log::info("wrote " + folder + "/flat_cases.png");
}

}  // namespace understudy::app
