// What all trainers have in common, shown on a network of one number.
#include "retarget/training/training_run.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <set>
#include <sstream>

#include "retarget/base/error.hpp"
#include "retarget/base/log.hpp"

namespace understudy::training {
namespace {

namespace fs = std::filesystem;

struct OneNumberImpl : torch::nn::Module {
  OneNumberImpl() { value = register_parameter("value", torch::full({1}, 5.0)); }
  torch::Tensor value;
};
TORCH_MODULE(OneNumber);

/// Pulls the number to zero; the steps in `broken` have a loss that is no number.
class Fake final : public TrainingRun {
 public:
  Fake(const nn::TrainOptions& options, const Schedule& schedule, std::set<int64_t> broken = {})
      : TrainingRun(options, "fake", schedule), broken_(std::move(broken)) {
    own(net_.ptr(), average_.ptr(), std::make_unique<torch::optim::SGD>(net_->parameters(), 0.1));
  }
  double value() const { return net_->value.item<double>(); }
  double average() const { return average_->value.item<double>(); }

 private:
  Step learn() override {
    LossSum loss;
    const double broken = broken_.count(progress().step) ? std::numeric_limits<double>::quiet_NaN() : 1;
    loss.add("square", net_->value.square().sum() * broken);
    loss.add("size", net_->value.abs().sum(), 0.5);
    loss.total.backward();
    return {4, loss.parts};
  }
  Figures evaluate() override { return {{"dev_value", average()}}; }
  nn::WeightsHeader header() const override { return {"fake", 1, {}}; }

  std::set<int64_t> broken_;
  OneNumber net_, average_;
};

class Run : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("understudy_run_" + std::to_string(::getpid()));
    fs::create_directories(folder_);
    sink_ = log::set_sink([this](log::Level, const std::string& line) { logged_ += line + "\n"; });
  }
  void TearDown() override {
    log::set_sink(sink_);
    fs::remove_all(folder_);
  }
  nn::TrainOptions options(int64_t samples) const {
    nn::TrainOptions options;
    options.out = (folder_ / "fake.weights").string();
    options.samples = samples;
    return options;
  }
  std::string text(const char* name) const {
    std::ostringstream all;
    all << std::ifstream(folder_ / name).rdbuf();
    return all.str();
  }

  fs::path folder_;
  std::string logged_;
  log::Sink sink_;
};

Schedule rate(double rate) {
  Schedule schedule;
  schedule.rate = rate;
  schedule.most_gradient = 1e6;
  return schedule;
}

TEST_F(Run, ColumnsAreNamedAfterTheFigures) {
  EXPECT_EQ(Fake(options(8), rate(0.1)).run(), 0);
  std::istringstream curve(text("fake.weights.csv"));
  std::string columns, row, more;
  std::getline(curve, columns), std::getline(curve, row);
  EXPECT_EQ(columns, "minutes,step,samples,rate,skipped,square,size,dev_value");
  EXPECT_NE(row.find(",2,8,"), std::string::npos) << row;
  EXPECT_FALSE(std::getline(curve, more));
}

TEST_F(Run, ACurveWithOtherColumnsGoesOnBelowItsNewOnes) {
  std::ofstream(folder_ / "fake.weights.csv") << "minutes,loss\n1,2\n";
  EXPECT_EQ(Fake(options(8), rate(0.1)).run(), 0);
  EXPECT_EQ(text("fake.weights.csv").rfind("minutes,loss\n1,2\nminutes,step,", 0), 0u);
}

TEST_F(Run, RefusesAPipeAsItsCurve) {
  nn::TrainOptions piped = options(8);
  piped.curve = (folder_ / "pipe").string();
  ASSERT_EQ(::mkfifo(piped.curve.c_str(), 0600), 0);
  // Whoever would read a row from it or write into it goes on, so that the test fails and does not hang.
  const int both = ::open(piped.curve.c_str(), O_RDWR);
  ASSERT_EQ(::write(both, "\n", 1), 1);
  try {
    Fake(piped, rate(0.1)).run();
    ADD_FAILURE() << "it was written into";
  } catch (const Error& error) {
    EXPECT_EQ(error.what(), piped.curve + ": is a pipe or a device, not a file");
  }
  ::close(both);
}

TEST_F(Run, TheRateWarmsUpThenFallsAlongACosine) {
  Schedule schedule = rate(0.1);
  schedule.warm_up = 4;
  // Steps of 4 samples; the gradient at 5 is 10.5.
  int asked = 0;
  nn::TrainOptions stopped = options(4000);
  stopped.cancelled = [&asked] { return ++asked == 2; };
  Fake run(stopped, schedule);
  EXPECT_EQ(run.run(), 1);
  EXPECT_NEAR(run.value(), 5 - 0.1 / 4 * 10.5, 1e-5);
}

TEST_F(Run, GoesOnWhereItWasStopped) {
  Schedule schedule = rate(0.05);
  schedule.average_decay = 0.9;
  Fake whole(options(40), schedule);
  EXPECT_EQ(whole.run(), 0);
  fs::remove(folder_ / "fake.weights.checkpoint");
  int asked = 0;
  nn::TrainOptions stopped = options(40);
  stopped.cancelled = [&asked] { return ++asked == 5; };
  EXPECT_EQ(Fake(stopped, schedule).run(), 1);
  Fake rest(options(40), schedule);
  EXPECT_EQ(rest.run(), 0);
  EXPECT_EQ(rest.value(), whole.value());
  EXPECT_EQ(rest.average(), whole.average());
  EXPECT_GT(rest.average(), rest.value());
  EXPECT_EQ(nn::read_weights_header(options(0).out).numbers.at("steps"), 10);
}

TEST_F(Run, RefusesWhatIsNoCheckpoint) {
  std::ofstream(folder_ / "fake.weights.checkpoint") << "not a checkpoint";
  EXPECT_THROW(Fake(options(8), rate(0.1)).run(), Error);
}

TEST_F(Run, WantsAnEnd) {
  EXPECT_THROW(Fake(options(0), rate(0.1)), Error);
}

TEST_F(Run, AStepThatIsNotFiniteIsSkippedCountedAndTold) {
  Fake broken(options(20), rate(0.05), {1, 3});
  EXPECT_EQ(broken.run(), 0);
  EXPECT_LT(broken.value(), 5);
  std::istringstream curve(text("fake.weights.csv"));
  std::string columns, row;
  std::getline(curve, columns), std::getline(curve, row);
  EXPECT_NE(row.find(",5,20,"), std::string::npos) << row;
  EXPECT_EQ(row.find("nan"), std::string::npos) << row;
  std::string cell;
  std::istringstream cells(row);
  for (int i = 0; i < 5; ++i) std::getline(cells, cell, ',');
  EXPECT_EQ(cell, "2");
  EXPECT_EQ(std::count(logged_.begin(), logged_.end(), '\n'), 2) << logged_;  // the warning and the row
  EXPECT_NE(logged_.find("skipped"), std::string::npos);
}

TEST_F(Run, StopsWhenNothingIsFiniteAnyMore) {
  std::set<int64_t> broken;
  for (int64_t step = 3; step < 200; ++step) broken.insert(step);
  Fake run(options(800), rate(0.05), broken);
  try {
    run.run();
    ADD_FAILURE() << "it went on";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("20 steps in a row"), std::string::npos) << error.what();
  }
  EXPECT_TRUE(std::isfinite(run.value()));
}

}  // namespace
}  // namespace understudy::training
