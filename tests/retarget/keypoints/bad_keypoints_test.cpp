// What is wrong with a file of poses is said in one sentence that names the file; what can be used is used.
#include "retarget/formats/npz.hpp"
#include "retarget/keypoints/keypoint_filter.hpp"
#include "tests/retarget/keypoints/support.hpp"

namespace understudy {
namespace {

using namespace test;

FlatPose bob(float x = 300) {
  return standing({x, 400}, 300);
}
std::string complaint_of(const std::string& text) {
  return error_of([&] { parse_keypoints(text, "x.json"); });
}
std::string complaint_of(const Json& json) {
  return complaint_of(json.dump());
}
KeypointReading read_of(const Json& json, const KeypointReaderOptions& options = {}) {
  return parse_keypoints(json.dump(), "x.json", options);
}
/// Three good frames, the middle one replaced.
KeypointReading with_middle(const Json& middle) {
  return read_of(Json::array({controlnet_frame({bob()}), middle, controlnet_frame({bob()})}));
}

TEST(BadKeypoints, NoJson) {
  EXPECT_EQ(complaint_of(std::string("hello")), "x.json: is no JSON");
  EXPECT_EQ(complaint_of(std::string(" \n")), "x.json: is empty");
}

TEST(BadKeypoints, CutOff) {
  const std::string text = openpose_frame({bob()}).dump();
  for (size_t cut = 1; cut < text.size(); cut += 7)
    EXPECT_EQ(complaint_of(text.substr(0, cut)), "x.json: its JSON is broken or cut off");
}

TEST(BadKeypoints, NestedTooDeeply) {
  EXPECT_TRUE(
      contains(complaint_of(std::string(1000, '[')), "x.json: its JSON is nested more than 32 levels deep"));
}

TEST(BadKeypoints, JsonOfSomethingElse) {
  EXPECT_TRUE(contains(complaint_of(std::string(R"({"name": "a scene", "objects": [1, 2]})")),
                       "x.json: is JSON, but holds no poses"));
  EXPECT_EQ(complaint_of(std::string("[]")), "x.json: is empty JSON, there is nobody in it");
}

TEST(BadKeypoints, AMillionPeople) {
  std::string text = "{\"people\":[";
  for (int i = 0; i < 1000000; ++i) text += i > 0 ? ",{}" : "{}";
  EXPECT_EQ(complaint_of(text + "]}"), "x.json: frame 0 has 1000000 people, more than 200");
}

TEST(BadKeypoints, NaNIsMissing) {
  std::string text = openpose_frame({bob()}).dump();
  const size_t number = text.find('[', text.find("pose_keypoints_2d")) + 1;
  text.replace(number, text.find(',', number) - number, "NaN");
  const KeypointReading reading = parse_keypoints(text, "x.json");
  EXPECT_FALSE(reading.performing().poses[0].pose.has(body25::Nose));
  EXPECT_TRUE(tells(reading, "x.json: 1 point whose numbers are none (NaN, null), which count as missing"));
}

TEST(BadKeypoints, TextForNumbers) {
  Json json = openpose_frame({bob()});
  json["people"][0]["pose_keypoints_2d"][4] = "12.5";
  EXPECT_EQ(complaint_of(json), "x.json: frame 0: has text where numbers belong");
  json["people"][0]["pose_keypoints_2d"] = "1,2,3";
  EXPECT_EQ(complaint_of(json), "x.json: frame 0: has text where numbers belong");
}

TEST(BadKeypoints, TwentyFourOf25Points) {
  Json json = openpose_frame({bob()});
  Json& list = json["people"][0]["pose_keypoints_2d"];
  list.erase(list.begin(), list.begin() + 3);
  EXPECT_TRUE(contains(complaint_of(json),
                       "x.json: frame 0: a person has 24 points, which is no known layout (BODY_25,"));
  list.erase(list.begin());
  EXPECT_EQ(complaint_of(json), "x.json: frame 0: 71 numbers do not make points of x, y and confidence");
}

TEST(BadKeypoints, UnknownLayout) {
  const Json json = {
      {"meta_info", {{"keypoint_id2name", {{"0", "tail"}, {"1", "snout"}}}}},
      {"instance_info", {{{"frame_id", 1}, {"instances", {{{"keypoints", {{1, 2}, {3, 4}}}}}}}}}};
  EXPECT_EQ(complaint_of(json), "x.json: unknown layout, none of its 2 points is called right_shoulder");
}

TEST(BadKeypoints, NobodyAtAll) {
  EXPECT_EQ(complaint_of(Json::array({controlnet_frame({}), controlnet_frame({})})),
            "x.json: there is nobody in any of its 2 frames");
  EXPECT_EQ(complaint_of(openpose_frame({FlatPose()})), "x.json: there is nobody in any of its 1 frame");
}

TEST(BadKeypoints, OneFrameIsEnough) {
  EXPECT_EQ(read_of(openpose_frame({bob()})).frames.size(), 1u);
}

TEST(BadKeypoints, FramesMissing) {
  const TempFolder folder;
  for (const int number : {1, 2, 3, 6, 7})
    folder.write("p/f_" + std::to_string(number) + ".json", openpose_frame({bob()}).dump());
  const KeypointReading reading = read_keypoints(folder.path("p"));
  ASSERT_EQ(reading.frames.size(), 7u);
  EXPECT_EQ(reading.frames[4].problem, folder.path("p") + ": frame 5 is missing");
  EXPECT_EQ(reading.tracks[0].at(3), nullptr);
  EXPECT_EQ(*reading.tracks[0].at(5), bob());
  EXPECT_TRUE(tells(reading, ": 2 frames are missing")) << all_told(reading);
}

TEST(BadKeypoints, FramesTwice) {
  const TempFolder folder;
  for (const char* name : {"f_1", "f_2", "f_02", "f_3"})
    folder.write(std::string("p/") + name + ".json", openpose_frame({bob()}).dump());
  const KeypointReading reading = read_keypoints(folder.path("p"));
  EXPECT_EQ(reading.frames.size(), 3u);
  EXPECT_TRUE(tells(reading, "1 frame is there twice or out of order and left out, the first of them 2"));
}

TEST(BadKeypoints, NumbersThatAreNotOfFrames) {
  const auto person = [](int64_t id) {
    return Json{{"image_id", id}, {"keypoints", listed(bob(), "coco17")}};
  };
  const KeypointReading reading = read_of({person(785), person(397133), person(2147483647)});
  EXPECT_EQ(reading.frames.size(), 3u);
  EXPECT_EQ(reading.frames[2].number, 2);
  EXPECT_TRUE(tells(reading, "its numbers are not those of frames"));
}

TEST(BadKeypoints, LayoutsMixed) {
  const KeypointReading reading = with_middle(openpose_frame({bob()}, "body25"));
  EXPECT_EQ(reading.frames[1].problem,
            "x.json: frame 1: a person has 25 points, those before have 18 (OpenPose-18)");
  EXPECT_TRUE(
      tells(reading, "x.json: 1 frame cannot be used, the first: x.json: frame 1: a person has 25 points"));
  EXPECT_EQ(reading.tracks[0].poses.size(), 2u);
}

TEST(BadKeypoints, SizesMixed) {
  EXPECT_EQ(with_middle(controlnet_frame({bob()}, 320, 240)).frames[1].problem,
            "x.json: frame 1 has a canvas of 320 x 240 among others of 640 x 480");
}

TEST(BadKeypoints, OneFileOfAFolderIsBroken) {
  const TempFolder folder;
  for (const int number : {1, 2, 3})
    folder.write("p/f_" + std::to_string(number) + ".json", openpose_frame({bob()}).dump());
  const std::string bad = folder.write("p/f_2.json", R"({"people":[{"pose_keypo)");
  const KeypointReading reading = read_keypoints(folder.path("p"));
  EXPECT_EQ(reading.frames[1].problem, bad + ": its JSON is broken or cut off");
  EXPECT_EQ(reading.tracks[0].poses.size(), 2u);
  folder.write("p/f_2.json", Json::array({controlnet_frame({bob()}), controlnet_frame({bob()})}).dump());
  EXPECT_EQ(read_keypoints(folder.path("p")).frames[1].problem,
            bad + ": holds 2 frames, a file of a folder holds one");
}

TEST(BadKeypoints, FolderWithoutPoses) {
  const TempFolder folder;
  folder.write("p/a.txt", "x");
  EXPECT_EQ(error_of([&] { read_keypoints(folder.path("p")); }),
            folder.path("p") + ": has no JSON files, so no poses");
  EXPECT_TRUE(contains(error_of([&] { read_keypoints(folder.path("q")); }),
                       folder.path("q") + ": there is no such file"));
}

TEST(BadKeypoints, EveryConfidence0) {
  Json json = openpose_frame({bob()});
  Json& list = json["people"][0]["pose_keypoints_2d"];
  for (size_t i = 2; i < list.size(); i += 3) list[i] = 0;
  const KeypointReading reading = read_of(json);
  EXPECT_EQ(points_seen(reading.performing().poses[0].pose), kBodyPoints);
  EXPECT_TRUE(
      tells(reading, "x.json: no confidence is above 0 although there are places: all count as seen"));
}

TEST(BadKeypoints, ConfidenceAbove1OrBelow0) {
  Json json = openpose_frame({bob()});
  json["people"][0]["pose_keypoints_2d"][2] = 5.5;
  json["people"][0]["pose_keypoints_2d"][5] = -0.5;
  const KeypointReading reading = read_of(json);
  EXPECT_EQ(reading.performing().poses[0].pose.confidence(body25::Nose), 1);
  EXPECT_FALSE(reading.performing().poses[0].pose.has(body25::Neck));
  EXPECT_TRUE(tells(reading, "1 point of a confidence above 1 (up to 5.5")) << all_told(reading);
  EXPECT_TRUE(tells(reading, "1 point of a confidence below 0, which counts as missing"));
}

TEST(BadKeypoints, PointsOffTheCanvas) {
  const KeypointReading reading = read_of(Json::array({controlnet_frame({bob(700)})}));
  EXPECT_GT(reading.performing().poses[0].pose.at(body25::Nose).x(), 640);
  EXPECT_TRUE(tells(reading, "18 points off the canvas, which stay where they are")) << all_told(reading);
  Json json = openpose_frame({bob()});
  json["people"][0]["pose_keypoints_2d"][0] = 1e30;
  EXPECT_TRUE(tells(read_of(json), "1 point absurdly far away, which count as missing"));
}

TEST(BadKeypoints, FractionsAmongPixels) {
  Json fractions = controlnet_frame({standing({0.5f, 0.9f}, 0.6f)});
  EXPECT_EQ(with_middle(fractions).frames[1].problem,
            "x.json: frame 1: places are in 0..1, those before in pixels");
  const KeypointReading other = read_of(Json::array({fractions, controlnet_frame({bob()}), fractions}));
  EXPECT_EQ(other.frames[1].problem, "x.json: frame 1: places are in pixels, those before in 0..1");
}

TEST(BadKeypoints, PictureAndJsonOfDifferentSize) {
  const TempFolder folder;
  const std::string path = folder.write("a.json", controlnet_frame({bob()}).dump());
  folder.write("a.png", "a picture");
  KeypointReaderOptions options;
  options.picture_size = [](const std::string&) { return Canvas{100, 100}; };
  const KeypointReading reading = read_keypoints(path, options);
  EXPECT_EQ(reading.canvas, (Canvas{640, 480}));
  EXPECT_TRUE(tells(
      reading, "the picture " + folder.path("a.png") + " is 100 x 100, the canvas of the poses 640 x 480"));
}

TEST(BadKeypoints, CanvasThatIsNone) {
  EXPECT_EQ(parse_canvas("1280x720"), (Canvas{1280, 720}));
  for (const char* text : {"", "1280", "0x5", "12x-3", "99999x2", "axb", "1x2x3"})
    EXPECT_TRUE(contains(error_of([&] { parse_canvas(text); }), "a canvas is given as 1280x720")) << text;
}

TEST(BadKeypoints, AFrameThatCannotBeUsedRepeatsTheLastPose) {
  const KeypointReading reading = with_middle(controlnet_frame({bob()}, 320, 240));
  const std::vector<CleanPose> clean = clean_track(reading, 0);
  ASSERT_EQ(clean.size(), 3u);
  EXPECT_FALSE(clean[1].is_usable);
  EXPECT_EQ(clean[1].pose, clean[0].pose);
  EXPECT_EQ(clean[1].problem, reading.frames[1].problem);
  EXPECT_TRUE(clean[2].is_usable);
}

TEST(BadKeypoints, ArraysThatAreNoPoses) {
  const TempFolder folder;
  EXPECT_TRUE(contains(error_of([&] { read_keypoints(folder.write("a.npy", "\x93NUMPY\x01")); }), "a.npy: "));
  EXPECT_TRUE(contains(error_of([&] { read_keypoints(folder.write("a.npz", "PK\x03\x04")); }), "a.npz: "));
  NpyArray array;
  array.shape = {7};
  array.values.resize(7);
  write_npz(folder.path("b.npz"), {{"betas", array}});
  EXPECT_EQ(error_of([&] { read_keypoints(folder.path("b.npz")); }),
            folder.path("b.npz") + ": has no array of frames, points and 2 or 3 numbers");
}

}  // namespace
}  // namespace understudy
