#include "app/run/scene_cases.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "app/run/case_writer.hpp"
#include "app/run/interrupt.hpp"
#include "app/run/report.hpp"
#include "retarget/base/rng.hpp"
#include "retarget/body/depth_cameras.hpp"
#include "retarget/body/furniture.hpp"
#include "retarget/body/joint_sight.hpp"
#include "retarget/math/directions.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/metrics/scene_score.hpp"
#include "retarget/skeleton/limb_ik.hpp"

namespace understudy::app {
namespace {

namespace fs = std::filesystem;

constexpr int kSceneFrames = 40;
constexpr float kPersonalSpace = 0.35f, kNearlyTouch = 0.22f;  // metres between joints of two people
constexpr float kTouch = 0.05f;                                // metres between points of their skins
constexpr int kTouchPoints = 1500;                             // of a skin, that are looked at
constexpr float kRoom = 3.4f, kWallHeight = 2.4f;              // metres, half its width
constexpr float kOutliers = 0.003f;                            // share of points
constexpr float kFieldOfView = 0.75f;

enum class Meeting { Apart, Cross, ShakeHands, Leave };
constexpr std::array<const char*, 4> kMeetings = {"apart", "cross", "handshake", "leave"};

struct ScenePlan {
  int people;
  Meeting meeting;
  int cameras;
};
constexpr std::array<ScenePlan, 12> kScenes = {{{1, Meeting::Apart, 3},
                                                {2, Meeting::Cross, 4},
                                                {2, Meeting::ShakeHands, 4},
                                                {4, Meeting::Cross, 6},
                                                {3, Meeting::Leave, 4},
                                                {2, Meeting::Cross, 1},
                                                {1, Meeting::Leave, 1},
                                                {3, Meeting::ShakeHands, 10},
                                                {2, Meeting::ShakeHands, 1},
                                                {3, Meeting::Cross, 3},
                                                {4, Meeting::Apart, 2},
                                                {4, Meeting::ShakeHands, 3}}};

// Where people are.

Vec3 level(const Vec3& x) {
  return {x.x(), 0, x.z()};
}

/// Turned so that the path leads along the heading (or, on the spot, the body faces there), and moved so that
/// the pelvis is above a place in one frame.
void send(Actor& actor, float heading, size_t frame, const Vec3& place) {
  const std::vector<Pose>& poses = actor.poses();
  const Vec3 way = level(poses.back().root - poses.front().root);
  const float now = way.norm() > 0.3f ? std::atan2(way.x(), way.z()) : heading_of(poses[frame].local[Pelvis]);
  actor.move(heading - now, Vec3::Zero());
  actor.move(0, place - level(actor.poses()[frame].root));
}

/// Farther and farther out until nobody is near.
void stand_apart(Actor& actor, const std::vector<Actor>& others, size_t number, Rng& rng) {
  const float angle = 2.4f * static_cast<float>(number) + rng.uniform(-0.3f, 0.3f);
  send(actor, rng.uniform(-kPi, kPi), actor.frames() / 2, Vec3::Zero());
  const Vec3 way = rotation_about_y(angle).col(2);
  const auto is_near = [&](const Actor& other) { return nearest_joints(actor, other) < kPersonalSpace; };
  actor.move(0, others.empty() ? Vec3::Zero() : Vec3(0.8f * way));
  while (std::any_of(others.begin(), others.end(), is_near)) actor.move(0, 0.1f * way);
}

/// Both over the middle: towards one another and past, or one shortly after the other.
void cross_paths(Actor& one, Actor& other, Rng& rng) {
  const size_t frames = one.frames();
  const float heading = rng.uniform(-kPi, kPi);
  const bool meet = rng.chance(0.5f);
  const Vec3 along = rotation_about_y(heading).col(2), across = rotation_about_y(heading + kPi / 2).col(2);
  send(one, heading, meet ? frames / 2 : frames / 3, Vec3::Zero());
  send(other, heading + (meet ? kPi : kPi / 2), meet ? frames / 2 : 2 * frames / 3, Vec3::Zero());
  const Vec3 aside = meet ? across : Vec3(-along);
  for (int step = 0; step < 40 && nearest_joints(one, other) < kNearlyTouch; ++step)
    other.move(0, 0.05f * aside);
}

/// Stands, arms hanging, and moves a quarter as much as it did.
std::vector<Pose> calmed(const Joints& rest, const std::vector<Pose>& poses) {
  constexpr float kLeft = 0.25f, kHang = 1.2f, kElbow = 0.35f;
  std::vector<Pose> calm = poses;
  for (Pose& pose : calm) {
    pose.local[Pelvis] = rotation_about_y(-heading_of(pose.local[Pelvis])) * pose.local[Pelvis];
    pose.root = poses[0].root + kLeft * (pose.root - poses[0].root);
    for (Mat3& R : pose.local)
      R = Eigen::Quaternionf::Identity().slerp(kLeft, Eigen::Quaternionf(R)).toRotationMatrix();
    for (const float side : {1.0f, -1.0f}) {
      const int left = side > 0 ? 0 : 1;
      Mat3& shoulder = pose.local[LeftShoulder + left];
      shoulder = rotation_from_axis_angle(Vec3(0, 0, -side * kHang)) * shoulder;
      pose.local[LeftElbow + left] = rotation_from_axis_angle(Vec3(0, -side * kElbow, 0));
    }
    pose.root.y() -= forward_kinematics(rest, pose).joints.col(1).minCoeff();  // stands also where it jumped
  }
  return calm;
}

/// Reaches out, holds, lets go: 0 .. 1.
float reached(size_t frame, size_t frames) {
  const float at = static_cast<float>(frame) / static_cast<float>(frames);
  return std::clamp(std::min((at - 0.1f) / 0.25f, (0.95f - at) / 0.2f), 0.0f, 1.0f);
}

/// Opposite one another, right hand in right hand for half of the time.
void shake_hands(Actor& one, Actor& other) {
  constexpr float kWristToPalm = 0.07f, kShoulderAside = 0.17f, kStretched = 0.92f;
  const float height = 0.5f * (one.poses()[0].root.y() + other.poses()[0].root.y()) + 0.2f;
  for (Actor* actor : {&one, &other}) {
    actor->perform(calmed(actor->body().joints, actor->poses()));
    const float side = actor == &one ? -1.0f : 1.0f;  // of the place where the hands meet
    const Joints joints = actor->skeleton(0).joints;
    const float rise = joints(RightShoulder, 1) - height, arm = kStretched * arm_length(joints);
    const float away = std::sqrt(std::max(0.05f, arm * arm - kShoulderAside * kShoulderAside - rise * rise));
    actor->move(-side * kPi / 2, Vec3::Zero());
    actor->move(0, Vec3(side * (away + kWristToPalm), 0, 0) - level(actor->poses()[0].root));
    std::vector<Pose> poses = actor->poses();
    for (size_t t = 0; t < poses.size(); ++t) {
      const float share = reached(t, poses.size());
      const Vec3 shaken(side * kWristToPalm, height + 0.03f * std::sin(0.9f * static_cast<float>(t)), 0);
      const Vec3 wrist = actor->skeleton(t).joints.row(RightWrist).transpose();
      place_wrist(actor->body().joints, 1, wrist + share * (shaken - wrist), poses[t]);
      if (share > 0) poses[t].local[RightWrist] = Mat3::Identity();  // the hand goes on as the forearm does
    }
    actor->perform(std::move(poses));
  }
}

// What stands about.

struct Room {
  std::vector<Furniture> things;                  // the ground and walls among them
  std::vector<float> density;                     // of each, points to the square metre
  float ball_radius = 0;                          // 0: there is no ball
  Vec3 ball = Vec3::Zero(), roll = Vec3::Zero();  // in the first frame, and more with each

