#include "app/session/study_edits.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>

#include "retarget/base/error.hpp"
#include "retarget/base/text.hpp"
#include "retarget/motion_space/blend.hpp"
#include "retarget/pipeline/method_table.hpp"

namespace understudy::app {
namespace {

bool is_index(const std::string& word) {
  return !word.empty() &&
         std::all_of(word.begin(), word.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
}

std::string without_indices(const std::string& name) {
  std::string bare;
  for (const std::string& word : split(name, '.'))
    if (!is_index(word)) append_item(bare, word, ".");
  return bare;
}

/// A name that nobody in the list has: "walk", then "walk 2".
template <class Item>
std::string free_name(const std::vector<Item>& items, const std::string& wanted) {
  const auto is_taken = [&](const std::string& name) {
    return std::any_of(items.begin(), items.end(), [&](const Item& one) { return one.name == name; });
  };
  std::string name = wanted.empty() ? "unnamed" : wanted;
  for (int n = 2; is_taken(name); ++n) name = wanted + " " + std::to_string(n);
  return name;
}

std::string stem(const std::string& path) {
  return std::filesystem::path(path).stem().string();
}

Json number_in(const std::string& name, const std::string& text) {
  double value = 0;
  US_CHECK(parse_number(text, value), "study: ", name, " is a number, not '", text, "'");
  return value;
}

/// The words as the setting's JSON is now; a setting that is not there yet is a number.
Json value_like(const Json* now, const std::string& name, const std::vector<std::string>& words) {
  const bool is_list = now != nullptr && now->is_array();
  if (is_list) {
    const bool are_numbers = !now->empty() ? now->front().is_number() : ends_with(name, "betas");
    Json list = Json::array();
    for (const std::string& word : words) list.push_back(are_numbers ? number_in(name, word) : Json(word));
    return list;
  }
  US_CHECK(words.size() == 1, "study: ", name, " has one value, not ", words.size());
  const std::string& word = words.front();
  if (now == nullptr) return number_in(name, word);
  if (now->is_string()) return word;
  if (now->is_number()) return number_in(name, word);
  US_CHECK(now->is_boolean(), "study: ", name, " is a group of settings");
  US_CHECK(word == "on" || word == "off", "study: ", name, " is on or off, not '", word, "'");
  return word == "on";
}

/// The object or list that the setting is in; `last` becomes its name or place there.
Json& holder_of(Json& json, const std::string& name, std::string& last) {
  const std::vector<std::string> words = split(name, '.');
  US_CHECK(!words.empty(), "a setting is missing");
  Json* at = &json;
  for (size_t i = 0; i + 1 < words.size(); ++i) {
    int64_t index = -1;
    if (at->is_array() && parse_integer(words[i], index) && index >= 0 &&
        index < static_cast<int64_t>(at->size()))
      at = &(*at)[static_cast<size_t>(index)];
    else if (at->is_object() && at->contains(words[i]))
      at = &(*at)[words[i]];
    else
      throw Error("the study has no '" + name + "'");
  }
  last = words.back();
  US_CHECK(at->is_object(), "the study has no '", name, "'");
  return *at;
}

template <class Item>
void rename_in_files(Study& study, const std::vector<Item>& before, const std::vector<Item>& now,
                     std::string StimulusFile::*name) {
  for (size_t i = 0; i < std::min(before.size(), now.size()); ++i) {
    if (before[i].name == now[i].name) continue;
    for (Condition& condition : study.conditions)
      for (StimulusFile& file : condition.files)
        if (file.*name == before[i].name) file.*name = now[i].name;
  }
}

void drop_files_of(Study& study, std::string StimulusFile::*name, const std::string& gone) {
  for (Condition& condition : study.conditions) {
    auto& files = condition.files;
    files.erase(std::remove_if(files.begin(), files.end(),
                               [&](const StimulusFile& file) { return file.*name == gone; }),
                files.end());
  }
}

/// Calls `act` with the list of that name. Throws Error for another name.
template <class Act>
void with_list(Study& study, const std::string& list, const Act& act) {
  if (list == "condition") return act(study.conditions);
  if (list == "motion") return act(study.motions);
  if (list == "target") return act(study.targets);
  US_CHECK(list == "question", "a list is condition, motion, target or question, not '", list, "'");
  act(study.questions);
}

template <class Item>
void check_item(const std::vector<Item>& items, const std::string& list, size_t i) {
  US_CHECK(i < items.size(), "there is no ", list, " ", i, " in the study");
}

}  // namespace

const std::vector<StudyField>& study_fields() {
  static const std::vector<StudyField> all = {
      {"name", "Name", "Of the study"},
      {"note", "Note", "For those who run the study; participants never see it"},
      {"consent", "Consent", "What participants agree to before they begin; empty: nothing"},
      {"conditions.name", "Name", "In answers and reports; participants never see it"},
      {"conditions.kind", "Results", "Where the results of this condition come from"},
      {"conditions.method.engine", "Transfer", "The method that transfers the motion to the target"},
      {"conditions.method.extractor", "Extractor", "The network that finds the joints in a scan"},
      {"conditions.method.offsets", "Offsets", kOffsetsExplanation},
      {"conditions.method.path", "Path", kPathExplanation},
      {"conditions.files.path", "File", "The animation that is shown"},
      {"conditions.files.motion", "Motion", "The motion that this animation is of"},
      {"conditions.files.target", "Target", "The target that performs in this animation"},
      {"motions.name", "Name", "In answers and reports; participants never see it"},
      {"motions.action", "Action", "The right answer to \"Which action is this?\"; empty: the name"},
      {"motions.from_s", "From", "Where the clip starts in the source"},
      {"motions.seconds", "Length, s", "At speed 1; auto: to the end of the source"},
      {"targets.name", "Name", "In answers and reports; participants never see it"},
      {"targets.target.import.height_m", "Height", "Height in metres; auto: as the file has it"},
      {"questions.name", "Name", "In answers and reports; participants never see it"},
      {"questions.kind", "Answer", "What participants choose from"},
      {"questions.text", "Question", "What participants are asked"},
      {"questions.points", "Points", "Of the scale: answers are 1 to this number"},
      {"questions.low", "Left end", "Words at the first point of the scale"},
      {"questions.high", "Right end", "Words at the last point of the scale"},
      {"questions.options", "Options", "What participants choose from, with | between them"},
      {"questions.right", "Right answer", "Who gives it too rarely is excluded"},
      {"questions.every", "In one trial of", "1: asked in every trial; more: in one of so many, by chance"},
      {"layout.panes", "Panes", "What a clip shows, left to right"},
      {"layout.results", "Results", "How many results a trial shows"},
      {"layout.labels", "Labels", "Writes what each pane is over it; conditions are never named"},
      {"clip.seconds", "Length", "Of each clip: a shorter motion is repeated, a longer one is cut"},
      {"clip.card", "Card", "Words that are shown between two runs of a motion"},
      {"clip.card_s", "Card for", "How long the card is shown; 0: no card"},
      {"clip.speed", "Speed", "0.5: half as fast"},
      {"picture.width", "Width", "Of the clips, pixels"},
      {"picture.height", "Height", "Of the clips, pixels"},
      {"picture.fps", "Frames/s", "Of the clips"},
      {"picture.yaw_deg", "Camera turn", "About the vertical; 0: from the front"},
      {"picture.pitch_deg", "Camera height", "Above the horizon"},
      {"picture.fov_deg", "Field of view",
       "Upright angle of the picture; the distance follows from the motion"},
      {"picture.margin", "Margin", "Share of a pane that is left free on each side"},
      {"picture.light_turn_deg", "Light turn", "Turns the main light about the vertical"},
      {"picture.light_height_deg", "Light height", "Raises or lowers the main light"},
      {"picture.brightness", "Brightness", "Of all light"},
      {"picture.background", "Background", "Behind everything"},
      {"plan.repetitions", "Repetitions", "How often each trial is shown to a participant"},
      {"plan.trials_per_participant", "Trials each", "0: all; fewer: a balanced subset for each participant"},
      {"plan.order", "Order", "In which order a participant sees the trials"},
      {"plan.practice", "Practice", "Trials before the others that do not count"},
      {"plan.break_every", "Break after", "Trials between two breaks; 0: no breaks"},
      {"plan.seed", "Seed", "Of all that is decided by chance: the same seed gives the same orders"},
      {"plan.participants", "Participants", "How many are to be asked"},
      {"plan.least_right", "Least right, %", "Who has fewer attention questions right is excluded"},
      {"plan.must_exceed", "Must exceed", "Excludes also who has exactly this share right"}};
  return all;
}

const StudyField* study_field(const std::string& name) {
  const std::string bare = without_indices(name);
  const auto& all = study_fields();
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const StudyField& field) { return bare == field.name; });
  return found == all.end() ? nullptr : &*found;
}

