#include "app/cli/pose_rows.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>

#include "render/pose_cell.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/file.hpp"
#include "retarget/base/index.hpp"
#include "retarget/base/text.hpp"
#include "retarget/character/picture.hpp"

namespace understudy::app {
namespace {

namespace fs = std::filesystem;

constexpr float kLowest = 0.45f, kHighest = 2.2f;  // of a cell's height to its width

/// Null where there is none that can be read.
std::shared_ptr<const render::Image> picture_beside(const std::string& path) {
  for (const char* suffix : {".png", ".jpg", ".jpeg", ".webp"}) {
    const fs::path picture = fs::path(path).replace_extension(suffix);
    std::error_code failed;
    if (!fs::is_regular_file(picture, failed)) continue;
    const Pixels pixels = decode_picture(read_file(picture.string()));
    auto image = std::make_shared<render::Image>(pixels.width, pixels.height);
    std::copy_n(pixels.rgb.get(), image->pixels.size(), image->pixels.data());
    return image;
  }
  return nullptr;
}

/// The frame that is there at a time, -1 after the last.
int64_t frame_at(const KeypointReading& reading, double time) {
  const auto frame = static_cast<int64_t>(std::lround(time * reading.fps));
  return frame < static_cast<int64_t>(reading.frames.size()) ? frame : -1;
}

std::vector<fs::path> pictures_in(const std::string& folder) {
  std::vector<fs::path> pictures;
  std::error_code failed;
  for (const auto& entry : fs::directory_iterator(folder, failed))
    if (lower_case(entry.path().extension().string()) == ".png") pictures.push_back(entry.path());
  std::sort(pictures.begin(), pictures.end());
  return pictures;
}

/// Each pixel the mean of those that fall on it.
render::Image smaller(const render::Image& picture, int width) {
  const int height =
      std::max(1, static_cast<int>(std::lround(static_cast<double>(picture.height) * width / picture.width)));
  render::Image small(width, height);
  const auto from = [](int at, int of, int to) {
    return static_cast<int>(static_cast<int64_t>(at) * of / to);
  };
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const int x0 = from(x, picture.width, width), x1 = std::max(x0 + 1, from(x + 1, picture.width, width)),
                y0 = from(y, picture.height, height),
                y1 = std::max(y0 + 1, from(y + 1, picture.height, height));
      for (int c = 0; c < 3; ++c) {
        int sum = 0;
        for (int v = y0; v < y1; ++v)
          for (int u = x0; u < x1; ++u) sum += picture.at(u, v)[c];
        small.at(x, y)[c] = static_cast<uint8_t>(sum / ((x1 - x0) * (y1 - y0)));
      }
    }
  return small;
}

render::PoseCell cell_of(const KeypointReading& reading, int64_t frame) {
  render::PoseCell cell;
  for (const KeypointTrack& track : reading.tracks) {
    const FlatPose* const pose = track.at(frame);
    if (!pose) continue;
    if (&track == &reading.performing())
      cell.performer = *pose;
    else
      cell.others.push_back(*pose);
  }
  cell.flagged = !cell.performer || !reading.frames[static_cast<size_t>(frame)].problem.empty();
  return cell;
}

}  // namespace

render::PictureRow pose_row(const KeypointReading& reading, const std::vector<double>& times, int width) {
  std::vector<FlatPose> performer;
  for (const double time : times)
    if (const int64_t frame = frame_at(reading, time); frame >= 0)
      if (const FlatPose* pose = reading.performing().at(frame)) performer.push_back(*pose);
  FlatBox view = render::view_of(performer);
  US_CHECK(!view.isEmpty(), reading.path, ": who performs is seen at none of the moments");
  const float aspect = std::clamp(view.sizes().y() / view.sizes().x(), kLowest, kHighest);
  const float across = std::max(view.sizes().x(), view.sizes().y() / aspect);
  const Vec2 half(across / 2, across * aspect / 2), middle = view.center();
  view = FlatBox(middle - half, middle + half);
  const int height = static_cast<int>(std::lround(static_cast<float>(width) * aspect));
  const auto behind = picture_beside(reading.path);
  render::PictureRow row;
  row.caption = fs::path(reading.path).stem().string();
  for (const double time : times) {
    const int64_t frame = frame_at(reading, time);
    if (frame < 0) {
      row.pictures.emplace_back(width, height);
      continue;
    }
    render::PoseCell cell = cell_of(reading, frame);
    cell.behind = behind;
    row.pictures.push_back(render::pose_cell(cell, view, width, height));
  }
  return row;
}

bool is_folder_of_pictures(const std::string& path) {
  return !pictures_in(path).empty();
}

int64_t count_pictures(const std::string& folder) {
  return ssize(pictures_in(folder));
}

render::PictureRow picture_row(const std::string& folder, const std::vector<double>& times, int width) {
  const std::vector<fs::path> all = pictures_in(folder);
  render::PictureRow row;
  row.caption = fs::path(folder).stem().string();
  for (const double time : times) {
    const auto at = static_cast<size_t>(std::lround(time * kPictureRate));
    row.pictures.push_back(at < all.size() ? smaller(render::read_png(all[at].string()), width)
                                           : render::Image(width, width));
  }
  return row;
}

}  // namespace understudy::app
