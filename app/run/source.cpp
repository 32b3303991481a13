#include "app/run/source.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "app/run/interrupt.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/base/log.hpp"
#include "retarget/base/text.hpp"
#include "retarget/body/body.hpp"
#include "retarget/formats/bytes.hpp"
#include "retarget/formats/mesh_reader.hpp"
#include "retarget/formats/npz.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/motion/clip.hpp"
#include "retarget/motion/read_motion.hpp"
#include "retarget/motion/skeletal_motion.hpp"

namespace understudy::app {
namespace {

constexpr Eigen::Index kFewestPoints = 32;  // that units, axes and floor are read from

std::string in_words(double fps) {
  return printed("%g frames/s", fps);
}

/// Scans on disk, brought into the program's units and axes as decided from the first usable frame.
class ScanFiles final : public Source {
 public:
  explicit ScanFiles(const SourceOptions& options)
      : Source(options.fps > 0 ? options.fps : 30),
        scans_(options.path, scan_options(options)),
        import_(options.import),
        quiet_(options.quiet) {
    if (options.quiet) return;
    log::info(options.path + ": " + in_words(fps()) + (options.fps > 0 ? "" : " assumed (--fps changes it)"));
  }

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
      decision_ = decide_import(frame->mesh, import_);
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

 private:
  static ScanSourceOptions scan_options(const SourceOptions& options) {
    ScanSourceOptions result;
    result.follow = options.follow;
    result.cancelled = interrupted;
    return result;
  }

  ScanSource scans_;
  ImportOptions import_;
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

/// Frames of an animation: it counts them.
class AnimatedSource : public Source {
 public:
  AnimatedSource(double fps, int64_t frames) : Source(fps), count_(frames) {}
  std::optional<SourceFrame> next() final {
    if (at_ >= count_) return std::nullopt;
    SourceFrame frame = frame_at(at_);
    frame.number = at_++;
    return frame;
  }
  void seek(int64_t frame) final {
    US_CHECK(frame >= 0 && frame < count_, "there is no frame ", frame, " in a motion of ", count_);
    at_ = frame;
  }
  std::optional<int64_t> count() const final { return count_; }

 private:
  virtual SourceFrame frame_at(int64_t frame) const = 0;

  int64_t count_, at_ = 0;
};

/// An SMPL-format body that performs an AMASS-format motion.
class PerformingBody final : public AnimatedSource {
 public:
  PerformingBody(const SourceOptions& options, Motion motion)
      : AnimatedSource(options.fps > 0 ? options.fps : motion.fps, ssize(motion.poses)),
        motion_(std::move(motion)) {
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
  SourceFrame frame_at(int64_t frame) const override {
    SourceFrame out;
    out.mesh = posed(frame);
    decision_.apply(out.mesh);
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
  ShapedBody person_;
  ImportDecision decision_;
};

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
  SourceFrame frame_at(int64_t frame) const override {
    SourceFrame out;
    out.mesh = motion_.surface(frame);
    out.skeleton = motion_.skeleton(frame);
    return out;
  }

  SkeletalMotion motion_;
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
    if (!options.quiet)
      log::info(options.path + ": its surface is sampled as a scan, " + in_words(fps()) + ", " +
                decision_.sentence);
  }

 private:
  SourceFrame frame_at(int64_t frame) const override {
    constexpr int kPoints = 8000;
    Rng rng(static_cast<uint64_t>(frame) + 1);
    SourceFrame out;
    out.mesh.vertices = decision_.apply(sample_points(surface(frame), kPoints, rng));
    return out;
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
};

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
}

void check_skeletal_options(const SourceOptions& options) {
  US_CHECK(options.edits.empty(), options.path, ": is a skeletal motion, only scans are cleaned (", kCleaning,
           ")");
  US_CHECK(options.betas.empty(), options.path,
           ": is a skeletal motion, only an SMPL-format body that performs a --motion takes --source-betas");
  US_CHECK(!options.follow, options.path, ": is a skeletal motion, only a folder of scans can be followed");
}

std::unique_ptr<Source> as_scan(Character character, const SourceOptions& options) {
  US_CHECK(character.vertex_count() > 0, options.path, ": has no surface to sample as a scan");
  const int clip = chosen_clip(character, options.clip);
  const ClipTimes times = clip_times(character, clip, options.fps);
  return std::make_unique<ScannedCharacter>(std::move(character), clip, times, options);
}

std::unique_ptr<Source> as_skeleton(const Character& character, const SourceOptions& options) {
  SkeletalMotionOptions how;
  how.clip = options.clip;
  how.bones = options.bones;
  how.import = options.import;
  how.fps = options.fps;
  return std::make_unique<MovingSkeleton>(SkeletalMotion(character, how), options);
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

void check_source_options(const SourceOptions& options) {
  if (!options.motion.empty()) return check_body_options(options);
  if (is_motion_file(options.path)) return check_skeletal_options(options);
  std::error_code failed;
  const bool is_folder = std::filesystem::is_directory(options.path, failed);
  if (is_folder || !may_hold_motion(options.path)) check_scan_options(options);
}

std::unique_ptr<Source> open_source(const SourceOptions& options) {
  check_source_options(options);
  if (!options.motion.empty())
    return std::make_unique<PerformingBody>(options, read_amass_motion(options.motion));
  std::optional<Character> moving = read_motion(options.path);
  if (!moving) {
    check_scan_options(options);
    return std::make_unique<ScanFiles>(options);
  }
  check_skeletal_options(options);
  return options.as_scan ? as_scan(std::move(*moving), options) : as_skeleton(*moving, options);
}

}  // namespace understudy::app
