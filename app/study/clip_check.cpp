#include "app/study/clip_check.hpp"

#include <algorithm>
#include <filesystem>

#include "retarget/base/checksum.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/text.hpp"

namespace understudy::app {
namespace {

namespace fs = std::filesystem;

/// The parts of a study that its clips show and that are not as they were in a digest, in words.
std::string changes_of_clips(const Json& before, const Json& now) {
  std::string changes;
  for (const auto& [name, checksum] : now.items()) {
    const bool is_shown = name != "plan" && !starts_with(name, "question ");
    if (is_shown && (!before.contains(name) || before[name] != checksum)) append_item(changes, name);
  }
  return changes;
}

/// Each file as long and of the sum that the manifest says; one that it does not name is somebody's own.
void check_whole(const std::vector<std::string>& clips, const Json& manifest, const std::string& folder,
                 const std::string& advice) {
  for (const Json& made : manifest["clips"]) {
    const std::string file = made.value("file", ""), sum = made.value("checksum", "");
    if (std::find(clips.begin(), clips.end(), file) == clips.end()) continue;
    US_CHECK(checksum_of_file(folder + "/" + file) == sum, folder, "/", file, " is damaged", advice);
  }
}

}  // namespace

void check_clips(const std::vector<std::string>& clips, const Study& study, const std::string& path,
                 const std::string& folder) {
  const std::string advice = ": make the clips with understudy study stimuli " + path + " --out " + folder;
  for (const std::string& clip : clips) {
    std::error_code failed;
    const uintmax_t size = fs::file_size(folder + "/" + clip, failed);
    US_CHECK(!failed && size > 0, folder, "/", clip, failed ? " is missing" : " is empty", advice);
  }
  const std::string manifest = folder + "/manifest.json";
  if (std::error_code ignored; !fs::exists(manifest, ignored)) return;
  const Json made = read_json(manifest);
  const bool is_manifest = made.is_object() && made.contains("design") && made["design"].is_object() &&
                           made.contains("clips") && made["clips"].is_array();
  US_CHECK(is_manifest, manifest, ": is not of clips", advice);
  const std::string changes =
      changes_of_clips(made["design"], Json::parse(digest_of(study, folder_of_file(path))));
  US_CHECK(changes.empty(), folder, " has clips of the study before it was changed (", changes, ")", advice);
  check_whole(clips, made, folder, advice);
}

}  // namespace understudy::app
