#include "app/run/source.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "app/run/animated_source.hpp"
#include "app/run/completed_source.hpp"
#include "app/run/interrupt.hpp"
#include "app/run/keypoint_source.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/base/log.hpp"
#include "retarget/base/text.hpp"
#include "retarget/body/body.hpp"
#include "retarget/formats/bytes.hpp"
#include "retarget/formats/mesh_reader.hpp"
#include "retarget/formats/npz.hpp"
#include "retarget/geometry/ground_finder.hpp"
#include "retarget/live/live_frames.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/motion/clip.hpp"
#include "retarget/motion/read_motion.hpp"
#include "retarget/motion/skeletal_motion.hpp"
#include "retarget/pipeline/observer.hpp"
#include "retarget/pipeline/unseen_limbs.hpp"

namespace understudy::app {
namespace {

constexpr Eigen::Index kFewestPoints = 32;  // that units, axes and floor are read from

std::string in_words(double fps) {
  return printed("%g frames/s", fps);
}

/// A ground that is seen tells floor and tilt better than the lowest points do. Whether one is.
bool stand_on_ground(ImportDecision& decision, Mesh first) {
  constexpr float kLevel = 0.9998f, kOwnZero_m = 0.02f, kLeast_m2 = 1;  // cosine of 1 degree
  decision.apply(first);
  const std::optional<Ground> ground = GroundFinder().push(Cells(first, 0.05f));
  if (!ground || ground->area_m2 < kLeast_m2) return false;  // a patch under somebody tells little of tilt
  const FloorPlane& plane = ground->plane;
  const bool is_tilted = plane.normal.y() < kLevel;
  // Both are of the file's own zero, in metres.
  const float floor = plane.height_m + plane.normal.y() * decision.floor;
  if (!is_tilted && std::abs(plane.height_m) <= kOwnZero_m) return true;
  if (is_tilted)
    decision.axes = Eigen::Quaternionf::FromTwoVectors(plane.normal, Vec3::UnitY()) * decision.axes;
  decision.floor = std::abs(floor) <= kOwnZero_m && !is_tilted ? 0.0f : floor;
  decision.sentence += printed(", ground seen at %.2f m", static_cast<double>(decision.floor));
  if (is_tilted)
    decision.sentence +=
        printed(", tilted by %.1f degrees",
                static_cast<double>(std::acos(std::min(1.0f, plane.normal.y())) * 180 / kPi));
  return true;
}

FeetCheck feet_check(const std::function<Extraction(const Mesh&)>& look) {
  return [look](const Mesh& upright) -> std::optional<UnseenFeet> {
    Observation seen;
    try {
      static_cast<Extraction&>(seen) = look(upright);
    } catch (const Error&) {  // who looks at the frame next tells
      return std::nullopt;
    }
    const bool is_person = refusal(seen).empty() && !is_implausible(seen);
    const auto half = is_person ? half_body(seen) : std::nullopt;
    if (!half) return std::nullopt;
    return UnseenFeet{half->stature, half->floor, half->upright};
  };
}

/// Scans on disk, brought into the program's units and axes as decided from the first usable frame.
class ScanFiles final : public Source {
 public:
  explicit ScanFiles(const SourceOptions& options)
      : ScanFiles(options, is_live(options) ? ScanSource(live_frames(live_options(options)))
                                            : ScanSource(options.path, scan_options(options))) {}

