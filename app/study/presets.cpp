#include "app/study/presets.hpp"

#include "retarget/base/error.hpp"
#include "retarget/base/text.hpp"
#include "retarget/pipeline/method_table.hpp"

namespace understudy::app {
namespace {

Condition method_condition(const std::string& name, const std::string& engine, float stride = 1) {
  Condition condition;
  condition.name = name;
  condition.method.engine = engine;
  condition.method.stride = stride;
  return condition;
}

/// Performed in a style that comes with the program.
Condition style_condition(const std::string& name, const std::string& style, float strength = 1,
                          float liveliness = 1) {
  Condition condition = method_condition(name, "copy");
  condition.method.style.choose(style);
  condition.method.style.strength = strength;
  condition.method.style.liveliness = liveliness;
  return condition;
}

StudyMotion motion_of(const std::string& name, const std::string& action, const std::string& source) {
  StudyMotion motion;
  motion.name = name;
  motion.action = action;
  motion.source.path = source;
  return motion;
}

/// height_m 0: the file's own.
StudyTarget target_of(const std::string& name, const std::string& file, float height_m = 0) {
  StudyTarget target;
  target.name = name;
  target.target.path = file;
  if (height_m > 0) target.target.import.height = height_m;
  return target;
}

StudyQuestion likert(const std::string& name, const std::string& text, const std::string& low,
                     const std::string& high) {
  StudyQuestion question;
  question.name = name;
  question.text = text;
  question.low = low;
  question.high = high;
  return question;
}

StudyQuestion choice(QuestionKind kind, const std::string& name, const std::string& text,
                     const std::vector<std::string>& options) {
  StudyQuestion question;
  question.name = name;
  question.kind = kind;
  question.text = text;
  question.options = options;
  return question;
}

/// Section 4.3: three methods, three motions, five pairs of source and target shape.
Study rekik(const std::string& samples) {
  constexpr float kHalfOfDance_s = 1.45f;
  Study study;
  study.name = "Rekik et al. 2024";
  study.note =
      "The design of the user study in section 4.3: 3 methods, 3 motions and 5 shape pairs, 45 trials in "
      "random "
      "order, 30 participants. H4D and TST are not part of Understudy: make their results, and add them as "
      "conditions of the kind \"files\" in place of the other engines. The paper's motions are walking, "
      "hip-hop "
      "and throwing; here the third is the second half of the bundled dance, and the five targets are the "
      "two "
      "bundled bodies at several heights.";
  for (const MethodChoice& engine : engines())
    study.conditions.push_back(method_condition(engine.label, engine.name));
  study.motions = {motion_of("walk", "walk", samples + "/walk"),
                   motion_of("dance", "dance", samples + "/scan"),
                   motion_of("dance, second half", "dance", samples + "/scan")};
  study.motions[1].seconds = study.motions[2].from_s = kHalfOfDance_s;
  const std::string adult = samples + "/target_adult.glb", child = samples + "/target_child.glb";
  study.targets = {target_of("adult", adult), target_of("child", child),
                   target_of("short adult", adult, 1.55f), target_of("tall adult", adult, 1.95f),
                   target_of("tall child", child, 1.35f)};
  study.questions = {likert("motion", "How similar is the motion of the result to that of the source?",
                            "Not similar at all", "Very similar"),
                     likert("shape", "How similar is the body of the result to the target shape?",
                            "Not similar at all", "Very similar")};
  study.layout.labels = true;
  study.plan.practice = 3;
  study.plan.break_every = 15;
  study.plan.participants = 30;
  return study;
}

/// Section 5.4: five conditions, a cyclic and a non-cyclic motion, 50 clips, three questions each.
Study dong(const std::string& samples) {
  Study study;
  study.name = "Dong et al. 2020";
  study.note =
      "The design of the perceptual study in section 5.4: 5 conditions, a cyclic and a non-cyclic motion, 50 "
      "clips of 10 s in random order, 41 participants; whoever names at most half of the actions rightly is "
      "excluded. The paper's conditions are adult, child, its own method, Holden et al. 2016 and Aberman et "
      "al. "
      "2020: add recorded children and the results of others as conditions of the kind \"files\" in place of "
      "some of the styles here. Its motions are a jump and a fast walk; here they are the bundled dance "
      "and walk. Each clip is shown 5 times; with more takes of a motion, list them as motions of the same "
      "action and show each once.";
  study.conditions = {method_condition("adult", "copy"), style_condition("child", "child"),
                      style_condition("child, half", "child", 0.5f),
                      style_condition("child, posture and size alone", "child", 1, 0),
                      style_condition("old", "old")};
  study.motions = {motion_of("walk", "Walking", samples + "/walk"),
                   motion_of("dance", "Dancing", samples + "/scan")};
  study.targets = {target_of("adult", samples + "/target_adult.glb")};
  study.questions = {
      choice(QuestionKind::Choice, "age", "Does this motion belong to a child or an adult?",
             {"Adult", "Child"}),
      likert("naturalness", "How natural is the motion?", "Not natural at all", "Very natural"),
      choice(QuestionKind::Attention, "action", "What is the action being performed?",
             {"Walking", "Jumping", "Dancing", "Throwing"})};
  study.layout.panes = {StudyPane::Result};
  study.plan.repetitions = 5;
  study.plan.practice = 2;
  study.plan.break_every = 10;
  study.plan.participants = 41;
  study.plan.must_exceed = true;
  return study;
}

}  // namespace

const std::vector<StudyPreset>& study_presets() {
  static const std::vector<StudyPreset> all = {
      {"rekik", "Rekik et al. 2024", "45 trials: similarity of motion and of shape on a scale of 7 points",
       rekik},
      {"dong", "Dong et al. 2020", "50 trials: adult or child, naturalness, and which action", dong}};
  return all;
}

const StudyPreset& study_preset(const std::string& name) {
  std::string names;
  for (const StudyPreset& preset : study_presets()) {
    if (name == preset.name) return preset;
    append_item(names, preset.name);
  }
  throw Error("there is no preset '" + name + "': " + names);
}

}  // namespace understudy::app
