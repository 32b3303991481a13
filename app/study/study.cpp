#include "app/study/study.hpp"

#include <algorithm>
#include <filesystem>
#include <set>

#include "retarget/base/error.hpp"
#include "retarget/base/part_file.hpp"
#include "retarget/base/text.hpp"
#include "retarget/pipeline/method_table.hpp"

namespace understudy::app {
namespace fs = std::filesystem;
namespace {

constexpr JsonFileKind kKind{"understudy study", "an Understudy study", "studies", kStudyVersion};

std::string quoted(const char* what, const std::string& name) {
  return std::string(what) + " '" + name + "'";
}

bool is_plain(const std::string& text) {
  return std::none_of(text.begin(), text.end(), [](char c) { return c >= 0 && c < ' '; });
}

/// Throws Error unless there are any, all have names, and no two the same.
template <class Named>
void check_names(const std::vector<Named>& all, const char* what) {
  US_CHECK(!all.empty(), "the study has no ", what);
  std::set<std::string> names;
  for (const Named& one : all) {
    US_CHECK(!one.name.empty(), "a ", what, " has no name");
    US_CHECK(is_plain(one.name), quoted(what, excerpt(one.name)),
             " has a line end or another control character");
    US_CHECK(names.insert(one.name).second, "there are two of ", quoted(what, one.name));
  }
}

template <class Named>
bool is_named(const std::vector<Named>& all, const std::string& name) {
  return std::any_of(all.begin(), all.end(), [&](const Named& one) { return one.name == name; });
}

void check_condition(const Condition& condition, const Study& study) {
  const std::string name = quoted("condition", condition.name);
  if (condition.kind == ConditionKind::Method) {
    US_CHECK(condition.files.empty(), name, " is a method: it has no files");
    const std::string problem = failure_of([&] {
      engine_named(condition.method.engine);
      extractor_named(condition.method.extractor);
    });
    US_CHECK(problem.empty(), name, ": ", problem);
    return;
  }
  for (const StimulusFile& file : condition.files) {
    US_CHECK(!file.path.empty(), name, " has a file without a path");
    US_CHECK(file.motion.empty() || is_named(study.motions, file.motion), name, " has a file for ",
             quoted("motion", file.motion), ", which the study does not have");
    US_CHECK(file.target.empty() || is_named(study.targets, file.target), name, " has a file for ",
             quoted("target", file.target), ", which the study does not have");
  }
  for (const StudyMotion& motion : study.motions)
    for (const StudyTarget& target : study.targets)
      US_CHECK(file_for(condition, motion, target) != nullptr, name, " has no file for ",
               quoted("motion", motion.name), " on ", quoted("target", target.name));
}

void check_question(const StudyQuestion& question, const Study& study) {
  const std::string name = quoted("question", question.name);
  US_CHECK(!question.text.empty(), name, " has no text");
  if (question.kind == QuestionKind::Likert) {
    US_CHECK(!question.low.empty() && !question.high.empty(), name,
             " needs a label at both ends of its scale");
    US_CHECK(question.options.empty(), name, " has a scale: it has no options");
    return;
  }
  const std::vector<std::string>& options = question.options;
  US_CHECK(options.size() >= 2, name, " needs at least two options");
  US_CHECK(std::set<std::string>(options.begin(), options.end()).size() == options.size(), name,
           " has an option twice");
  US_CHECK(std::all_of(options.begin(), options.end(), is_plain), name,
           " has an option with a line end or another control character");
  if (question.kind != QuestionKind::Attention) return;
  for (const StudyMotion& motion : study.motions) {
    const std::string& right = right_answer(question, motion);
    US_CHECK(std::find(options.begin(), options.end(), right) != options.end(), name, ": the right answer '",
             right, "' is not among its options");
  }
}

void check_layout(const StudyLayout& layout) {
  const std::set<StudyPane> panes(layout.panes.begin(), layout.panes.end());
  US_CHECK(panes.size() == layout.panes.size(), "the layout has a pane twice");
  US_CHECK(panes.count(StudyPane::Result) > 0, "the layout has no pane of the result");
}

void check_size(const Study& study) {
  constexpr double kMost = 100000;
  const double conditions = static_cast<double>(study.conditions.size());
  const double shown =
      study.layout.results == TrialResults::Pair ? conditions * (conditions - 1) / 2 : conditions;
  const double trials = shown * static_cast<double>(study.motions.size()) *
                        static_cast<double>(study.targets.size()) * study.plan.repetitions;
  US_CHECK(trials <= kMost, "the study has ", printed("%.0f", trials),
           " trials, 100000 at most are possible");
}

bool is_there(const std::string& path) {
  std::error_code ignored;
  return fs::exists(path, ignored);
}

/// As check(), the sentence begins with the path.
void check_at(const std::string& path, const Study& study) {
  const std::string problem = failure_of([&] { check(study); });
  US_CHECK(problem.empty(), path, ": ", problem);
}

void check_there(const std::string& who, const std::string& path) {
  US_CHECK(path.empty() || is_there(path), who, ": ", path, " is gone");
}

}  // namespace

const std::string& right_answer(const StudyQuestion& question, const StudyMotion& motion) {
  static const std::string none;
  if (question.kind != QuestionKind::Attention) return none;
  return question.right.empty() ? action_of(motion) : question.right;
}

const StimulusFile* file_for(const Condition& condition, const StudyMotion& motion,
                             const StudyTarget& target) {
  const StimulusFile* found = nullptr;
  for (const StimulusFile& file : condition.files) {
    const bool fits = (file.motion.empty() || file.motion == motion.name) &&
                      (file.target.empty() || file.target == target.name);
    const bool is_closer = found == nullptr || file.motion.empty() + file.target.empty() <
                                                   found->motion.empty() + found->target.empty();
    if (fits && is_closer) found = &file;  // one that is named wins over one for all
  }
  return found;
}

void check(const Study& study) {
  check_names(study.conditions, "condition");
  US_CHECK(study.conditions.size() >= 2, "the study has one condition: it needs two to compare");
  check_names(study.motions, "motion");
  check_names(study.targets, "target");
  check_names(study.questions, "question");
  for (const StudyMotion& motion : study.motions)
    US_CHECK(!motion.source.path.empty(), quoted("motion", motion.name), " has no source");
  for (const StudyTarget& target : study.targets)
    US_CHECK(!target.target.path.empty(), quoted("target", target.name), " has no file");
  for (const Condition& condition : study.conditions) check_condition(condition, study);
  for (const StudyQuestion& question : study.questions) check_question(question, study);
  check_layout(study.layout);
  check_size(study);
  const Vec3& colour = study.picture.background;
  US_CHECK(colour.minCoeff() >= 0 && colour.maxCoeff() <= 1,
           "picture.background must be three numbers from 0 to 1");
}

void check_files(const Study& study) {
  for (const Condition& condition : study.conditions)
    if (condition.kind != ConditionKind::Method)
      for (const StimulusFile& file : condition.files)
        check_there(quoted("condition", condition.name), file.path);
  for (const StudyMotion& motion : study.motions) {
    check_there(quoted("motion", motion.name), motion.source.path);
    check_there(quoted("motion", motion.name), motion.source.motion);
    if (motion.source.blend)
      for (const BlendPart& part : motion.source.blend->parts)
        check_there(quoted("motion", motion.name), part.path);
  }
  for (const StudyTarget& target : study.targets)
    check_there(quoted("target", target.name), target.target.path);
}

Json to_json(const Study& study, const std::string& folder) {
  Json json{{"format", kKind.format}, {"version", kKind.version}};
  FieldsWriter writer(json, folder, "");
  fields(writer, study);
  return json;
}

Study draft_from_json(const Json& json, const std::string& folder, const std::string& path) {
  check_kind(json, path, kKind);
  FieldsReader reader(json, folder, path + ": ", UnknownMembers::Refused);
  reader.know("format");
  reader.know("version");
  Study study;
  fields(reader, study);
  reader.finish();
  return study;
}

Study study_from_json(const Json& json, const std::string& folder, const std::string& path) {
  Study study = draft_from_json(json, folder, path);
  check_at(path, study);
  return study;
}

void write_draft(const std::string& path, const Study& study) {
  write_file(path, json_text(to_json(study, folder_of_file(path))));
}

void write_study(const std::string& path, const Study& study) {
  check_at(path, study);
  write_draft(path, study);
}

Study read_draft(const std::string& path) {
  return draft_from_json(read_json(path), folder_of_file(path), path);
}

Study read_study(const std::string& path) {
  const std::string folder = folder_of_file(path);
  return study_from_json(read_json(path), folder, path);
}

}  // namespace understudy::app