  std::optional<SourceFrame> next() override {
    std::optional<ScanFrame> scan = scans_.next();
    std::optional<SourceFrame> frame;
    if (scan) frame.emplace(SourceFrame{std::move(*scan), std::nullopt});
    if (frame) undecided_ = std::max(undecided_, decision_ ? 0 : ++at_);
    if (!frame || !frame->usable) return frame;
    const Eigen::Index points = finite_count(frame->mesh.vertices);
    if (!decision_ && points < kFewestPoints) {
      frame->usable = false;
      frame->problem = frame->path + ": " + std::to_string(points) + " points are too few for a body";
      return frame;
    }
    if (!decision_) {
      decision_ = decide_scan_import(frame->mesh, forced_, look_ ? feet_check(look_) : FeetCheck());
      if (!decision_) {
        frame->usable = false;
        frame->problem = frame->path + ": shows a ground or walls, and nobody";
        return frame;
      }
      const bool grounded = !forced_.floor && stand_on_ground(*decision_, frame->mesh);
      if (grounded && decision_->again) decision_->again->floor.reset();  // it will be seen again
      set_import(decision_->again);
      set_decision(decision_->sentence, decision_->to_file());
      if (!quiet_) log::info(frame->path + ": " + decision_->sentence);
    }
    decision_->apply(frame->mesh);
    return frame;
  }

  /// What was read before decides, as if it was read in order; nothing behind the frame is looked at.
  void seek(int64_t frame) override {
    if (!decision_ && undecided_ < frame) {
      scans_.seek(at_ = undecided_);
      while (!decision_ && at_ < frame && next()) {
      }
    }
    scans_.seek(at_ = frame);
  }
  std::optional<int64_t> count() const override { return scans_.count(); }
  void set_look(const std::function<Extraction(const Mesh&)>& look) override { look_ = look; }

 private:
  ScanFiles(const SourceOptions& options, ScanSource scans)
      : Source(rate_of(scans, options)),
        scans_(std::move(scans)),
        forced_(options.import),
        quiet_(options.quiet) {
    if (options.quiet) return;
    const char* const source = options.fps > 0 ? "" : " assumed (--fps changes it)";
    log::info(scans_.clock() ? scans_.clock()->sentence : options.path + ": " + in_words(fps()) + source);
  }
  static double rate_of(const ScanSource& scans, const SourceOptions& options) {
    if (scans.clock()) return scans.clock()->fps;
    return options.fps > 0 ? options.fps : 30;
  }
  static ScanSourceOptions scan_options(const SourceOptions& options) {
    ScanSourceOptions result;
    result.follow = options.follow;
    result.times = options.times;
    result.fps = options.fps;
    result.cancelled = interrupted;
    if (options.wait_s > 0) result.timeout_s = options.wait_s;
    return result;
  }
  static LiveOptions live_options(const SourceOptions& options) {
    LiveOptions result;
    result.address = options.path;
    if (!options.stream.empty()) result.format = stream_format(options.stream);
    if (options.fps > 0) result.fps = options.fps;
    result.wait_s = options.wait_s;
    result.cancelled = interrupted;
    return result;
  }

