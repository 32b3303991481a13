#include "app/session/taught_styles.hpp"

#include <algorithm>
#include <filesystem>

#include "retarget/base/text.hpp"
#include "retarget/style/load_style.hpp"

namespace understudy::app {
namespace fs = std::filesystem;
namespace {

constexpr size_t kLongestName = 60;

/// Letters beyond A to Z are bytes from 128 on.
bool is_of_style_name(char c) {
  const bool is_letter =
      (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || static_cast<unsigned char>(c) > 127;
  return is_letter || (c >= '0' && c <= '9') || c == ' ' || c == '-' || c == '_';
}

}  // namespace

const TaughtStyle* taught_style(const StylesState& styles, const std::string& name_or_file) {
  for (const TaughtStyle& style : styles.taught)
    if (style.note.name == name_or_file || style.file == name_or_file) return &style;
  return nullptr;
}

std::string styles_folder(const std::string& settings_file) {
  if (settings_file.empty()) return "";
  return (fs::absolute(settings_file).lexically_normal().parent_path() / "styles").string();
}

std::vector<TaughtStyle> taught_styles(const std::string& folder) {
  std::vector<TaughtStyle> taught;
  for (const MannerFile& style : styles_in(folder))
    taught.push_back({style.note, (fs::path(folder) / (style.note.name + ".json")).string()});
  return taught;
}

std::string why_no_style_name(const std::string& name) {
  if (name.empty()) return "a style needs a name";
  if (name.size() > kLongestName)
    return "a style's name has at most " + std::to_string(kLongestName) + " letters";
  const bool plain = std::all_of(name.begin(), name.end(), is_of_style_name);
  if (!plain || name.front() == ' ' || name.back() == ' ')
    return "a style's name has letters, digits, -, _ and blanks between them, '" + excerpt(name) +
           "' does not fit";
  for (const MannerFile& style : bundled_styles())
    if (lower_case(name) == lower_case(style.note.name) || lower_case(name) == lower_case(style.note.label))
      return "'" + style.note.label + "' is the name of a style that comes with the program";
  return "";
}

}  // namespace understudy::app
