#include <gtest/gtest.h>

#include <CLI/CLI.hpp>

#include "app/cli/options.hpp"

namespace understudy::app {
namespace {

MethodOptions parsed(const std::string& line) {
  CLI::App app;
  MethodOptions how;
  add_method_options(app, how);
  app.parse(line);
  return how;
}

TEST(MethodOptions, EverySwitchOfAMethodIsAnOption) {
  const Method off = parsed(
                         "--engine paper --extractor paper --root in-place --no-near --no-swap-repair "
                         "--no-smoothing --no-fixed-lengths --no-foot-lock --no-hand-contacts --no-offsets")
                         .method;
  const Method all = {"paper", "paper", false, false, false, false, false, false, false, RootMode::InPlace};
  EXPECT_TRUE(same(off, all));
  EXPECT_TRUE(same(parsed("").method, Method{}));
}

TEST(MethodOptions, ReachThePipelineAndTheNetworks) {
  const RetargetOptions off =
      retarget_options(parsed("--root original --no-swap-repair --no-smoothing --no-fixed-lengths "
                              "--no-foot-lock --no-hand-contacts")
                           .method);
  EXPECT_FALSE(off.filter.repair_swaps || off.filter.smooth || off.filter.fix_lengths || off.lock_feet ||
               off.keep_contacts);
  EXPECT_EQ(off.root.mode, RootMode::Original);
  const nn::NetworkOptions networks = network_options(
      parsed("--engine paper --extractor paper --no-near --no-offsets --weights w --engine-weights e "
             "--extractor-weights x"));
  EXPECT_FALSE(networks.near || networks.offsets);
  EXPECT_EQ(networks.engine + networks.extractor, "paperpaper");
  EXPECT_EQ(networks.weights + networks.engine_file + networks.extractor_file, "wex");
}

}  // namespace
}  // namespace understudy::app