  void add(Furniture thing, float points_per_square_metre) {
    things.push_back(std::move(thing));
    density.push_back(points_per_square_metre);
  }
  SeenSurface surface(size_t frame, float dense, Rng& rng) const;
};

SeenSurface Room::surface(size_t frame, float dense, Rng& rng) const {
  std::vector<Vec3> now;
  for (size_t i = 0; i < things.size(); ++i) {
    const float area = surface_of(things[i]);
    for (auto left = static_cast<int>(dense * density[i] * area); left > 0; --left)
      now.push_back(sample_of(things[i], area, rng));
  }
  std::vector<Vec3> beside = now;
  const float ball_area = 4 * kPi * ball_radius * ball_radius;
  for (auto left = static_cast<int>(dense * 800 * ball_area); left > 0; --left) {
    now.push_back(ball + static_cast<float>(frame) * roll + ball_radius * random_direction(rng));
    beside.push_back(now.back() + roll);
  }
  return {rows_of(now), rows_of(beside), std::vector<float>(now.size(), 1)};
}

Furniture slab(const Vec3& centre, const Vec3& half) {
  return {{centre, half, Mat3::Identity()}};
}

/// Whether somebody comes within so many metres of a thing, or it stands before a camera.
bool is_in_the_way(const Furniture& thing, const std::vector<Actor>& actors, const DepthRig& rig,
                   float margin) {
  for (Block block : thing) {
    block.half.array() += margin;
    for (const DepthCamera& camera : rig.cameras)
      if (block.blocks(camera.eye, camera.at)) return true;
    for (const Actor& actor : actors)
      for (size_t t = 0; t < actor.frames(); t += 3) {
        const Joints joints = actor.skeleton(t).joints;
        for (const auto& joint : joints.rowwise())
          if ((block.own(joint.transpose()).cwiseAbs() - block.half).maxCoeff() < 0) return true;
      }
  }
  return false;
}

/// Walls where no camera looks through them.
void add_walls(Room& room, const DepthRig& rig, Rng& rng) {
  const int first = rng.below(4);
  for (int k = 0; k < 2; ++k) {
    const Vec3 way = rotation_about_y(0.5f * kPi * static_cast<float>((first + k) % 4)).col(2);
    const auto is_beyond = [&](const DepthCamera& camera) { return camera.eye.dot(way) > kRoom - 0.2f; };
    if (std::any_of(rig.cameras.begin(), rig.cameras.end(), is_beyond)) continue;
    const Vec3 half = kRoom * (Vec3(1, 0, 1) - way.cwiseAbs());
    room.add(slab(kRoom * way + Vec3(0, 0.5f * kWallHeight, 0), half + Vec3(0, 0.5f * kWallHeight, 0)), 50);
  }
}

Room furnish(const std::vector<Actor>& actors, const DepthRig& rig, Rng& rng) {
  Room room;
  room.add(slab(Vec3::Zero(), Vec3(kRoom, 0, kRoom)), 70);
  add_walls(room, rig, rng);
  const std::array<Furniture, 3> furniture = {table(1, rng), chair(0.45f, rng), cabinet(rng)};
  const size_t missing = rng.below(3);
  for (size_t i = 0; i < furniture.size(); ++i)
    for (int tries = 0; i != missing && tries < 60; ++tries) {
      Furniture thing = furniture[i];
      const Vec3 foot = rng.uniform(0.8f, 2.2f) * rotation_about_y(rng.uniform(-kPi, kPi)).col(2);
      place(thing, foot, rotation_about_y(rng.uniform(-kPi, kPi)));
      if (is_in_the_way(thing, actors, rig, 0.15f)) continue;
      room.add(std::move(thing), 400);
      break;
    }
  for (int tries = 0; tries < 60 && room.ball_radius == 0; ++tries) {
    const float radius = rng.uniform(0.09f, 0.2f);
    const Vec3 from =
        rng.uniform(0.5f, 1.6f) * rotation_about_y(rng.uniform(-kPi, kPi)).col(2) + Vec3(0, radius, 0);
    const Vec3 roll = 0.02f * rotation_about_y(rng.uniform(-kPi, kPi)).col(2);
    const Vec3 middle = from + 0.5f * kSceneFrames * roll;
    const Furniture path =
        slab(middle, Vec3(std::abs(middle.x() - from.x()), 0, std::abs(middle.z() - from.z())) +
                         Vec3::Constant(radius));
    if (is_in_the_way(path, actors, rig, 0.12f)) continue;
    room.ball_radius = radius, room.ball = from, room.roll = roll;
  }
  return room;
}

// What cameras see of it.

/// A scene and all that is the same in its frames.
struct StagedScene {
  ScenePlan plan;
  std::vector<Actor> actors;
  std::vector<DarkCloth> dark;  // of each
  DepthRig rig;
  Room room;

