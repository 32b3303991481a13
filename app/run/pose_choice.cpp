#include "app/run/pose_choice.hpp"

#include <filesystem>
#include <nlohmann/json.hpp>
#include <tuple>

#include "render/camera.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/file.hpp"
#include "retarget/base/text.hpp"
#include "retarget/formats/bytes.hpp"
#include "retarget/keypoints/keypoint_reader.hpp"

namespace understudy::app {
namespace {

constexpr const char* kCameraWords =
    "yaw, pitch, distance, fov (degrees, metres) and orthographic, as in yaw=30,distance=4; or a JSON file";
constexpr float kFilmMargin = 0.06f;  // of the picture, free on each side
constexpr float kUsualFovDeg = 28.6f;

/// One number within its range into the camera. where: names it in messages.
void set_number(PictureCamera& camera, const std::string& key, double value, const std::string& where) {
  struct Number {
    const char* key;
    std::optional<float> PictureCamera::*member;
    double low, high;
  };
  static const std::array<Number, 4> numbers = {{{"yaw", &PictureCamera::yaw_deg, -360, 360},
                                                 {"pitch", &PictureCamera::pitch_deg, -89, 89},
                                                 {"distance", &PictureCamera::distance_m, 0.05, 500},
                                                 {"fov", &PictureCamera::fov_deg, 1, 150}}};
  for (const Number& number : numbers) {
    if (key != number.key) continue;
    US_CHECK(value >= number.low && value <= number.high, where, ": ", key, " is between ", number.low,
             " and ", number.high, ", not ", value);
    camera.*number.member = static_cast<float>(value);
    return;
  }
  throw Error(where + ": a camera has no '" + key + "', only " + kCameraWords);
}

PictureCamera camera_of_words(const std::string& words) {
  const std::string where = "--camera " + words;
  PictureCamera camera;
  for (const std::string& word : split(words, ',')) {
    if (word == "orthographic") {
      camera.orthographic = true;
      continue;
    }
    const size_t equals = word.find('=');
    US_CHECK(equals != std::string::npos, where, ": '", word,
             "' is neither a camera's number nor a file; it takes ", kCameraWords);
    double value = 0;
    US_CHECK(parse_number(std::string_view(word).substr(equals + 1), value), where, ": '", word,
             "' is no number");
    set_number(camera, word.substr(0, equals), value, where);
  }
  return camera;
}

/// "yaw_deg" is "yaw".
std::string without_unit(const std::string& key) {
  for (const char* unit : {"_deg", "_m"})
    if (ends_with(key, unit)) return key.substr(0, key.size() - std::string(unit).size());
  return key;
}

PictureCamera camera_of_json(const std::string& path) {
  const nlohmann::json json = nlohmann::json::parse(read_file(path), nullptr, /*allow_exceptions=*/false);
  US_CHECK(json.is_object(), path, ": is neither a camera nor a file of 2D poses");
  PictureCamera camera;
  for (const auto& [key, value] : json.items()) {
    if (key == "orthographic" && value.is_boolean()) {
      camera.orthographic = value.get<bool>();
    } else if (key == "target") {
      const bool is_place = value.is_array() && value.size() == 3 && value[0].is_number() &&
                            value[1].is_number() && value[2].is_number();
      US_CHECK(is_place, path, ": target is a list of three numbers, metres");
      camera.target = Vec3(value[0], value[1], value[2]);
    } else {
      US_CHECK(value.is_number(), path, ": ", excerpt(key), " is no number");
      set_number(camera, without_unit(key), value.get<double>(), path);
    }
  }
  return camera;
}

}  // namespace

const std::array<CanvasPreset, 9> kCanvasPresets = {{{"Stable Diffusion 1.5", {512, 512}},
                                                     {"Stable Diffusion 1.5, wide", {768, 512}},
                                                     {"Stable Diffusion 1.5, tall", {512, 768}},
                                                     {"Wan, wide", {832, 480}},
                                                     {"Wan, tall", {480, 832}},
                                                     {"SDXL, Flux", {1024, 1024}},
                                                     {"720p, wide", {1280, 720}},
                                                     {"720p, tall", {720, 1280}},
                                                     {"AnimateDiff, tall", {576, 1024}}}};

PictureCamera picture_camera(const std::string& words) {
  std::error_code ignored;
  const bool is_there = std::filesystem::exists(words, ignored);
  if (!is_there && file_suffix(words).empty()) return camera_of_words(words);
  if (!is_there && words.find('=') != std::string::npos) return camera_of_words(words);
  if (!std::filesystem::is_directory(words, ignored)) check_file(words);
  if (!looks_like_keypoints(words)) return camera_of_json(words);
  PictureCamera camera;
  camera.reference = words;
  return camera;
}

PictureCount picture_count(const std::string& text) {
  if (lower_case(text) == "4n+1") return {0, true};
  int64_t count = 0;
  US_CHECK(parse_integer(text, count) && count >= 1 && count <= 1000000, "--count ", text,
           ": is a number of pictures from 1 to 1,000,000, or 4n+1");
  return {static_cast<int>(count), false};
}

bool is_usual(const PoseChoice& poses) {
  const PictureCamera& camera = poses.camera;
  const bool has_camera = camera.yaw_deg || camera.pitch_deg || camera.distance_m || camera.fov_deg ||
                          camera.target || camera.orthographic || !camera.reference.empty();
  const PoseChoice usual;
  const auto drawn = [](const render::PosePictureOptions& d) {
    return std::tie(d.layout, d.hands, d.face, d.half_width, d.wide_sticks);
  };
  const auto others = [](const PoseChoice& c) {
    return std::tie(c.rate, c.count.count, c.count.is_4n_plus_1, c.hides_face, c.hides_limbs, c.file, c.depth,
                    c.normals, c.mask);
  };
  return !has_camera && !poses.canvas && drawn(poses.drawing) == drawn(usual.drawing) &&
         others(poses) == others(usual);
}

Pinhole film_camera(const PictureCamera& camera, const Points& points, float front, const Canvas& canvas) {
  const render::PixelSize size{canvas.width, canvas.height};
  render::Camera orbit;
  orbit.yaw = camera.yaw_deg ? *camera.yaw_deg * kPi / 180 : front;
  orbit.pitch = camera.pitch_deg.value_or(0) * kPi / 180;
  orbit.fov = camera.fov_deg.value_or(kUsualFovDeg) * kPi / 180;
  orbit.orthographic = camera.orthographic;
  orbit = fitted(orbit, points, size.aspect(), kFilmMargin);
  if (camera.target) {
    orbit.target = *camera.target;
    orbit.distance = fitting_distance(orbit, points, size.aspect(), kFilmMargin);
  }
  if (camera.distance_m) orbit.distance = *camera.distance_m;
  Pinhole out = render::pinhole(orbit, size);
  out.centre -= Eigen::Vector2f(0.5f, 0.5f);  // of pixels' middles
  return out;
}

}  // namespace understudy::app
