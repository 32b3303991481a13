#include "retarget/pipeline/method_table.hpp"

#include <gtest/gtest.h>

#include <set>

#include "retarget/base/error.hpp"

namespace understudy {
namespace {

TEST(MethodTable, EveryRowHasANameOfItsOwnAndWords) {
  for (const MethodChoices* const choices : {&engines(), &flat_engines(), &extractors()}) {
    std::set<std::string> names, labels;
    for (const MethodChoice& choice : *choices) {
      EXPECT_TRUE(names.insert(choice.name).second) << choice.name;
      EXPECT_TRUE(labels.insert(choice.label).second) << choice.label;
      EXPECT_NE(std::string(choice.sentence), "") << choice.name;
      EXPECT_NE(std::string(choice.caption), "") << choice.name;
    }
  }
}

TEST(MethodTable, AnEngineWithoutWeightsIsMadeUnderItsOwnName) {
  for (const MethodChoice& engine : engines()) {
    EXPECT_EQ(engine.weights == nullptr, engine.make != nullptr) << engine.name;
    if (engine.make) EXPECT_EQ(engine.make()->name(), engine.name);
  }
}

TEST(MethodTable, AnUnknownNameIsToldWithThoseThatThereAre) {
  EXPECT_STREQ(engine_named("copy").label, "Copy");
  EXPECT_EQ(index_of(engines(), "hybrid"), -1);
  try {
    engine_named("hybrid");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(std::string(error.what()).rfind("there is no engine 'hybrid': copy, ", 0), 0u) << error.what();
  }
}

TEST(MethodTable, AnEngineOfTheOtherKindIsToldApart) {
  EXPECT_STREQ(flat_engine_named("limbs").label, "Limbs");
  EXPECT_EQ(failure_of([] { engine_named("limbs"); }),
            "the engine 'limbs' is for 2D poses; for what moves in space there are copy, paper, positions");
  EXPECT_EQ(
      failure_of([] { flat_engine_named("copy"); }).rfind("the engine 'copy' is for what moves in space", 0),
      0u);
  EXPECT_EQ(failure_of([] { flat_engine_named("hybrid"); }).rfind("there is no engine 'hybrid': limbs", 0),
            0u);
}

}  // namespace
}  // namespace understudy
