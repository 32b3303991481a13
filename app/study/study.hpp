// A perceptual study: what is shown to whom, and what they are asked. On disk: .study, one JSON file with
// paths relative to it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/run/fields_json.hpp"
#include "app/run/method.hpp"
#include "app/run/source.hpp"
#include "app/run/target_file.hpp"
#include "retarget/base/fields.hpp"

namespace understudy::app {

constexpr int kStudyVersion = 1;

/// What participants read first, unless the study says something else.
constexpr const char* kConsent =
    "You will see short clips of computer-animated people and answer questions about them.\n"
    "Taking part is voluntary: you may stop at any time, without giving a reason.\n"
    "Recorded are your answers, how long each took, and how often you played a clip again, under the "
    "participant name that you were given. They stay on this computer until the file of answers is handed "
    "over.";

/// An animation that somebody else made for a condition.
struct StimulusFile {
  std::string motion, target;  ///< names; empty: of all of them
  std::string path;            ///< an animated file, or the truth.npz of a case
};
template <class V, class S>
FieldsOf<S, StimulusFile> fields(V& visit, S& file) {
  visit("motion", file.motion);
  visit("target", file.target);
  visit("path", file.path, FilePath{});
}

/// Where the results of a condition come from.
enum class ConditionKind {
  Method,      ///< the program retargets
  Files,       ///< imported animations
  GroundTruth  ///< the same, and known to be right
};
constexpr Names<3> kConditionKindNames{"method", "files", "ground-truth"};

struct Condition {
  std::string name;  ///< in answers and reports; participants never see it unless labels are shown
  ConditionKind kind = ConditionKind::Method;
  Method method;                    ///< of Method
  std::vector<StimulusFile> files;  ///< of the other kinds: one for each motion and target
};
template <class V, class S>
FieldsOf<S, Condition> fields(V& visit, S& condition) {
  visit("name", condition.name);
  visit("kind", condition.kind, kConditionKindNames);
  visit("method", condition.method);
  visit("files", condition.files);
}

struct StudyMotion {
  std::string name;
  std::string action;  ///< the right answer to "Which action is this?"; empty: the name
  SourceOptions source;
  ScanEdits edits;
  float from_s = 0;                ///< where the clip starts in the source
  std::optional<float> seconds{};  ///< how long it is, at speed 1; none: to the end
};
template <class V, class S>
FieldsOf<S, StudyMotion> fields(V& visit, S& motion) {
  visit("name", motion.name);
  visit("action", motion.action);
  visit("source", motion.source);
  visit("edits", motion.edits);
  visit("from_s", motion.from_s, Within<float>{0, 1e5f});
  visit("seconds", motion.seconds, Within<float>{0.1f, 1e5f});
}
inline const std::string& action_of(const StudyMotion& motion) {
  return motion.action.empty() ? motion.name : motion.action;
}

struct StudyTarget {
  std::string name;
  TargetOptions target;
};
template <class V, class S>
FieldsOf<S, StudyTarget> fields(V& visit, S& target) {
  visit("name", target.name);
  visit("target", target.target);
}

enum class QuestionKind {
  Likert,    ///< a point of a scale
  Choice,    ///< one of the options
  Attention  ///< the same, and one of them is right
};
constexpr Names<3> kQuestionKindNames{"likert", "choice", "attention"};

struct StudyQuestion {
  std::string name;  ///< in answers and reports
  QuestionKind kind = QuestionKind::Likert;
  std::string text;
  int points = 7;         ///< of Likert: answers are 1 .. points
  std::string low, high;  ///< of Likert: labels of the ends
  std::vector<std::string>
      options;        ///< of Choice (two of them: a two-alternative forced choice) and Attention
  std::string right;  ///< of Attention: the right option; empty: the motion's action
  int every = 1;      ///< asked in one of so many trials, at a place that cannot be foreseen
};
template <class V, class S>
FieldsOf<S, StudyQuestion> fields(V& visit, S& question) {
  visit("name", question.name);
  visit("kind", question.kind, kQuestionKindNames);
  visit("text", question.text);
  visit("points", question.points, Within<int>{2, 11});
  visit("low", question.low);
  visit("high", question.high);
  visit("options", question.options);
  visit("right", question.right);
  visit("every", question.every, Within<int>{1, 1000});
}
/// The right answer in a trial with this motion; empty where none is.
const std::string& right_answer(const StudyQuestion& question, const StudyMotion& motion);

enum class StudyPane { Source, Target, Result };
constexpr Names<3> kStudyPaneNames{"source", "target", "result"};

/// How many results a trial shows.
enum class TrialResults {
  One,  ///< of one condition
  Pair  ///< of two, side by side; each pair of conditions is a trial
};
constexpr Names<2> kTrialResultsNames{"one", "pair"};

struct StudyLayout {
  std::vector<StudyPane> panes = {StudyPane::Source, StudyPane::Target,
                                  StudyPane::Result};  ///< left to right
  TrialResults results = TrialResults::One;
  bool labels = false;  ///< "Source", "Target" and "Result" over the panes; conditions are never named
};
template <class V, class S>
FieldsOf<S, StudyLayout> fields(V& visit, S& layout) {
  visit("panes", layout.panes, kStudyPaneNames);
  visit("results", layout.results, kTrialResultsNames);
  visit("labels", layout.labels);
}

/// The same camera and light for all clips. The distance follows from the motion: all of it is in the
/// picture.
struct StudyPicture {
  int width = 1280, height = 720, fps = 30;
  float yaw_deg = 32, pitch_deg = 10, fov_deg = 28;
  float margin = 0.05f;  ///< share of a pane left free on each side
  float light_turn_deg = 0, light_height_deg = 0, brightness = 1;
  Vec3 background = Vec3::Constant(0.93f);  ///< red, green, blue, 0 .. 1
};
template <class V, class S>
FieldsOf<S, StudyPicture> fields(V& visit, S& picture) {
  visit("width", picture.width, Within<int>{64, 7680});
  visit("height", picture.height, Within<int>{64, 4320});
  visit("fps", picture.fps, Within<int>{1, 240});
  visit("yaw_deg", picture.yaw_deg, Within<float>{-360, 360});
  visit("pitch_deg", picture.pitch_deg, Within<float>{-89, 89});
  visit("fov_deg", picture.fov_deg, Within<float>{5, 120});
  visit("margin", picture.margin, Within<float>{0, 0.4f});
  visit("light_turn_deg", picture.light_turn_deg, Within<float>{-360, 360});
  visit("light_height_deg", picture.light_height_deg, Within<float>{-90, 90});
  visit("brightness", picture.brightness, Within<float>{0.05f, 5});
  visit("background", picture.background);
}

struct StudyClip {
  float seconds = 10;           ///< of each clip; a shorter motion is repeated, a longer one cut
  std::string card = "Repeat";  ///< shown between two runs of a motion
  float card_s = 1;             ///< how long; 0: no card
  float speed = 1;              ///< 0.5: half as fast
};
template <class V, class S>
FieldsOf<S, StudyClip> fields(V& visit, S& clip) {
  visit("seconds", clip.seconds, Within<float>{0.5f, 600});
  visit("card", clip.card);
  visit("card_s", clip.card_s, Within<float>{0, 10});
  visit("speed", clip.speed, Within<float>{0.1f, 10});
}

enum class TrialOrder {
  Random,      ///< shuffled for each participant
  LatinSquare  ///< Williams' balanced Latin square over the conditions
};
constexpr Names<2> kTrialOrderNames{"random", "latin-square"};

/// Who sees what, and when. Every participant sees every condition: the design is within-subject.
struct StudyPlan {
  int repetitions = 1;             ///< of each trial
  int trials_per_participant = 0;  ///< 0: all; otherwise a balanced subset
  TrialOrder order = TrialOrder::Random;
  int practice = 0;     ///< trials before the others that do not count
  int break_every = 0;  ///< trials between two breaks; 0: none
  int seed = 1;
  int participants = 30;     ///< to be asked
  float least_right = 0.5f;  ///< who has a smaller share of attention questions right is excluded
  bool must_exceed = false;  ///< so is who has exactly this share
};
template <class V, class S>
FieldsOf<S, StudyPlan> fields(V& visit, S& plan) {
  visit("repetitions", plan.repetitions, Within<int>{1, 1000});
  visit("trials_per_participant", plan.trials_per_participant, Within<int>{0, 100000});
  visit("order", plan.order, kTrialOrderNames);
  visit("practice", plan.practice, Within<int>{0, 100});
  visit("break_every", plan.break_every, Within<int>{0, 10000});
  visit("seed", plan.seed, kFrameNumbers);
  visit("participants", plan.participants, Within<int>{1, 100000});
  visit("least_right", plan.least_right, Within<float>{0, 1});
  visit("must_exceed", plan.must_exceed);
}

/// Paths are absolute in memory.
struct Study {
  std::string name;
  std::string note;                ///< for those who run it
  std::string consent = kConsent;  ///< what participants agree to before they begin; empty: nothing
  std::vector<Condition> conditions;
  std::vector<StudyMotion> motions;
  std::vector<StudyTarget> targets;
  std::vector<StudyQuestion> questions;
  StudyLayout layout;
  StudyClip clip;
  StudyPicture picture;
  StudyPlan plan;
};
template <class V, class S>
FieldsOf<S, Study> fields(V& visit, S& study) {
  visit("name", study.name);
  visit("note", study.note);
  visit("consent", study.consent);
  visit("conditions", study.conditions);
  visit("motions", study.motions);
  visit("targets", study.targets);
  visit("questions", study.questions);
  visit("layout", study.layout);
  visit("clip", study.clip);
  visit("picture", study.picture);
  visit("plan", study.plan);
}

/// Throws Error, one sentence: fewer than two conditions, no motion, target or question, a name twice, a
/// question without its options or a right answer among them, a condition without a file for some trial.
/// Touches no file.
void check(const Study& study);
/// The file that shows a condition in a trial of a motion and a target: one that names both before one that
/// names one of them, the first of equals; null where there is none.
const StimulusFile* file_for(const Condition& condition, const StudyMotion& motion,
                             const StudyTarget& target);
/// Throws Error naming who needs it: "condition 'H4D': walk.glb is gone".
void check_files(const Study& study);
/// Throws Error where an imported animation is not as long as the motion that it stands beside, more than two
/// frames apart. Opens sources and animations, one after the other.
void check_lengths(const Study& study);

Json to_json(const Study& study, const std::string& folder);
/// Throws Error naming `path` and the member that is wrong; members that are not known are refused, since a
/// setting with a wrong name would silently not be one.
Study study_from_json(const Json& json, const std::string& folder, const std::string& path);
/// Writes beside the file, then renames. Throws Error naming the path, also where check() does.
void write_study(const std::string& path, const Study& study);
/// Throws Error when the file is missing, no study, damaged, from a newer version or one that check()
/// refuses.
Study read_study(const std::string& path);
/// The same for a study that is still being designed: check() is not asked. Throws Error as the others, but
/// for that.
void write_draft(const std::string& path, const Study& study);
Study read_draft(const std::string& path);
/// As study_from_json(), but for check().
Study draft_from_json(const Json& json, const std::string& folder, const std::string& path);

/// What the answers of a study depend on, as text for their files: a checksum of each part of the design,
/// paths relative to `folder`, so that a study moved with its files stays the same. Name, note, consent,
/// breaks, the number of participants and the rule of exclusion may change at any time.
std::string digest_of(const Study& study, const std::string& folder);
/// What changed since: "condition 'H4D', motion 'walk' is new, clip"; empty: nothing. Throws Error when the
/// text is no digest.
std::string changes_since(const std::string& digest, const Study& study, const std::string& folder);

}  // namespace understudy::app