Study with_value(const Study& study, const std::string& name, const std::vector<std::string>& values) {
  Json json = to_json(study, "");
  std::string last;
  Json& holder = holder_of(json, name, last);
  const bool is_optional = last == "seconds" || last == "height_m" || last == "floor_m";
  const auto now = holder.find(last);
  if (is_optional && values == std::vector<std::string>{"none"} && !starts_with(name, "clip."))
    holder.erase(last);
  else
    holder[last] = value_like(now == holder.end() ? nullptr : &*now, name, values);
  Study changed = draft_from_json(json, "", "study");
  rename_in_files(changed, study.motions, changed.motions, &StimulusFile::motion);
  rename_in_files(changed, study.targets, changed.targets, &StimulusFile::target);
  return changed;
}

void remove_item(Study& study, const std::string& list, size_t i) {
  with_list(study, list, [&](auto& items) {
    check_item(items, list, i);
    const std::string gone = items[i].name;
    items.erase(items.begin() + static_cast<std::ptrdiff_t>(i));
    if (list == "motion") drop_files_of(study, &StimulusFile::motion, gone);
    if (list == "target") drop_files_of(study, &StimulusFile::target, gone);
  });
}

void move_item(Study& study, const std::string& list, size_t from, size_t to) {
  with_list(study, list, [&](auto& items) {
    check_item(items, list, from);
    check_item(items, list, to);
    auto item = std::move(items[from]);
    items.erase(items.begin() + static_cast<std::ptrdiff_t>(from));
    items.insert(items.begin() + static_cast<std::ptrdiff_t>(to), std::move(item));
  });
}

