// Judges of style: their networks, and the training, on styles that differ in one thing.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>

#include "retarget/base/error.hpp"
#include "retarget/base/log.hpp"
#include "retarget/base/rng.hpp"
#include "retarget/formats/npz_writer.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/nn/load.hpp"
#include "retarget/nn/modules/judge_net.hpp"
#include "retarget/nn/modules/words_gan.hpp"
#include "retarget/nn/weights_file.hpp"
#include "retarget/style/judged_channels.hpp"
#include "retarget/training/training_run.hpp"
#include "tests/retarget/nn/motion_support.hpp"

namespace understudy {
namespace {

namespace fs = std::filesystem;

/// How somebody moves their elbows.
struct Manner {
  float offset = 0;  ///< radians, of the left one
  float lag = 0;     ///< radians of a cycle, of the right one behind the left one
  float gain = 1, rate = 1;
};

/// Elbows about their one axis and a shoulder, in waves; no clip is as another.
std::vector<Rotations> clip_of(const Manner& manner, uint64_t seed, const std::string& action = "wave") {
  Rng rng(seed);
  const float phase = rng.uniform(0, 2 * kPi), size = manner.gain * rng.uniform(0.2f, 0.3f),
              speed = manner.rate * rng.uniform(0.11f, 0.13f), lean = rng.uniform(-0.03f, 0.03f);
  std::vector<Rotations> local(static_cast<size_t>(120 / manner.rate), identity_rotations());
  for (size_t t = 0; t < local.size(); ++t) {
    const float at = phase + speed * static_cast<float>(t);
    local[t][LeftElbow] = rotation_from_axis_angle(Vec3(0, manner.offset + lean + size * std::sin(at), 0));
    local[t][RightElbow] = rotation_from_axis_angle(Vec3(0, lean + size * std::sin(at - manner.lag), 0));
    const float raised = action == "raise" ? 0.6f : 0.1f;
    local[t][LeftShoulder] = rotation_from_axis_angle(Vec3(0, 0, raised + 0.1f * std::sin(at + 1)));
    local[t][RightShoulder] = rotation_from_axis_angle(Vec3(0, 0, -raised - 0.1f * std::sin(at + 1)));
  }
  return local;
}

class JudgeTraining : public ::testing::Test {
 protected:
  void SetUp() override {
    before_ = log::set_sink([](log::Level, const std::string&) {});
  }
  void TearDown() override { log::set_sink(before_); }

  std::string file(const std::string& name) const { return folder_.path() + "/" + name; }

  void write_clip(const std::string& name, const std::vector<Rotations>& local,
                  const std::string& info) const {
    fs::create_directories(fs::path(file(name)).parent_path());
    NpzWriter writer(file(name));
    const auto frames = static_cast<int64_t>(local.size());
    std::vector<double> poses;
    for (const Rotations& pose : local)
      for (int j = 0; j < kJointCount; ++j)
        for (const float x : Vec3(rotation_to_axis_angle(pose[static_cast<size_t>(j)])))
          poses.push_back(static_cast<double>(x));
    writer.add("poses", {frames, 3 * kJointCount}, poses);
    writer.add("trans", {frames, 3}, std::vector<double>(3 * local.size()));
    writer.add("mocap_framerate", {}, {30});
    writer.add("info", info);
    writer.finish();
  }

  /// DATA/one and DATA/other, a dozen clips each, in a folder inside.
  std::string write_styles(const Manner& one, const Manner& other) const {
    for (int i = 0; i < 24; ++i) {
      const std::string action = i % 4 < 2 ? "wave" : "raise";
      const std::string name =
          (i % 2 == 0 ? "data/one/somebody/" : "data/other/somebody/") + std::to_string(i);
      write_clip(name + ".npz", clip_of(i % 2 == 0 ? one : other, static_cast<uint64_t>(i + 1), action),
                 R"({"actions": [")" + action + R"("], "desc": "To )" + action + R"( 2 hands"})");
    }
    return file("data");
  }

