#include "retarget/pipeline/method_table.hpp"

#include "retarget/base/error.hpp"
#include "retarget/base/text.hpp"
#include "retarget/pipeline/copy_transfer.hpp"

namespace understudy {
namespace {

template <bool sees_rotations>
std::unique_ptr<MotionTransfer> made() {
  return std::make_unique<CopyTransfer>(sees_rotations);
}

const MethodChoice& named(const MethodChoices& choices, const std::string& name, const char* what) {
  const int i = index_of(choices, name);
  US_CHECK(i >= 0, "there is no ", what, " '", name, "': ", names_of(choices, ", "));
  return choices[i];
}

}  // namespace

const MethodChoices& engines() {
  static const MethodChoices all = {
      {"copy", "Copy", "copied rotations", "turns each bone of the target as the source's turns", nullptr,
       made<true>},
      {"paper", "Paper", "paper's network", "a recurrent network (paper 1) predicts rotations from joints",
       "motion.weights"},
      {"positions", "Positions", "rotations from positions",
       "solves rotations from the places of the joints alone", nullptr, made<false>}};
  return all;
}

const MethodChoices& flat_engines() {
  static const MethodChoices all = {
      {"limbs", "Limbs", "rebuilt limbs",
       "rebuilds 2D poses from the mid-hip outwards, each bone as much longer as the other person's is",
       nullptr},
      {"paper", "Paper", "paper's engine", "the network of paper 5 decodes a pose's code with the person's",
       "pose2d.weights"},
      {"lift", "Lift", "lifted bones",
       "lifts 2D poses into space, where bones take the other person's lengths; what is cut off is made up",
       "lifter.weights"}};
  return all;
}

const MethodChoices& extractors() {
  static const MethodChoices all = {
      {"dense", "Dense", "dense extractor", "every point of the scan votes for where the joints are",
       "skeleton.weights"},
      {"paper", "Paper", "paper's extractor",
       "the network of paper 1 finds the joints in a few sampled points", "skeleton_paper.weights"}};
  return all;
}

const MethodChoices& rig_methods() {
  static const MethodChoices all = {
      {"parts", "Parts", "rigid parts",
       "what moves as one in the scans becomes a bone, in anything that moves enough", nullptr},
      {"slots", "Slots", "a kind's keypoints",
       "a network's keypoints, the same in every body of a kind that it knows, tell where parts go however "
       "fast, and name their bones; one scan is enough",
       "marionette_slots"},
      {"paper", "Paper (small)", "paper 3's keypoints, trained small",
       "the keypoints and the tree of paper 3's own network, on a coarser grid with fewer channels than the "
       "paper's, with weights of one's own (train marionette-paper): for comparison",
       "marionette_paper", nullptr, true}};
  return all;
}

const MethodChoice& engine_named(const std::string& name) {
  const bool is_flat = index_of(engines(), name) < 0 && index_of(flat_engines(), name) >= 0;
  US_CHECK(!is_flat, "the engine '", name, "' is for 2D poses; for what moves in space there are ",
           names_of(engines(), ", "));
  return named(engines(), name, "engine");
}

const MethodChoice& flat_engine_named(const std::string& name) {
  const bool is_deep = index_of(flat_engines(), name) < 0 && index_of(engines(), name) >= 0;
  US_CHECK(!is_deep, "the engine '", name, "' is for what moves in space; for 2D poses there are ",
           names_of(flat_engines(), ", "));
  return named(flat_engines(), name, "engine");
}

const MethodChoice& extractor_named(const std::string& name) {
  return named(extractors(), name, "extractor");
}

const MethodChoice& rig_method_named(const std::string& name) {
  return named(rig_methods(), name, "way to find bones");
}

std::vector<std::string> names_of(const MethodChoices& choices) {
  std::vector<std::string> names;
  for (const MethodChoice& choice : choices) names.push_back(choice.name);
  return names;
}

std::string names_of(const MethodChoices& choices, const char* between) {
  std::string names;
  for (const MethodChoice& choice : choices) append_item(names, choice.name, between);
  return names;
}

std::vector<std::string> labels_of(const MethodChoices& choices) {
  std::vector<std::string> labels;
  for (const MethodChoice& choice : choices) labels.push_back(choice.label);
  return labels;
}

int index_of(const MethodChoices& choices, const std::string& name) {
  for (size_t i = 0; i < choices.size(); ++i)
    if (name == choices[i].name) return static_cast<int>(i);
  return -1;
}

std::string tip_of(const MethodChoice& choice) {
  return std::string(choice.label) + ": " + choice.sentence + ".";
}

std::string help_of(const MethodChoices& choices) {
  std::string help;
  for (const MethodChoice& choice : choices)
    append_item(help, std::string(choice.name) + ": " + choice.sentence, "; ");
  return help;
}

}  // namespace understudy