  ScanSource scans_;
  ImportOptions forced_;
  std::function<Extraction(const Mesh&)> look_;
  bool quiet_;
  std::optional<ImportDecision> decision_;
  int64_t at_ = 0, undecided_ = 0;  // the next frame, and up to which none decides; while nothing is decided
};

/// The shape parameters in a motion's file, as many as the body takes; none when all are zero.
Eigen::VectorXf betas_in(const std::string& motion, Eigen::Index most) {
  const Npz npz = read_npz(motion);
  const auto found = npz.find("betas");
  if (found == npz.end()) return {};
  const Eigen::Index count =
      std::min<Eigen::Index>(most, static_cast<Eigen::Index>(found->second.values.size()));
  const Eigen::VectorXf betas = Eigen::Map<const Eigen::VectorXf>(found->second.values.data(), count);
  return betas.isZero() ? Eigen::VectorXf() : betas;
}

Eigen::VectorXf as_vector(const std::vector<float>& values) {
  return Eigen::Map<const Eigen::VectorXf>(values.data(), values.size());
}

/// The skeleton as a similarity of the world moves it.
Extraction moved(Extraction skeleton, const Eigen::Matrix4d& by) {
  const Eigen::Matrix4f m = by.cast<float>();
  const Mat3 turn = nearest_rotation(m.topLeftCorner<3, 3>());
  skeleton.joints = (skeleton.joints * m.topLeftCorner<3, 3>().transpose()).rowwise() +
                    m.topRightCorner<3, 1>().transpose();
  for (Mat3& R : *skeleton.global) R = turn * R;
  return skeleton;
}

/// An SMPL-format body that performs an AMASS-format motion.
class PerformingBody final : public AnimatedSource {
 public:
  PerformingBody(const SourceOptions& options, Motion motion)
      : AnimatedSource(options.fps > 0 ? options.fps : motion.fps, ssize(motion.poses)),
        motion_(std::move(motion)),
        tells_truth_(options.truth) {
    const Body body = read_smpl_body(options.path);
    US_CHECK(!motion_.poses.empty(), options.motion, ": has no frames");
    const bool turned = turn_upright(motion_, options.import.up);
    const Eigen::VectorXf own = betas_in(options.motion, body.shape_dirs.cols());
    person_ = body.shaped(options.betas.empty() ? own : as_vector(options.betas));
    place(body, options.betas.empty());
    const Mesh first = posed(0);
    ImportOptions import = options.import;
    import.units = "m";
    import.up = "y";
    decision_ = decide_import(first, import);
    set_decision(decision_.sentence, decision_.to_file());
    if (!options.quiet)
      log::info(options.motion + ": " + in_words(fps()) + ", " + (turned ? "z up, turned to y up" : "y up"));
  }

 private:
  SourceFrame frame_at(int64_t frame) override {
    SourceFrame out;
    out.mesh = posed(frame);
    decision_.apply(out.mesh);
    if (!tells_truth_) return out;
    const PosedSkeleton bones = forward_kinematics(person_.joints, motion_.poses[frame]);
    Extraction truth;
    truth.joints = bones.joints;
    truth.global = bones.global;
    out.truth = moved(std::move(truth), to_file().inverse());
    return out;
  }

  /// A motion without shape of its own was recorded for the mean person: another's path is as much longer as
  /// the legs. The file's translation moves the whole body, the pelvis from where it is in the T-pose.
  void place(const Body& body, bool own_shape) {
    const Joints mean = body.shaped(Eigen::VectorXf()).joints;
    const float scale = own_shape ? 1.0f : leg_length(person_.joints) / leg_length(mean);
    for (Pose& pose : motion_.poses) pose.root = (pose.root + mean.row(Pelvis).transpose()) * scale;
  }

  Mesh posed(size_t t) const {
    Mesh mesh;
    mesh.vertices = posed_vertices(person_, motion_.poses[t]);
    mesh.faces = person_.faces;
    return mesh;
  }

  Motion motion_;
  bool tells_truth_;
  ShapedBody person_;
  ImportDecision decision_;
};

SkeletalMotionOptions skeletal_options(const SourceOptions& options) {
  SkeletalMotionOptions how;
  how.clip = options.clip;
  how.bones = options.bones;
  how.import = options.import;
  how.fps = options.fps;
  return how;
}

/// A skeleton that moves.
class MovingSkeleton final : public AnimatedSource {
 public:
  MovingSkeleton(SkeletalMotion motion, const SourceOptions& options)
      : AnimatedSource(motion.fps(), motion.count()), motion_(std::move(motion)) {
    set_clips(motion_.character(), motion_.clip());
    std::string notes;
    for (const std::string& note : motion_.notes()) {
      if (!options.quiet) log::info(options.path + ": " + note);
      append_item(notes, note, "; ");
    }
    set_decision(notes, motion_.to_file());
  }

 private:
  SourceFrame frame_at(int64_t frame) override {
    SourceFrame out;
    out.mesh = motion_.surface(frame);
    out.skeleton = motion_.skeleton(frame);
    return out;
  }