  nn::StyleJudgeTrainOptions options(const std::string& data, const char* name, int64_t steps) const {
    nn::StyleJudgeTrainOptions options;
    options.data = data;
    options.out = file(name);
    options.threads = 1;
    options.batch = 16;
    options.samples = 16 * steps;
    options.licence = "CC BY 4.0";
    return options;
  }

  testing::DataFolder folder_;
  log::Sink before_;
};

/// Shares of clips, unlike those learned from, whose style is judged to be the second.
struct Shares {
  double look = 0, coordination = 0;
};
Shares judged_other(StyleJudge& judge, const Manner& manner) {
  Shares shares;
  constexpr int kClips = 10;
  for (int i = 0; i < kClips; ++i) {
    const Verdict verdict = judge.judge(clip_of(manner, static_cast<uint64_t>(1000 + i)), 30);
    shares.look += verdict.look == "other" ? 1.0 / kClips : 0;
    shares.coordination += verdict.coordination == "other" ? 1.0 / kClips : 0;
  }
  return shares;
}

TEST_F(JudgeTraining, LookTellsAnOffsetAndContentWhatIsDone) {
  const Manner one, other{0.4f};
  ASSERT_EQ(training::train(options(write_styles(one, other), "judge.weights", 120)), 0);
  const auto judge = nn::load_judges(file("judge.weights"));
  EXPECT_EQ(judge->styles(), (std::vector<std::string>{"one", "other"}));
  EXPECT_EQ(judge->contents(), (std::vector<std::string>{"raise", "wave"}));
  EXPECT_LT(judged_other(*judge, one).look, 0.15);
  EXPECT_GT(judged_other(*judge, other).look, 0.85);
  for (const char* const action : {"wave", "raise"})
    EXPECT_EQ(judge->judge(clip_of(other, 77, action), 30).content, action);
  EXPECT_EQ(nn::read_weights_header(file("judge.weights")).texts.at("licence"), "CC BY 4.0");
}

TEST_F(JudgeTraining, CoordinationTellsHowJointsHangTogether) {
  const Manner one, other{0, 1.5f};
  ASSERT_EQ(training::train(options(write_styles(one, other), "judge.weights", 250)), 0);
  const auto judge = nn::load_judges(file("judge.weights"));
  for (const Manner& disguise : {Manner{}, Manner{0.3f, 0, 0.5f, 1}, Manner{-0.2f, 0, 2, 0.5f}}) {
    EXPECT_LT(judged_other(*judge, disguise).coordination, 0.15) << disguise.gain;
    Manner lagging = disguise;
    lagging.lag = other.lag;
    EXPECT_GT(judged_other(*judge, lagging).coordination, 0.85) << disguise.gain;
  }
}

TEST_F(JudgeTraining, ContentsMayBeTheDescriptions) {
  nn::StyleJudgeTrainOptions described = options(write_styles({}, {}), "judge.weights", 1);
  described.contents = "descriptions";
  described.legs = true;
  ASSERT_EQ(training::train(described), 0);
  EXPECT_EQ(nn::load_judges(file("judge.weights"))->contents(),
            (std::vector<std::string>{"to raise 2 hands", "to wave 2 hands"}));
}

/// The networks are blind, not taught to be.
TEST(JudgeNet, CoordinationSeesNeitherOffsetNorGainNorRate) {
  torch::manual_seed(1);
  nn::JudgeForm form;
  form.styles = {"one", "other"}, form.contents = {"wave"};
  for (int c = 0; c < 36; ++c) form.channels.push_back(c);
  nn::JudgeNet net(form);
  net->eval();
  Rng rng(3);
  std::vector<Rotations> local(70, identity_rotations());
  for (size_t t = 0; t < local.size(); ++t)
    for (Mat3& turn : local[t])
      turn = rotation_from_axis_angle(Vec3(rng.normal(), rng.normal(), rng.normal()) * 0.2f);
  const RowMatrix rows = judged_channels(local, false);
  RowMatrix other = resampled(rows, 0, 69, 139);
  other.array() = other.array() * 1.7f + 1;
  const nn::JudgeVotes a = nn::votes_of(net, form, nn::judged_clip(rows, form)),
                       b = nn::votes_of(net, form, nn::judged_clip(other, form));
  EXPECT_LT((a.coordination - b.coordination).abs().max().item<double>(), 1e-3);
  EXPECT_GT((a.look - b.look).abs().max().item<double>(), 1e-2);
}

TEST_F(JudgeTraining, GoesOnAsIfItHadNotBeenStopped) {
  const std::string data = write_styles({}, {0.4f});
  ASSERT_EQ(training::train(options(data, "whole.weights", 12)), 0);
  nn::StyleJudgeTrainOptions parted = options(data, "parted.weights", 12);
  int asked = 0;
  parted.cancelled = [&] { return ++asked > 5; };
  ASSERT_EQ(training::train(parted), 1);
  parted.cancelled = {};
  ASSERT_EQ(training::train(parted), 0);
  const auto weights = [&](const char* name) {
    nn::JudgeForm form;
    form.styles = {"one", "other"}, form.contents = {"raise", "wave"};
    const std::string used = nn::read_weights_header(file(name)).texts.at("channels");
    for (size_t c = 0; c < used.size(); ++c)
      if (used[c] == '1') form.channels.push_back(static_cast<int>(c));
    nn::JudgeNet net(form);
    nn::load_weights(file(name), "style-judge", nn::kJudgeVersion, *net);
    std::vector<torch::Tensor> all;
    for (const auto& parameter : net->parameters()) all.push_back(parameter.flatten());
    return torch::cat(all);
  };
  EXPECT_TRUE(torch::equal(weights("whole.weights"), weights("parted.weights")));
}

TEST_F(JudgeTraining, AClipOfOneFrameIsJudgedAndOneOfNoneIsNot) {
  ASSERT_EQ(training::train(options(write_styles({}, {0.4f}), "judge.weights", 2)), 0);
  const auto judge = nn::load_judges(file("judge.weights"));
  for (const double fps : {12.0, 30.0, 120.0})
    EXPECT_FALSE(judge->judge({identity_rotations()}, fps).look.empty());
  EXPECT_THROW(judge->judge({}, 30), Error);
  EXPECT_THROW(judge->judge({identity_rotations()}, 0), Error);
  std::vector<Rotations> broken(40, identity_rotations());
  broken[20][Head](1, 1) = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THROW(judge->judge(broken, 30), Error);
}

TEST_F(JudgeTraining, DataThatIsNoneIsRefusedInASentence) {
  const auto refused = [&](const std::string& data) {
    const std::string problem = failure_of([&] { training::train(options(data, "none.weights", 1)); });
    EXPECT_FALSE(fs::exists(file("none.weights")));
    return problem;
  };
  EXPECT_NE(refused(file("absent")).find("there is no such folder"), std::string::npos);
  fs::create_directories(file("few"));
  EXPECT_NE(refused(file("few")).find("holds no folder"), std::string::npos);
  fs::create_directories(file("few/one"));
  EXPECT_NE(refused(file("few")).find("holds one folder"), std::string::npos);
  const std::string data = write_styles({}, {});
  fs::create_directories(data + "/third");
  EXPECT_NE(refused(data).find("third: holds no clip"), std::string::npos);
}

TEST_F(JudgeTraining, OtherAndDamagedFilesAreRefusedByName) {
  const auto problem = [&] { return failure_of([&] { nn::load_judges(file("other.weights")); }); };
  EXPECT_NE(problem().find("other.weights"), std::string::npos);
  nn::save_weights(file("other.weights"), {"motion", 1, {}}, *nn::WordDiscriminator());
  EXPECT_NE(problem().find("other.weights: holds weights for 'motion'"), std::string::npos);
  nn::save_weights(file("other.weights"), {"style-judge", nn::kJudgeVersion, {}}, *nn::WordDiscriminator());
  EXPECT_NE(problem().find("other.weights: has no styles"), std::string::npos);
  ASSERT_EQ(training::train(options(write_styles({}, {}), "other.weights", 1)), 0);
  fs::resize_file(file("other.weights"), fs::file_size(file("other.weights")) / 2);
  EXPECT_NE(problem().find("other.weights"), std::string::npos);
}

}  // namespace
}  // namespace understudy