void copy_item(Study& study, const std::string& list, size_t i) {
  with_list(study, list, [&](auto& items) {
    check_item(items, list, i);
    auto item = items[i];
    item.name = free_name(items, item.name);
    items.insert(items.begin() + static_cast<std::ptrdiff_t>(i) + 1, std::move(item));
  });
}

void add_conditions_of_takes(Study& study, const Document& document) {
  auto& all = study.conditions;
  for (const Take& take : document.takes) {
    const auto is_it = [&](const Condition& one) {
      return one.kind == ConditionKind::Method && same(one.method, take.method);
    };
    if (std::any_of(all.begin(), all.end(), is_it)) continue;
    Condition condition;
    condition.name = free_name(all, method_in_words(take.method));
    condition.method = take.method;
    all.push_back(std::move(condition));
  }
}

void add_targets_of_takes(Study& study, const Document& document) {
  auto& all = study.targets;
  for (const Take& take : document.takes) {
    const auto is_it = [&](const StudyTarget& one) { return same(one.target, take.target); };
    if (std::none_of(all.begin(), all.end(), is_it))
      all.push_back({free_name(all, stem(take.target.path)), take.target});
  }
}

void add_motion_of_source(Study& study, const Session& session) {
  const Document& document = session.document;
  US_CHECK(!document.source.path.empty(), "no source is open");
  StudyMotion motion;
  motion.source = document.source;
  motion.edits = document.scan_edits;
  motion.name = free_name(study.motions, stem(name_of(document.source)));
  const Playback& playback = session.playback;
  const double fps = session.source.fps > 0 ? session.source.fps : 30;
  if (playback.in > 0) motion.from_s = static_cast<float>(playback.in / fps);
  if (playback.out >= 0)
    motion.seconds = static_cast<float>((playback.out + 1 - std::max(0, playback.in)) / fps);
  const auto is_it = [&](const StudyMotion& one) {
    return same(one.source, motion.source) && same(one.edits, motion.edits) && one.from_s == motion.from_s &&
           one.seconds == motion.seconds;
  };
  if (std::none_of(study.motions.begin(), study.motions.end(), is_it)) study.motions.push_back(motion);
}

