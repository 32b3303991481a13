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

constexpr int kCellHeight = 250, kColumns = 5;

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
  const FlatPose one = centred_on(moment.one_frame, moment.truth),
                 ours = centred_on(moment.ours, moment.truth);
  const FlatBox view = cell_view({moment.truth, one, ours}, width);
  render::PoseCell cell;
  cell.truth = moment.truth;
  render::PictureRow row{moment.name, {alone(moment.source, width), alone(moment.reference, width)}};
  const auto add = [&](const FlatPose& pose) {
    cell.performer = pose;
    row.pictures.push_back(render::pose_cell(cell, view, width, kCellHeight));
  };
  add(one);
  cell.left = one;
  add(ours);
  cell.left.reset();
  add(ours);
  return row;
}

}  // namespace

void write_flat_pictures(const std::string& folder, const std::vector<FlatMoment>& moments) {
  if (moments.empty()) return;
  render::StripOptions options;
  options.width = 1400;
  options.columns = kColumns;
  const int width = render::picture_width(options, kColumns);
  std::vector<render::PictureRow> rows;
  for (const FlatMoment& moment : moments) rows.push_back(row_of(moment, width));
  std::filesystem::create_directories(folder);
  render::write_png(folder + "/flat_cases.png",
                    render::picture_sheet(rows,
                                          {"source", "reference", "ratios of one frame",
                                           "one frame | " + moments[0].engine, moments[0].engine},
                                          options));
  log::info("wrote " + folder + "/flat_cases.png");
}

}  // namespace understudy::app
