#include "app/run/motion_blender.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "app/run/fields_json.hpp"
#include "app/run/source.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/motion_space/knot_coder.hpp"
#include "tests/app/program.hpp"
#include "tests/app/sample_files.hpp"

namespace understudy::app {
namespace {

using tests::ScratchFolder;
using tests::write_walk;

std::string failure(const std::function<void()>& action) {
  return failure_of(action);
}

/// A walk, the same twice as fast and from the other foot, and somebody who stands.
class Blends : public testing::Test {
 protected:
  void SetUp() override {
    write_walk(walk());
    tests::WalkOptions fast, still;
    fast.fps = 60, fast.mirrored = true;
    still.motion = "still";
    write_walk(run(), fast);
    write_walk(scratch.path("still.npz"), still);
  }
  std::string walk() const { return scratch.path("walk.npz"); }
  std::string run() const { return scratch.path("run.npz"); }
  static BlendRecipe recipe(const std::vector<std::string>& parts, const std::string& coder = "plain") {
    BlendRecipe blend;
    for (const std::string& part : parts) blend.parts.push_back(blend_part(part));
    blend.coder = coder;
    return blend;
  }
  ScratchFolder scratch;
};

bool same_bits(const Motion& a, const Motion& b) {
  if (a.poses.size() != b.poses.size() || a.doubt_m != b.doubt_m) return false;
  for (size_t t = 0; t < a.poses.size(); ++t)
    if (a.poses[t].local != b.poses[t].local || a.poses[t].root != b.poses[t].root) return false;
  return true;
}

TEST_F(Blends, TheSameRecipeGivesTheSameBits) {
  BlendRecipe blend = recipe({walk(), run()});
  MotionBlender one, other;
  const BlendedMotion first = one.make(blend);
  EXPECT_GT(first.motion.poses.size(), 5u);
  EXPECT_EQ(first.motion.fps, 30);
  BlendRecipe elsewhere = blend;
  set_weights({0.9f, 0.1f}, elsewhere);
  EXPECT_FALSE(same_bits(first.motion, one.make(elsewhere).motion));
  EXPECT_TRUE(same_bits(first.motion, one.make(blend).motion)) << "after other weights";
  EXPECT_TRUE(same_bits(first.motion, other.make(blend).motion));
  Json json = Json::object();
  FieldsWriter writer(json, "/", "");
  fields(writer, blend);
  BlendRecipe read;
  FieldsReader reader(json, "/", "");
  fields(reader, read);
  EXPECT_TRUE(same_bits(first.motion, other.make(read).motion)) << "through a document";
}

TEST_F(Blends, AllFramesTellThatTheyWereMade) {
  SourceOptions options = blended_source(recipe({walk(), run()}));
  options.quiet = true;
  options.fps = 50;
  EXPECT_EQ(name_of(options), "walk - run");
  const auto source = open_source(options);
  EXPECT_EQ(source->fps(), 50);
  EXPECT_NE(source->decision().find("blended by the coder plain"), std::string::npos) << source->decision();
  int64_t frames = 0;
  while (const auto frame = source->next()) {
    ++frames;
    ASSERT_TRUE(frame->skeleton && frame->skeleton->exact);
    EXPECT_GT(frame->doubt_m, 0);
    EXPECT_TRUE(frame->mesh.vertices.allFinite());
    EXPECT_GT(frame->mesh.faces.rows(), 0) << "something to look at";
  }
  EXPECT_EQ(frames, source->count());
  source->seek(3);
  EXPECT_EQ(source->next()->number, 3);
}

TEST_F(Blends, TheSameFootStridesFirstInAllParts) {
  MotionBlender blender;
  const BlendedMotion made = blender.make(recipe({walk(), run()}));
  ASSERT_EQ(made.parts.size(), 2u);
  EXPECT_GT(made.parts[0].lead * made.parts[1].lead, 0);
  EXPECT_FALSE(made.parts[1].mirrored) << "it has steps of both feet";
  const BlendRange own = made.parts[0].range;
  const auto at = [](const std::string& path, const BlendRange& range) {
    return path + '@' + std::to_string(range.first) + ':' + std::to_string(range.last);
  };
  // The mirrored walk is opposed in the same frames.
  const BlendedMotion asked = blender.make(recipe({at(walk(), own), at(run(), own)}));
  EXPECT_GT(asked.parts[0].lead * asked.parts[1].lead, 0);
  EXPECT_NE(asked.parts[1].range.first, own.first);
  EXPECT_FALSE(asked.parts[1].mirrored);
  ASSERT_EQ(asked.notes.size(), 1u);
  EXPECT_NE(asked.notes[0].find("so that the same foot strides first"), std::string::npos) << asked.notes[0];
  // Where there is nothing before and after, it is mirrored.
  tests::WalkOptions alone;
  alone.mirrored = true, alone.first = own.first, alone.last = own.last;
  const std::string step = scratch.path("step.npz");
  write_walk(step, alone);
  const BlendedMotion seen = blender.make(recipe({at(walk(), own), at(step, {0, own.last - own.first})}));
  EXPECT_TRUE(seen.parts[1].mirrored);
  EXPECT_GT(seen.parts[0].lead * seen.parts[1].lead, 0);
  ASSERT_EQ(seen.notes.size(), 1u);
  EXPECT_NE(seen.notes[0].find("step.npz is mirrored"), std::string::npos) << seen.notes[0];
}

TEST_F(Blends, DurationsGoMonotoneFromOneMotionToTheOther) {
  MotionBlender blender;
  BlendRecipe blend = recipe({walk(), run()});
  float before = 100;
  for (const float share : {0.0f, 0.25f, 0.5f, 0.75f, 1.0f}) {
    set_share(1, share, blend);
    const float seconds = blender.make(blend).seconds;
    EXPECT_LT(seconds, before);
    before = seconds;
  }
}

TEST_F(Blends, CyclesFollowOneAnother) {
  BlendRecipe blend = recipe({walk(), run()});
  MotionBlender blender;
  const BlendedMotion once = blender.make(blend);
  blend.cycles = 3;
  const BlendedMotion thrice = blender.make(blend);
  EXPECT_NEAR(static_cast<double>(thrice.motion.poses.size()),
              3 * static_cast<double>(once.motion.poses.size()), 4);
}

TEST_F(Blends, UnlikeMotionsAreMadeAndDoubtedAloud) {
  tests::WalkOptions dance;
  dance.motion = "dance";
  write_walk(scratch.path("dance.npz"), dance);
  MotionBlender blender;
  EXPECT_TRUE(blender.make(recipe({walk(), run()})).warnings.empty());
  const BlendedMotion unlike = blender.make(recipe({walk() + "@0:30", scratch.path("dance.npz") + "@60:90"}));
  ASSERT_EQ(unlike.warnings.size(), 1u);
  EXPECT_NE(unlike.warnings[0].find("walk.npz and dance.npz are unlike each other"), std::string::npos)
      << unlike.warnings[0];
  EXPECT_GT(unlike.motion.doubt_m[10], 0.03f);
}

TEST_F(Blends, AFileThatHasChangedIsToldInASentence) {
  const BlendRecipe blend = recipe({walk(), run()});
  MotionBlender blender;
  EXPECT_TRUE(blender.make(blend).warnings.empty());
  tests::WalkOptions slower;
  slower.fps = 24;
  write_walk(run(), slower);
  std::filesystem::last_write_time(run(),
                                   std::filesystem::file_time_type::clock::now() + std::chrono::hours(1));
  const BlendedMotion made = blender.make(blend);
  ASSERT_EQ(made.warnings.size(), 1u);
  EXPECT_EQ(made.warnings[0], run() + ": has changed since it was blended, so the blend is another");
}

TEST_F(Blends, WhatCannotBeBlendedIsToldInASentence) {
  MotionBlender blender;
  const BlendRecipe gone = recipe({walk(), run()});
  std::filesystem::remove(run());
  EXPECT_EQ(failure([&] { blender.make(gone); }), run() + ": is blended, but there is no such file any more");
  const std::string still = scratch.path("still.npz");
  EXPECT_EQ(failure([&] {
              blender.make(recipe({walk(), still}));
            }),
            still + ": nobody steps in it: tell the frames that are blended, still.npz@FIRST:LAST");
  EXPECT_EQ(failure([&] {
              blender.make(recipe({walk(), walk() + "@10:9000"}));
            }),
            walk() + ": has no frames 10 to 9000, its last is 149");
  EXPECT_NE(failure([&] { blender.make(recipe({walk()})); }).find("2 to 4 movements, not of 1"),
            std::string::npos);
  tests::write_text(scratch.path("words.bvh"), "no motion");
  EXPECT_NE(failure([&] { blender.make(recipe({walk(), scratch.path("words.bvh")})); }), "");
  tests::write_target(scratch.path("person.obj"));
  EXPECT_EQ(failure([&] {
              blender.make(recipe({walk(), scratch.path("person.obj")}));
            }),
            scratch.path("person.obj") + ": is no skeletal motion, only these are blended");
}

TEST_F(Blends, WithoutTheLearnedCoderAreStraightAndSaySo) {
  MotionBlender failing([]() -> std::shared_ptr<MotionCoder> { throw Error("w.weights: is missing"); });
  const BlendRecipe blend = recipe({walk(), run()}, "paper");
  const BlendedMotion made = failing.make(blend);
  EXPECT_EQ(made.coder, "plain");
  ASSERT_EQ(made.warnings.size(), 1u);
  EXPECT_EQ(made.warnings[0], "w.weights: is missing: the blend goes straight from pose to pose");
  EXPECT_EQ(failing.make(blend).warnings.size(), 1u) << "each time";
  MotionBlender another([]() -> std::shared_ptr<MotionCoder> { return make_knot_coder(); });
  EXPECT_NE(failure([&] { another.make(blend); }).find("by the coder 'paper', there is only 'plain'"),
            std::string::npos);
}

TEST_F(Blends, OptionsOfOtherSourcesAreRefused) {
  const SourceOptions blend = blended_source(recipe({walk(), run()}));
  const auto refusal = [&](const std::function<void(SourceOptions&)>& change) {
    SourceOptions other = blend;
    change(other);
    return failure([&] { check_source_options(other); });
  };
  EXPECT_EQ(refusal([](SourceOptions&) {}), "");
  EXPECT_NE(refusal([](SourceOptions& o) { o.clip = "walk"; }), "");
  EXPECT_NE(refusal([](SourceOptions& o) { o.bones["head"] = "Head"; }), "");
  EXPECT_NE(refusal([](SourceOptions& o) { o.as_scan = true; }), "");
  EXPECT_NE(refusal([](SourceOptions& o) { o.follow = true; }), "");
  EXPECT_NE(refusal([](SourceOptions& o) { o.motion = "a.npz"; }), "");
  EXPECT_NE(refusal([](SourceOptions& o) { o.person = "2"; }), "");
  EXPECT_NE(refusal([](SourceOptions& o) { o.times = "t.csv"; }), "");
  EXPECT_NE(refusal([](SourceOptions& o) { o.edits.largest_cluster = true; }), "");
}

TEST_F(Blends, PartsAreReadFromWordsAndWrittenAgain) {
  const BlendPart whole = blend_part(walk()), some = blend_part(walk() + "@10:45");
  EXPECT_FALSE(whole.range);
  EXPECT_EQ(in_words(whole), walk());
  EXPECT_EQ(some.range->first, 10);
  EXPECT_EQ(some.range->last, 45);
  EXPECT_EQ(in_words(some), walk() + "@10:45");
  EXPECT_EQ(some.checksum.size(), 16u);
  const std::string at = scratch.path("me@home.npz");
  write_walk(at);
  EXPECT_EQ(blend_part(at).path, at);
  EXPECT_EQ(blend_part(at + "@1:2").path, at);
  for (const char* bad : {"@10", "@a:b", "@5:5", "@9:3", "@-1:3", "@1:2:3", "@1.5:3", "@"})
    EXPECT_NE(failure([&] { blend_part(walk() + bad); }).find("is not FILE@FIRST:LAST"), std::string::npos)
        << bad;
  EXPECT_EQ(failure([&] { blend_part("/no/such.bvh"); }), "/no/such.bvh: there is no such file");
  EXPECT_EQ(failure([&] { blend_part("/no/such.bvh@1:2"); }), "/no/such.bvh: there is no such file");
}

TEST(BlendWeights, SumToOneAndKeepTheirProportions) {
  BlendRecipe blend;
  blend.parts.resize(3);
  set_weights(blend_weights("1,2,1"), blend);
  EXPECT_FLOAT_EQ(blend.parts[1].weight, 0.5f);
  set_share(1, 0, blend);
  EXPECT_FLOAT_EQ(blend.parts[0].weight, 0.5f);
  set_share(0, 0.2f, blend);
  EXPECT_FLOAT_EQ(blend.parts[2].weight, 0.8f);
  EXPECT_FLOAT_EQ(blend.parts[1].weight, 0);
  set_share(2, 1, blend);
  set_share(2, 0.5f, blend);
  EXPECT_FLOAT_EQ(blend.parts[0].weight, 0.25f) << "nothing was left to keep in proportion";
  EXPECT_THROW(set_share(3, 0.5f, blend), Error);
  EXPECT_THROW(set_weights({1, 1}, blend), Error);
  for (const char* bad : {"", "a,b", "1,-1", "0,0", "1,,2", "nan,1", "1;2"})
    EXPECT_THROW(blend_weights(bad), Error) << bad;
}

}  // namespace
}  // namespace understudy::app
