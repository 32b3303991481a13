#include "retarget/keypoints/keypoint_reader.hpp"

#include "retarget/formats/npz.hpp"
#include "tests/retarget/keypoints/support.hpp"

namespace understudy {
namespace {

using namespace test;

const Vec2 kFoot(300, 400);
FlatPose anna() {
  return standing(kFoot, 300);
}
/// What a format without feet, neck or mid-hip leaves of a pose.
FlatPose through(const char* layout, const FlatPose& pose) {
  return pose_of_layout(*layout_named(layout), points_in_layout(*layout_named(layout), pose));
}
KeypointReading parsed(const Json& json, const KeypointReaderOptions& options = {}) {
  return parse_keypoints(json.dump(), "x.json", options);
}
KeypointReaderOptions on_canvas(int width, int height) {
  KeypointReaderOptions options;
  options.canvas = {width, height};
  return options;
}
const FlatPose& first_pose(const KeypointReading& reading) {
  return reading.performing().poses.front().pose;
}

TEST(KeypointReader, ReadsOneOpenPoseFrame) {
  const KeypointReading reading = parsed(openpose_frame({anna()}));
  EXPECT_EQ(first_pose(reading), anna());
  EXPECT_EQ(reading.layout, "BODY_25");
  EXPECT_EQ(reading.canvas, (Canvas{512, 512}));
  EXPECT_TRUE(reading.canvas_is_guessed);
  EXPECT_TRUE(tells(reading, "x.json: OpenPose frame, BODY_25, 1 frame, 1 person")) << all_told(reading);
  EXPECT_TRUE(tells(reading, "30 frames/s assumed"));
}

TEST(KeypointReader, ReadsAFolderOfOpenPoseFramesByTheirNumbers) {
  const TempFolder folder;
  for (const int number : {10, 9, 11})
    folder.write("poses/walk_" + std::to_string(number) + "_keypoints.json",
                 openpose_frame({standing(kFoot + Vec2(static_cast<float>(number), 0), 300)}).dump());
  folder.write("poses/readme.txt", "not a pose");
  KeypointReaderOptions options;
  options.fps = 25;
  const KeypointReading reading = read_keypoints(folder.path("poses"), options);
  ASSERT_EQ(reading.frames.size(), 3u);
  EXPECT_EQ(reading.frames[0].number, 9);
  ASSERT_EQ(reading.tracks.size(), 1u);
  EXPECT_EQ(reading.tracks[0].poses[2].pose, standing(kFoot + Vec2(11, 0), 300));
  EXPECT_EQ(reading.format, "OpenPose folder");
  EXPECT_DOUBLE_EQ(reading.seconds(2), 2 / 25.0);
}

TEST(KeypointReader, ReadsOldOpenPoseKeysAndTheLayoutsOf18And15Points) {
  const Json old = {{"people", {{{"pose_keypoints", listed(anna(), "openpose18")}}}}};
  EXPECT_EQ(first_pose(parsed(old)), through("openpose18", anna()));
  const KeypointReading mpi = parsed(openpose_frame({anna()}, "mpi15"));
  EXPECT_EQ(mpi.layout, "MPI-15");
  EXPECT_EQ(first_pose(mpi), through("mpi15", anna()));
}

TEST(KeypointReader, KeepsHandsAndFace) {
  const FlatPose pose = with_hands_and_face(anna());
  Json json = openpose_frame({pose});
  json["people"][0]["hand_left_keypoints_2d"] = flat_list(pose.left_hand);
  json["people"][0]["hand_right_keypoints_2d"] = flat_list(pose.right_hand);
  json["people"][0]["face_keypoints_2d"] = flat_list(pose.face);
  EXPECT_EQ(first_pose(parsed(json)), pose);
}

TEST(KeypointReader, ZerosAreMissingNeverAPlace) {
  FlatPose pose = anna();
  pose.forget(body25::LeftWrist);
  const KeypointReading reading = parsed(openpose_frame({pose}));
  EXPECT_FALSE(first_pose(reading).has(body25::LeftWrist));
  Json corner = openpose_frame({anna()});
  corner["people"][0]["pose_keypoints_2d"][21] = 0;
  corner["people"][0]["pose_keypoints_2d"][22] = 0;
  EXPECT_FALSE(first_pose(parsed(corner)).has(body25::LeftWrist)) << "whatever its confidence";
}

TEST(KeypointReader, TakesFractionsOfTheCanvasAsOpenPoseScalesThem) {
  const auto scaled = [](bool is_signed) {
    FlatPose pose = anna();
    for (int p = 0; p < kBodyPoints; ++p) {
      Vec2 place = pose.at(p).cwiseQuotient(Vec2(639, 479));
      if (is_signed) place = 2 * place.array() - 1;
      pose.set(p, place, 0.5f);
    }
    return openpose_frame({pose});
  };
  for (const bool is_signed : {false, true}) {
    const KeypointReading reading = parsed(scaled(is_signed), on_canvas(640, 480));
    EXPECT_LT(farthest_apart(first_pose(reading), anna()), 1e-3f);
    EXPECT_TRUE(
        tells(reading, is_signed ? "places are in -1..1 of the canvas" : "places are in 0..1 of the canvas"));
    EXPECT_EQ(error_of([&] { parsed(scaled(is_signed)); }),
              std::string("x.json: frame 0: places are in ") + (is_signed ? "-1..1" : "0..1") +
                  " of a canvas of unknown size; say its width and height (--canvas 1280x720)");
  }
}

TEST(KeypointReader, ReadsControlNetListsWithTheirCanvasAndNulls) {
  Json list = Json::array({controlnet_frame({anna()}), controlnet_frame({}), controlnet_frame({anna()})});
  list[0]["people"][0]["face_keypoints_2d"] = nullptr;
  list[0]["people"][0]["hand_left_keypoints_2d"] = nullptr;
  list[1]["people"] = nullptr;
  const KeypointReading reading = parsed(list);
  EXPECT_EQ(reading.format, "ControlNet list");
  EXPECT_EQ(reading.layout, "OpenPose-18");
  EXPECT_EQ(reading.canvas, (Canvas{640, 480}));
  EXPECT_EQ(reading.frames.size(), 3u);
  ASSERT_EQ(reading.tracks.size(), 1u);
  EXPECT_EQ(reading.tracks[0].at(1), nullptr);
  EXPECT_EQ(*reading.tracks[0].at(2), through("openpose18", anna()));
}

TEST(KeypointReader, TakesControlNetsFractionsOfTheWholeCanvas) {
  FlatPose pose = anna();
  for (int p = 0; p < kBodyPoints; ++p) pose.set(p, pose.at(p).cwiseQuotient(Vec2(640, 480)), 1);
  EXPECT_LT(farthest_apart(first_pose(parsed(controlnet_frame({pose}))), through("openpose18", anna())),
            1e-3f);
}

Json coco_annotations() {
  Json points = listed(anna(), "coco17");
  for (size_t i = 2; i < points.size(); i += 3) points[i] = i == 2 ? 1 : 2;
  points[5 * 3 + 2] = 0;
  return {{"images",
           {{{"id", 7}, {"file_name", "b_10.jpg"}, {"width", 640}, {"height", 480}},
            {{"id", 8}, {"file_name", "b_9.jpg"}, {"width", 640}, {"height", 480}}}},
          {"annotations", {{{"image_id", 7}, {"category_id", 1}, {"keypoints", points}, {"track_id", 5}}}},
          {"categories", {{{"id", 1}, {"name", "person"}, {"keypoints", layout_named("coco17")->points}}}}};
}

TEST(KeypointReader, ReadsCocoAnnotationsInTheOrderOfTheFileNames) {
  const KeypointReading reading = parsed(coco_annotations());
  ASSERT_EQ(reading.frames.size(), 2u);
  EXPECT_EQ(reading.frames[0].number, 9);
  EXPECT_EQ(reading.tracks[0].person, 5);
  EXPECT_EQ(reading.tracks[0].poses[0].frame, 1);
  EXPECT_EQ(reading.canvas, (Canvas{640, 480}));
  const FlatPose& pose = first_pose(reading);
  EXPECT_EQ(pose.confidence(body25::Nose), 0.5f) << "marked where it is hidden";
  EXPECT_EQ(pose.confidence(body25::LeftKnee), 1);
  EXPECT_FALSE(pose.has(body25::LeftShoulder)) << "not marked, whatever its place";
}

TEST(KeypointReader, ReadsCocoResultsWithoutTheFramesInWhichNobodyIs) {
  const auto person = [](const Json& id) {
    return Json{
        {"image_id", id}, {"category_id", 1}, {"keypoints", listed(anna(), "coco17")}, {"score", 0.75}};
  };
  const KeypointReading reading = parsed({person(3), person(4), person(6)});
  ASSERT_EQ(reading.frames.size(), 4u);
  EXPECT_EQ(reading.frames[2].problem, "x.json: frame 5 is missing");
  EXPECT_TRUE(tells(reading, "1 frame is missing"));
  EXPECT_EQ(first_pose(reading), through("coco17", anna())) << "Detectron2 has taken its half pixel off";
  EXPECT_EQ(reading.tracks[0].poses[0].score, 0.75f);
  const KeypointReading alpha = parsed({person("12.jpg"), person("2.jpg"), person("3.jpg")});
  EXPECT_EQ(alpha.format, "AlphaPose results");
  EXPECT_EQ(alpha.frames[0].number, 2);
}

TEST(KeypointReader, ReadsAlphaPosesOtherFormats) {
  Json cmu, open;
  cmu["1.jpg"] = {{"version", 0.1}, {"bodies", {{{"joints", listed(anna(), "openpose18")}}}}};
  cmu["2.jpg"] = cmu["1.jpg"];
  open["1.jpg"] = openpose_frame({anna()}, "openpose18");
  EXPECT_EQ(parsed(cmu).tracks[0].poses.size(), 2u);
  EXPECT_EQ(first_pose(parsed(cmu)), through("openpose18", anna()));
  EXPECT_EQ(first_pose(parsed(open)), through("openpose18", anna()));
}

Json mmpose_instance() {
  Json places = Json::array(), scores = Json::array();
  const FlatPoints points = points_in_layout(*layout_named("coco17"), anna());
  for (int i = 0; i < 17; ++i) {
    places.push_back({points(i, 0), points(i, 1)});
    scores.push_back(points(i, 2));
  }
  return {{"keypoints", places}, {"keypoint_scores", scores}, {"bbox", {{1, 2, 3, 4}}}, {"bbox_score", 0.9}};
}

TEST(KeypointReader, ReadsBothDumpsOfMmpose) {
  Json names;
  for (int i = 0; i < 17; ++i)
    names[std::to_string(i)] = layout_named("coco17")->points[static_cast<size_t>(i)];
  const Json demo = {
      {"meta_info", {{"keypoint_id2name", names}, {"sigmas", {{"__ndarray__", {0.1}}, {"dtype", "f"}}}}},
      {"instance_info",
       {{{"frame_id", 1}, {"instances", {mmpose_instance()}}},
        {{"frame_id", 2}, {"instances", Json::array()}}}}};
  const Json inferencer = {{{"frame_id", 0}, {"instances", {mmpose_instance()}}}};
  const Json picture = Json::array({mmpose_instance()});
  for (const Json& json : {demo, inferencer, picture}) {
    EXPECT_EQ(first_pose(parsed(json)), through("coco17", anna()));
    EXPECT_EQ(parsed(json).layout, "COCO-17");
  }
  EXPECT_EQ(parsed(demo).frames[0].number, 1);
  EXPECT_EQ(parsed(demo).frames.size(), 2u);
}

Json landmarks(bool as_logits = false) {
  Json list = Json::array();
  const FlatPoints points = points_in_layout(*layout_named("mediapipe33"), anna());
  for (int i = 0; i < 33; ++i)
    list.push_back({{"x", points(i, 0) / 640},
                    {"y", points(i, 1) / 480},
                    {"z", 0.1},
                    {"visibility", as_logits ? 5.0 : 0.5}});
  return list;
}

TEST(KeypointReader, ReadsMediaPipesLandmarksInAnyWrapping) {
  const std::vector<Json> wrapped = {
      landmarks(),
      Json::array({landmarks(), nullptr, landmarks()}),
      Json::array({Json::array({landmarks()}), Json::array()}),
      {{"frames", {{{"frame", 0}, {"landmarks", landmarks()}}, {{"frame", 2}, {"landmarks", landmarks()}}}}},
      Json::array({Json{{"pose_landmarks", {landmarks()}}}}),
      Json::array({Json{{"poseLandmarks", landmarks()}}, Json{{"poseLandmarks", nullptr}}}),
      {{"pose_landmarks", {{"landmark", landmarks()}}}}};
  for (const Json& json : wrapped) {
    const KeypointReading reading = parsed(json, on_canvas(640, 480));
    FlatPose expected = through("mediapipe33", anna());
    for (int p = 0; p < kBodyPoints; ++p)
      if (!first_pose(reading).has(p)) expected.forget(p);
    EXPECT_LT(farthest_apart(first_pose(reading), expected), 1e-2f) << json.dump().substr(0, 60);
    EXPECT_TRUE(first_pose(reading).has(body25::MidHip));
    EXPECT_EQ(reading.layout, "MediaPipe-33");
  }
  EXPECT_EQ(parsed(wrapped[3], on_canvas(640, 480)).frames.size(), 2u) << "every other frame is usual here";
}

TEST(KeypointReader, AsksForTheCanvasThatMediaPipeDoesNotTell) {
  EXPECT_TRUE(
      contains(error_of([] { parsed(landmarks()); }), "say its width and height (--canvas 1280x720)"));
}

TEST(KeypointReader, TakesVisibilitiesOutsideOf0To1ForLogits) {
  const KeypointReading reading = parsed(landmarks(/*as_logits=*/true), on_canvas(640, 480));
  EXPECT_NEAR(first_pose(reading).confidence(body25::LeftKnee), 1 / (1 + std::exp(-5.0f)), 1e-6f);
  EXPECT_TRUE(tells(reading, "logits"));
}

TEST(KeypointReader, ReadsArrays) {
  const TempFolder folder;
  NpyArray array;
  for (int t = 0; t < 4; ++t) {
    const FlatPoints points =
        points_in_layout(*layout_named("coco17"), standing(kFoot + Vec2(static_cast<float>(t), 0), 300));
    array.values.insert(array.values.end(), points.data(), points.data() + points.size());
  }
  const auto read = [&](const std::vector<int64_t>& shape) {
    array.shape = shape;
    write_npz(folder.path("poses.npz"), {{"anything", array}});
    return read_keypoints(folder.path("poses.npz"));
  };
  EXPECT_EQ(read({4, 17, 3}).frames.size(), 4u);
  EXPECT_EQ(read({2, 2, 17, 3}).tracks.size(), 2u);
  EXPECT_EQ(first_pose(read({4, 17, 3})), through("coco17", anna()));
  array.values.resize(17 * 2 * 4);
  EXPECT_EQ(first_pose(read({4, 17, 2})).confidence(body25::Nose), 1);
}

TEST(KeypointReader, AsksWhich15PointsAnArrayHas) {
  const TempFolder folder;
  NpyArray array;
  array.shape = {1, 15, 3};
  const FlatPoints points = points_in_layout(*layout_named("body15"), anna());
  array.values.assign(points.data(), points.data() + points.size());
  write_npz(folder.path("p.npz"), {{"keypoints", array}});
  EXPECT_TRUE(contains(error_of([&] { read_keypoints(folder.path("p.npz")); }), "--layout mpi15 or body15"));
  KeypointReaderOptions options;
  options.layout = "body15";
  EXPECT_EQ(first_pose(read_keypoints(folder.path("p.npz"), options)), through("body15", anna()));
}

TEST(KeypointReader, WhatIsAskedForComesBeforeWhatTheFileSays) {
  KeypointReaderOptions options = on_canvas(1024, 768);
  options.fps = 50;
  options.person = 2;
  const KeypointReading reading =
      parsed({controlnet_frame({anna(), standing({500, 300}, 100)}), controlnet_frame({anna()})}, options);
  EXPECT_EQ(reading.canvas, (Canvas{1024, 768}));
  EXPECT_EQ(reading.fps, 50);
  EXPECT_EQ(reading.performing().person, 2);
  options.person = 9;
  EXPECT_EQ(error_of([&] { parsed(Json::array({controlnet_frame({anna()})}), options); }),
            "x.json: there is no person 9, only 1");
  options.layout = "octopus8";
  EXPECT_TRUE(contains(error_of([&] { parsed(openpose_frame({anna()}), options); }),
                       "there is no layout 'octopus8'"));
}

TEST(KeypointReader, TakesTheCanvasFromThePictureBeside) {
  const TempFolder folder;
  folder.write("anna_keypoints.json", openpose_frame({anna()}).dump());
  folder.write("anna.png", "a picture");
  KeypointReaderOptions options;
  options.picture_size = [](const std::string& path) {
    return contains(path, "anna.png") ? std::optional<Canvas>({800, 600}) : std::nullopt;
  };
  const KeypointReading reading = read_keypoints(folder.path("anna_keypoints.json"), options);
  EXPECT_EQ(reading.canvas, (Canvas{800, 600}));
  EXPECT_FALSE(reading.canvas_is_guessed);
  EXPECT_TRUE(tells(reading, "canvas 800 x 600, that of " + folder.path("anna.png"))) << all_told(reading);
}

TEST(KeypointReader, TellsPosesFromOtherFilesByTheirBeginning) {
  const TempFolder folder;
  EXPECT_TRUE(looks_like_keypoints(folder.write("poses/a_1.json", openpose_frame({anna()}).dump())));
  EXPECT_TRUE(looks_like_keypoints(folder.path("poses")));
  EXPECT_TRUE(looks_like_keypoints(folder.write("mp.json", Json::array({landmarks()}).dump())));
  EXPECT_FALSE(looks_like_keypoints(folder.write("doc.json", R"({"understudy": 1})")));
  EXPECT_FALSE(looks_like_keypoints(folder.write("mesh.ply", ascii_ply())));
  EXPECT_FALSE(looks_like_keypoints(folder.path("nothing")));
  write_keypoint_npz(folder.path("p.npz"), reading_of({{anna()}}));
  EXPECT_TRUE(looks_like_keypoints(folder.path("p.npz")));
}

TEST(KeypointReader, NoPoseDependsOnALaterFrame) {
  Json list = Json::array();
  for (int i = 0; i < 12; ++i)
    list.push_back(controlnet_frame(
        {standing(kFoot + Vec2(3.0f * static_cast<float>(i), 0), 300), standing({90, 400}, 200)}));
  const KeypointReading whole = parsed(list);
  for (size_t cut : {1u, 5u, 11u}) {
    Json changed = list;
    for (size_t i = cut; i < changed.size(); ++i) changed[i] = openpose_frame({standing({0.5f, 0.9f}, 0.5f)});
    const KeypointReading part = parsed(changed);
    for (const KeypointTrack& track : part.tracks)
      for (const TrackedPose& pose : track.poses)
        if (pose.frame < static_cast<int64_t>(cut)) {
          ASSERT_GE(whole.track_of(track.person), 0);
          EXPECT_EQ(*whole.tracks[static_cast<size_t>(whole.track_of(track.person))].at(pose.frame),
                    pose.pose);
        }
  }
}

}  // namespace
}  // namespace understudy
