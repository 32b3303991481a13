#include "app/session/command_sets.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/base/text.hpp"

namespace understudy::app {

void remember_folder(Studio& studio, const std::string& path) {
  namespace fs = std::filesystem;
  std::error_code lost;  // the working folder is gone: then none is remembered
  const auto whole = [&](const std::string& given) { return fs::absolute(given, lost).lexically_normal(); };
  const std::string folder = whole(path).parent_path().string(), &samples = studio.services().samples;
  if (!samples.empty() && starts_with(folder + '/', (whole(samples) / "").string())) return;
  if (!lost) studio.session().settings.last_folder = folder;
}

const std::string& ArgumentReader::word(size_t i, const char* what) const {
  US_CHECK(i < arguments.size(), "a ", what, " is missing");
  return arguments[i];
}

double ArgumentReader::real_number(size_t i, const char* what) const {
  const std::string& text = word(i, what);
  double value = 0;
  US_CHECK(parse_number(text, value) && std::abs(value) < 1e12, what, " is a number, not '", text, "'");
  return value;
}

double ArgumentReader::whole_number(size_t i, const char* what) const {
  const double value = real_number(i, what);
  US_CHECK(value == std::floor(value) && std::abs(value) < 1e9, what, " is a whole number, not ",
           arguments[i]);
  return value;
}

size_t ArgumentReader::choice(size_t i, const char* what, const std::vector<std::string>& words) const {
  const std::string& text = word(i, what);
  const auto found = std::find(words.begin(), words.end(), text);
  std::string all;
  for (const std::string& known : words) append_item(all, known);
  US_CHECK(found != words.end(), what, " is one of ", all, ", not '", text, "'");
  return static_cast<size_t>(found - words.begin());
}

const std::string& ArgumentReader::one_of(size_t i, const char* what,
                                          const std::vector<std::string>& words) const {
  choice(i, what, words);
  return arguments[i];
}

bool ArgumentReader::on(size_t i) const {
  return choice(i, "switch", {"off", "on"}) == 1;
}

bool ArgumentReader::switched(size_t i, bool now) const {
  const size_t how = i < arguments.size() ? choice(i, "switch", {"off", "on", "toggle"}) : 2;
  return how == 2 ? !now : how == 1;
}

std::optional<float> ArgumentReader::body_height(size_t i) const {
  if (word(i, "height") == "auto") return std::nullopt;
  const auto height = number(i, "height");
  US_CHECK(height >= kBodyHeights.low && height <= kBodyHeights.high, "a height is ", kBodyHeights.low,
           " to ", kBodyHeights.high, " m, not ", height);
  return height;
}

int ArgumentReader::joint(size_t i) const {
  const std::string& text = word(i, "joint");
  if (const int j = joint_named(text); j >= 0) return j;
  const int j = number<int>(i, "joint");
  US_CHECK(j >= 0 && j < kJointCount, "there is no joint ", j);
  return j;
}

Vec3 ArgumentReader::vector(size_t i, const char* what) const {
  return {number(i, what), number(i + 1, what), number(i + 2, what)};
}

std::string ArgumentReader::path(size_t i, const char* what) const {
  return std::filesystem::absolute(word(i, what)).lexically_normal().string();
}

bool ArgumentReader::has(const std::string& wanted, size_t from) const {
  return from < arguments.size() &&
         std::find(arguments.begin() + static_cast<long>(from), arguments.end(), wanted) != arguments.end();
}

size_t Call::take_number(size_t i) const {
  const int k = number<int>(i, "take");
  US_CHECK(k >= 0 && k < ssize(document.takes), "there is no take ", k);
  return k;
}

void add_all_commands(Commands& commands) {
  add_document_commands(commands);
  add_source_commands(commands);
  add_take_commands(commands);
  add_style_commands(commands);
  add_teach_commands(commands);
  add_playback_commands(commands);
  add_view_commands(commands);
  add_edit_commands(commands);
  add_export_commands(commands);
  add_study_commands(commands);
  add_map_commands(commands);
  add_bones_commands(commands);
  add_second_body_commands(commands);
  add_made_motions_commands(commands);
  add_flat_commands(commands);
  add_program_commands(commands);
}

}  // namespace understudy::app
