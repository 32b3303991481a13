#include "tests/app/study/made_study.hpp"

namespace understudy::tests {

using namespace app;

Study made_study(const std::string& folder) {
  Study study;
  study.name = "small";
  study.conditions.resize(3);
  study.conditions[0].name = "copy";
  study.conditions[1].name = "no offsets";
  study.conditions[1].method.offsets = false;
  study.conditions[2].name = "guest";
  study.conditions[2].kind = ConditionKind::Files;
  study.conditions[2].files = {{"walk", "", folder + "/walk.bvh"},
                               {"", "tall", folder + "/tall.bvh"},
                               {"jump", "", folder + "/jump.bvh"}};
  study.motions.resize(2);
  study.motions[0].name = "walk";
  study.motions[0].source.path = folder + "/walk";
  study.motions[1].name = "jump";
  study.motions[1].source.path = folder + "/jump.bvh";
  study.motions[1].seconds = 1.5f;
  study.targets.resize(3);
  for (size_t i = 0; i < 3; ++i)
    study.targets[i].name = std::vector<const char*>{"tall", "short", "child"}[i];
  for (StudyTarget& target : study.targets) target.target.path = folder + "/" + target.name + ".glb";
  study.targets[2].target.import.height = 1.2f;
  study.questions.resize(3);
  study.questions[0] = {
      "natural", QuestionKind::Likert, "How natural is it?", 7, "Not at all", "Very", {}, "", 1};
  study.questions[1] = {"age", QuestionKind::Choice, "Who is it?", 7, "", "", {"Adult", "Child"}, "", 1};
  study.questions[2] = {"action", QuestionKind::Attention, "What is it?", 7, "", "", {"walk", "jump"}, "", 4};
  study.plan.practice = 2;
  return study;
}

}  // namespace understudy::tests