  SkeletalMotion motion_;
};

/// What lies between skeletal motions: made, all of it.
class BlendedSource final : public AnimatedSource {
 public:
  BlendedSource(BlendedMotion blend, const SourceOptions& options)
      : AnimatedSource(static_cast<double>(blend.motion.fps), ssize(blend.motion.poses)),
        blend_(std::move(blend)) {
    const std::string name = name_of(options);
    std::string sentence = printed("blended by the coder %s, %.2f s a cycle", blend_.coder.c_str(),
                                   static_cast<double>(blend_.seconds));
    for (const auto* notes : {&blend_.notes, &blend_.warnings})
      for (const std::string& note : *notes) append_item(sentence, note, "; ");
    set_decision(sentence, Eigen::Matrix4d::Identity());
    if (options.quiet) return;
    for (const std::string& note : blend_.notes) log::info(name + ": " + note);
    for (const std::string& warning : blend_.warnings) log::warn(name + ": " + warning);
  }

 private:
  SourceFrame frame_at(int64_t frame) override {
    const PosedSkeleton posed = forward_kinematics(blend_.rest, blend_.motion.poses[frame]);
    SourceFrame out;
    out.mesh = bone_shapes(posed.joints);
    out.skeleton = exact_extraction(posed);
    out.doubt_m = blend_.motion.doubt_m[frame];
    return out;
  }

  BlendedMotion blend_;
};

/// The surface of an animated character, sampled anew in each frame: a scan of it.
class ScannedCharacter final : public AnimatedSource {
 public:
  ScannedCharacter(Character character, int clip, const ClipTimes& times, const SourceOptions& options)
      : AnimatedSource(times.fps, times.count),
        character_(std::move(character)),
        clip_(clip),
        times_(times),
        merged_(merged_surface(character_, bind_pose(character_).vertices)),
        decision_(decide_import(surface(0), options.import)) {
    set_clips(character_, clip_);
    set_decision(decision_.sentence, decision_.to_file());
    if (options.truth) find_bones(options);
    if (!options.quiet)
      log::info(options.path + ": its surface is sampled as a scan, " + in_words(fps()) + ", " +
                decision_.sentence);
  }

 private:
  SourceFrame frame_at(int64_t frame) override {
    constexpr int kPoints = 8000;
    Rng rng(static_cast<uint64_t>(frame) + 1);
    SourceFrame out;
    out.mesh.vertices = decision_.apply(sample_points(surface(frame), kPoints, rng));
    if (bones_) out.truth = moved(bones_->skeleton(frame), to_file().inverse() * bones_->to_file());
    return out;
  }
  void find_bones(const SourceOptions& options) {
    const std::string failure = failure_of([&] { bones_.emplace(character_, skeletal_options(options)); });
    if (!failure.empty()) log::warn(options.path + ": is not judged against its bones: " + failure);
  }
  /// In the file's units and axes.
  Mesh surface(int64_t frame) const {
    Mesh mesh;
    mesh.vertices = merged_.merged(vertices_at(character_, clip_, times_.at(frame)));
    mesh.faces = merged_.mesh.faces;
    return mesh;
  }