void add_blends(Study& study, const Session& session, int steps) {
  const SourceOptions& open = session.document.source;
  US_CHECK(open.blend, "the source is no blend of motions");
  US_CHECK(steps >= 2 && steps <= 100, "a line of blends has 2 to 100 steps, not ", steps);
  for (const auto& weights : weights_along(open.blend->parts.size(), steps)) {
    StudyMotion motion;
    motion.source = open;
    set_weights(weights, *motion.source.blend);
    std::string shares;
    for (const float weight : weights) append_item(shares, printed("%.2f", static_cast<double>(weight)), " ");
    motion.name = free_name(study.motions, name_of(open) + " " + shares);
    study.motions.push_back(std::move(motion));
  }
}

Study study_of_takes(const Session& session) {
  Study study;
  study.name = "Untitled study";
  add_conditions_of_takes(study, session.document);
  add_targets_of_takes(study, session.document);
  if (!session.document.source.path.empty()) add_motion_of_source(study, session);
  return study;
}

void add_condition_of_files(Study& study, const std::vector<std::string>& paths) {
  US_CHECK(!paths.empty(), "a path is missing");
  Condition condition;
  condition.kind = ConditionKind::Files;
  condition.name = free_name(study.conditions, stem(paths.front()));
  const bool each = paths.size() > 1 && paths.size() == study.motions.size();
  for (size_t i = 0; i < paths.size(); ++i)
    condition.files.push_back({each ? study.motions[i].name : "", "", paths[i]});
  study.conditions.push_back(std::move(condition));
}

void add_motion_of_file(Study& study, const std::string& path) {
  StudyMotion motion;
  motion.name = free_name(study.motions, stem(path));
  motion.source.path = path;
  study.motions.push_back(std::move(motion));
}

void add_target_of_file(Study& study, const std::string& path) {
  StudyTarget target;
  target.name = free_name(study.targets, stem(path));
  target.target.path = path;
  study.targets.push_back(std::move(target));
}

void add_question(Study& study, QuestionKind kind) {
  StudyQuestion question;
  question.kind = kind;
  if (kind == QuestionKind::Likert) {
    question.name = "naturalness";
    question.text = "How natural is the motion?";
    question.low = "Not natural at all", question.high = "Very natural";
  } else if (kind == QuestionKind::Choice) {
    question.name = "choice";
    question.text = "Does this motion belong to a child or an adult?";
    question.options = {"Adult", "Child"};
  } else {
    question.name = "action";
    question.text = "What is the action being performed?";
    for (const StudyMotion& motion : study.motions) {
      const std::string& action = action_of(motion);
      auto& options = question.options;
      if (std::find(options.begin(), options.end(), action) == options.end()) options.push_back(action);
    }
    question.options.push_back("None of these");
  }
  question.name = free_name(study.questions, question.name);
  study.questions.push_back(std::move(question));
}

void see_as_in_view(Study& study, const View& view) {
  constexpr float kDegrees = 57.29578f;
  const CameraState& camera = active_camera(view);
  StudyPicture& picture = study.picture;
  picture.yaw_deg = std::round(std::remainder(camera.yaw * kDegrees, 360.f) * 10) / 10;
  picture.pitch_deg = std::clamp(std::round(camera.pitch * kDegrees * 10) / 10, -89.f, 89.f);
  picture.fov_deg = std::clamp(std::round(camera.fov * kDegrees * 10) / 10, 5.f, 120.f);
  picture.light_turn_deg = view.light.turn_deg, picture.light_height_deg = view.light.height_deg;
  picture.brightness = std::max(0.05f, view.light.brightness);
}

std::string method_in_words(const Method& method) {
  const Method usual;
  const int engine = index_of(engines(), method.engine);
  std::string words = engine < 0 ? method.engine : engines()[static_cast<size_t>(engine)].label;
  if (method.extractor != usual.extractor) append_item(words, method.extractor + " extractor");
  if (!method.offsets) append_item(words, "no offsets");
  if (method.path != usual.path)
    append_item(words, std::string("path ") + kRootNames[static_cast<size_t>(method.path)]);
  for (const MethodSwitch& one : kSwitches)
    if (method.*one.on != usual.*one.on) append_item(words, "no " + lower_case(one.label));
  if (method.predict) append_item(words, "predicted gaps");
  for (const Proportion& one : kProportions)
    if (method.*one.value != usual.*one.value)
      append_item(words, lower_case(one.label) + " " + printed("%g", static_cast<double>(method.*one.value)));
  return words;
}

}  // namespace understudy::app
