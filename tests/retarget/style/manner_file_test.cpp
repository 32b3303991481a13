#include "retarget/style/manner_file.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "retarget/base/error.hpp"

namespace understudy {
namespace {

using Json = nlohmann::ordered_json;

Json good() {
  return Json::parse(
      R"({"understudy_style": 1, "joints": "SMPL 22", "label": "Proud", "sentence": "Stands tall",
    "licence": "MIT", "made_from": "values set by hand",
    "figures": {"posture": {"value": {"shoulder": [10, 20, 30], "head": [-5, 0, 0]}, "unit": "degrees",
                            "source": "set by hand"},
                "size": {"value": {"elbow": 1.5, "left_wrist": 0.5}, "unit": "times", "source": "set by hand"},
                "lean": {"value": 12, "unit": "degrees per leg", "source": "set by hand"}}})");
}

std::string problem_of(const Json& json) {
  return failure_of([&] { parse_manner(json.dump(), "proud.json"); });
}

TEST(MannerFile, ReadsFiguresInTheirUnitsAndMirrorsWhatIsOfBothSides) {
  const MannerFile file = parse_manner(good().dump(), "somewhere/proud.json");
  EXPECT_EQ(file.note.name, "proud");
  EXPECT_EQ(file.note.label, "Proud");
  constexpr float kDegree = kPi / 180;
  EXPECT_TRUE(file.manner.posture[LeftShoulder].isApprox(kDegree * Vec3(10, 20, 30)));
  EXPECT_TRUE(file.manner.posture[RightShoulder].isApprox(kDegree * Vec3(10, -20, -30)));
  EXPECT_FLOAT_EQ(file.manner.size[RightElbow], 1.5f);
  EXPECT_FLOAT_EQ(file.manner.size[LeftWrist], 0.5f);
  EXPECT_FLOAT_EQ(file.manner.size[RightWrist], 1);
  EXPECT_FLOAT_EQ(file.manner.lean, 12 * kDegree);
}

TEST(MannerFile, WrittenAndReadItIsTheSame) {
  const MannerFile file = parse_manner(good().dump(), "proud.json");
  const MannerFile again = parse_manner(to_json(file), "proud.json");
  EXPECT_EQ(to_json(again), to_json(file));
  EXPECT_FLOAT_EQ(again.manner.posture[RightShoulder].z(), file.manner.posture[RightShoulder].z());
}

TEST(MannerFile, WhatIsWrongIsSaidInASentenceThatNamesTheFile) {
  const auto changed = [](const std::function<void(Json&)>& change) {
    Json json = good();
    change(json);
    const std::string problem = problem_of(json);
    EXPECT_EQ(problem.rfind("proud.json: ", 0), 0u) << problem;
    return problem;
  };
  EXPECT_NE(failure_of([] { parse_manner("{", "proud.json"); }).find("proud.json: is not the JSON"),
            std::string::npos);
  EXPECT_NE(changed([](Json& j) { j.erase("understudy_style"); }).find("is not a style"), std::string::npos);
  EXPECT_NE(changed([](Json& j) { j["understudy_style"] = 2; }).find("newer"), std::string::npos);
  EXPECT_NE(changed([](Json& j) { j["joints"] = "Mixamo 65"; }).find("joints Mixamo 65"), std::string::npos);
  EXPECT_NE(changed([](Json& j) { j.erase("licence"); }).find("no licence"), std::string::npos);
  EXPECT_NE(changed([](Json& j) { j["licence"] = ""; }).find("licence"), std::string::npos);
  EXPECT_NE(changed([](Json& j) { j["figures"]["lean"].erase("source"); }).find("source"), std::string::npos);
  EXPECT_NE(changed([](Json& j) { j["figures"]["lean"]["unit"] = "radians"; }).find("degrees per leg"),
            std::string::npos);
  EXPECT_NE(changed([](Json& j) { j["figures"]["lean"]["value"] = 1e9; }).find("it must be from"),
            std::string::npos);
  EXPECT_NE(changed([](Json& j) { j["figures"]["lean"]["value"] = "much"; }).find("not a number"),
            std::string::npos);
  EXPECT_NE(changed([](Json& j) { j["figures"]["lien"] = j["figures"]["lean"]; }).find("no figure 'lien'"),
            std::string::npos);
  EXPECT_NE(changed([](Json& j) { j["figures"]["size"]["value"]["tail"] = 2; }).find("no joint 'tail'"),
            std::string::npos);
  EXPECT_NE(changed([](Json& j) {
              j["figures"]["posture"]["value"]["head"] = {1, 2};
            }).find("three angles"),
            std::string::npos);
  EXPECT_NE(changed([](Json& j) { j["colour"] = "red"; }).find("colour is not known"), std::string::npos);
}

TEST(MannerFile, TellsLicencesThatForbidUsesForMoney) {
  StyleNote note;
  for (const char* const licence : {"CC BY-NC 4.0", "CC-BY-NC-SA", "Non-commercial research only"}) {
    note.licence = licence;
    EXPECT_TRUE(note.non_commercial()) << licence;
  }
  for (const char* const licence : {"MIT", "CC BY 4.0", "CC0"}) {
    note.licence = licence;
    EXPECT_FALSE(note.non_commercial()) << licence;
  }
}

TEST(MannerFile, AllThatComeWithTheProgramAreReadAndSayWhereTheirFiguresAreFrom) {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(US_SOURCE_DIR "/assets/styles")) {
    if (entry.path().extension() != ".json") continue;
    const MannerFile file = read_manner(entry.path().string());
    EXPECT_EQ(file.note.licence, "MIT") << entry.path();
    EXPECT_FALSE(file.origins.empty());
    ++count;
  }
  EXPECT_GE(count, 4);
}

}  // namespace
}  // namespace understudy