  /// Who leaves is away in the middle of the time.
  bool is_away(size_t person, size_t frame) const {
    const size_t frames = actors[0].frames();
    return plan.meeting == Meeting::Leave && person == 0 && frame >= 3 * frames / 10 &&
           frame < 6 * frames / 10;
  }
};

StagedScene make_scene(const ScenePlan& plan, size_t number, const Cast& cast, int frames, Rng& rng) {
  StagedScene scene{plan, {}, {}, {}, {}};
  const std::vector<size_t> walks = cast.longest_paths(frames);
  for (int i = 0; i < plan.people; ++i) {
    const bool is_walker = plan.meeting == Meeting::Cross && i < 2;
    const size_t motion =
        is_walker ? walks[(number + i) % std::min<size_t>(3, walks.size())] : number + 3 * i;
    Actor actor = cast.actor(4 * number + i, motion, frames, rng);
    const bool meets = i < 2 && (plan.meeting == Meeting::Cross || plan.meeting == Meeting::ShakeHands);
    if (!meets) stand_apart(actor, scene.actors, i, rng);
    scene.actors.push_back(std::move(actor));
    if (i == 1 && plan.meeting == Meeting::Cross) cross_paths(scene.actors[0], scene.actors[1], rng);
    if (i == 1 && plan.meeting == Meeting::ShakeHands) shake_hands(scene.actors[0], scene.actors[1]);
    scene.dark.push_back(random_dark_cloth(rng));
  }
  const float nearest = plan.cameras == 1 ? 2.6f : 2.0f;
  scene.rig = random_depth_rig({plan.cameras, Vec3(0, 0.9f, 0), nearest, 2.9f}, rng);
  for (DepthCamera& camera : scene.rig.cameras) camera.widest = kFieldOfView;
  scene.room = furnish(scene.actors, scene.rig, rng);
  return scene;
}

void append(SeenSurface& to, const SeenSurface& more) {
  const Eigen::Index before = to.now.rows(), count = more.now.rows();
  for (Points SeenSurface::*points : {&SeenSurface::now, &SeenSurface::beside}) {
    (to.*points).conservativeResize(before + count, 3);
    (to.*points).bottomRows(count) = more.*points;
  }
  to.returned.insert(to.returned.end(), more.returned.begin(), more.returned.end());
}

/// One frame before the cameras: the people in order, then the room.
struct StagedFrame {
  std::vector<LabelledPoints> skins;  // of all, the one who is away, too
  std::vector<SeenSurface> people;    // of each
  std::vector<int> owners, parts;     // of the points of `all`
  SeenSurface all;
};

StagedFrame set_up(const StagedScene& scene, size_t frame, int skin_points, Rng& rng) {
  StagedFrame made;
  for (size_t p = 0; p < scene.actors.size(); ++p) {
    const Actor& actor = scene.actors[p];
    made.skins.push_back(actor.surface(frame, skin_points, rng));
    const LabelledPoints& skin = made.skins.back();
    made.people.push_back(surface_to_see(skin, scene.dark[p], actor.skeleton(frame), actor.beside(frame)));
    if (scene.is_away(p, frame)) continue;
    append(made.all, made.people.back());
    made.owners.insert(made.owners.end(), skin.parts.size(), static_cast<int>(p));
    made.parts.insert(made.parts.end(), skin.parts.begin(), skin.parts.end());
  }
  append(made.all, scene.room.surface(frame, static_cast<float>(skin_points) / 5000, rng));
  made.owners.resize(made.all.now.rows(), kNobodysPoint);
  made.parts.resize(made.all.now.rows(), kNoBody);
  return made;
}

/// A scan with an owner and a part for each point, in random order.
struct OwnedScan {
  LabelledPoints cloud;
  std::vector<int> owners;
};

OwnedScan scanned(const StagedFrame& frame, const std::vector<DepthReading>& readings, float share,
                  Rng& rng) {
  std::vector<DepthReading> kept;
  for (const DepthReading& reading : readings)
    if (rng.chance(share)) kept.push_back(reading);
  for (size_t i = 0; i + 1 < kept.size(); ++i)
    std::swap(kept[i], kept[i + rng.below(static_cast<int>(kept.size() - i))]);
  OwnedScan scan;
  std::vector<Vec3> places;
  for (const DepthReading& reading : kept) {
    const int owner = frame.owners[reading.row];
    places.push_back(reading.place);
    scan.owners.push_back(owner >= 0 && reading.flies() ? kUndecidedPoint : owner);
    scan.cloud.parts.push_back(scan.owners.back() >= 0 ? frame.parts[reading.row] : kNoBody);
  }
  scan.cloud.points = rows_of(places);
  return scan;
}

/// Some points are anywhere.
void stray(OwnedScan& scan, Rng& rng) {
  for (Eigen::Index i = 0; i < scan.cloud.points.rows(); ++i) {
    if (!rng.chance(kOutliers)) continue;
    scan.cloud.points.row(i) << rng.uniform(-kRoom, kRoom), rng.uniform(0, kWallHeight),
        rng.uniform(-kRoom, kRoom);
    scan.owners[i] = kNobodysPoint;
    scan.cloud.parts[i] = kNoBody;
  }
}

/// What a scan shows of somebody in it.
TruePerson true_person(const StagedScene& scene, const StagedFrame& frame, const OwnedScan& scan,
                       size_t person, size_t at) {
  const PosedSkeleton posed = scene.actors[person].skeleton(at);
  LabelledPoints own = scan.cloud;
  keep_where(own, [&](int i) { return scan.owners[i] == static_cast<int>(person); });
  TruePerson truth{posed.joints};
  if (own.points.rows() > 0)
    truth.seen = joint_sight(surface_about_joints(frame.skins[person], posed), own, posed).seen;
  for (size_t other = 0; other < scene.actors.size(); ++other) {
    if (other == person || scene.is_away(person, at) || scene.is_away(other, at)) continue;
    const auto few = [](const Points& points) {
      return points.topRows(std::min<Eigen::Index>(points.rows(), kTouchPoints));
    };
    const Points mine = few(frame.skins[person].points), theirs = few(frame.skins[other].points);
    const IntMatrix nearest = nearest_neighbours(theirs, mine, 1);
    for (Eigen::Index i = 0; i < mine.rows() && !truth.touches; ++i)
      truth.touches = (mine.row(i) - theirs.row(nearest(i, 0))).norm() < kTouch;
  }
  return truth;
}

/// All frames of a truth.
struct StagedTruth {
  int64_t frames = 0, people;
  NpyArray joints, seen, touch, counts, owners;

