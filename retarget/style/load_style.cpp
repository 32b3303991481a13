#include "retarget/style/load_style.hpp"

#include <algorithm>
#include <filesystem>

#include "retarget/base/error.hpp"
#include "retarget/base/log.hpp"
#include "retarget/base/program_files.hpp"
#include "retarget/base/text.hpp"
#include "retarget/style/skeleton_style.hpp"

namespace understudy {
namespace fs = std::filesystem;

std::vector<MannerFile> styles_in(const std::string& folder) {
  std::vector<MannerFile> styles;
  std::error_code failed;
  if (folder.empty()) return styles;
  for (const auto& entry : fs::directory_iterator(folder, failed)) {
    if (entry.path().extension() != ".json") continue;
    const std::string problem = failure_of([&] { styles.push_back(read_manner(entry.path().string())); });
    if (!problem.empty()) log::warn_once(problem);
  }
  std::sort(styles.begin(), styles.end(),
            [](const auto& a, const auto& b) { return a.note.name < b.note.name; });
  return styles;
}

std::vector<MannerFile> bundled_styles() {
  return styles_in(program_files("styles").string());
}

std::string style_file(const StyleChoice& choice) {
  std::error_code failed;
  if (!choice.file.empty()) {
    US_CHECK(fs::exists(choice.file, failed), choice.file, ": there is no such file");
    return choice.file;
  }
  const fs::path bundled = program_files("styles") / (choice.name + ".json");
  if (fs::exists(bundled, failed)) return bundled.string();
  std::string names;
  for (const MannerFile& one : bundled_styles()) append_item(names, one.note.name);
  throw Error("there is no style '" + choice.name + "': " +
              (names.empty() ? "none comes with the program" : names) + ", or the path of a style's file");
}

bool is_words_file(const std::string& path) {
  return file_suffix(path) == ".weights";
}

std::shared_ptr<MotionStyle> load_style(const StyleChoice& choice) {
  if (!choice.any()) return nullptr;
  const MannerFile file = read_manner(style_file(choice));
  auto style = std::make_shared<SkeletonStyle>(
      std::make_unique<MannerStyle>(file.manner, choice.posture, choice.size, choice.liveliness),
      choice.strength);
  style->set_rights(file.note.rights());
  return style;
}

}  // namespace understudy