  Character character_;
  int clip_;
  ClipTimes times_;
  MergedSurface merged_;
  ImportDecision decision_;
  std::optional<SkeletalMotion> bones_;  // none: nobody asked
};

constexpr double kFineClock = 240;  // frames/s on which scans lie that are completed: they keep their times

constexpr const char* kTimesAreFor = "a table of times (--times) is for scans";

/// What asks for bones or animations of a source that has none would go unheard.
void check_no_skeleton(const SourceOptions& options, const char* is) {
  US_CHECK(options.bones.empty(), options.path, ": ", is,
           ", it has no bones that a map (--source-map) could name");
  US_CHECK(options.clip.empty(), options.path, ": ", is, ", it has no animations to choose from (--clip)");
}

void check_scan_options(const SourceOptions& options) {
  check_no_skeleton(options, "is a scan");
  US_CHECK(options.betas.empty(), options.path,
           ": is a scan, only an SMPL-format body that performs a --motion takes --source-betas");
  US_CHECK(options.times.empty() || !options.follow, options.path,
           ": is still being written (--follow), its scans have no times yet (--times)");
  US_CHECK(options.complete == 0 || !options.follow, options.path,
           ": is still being written (--follow); what is completed (--complete) is known to its end");
  US_CHECK(options.complete == 0 || options.person.empty(), options.path,
           ": one person is completed (--complete), none can be chosen (--person)");
  US_CHECK(options.markers.empty() || options.complete > 0, options.path,
           ": markers (--markers) are for scans that are completed (--complete)");
}

void check_live_options(const SourceOptions& options) {
  US_CHECK(options.follow, options.path, ": is a live stream, which passes once; retarget takes one in");
  US_CHECK(options.motion.empty() && !options.as_scan, options.path,
           ": is a live stream of scans, there is no body or skeleton");
  US_CHECK(options.person != "all", options.path,
           ": is a live stream, one person of it is performed (--person)");
  check_scan_options(options);
}

void check_not_completed(const SourceOptions& options) {
  US_CHECK(options.complete == 0 && options.markers.empty(), options.path,
           ": is a motion already, only scans are completed (--complete, --markers)");
}

void check_body_options(const SourceOptions& options) {
  check_no_skeleton(options, "is a body that performs a motion");
  const std::string& units = options.import.units;
  US_CHECK(units.empty() || units == "auto" || units == "m", options.path,
           ": is a body in metres, other units (--units) are for scans and rigs");
  US_CHECK(!options.import.height, options.path,
           ": is a body in metres, its height follows from its shape (--source-betas)");
  US_CHECK(!options.follow, options.path,
           ": is a body that performs a motion, only a folder of scans can be followed");
  US_CHECK(options.person.empty(), options.path,
           ": is a body that performs a motion, only scans may hold several people (--person)");
  US_CHECK(options.times.empty(), options.path, ": is a body that performs a motion, ", kTimesAreFor);
  check_not_completed(options);
}

void check_skeletal_options(const SourceOptions& options) {
  US_CHECK(options.edits.empty(), options.path, ": is a skeletal motion, only scans are cleaned (", kCleaning,
           ")");
  US_CHECK(options.betas.empty(), options.path,
           ": is a skeletal motion, only an SMPL-format body that performs a --motion takes --source-betas");
  US_CHECK(!options.follow, options.path, ": is a skeletal motion, only a folder of scans can be followed");
  US_CHECK(options.person.empty(), options.path,
           ": is a skeletal motion, only scans may hold several people (--person)");
  US_CHECK(options.times.empty(), options.path, ": is a skeletal motion, ", kTimesAreFor);
  check_not_completed(options);
}

void check_blend_options(const SourceOptions& options) {
  const std::string name = name_of(options);
  check_no_skeleton(options, "is blended with other motions");
  US_CHECK(options.motion.empty() && options.betas.empty() && !options.as_scan && !options.follow, name,
           ": is a blend of skeletal motions, there is no body or scan");
  US_CHECK(options.edits.empty() && options.person.empty(), name,
           ": is a blend of skeletal motions, only scans are cleaned and hold several people");
  US_CHECK(options.times.empty(), name, ": is a blend of skeletal motions, ", kTimesAreFor);
}

std::unique_ptr<Source> as_scan(Character character, const SourceOptions& options) {
  US_CHECK(character.vertex_count() > 0, options.path, ": has no surface to sample as a scan");
  const int clip = chosen_clip(character, options.clip);
  const ClipTimes times = clip_times(character, clip, options.fps);
  return std::make_unique<ScannedCharacter>(std::move(character), clip, times, options);
}

std::unique_ptr<Source> scans_to_complete(SourceOptions options) {
  if (!options.times.empty()) options.fps = kFineClock;
  return std::make_unique<ScanFiles>(options);
}

std::unique_ptr<Source> as_skeleton(const Character& character, const SourceOptions& options) {
  return std::make_unique<MovingSkeleton>(SkeletalMotion(character, skeletal_options(options)), options);
}

}  // namespace

void Source::set_clips(const Character& character, int clip) {
  for (const CharacterAnimation& animation : character.animations)
    clips_.push_back({animation.name, static_cast<double>(animation.duration())});
  clip_ = clip;
}

void Source::set_decision(const std::string& sentence, const Eigen::Matrix4d& to_file) {
  decision_ = sentence;
  to_file_ = to_file;
}

bool turn_upright(Motion& motion, const std::string& up) {
  US_CHECK(up.empty() || up == "auto" || up == "y" || up == "z", "a motion's up is y or z, not ", up);
  const Vec3 body_up = motion.poses.empty() ? Vec3::UnitY() : Vec3(motion.poses[0].local[Pelvis].col(1));
  const bool z_up = up == "z" || (up != "y" && std::abs(body_up.z()) > std::abs(body_up.y()));
  if (!z_up) return false;
  const Mat3 turn = rotation_from_axis_angle(Vec3(-kPi / 2, 0, 0));  // z to y, y to -z
  for (Pose& pose : motion.poses) {
    pose.local[Pelvis] = turn * pose.local[Pelvis];
    pose.root = turn * pose.root;
  }
  return true;
}

SourceOptions blended_source(BlendRecipe blend) {
  SourceOptions source;
  if (!blend.parts.empty()) source.path = blend.parts.front().path;
  source.blend = std::move(blend);
  return source;
}

std::string name_of(const SourceOptions& options) {
  if (options.blend) return name_of(*options.blend);
  return file_name(options.motion.empty() ? options.path : options.motion);
}

bool is_live(const SourceOptions& options) {
  return !options.blend && is_live_address(options.path);
}

SourceOptions without_people(SourceOptions options) {
  options.person.clear();
  options.people.clear();
  return options;
}

int person_number(const std::string& person) {
  if (person.empty() || person == "best" || person == "largest" || person == "all") return 0;
  const bool digits = person.size() < 6 &&
                      std::all_of(person.begin(), person.end(), [](char c) { return c >= '0' && c <= '9'; });
  const int number = digits ? std::stoi(person) : 0;
  US_CHECK(number > 0, "--person ", person, ": must be a number from 1, largest, best or all");
  return number;
}

void check_source_options(const SourceOptions& options) {
  if (!is_live(options) && is_keypoint_source(options)) return check_keypoint_options(options);
  check_no_picture(options);
  person_number(options.person);
  if (is_live(options)) return check_live_options(options);
  US_CHECK(options.stream.empty(), options.path, ": only a live stream has a form (--stream)");
  if (options.blend) return check_blend_options(options);
  if (!options.motion.empty()) return check_body_options(options);
  if (is_motion_file(options.path)) return check_skeletal_options(options);
  std::error_code failed;
  const bool is_folder = std::filesystem::is_directory(options.path, failed);
  if (is_folder || !may_hold_motion(options.path)) check_scan_options(options);
}

std::unique_ptr<Source> open_source(const SourceOptions& options, MotionBlender* blender) {
  check_source_options(options);
  if (is_live(options)) return std::make_unique<ScanFiles>(options);
  if (is_keypoint_source(options)) return open_keypoint_source(options);
  if (options.blend) {
    MotionBlender plain;
    return std::make_unique<BlendedSource>((blender ? blender : &plain)->make(*options.blend, options.fps),
                                           options);
  }
  if (!options.motion.empty())
    return std::make_unique<PerformingBody>(options, read_amass_motion(options.motion));
  std::optional<Character> moving = read_motion(options.path);
  if (!moving) {
    check_scan_options(options);
    if (options.complete > 0) return complete_scans(scans_to_complete(options), options);
    return std::make_unique<ScanFiles>(options);
  }
  check_skeletal_options(options);
  return options.as_scan ? as_scan(std::move(*moving), options) : as_skeleton(*moving, options);
}

}  // namespace understudy::app