  void add(const TruePeople& frame) {
    ++frames;
    for (const TruePerson& person : frame.people) {
      joints.values.insert(joints.values.end(), person.joints.data(), person.joints.data() + 3 * kJointCount);
      seen.values.insert(seen.values.end(), person.seen.data(), person.seen.data() + kJointCount);
      touch.values.push_back(person.touches ? 1.0f : 0.0f);
    }
    counts.values.push_back(static_cast<float>(frame.owners.size()));
    owners.values.insert(owners.values.end(), frame.owners.begin(), frame.owners.end());
  }
  Npz arrays() {
    joints.shape = {frames, people, kJointCount, 3};
    seen.shape = {frames, people, kJointCount};
    touch.shape = {frames, people};
    counts.shape = {frames};
    owners.shape = {owners.size()};
    return {{"people_joints", joints},
            {"people_seen", seen},
            {"people_touch", touch},
            {"point_counts", counts},
            {"point_owners", owners}};
  }
};

/// Scans of one person alone by the scene's cameras.
void write_alone(const StagedScene& scene, const StagedFrame& frame, float share, const fs::path& folder,
                 size_t at, Rng& rng) {
  for (size_t p = 0; p < scene.actors.size(); ++p) {
    StagedFrame alone;
    alone.owners.assign(frame.skins[p].parts.size(), 0);
    alone.parts = frame.skins[p].parts;
    const std::vector<DepthReading> readings = depth_readings(frame.people[p], scene.rig.cameras, rng);
    write_scan(folder / ("alone_" + std::to_string(p)), at,
               scanned(alone, readings, share, rng).cloud.points);
  }
}

void make_scene_case(const ScenePlan& plan, size_t number, const SuiteOptions& options, const Cast& cast,
                     const std::string& name) {
  Rng rng(case_seed(name, options.seed));
  const fs::path folder = fs::path(options.out) / name;
  const StagedScene scene = make_scene(plan, number, cast, std::min(options.frames, kSceneFrames), rng);
  make_scan_folder(folder / "source");
  Json alone = Json::array();
  for (int p = 0; p < plan.people; ++p) {
    alone.push_back("alone_" + std::to_string(p));
    make_scan_folder(folder / alone.back().get<std::string>());
  }
  const float wanted = 0.5f * static_cast<float>(options.points * (1 + plan.people));
  StagedTruth truth{0, plan.people, {}, {}, {}, {}, {}};
  for (size_t t = 0; t < scene.actors[0].frames(); ++t) {
    const StagedFrame frame = set_up(scene, t, 5 * options.points / 8, rng);
    const std::vector<DepthReading> readings = depth_readings(frame.all, scene.rig.cameras, rng);
    const float share =
        wanted * rng.uniform(0.9f, 1.1f) / static_cast<float>(std::max<size_t>(readings.size(), 1));
    OwnedScan scan = scanned(frame, readings, share, rng);
    stray(scan, rng);
    TruePeople people{scan.owners, {}};
    for (size_t p = 0; p < scene.actors.size(); ++p)
      people.people.push_back(true_person(scene, frame, scan, p, t));
    truth.add(people);
    write_scan(folder / "source", t, scan.cloud.points);
    write_alone(scene, frame, share, folder, t, rng);
  }
  write_npz((folder / "truth.npz").string(), truth.arrays());
  write_json(
      (folder / "case.json").string(),
      {{"fps", 30},
       {"source", "source"},
       {"truth", "truth.npz"},
       {"alone", alone},
       {"tags", {"scenes", std::to_string(plan.people), kMeetings[static_cast<size_t>(plan.meeting)]}}});
}

}  // namespace

int make_scene_cases(const SuiteOptions& options, const Cast& cast,
                     const std::function<void(const std::string&)>& done) {
  const size_t count = options.cases > 0 ? std::min<size_t>(options.cases, kScenes.size()) : kScenes.size();
  for (size_t i = 0; i < count; ++i) {
    const ScenePlan& plan = kScenes[i];
    const std::string name = std::to_string(plan.people) + "p_" +
                             kMeetings[static_cast<size_t>(plan.meeting)] + "_" +
                             std::to_string(plan.cameras) + "c";
    check_interrupt("before case " + name);
    make_scene_case(plan, i, options, cast, name);
    done(name);
  }
  return static_cast<int>(count);
}

}  // namespace understudy::app
