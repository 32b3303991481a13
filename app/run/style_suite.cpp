#include "app/run/style_suite.hpp"

#include <filesystem>

#include "app/run/interrupt.hpp"
#include "app/run/report.hpp"
#include "app/run/style_teacher.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/file.hpp"
#include "retarget/base/index.hpp"
#include "retarget/base/part_file.hpp"
#include "retarget/base/text.hpp"
#include "retarget/body/clips.hpp"

namespace understudy::app {
namespace {
namespace fs = std::filesystem;

/// The clips of a manner, at most so many of them, evenly.
std::vector<std::string> clips_of(const SuiteOptions& options, const std::string& manner) {
  std::vector<std::string> clips;
  const std::string folder = (fs::path(options.data) / manner).string();
  for (const std::string& path : recordings(folder))
    if (file_suffix(path) == ".npz") clips.push_back(path);
  US_CHECK(!clips.empty(), folder, ": holds no clip (.npz, AMASS-format)");
  const int64_t all = ssize(clips), wanted = options.cases;
  if (wanted == 0 || wanted >= all) return clips;
  std::vector<std::string> some;
  for (int64_t i = 0; i < wanted; ++i) some.push_back(clips[static_cast<size_t>(i * all / wanted)]);
  return some;
}

/// The folder that a clip lies in tells whose it is, where clips are sorted so.
std::string subject_of(const std::string& clip, const SuiteOptions& options, const std::string& manner) {
  const fs::path folder = fs::path(clip).parent_path();
  return folder == fs::path(options.data) / manner ? "" : folder.filename().string();
}

Json contents_of(const std::string& clip) {
  Json contents = Json::array();
  const std::vector<std::string> labels = clip_labels(clip);
  if (!labels.empty()) contents.push_back(lower_case(labels.front()));
  if (const std::string said = lower_case(clip_description(clip)); !said.empty()) contents.push_back(said);
  return contents;
}

void write_case(const SuiteOptions& options, const std::string& name, const std::string& clip,
                const Json& style) {
  const fs::path folder = fs::path(options.out) / name;
  fs::create_directories(folder);
  write_file((folder / "clip.npz").string(), read_file(clip), false);
  const bool real = style["is"] == style["wanted"];
  write_json((folder / "case.json").string(),
             {{"source", "clip.npz"}, {"style", style}, {"tags", {"style", real ? "real" : "source"}}});
}

}  // namespace

int make_style_suite(const SuiteOptions& options, const std::function<void(const std::string&)>& done) {
  US_CHECK(!options.from.empty() && !options.to.empty() && options.from != options.to,
           "the suite style needs --from and --to: two folders of clips in the data folder");
  int count = 0;
  for (const std::string& manner : {options.from, options.to})
    for (const std::string& clip : clips_of(options, manner)) {
      const std::string name = manner + "_" + fs::path(clip).stem().string();
      check_interrupt("before case " + name);
      write_case(options, name, clip,
                 {{"is", manner},
                  {"wanted", options.to},
                  {"contents", contents_of(clip)},
                  {"subject", subject_of(clip, options, manner)}});
      done(name);
      ++count;
    }
  return count;
}

}  // namespace understudy::app
