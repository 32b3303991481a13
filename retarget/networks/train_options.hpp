// What can be trained, without LibTorch: the options of each network's training, and the call that runs one.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <variant>
#include <vector>

namespace understudy::nn {

/// Options of every training.
struct TrainOptions {
  std::string data, out;  ///< the data folder; the weights file, its checkpoint (OUT.checkpoint) beside it
  std::string curve;      ///< learning curve CSV; empty: out + ".csv"
  double minutes = 0;     ///< stop after this long; 0: no limit
  int64_t samples = 0;    ///< stop after this many in total; 0: no limit
  int threads = 0;        ///< 0: the network's own
  int batch = 0;          ///< 0: the network's own
  uint64_t seed = 1;
  std::string device = "cpu";       ///< "cpu" or "cuda"
  std::string init;                 ///< weights to start from
  double keep = 0;                  ///< share of those in the weights that are written
  std::function<bool()> cancelled;  ///< asked between steps; the checkpoint is written before it stops
};

struct SkeletonTrainOptions : TrainOptions {
  static constexpr const char* kNetwork = "skeleton";
  std::string form = "dense";  ///< "dense" or "paper"
  std::string poses = "all";   ///< "all", or "rest": people in T-pose, for the joints of targets
};

/// Kinds of parts, in the order of PartKind.
constexpr std::array<const char*, 5> kPartKindNames = {"hand", "head", "foot", "arm", "leg"};

struct PartTrainOptions : TrainOptions {
  static constexpr const char* kNetwork = "part";
  std::vector<std::string> kinds;  ///< of kPartKindNames; empty: all. The others stay as they are
};

struct MotionTrainOptions : TrainOptions {
  static constexpr const char* kNetwork = "motion";
  std::string rotation = "6d";  ///< how the network puts rotations, "6d" or "quaternion"
  bool rotation_loss = true;    ///< L_rot of paper 1, eq. 2
  int context = 30;             ///< frames of a sequence; the paper's 30
};

struct DeformationTrainOptions : TrainOptions {
  static constexpr const char* kNetwork = "deformation";
};

struct MotionSpaceTrainOptions : TrainOptions {
  static constexpr const char* kNetwork = "motion-space";
  std::string form = "space";  ///< "space": windows with holes; "paper": steps as codes
  // Of "paper" alone:
  int code = 64;        ///< numbers of a code
  double kl = 0.01;     ///< weight of the Kullback-Leibler divergence, w_KL
  bool surface = true;  ///< phase 2, on vertices
  double clips = 1;     ///< share of the clips that is learned from
  bool told = true;     ///< the decoder is told the body
  bool timed = true;    ///< movements have their times
};

struct StyleTrainOptions : TrainOptions {
  static constexpr const char* kNetwork = "style";
  std::string from,
      to;  ///< folders in the data folder: clips in the manner to be left, and in that to be taken
  std::string convolution = "joint";  ///< "joint": kernels of each joint's own; "overall": over all joints
  std::string joints = "all";         ///< "all", "trunk-and-limbs", "upper-body": see fitted_joints()
  double cycle = 15, coherence = 30, transition = 0;  ///< weights of the losses, paper 4's
  bool velocities = false;                      ///< coherence is judged against the source's, not by itself
  double smooth = 1.5;                          ///< frames, the Gaussian that both domains go through
  std::string licence, attribution, made_from;  ///< written into the weights
};

/// `data` holds a folder of clips for each style, named so.
struct StyleJudgeTrainOptions : TrainOptions {
  static constexpr const char* kNetwork = "style-judge";
  std::string contents =
      "actions";      ///< "actions": a clip's first; "descriptions": the sentence it comes with
  bool legs = false;  ///< hips and knees are judged too, which a depth camera does not see
  std::string licence, attribution, made_from;  ///< written into the weights
};

/// Where there is neither minutes nor samples, as many samples as the shipped weights saw.
struct ProportionsTrainOptions : TrainOptions {
  static constexpr const char* kNetwork = "proportions";
};

/// Zheng et al. (2021); what is not the paper's own choice is for tables 2 to 4.
struct Pose2dTrainOptions : TrainOptions {
  static constexpr const char* kNetwork = "pose2d";
  std::string links = "virtual";  ///< "virtual" (L_VL), "ranking", or "none"
  bool angles = true;             ///< L_AL
  std::string pairs = "all";      ///< between which points links are: "all", "bones", "ends" (bones and ends)
  int directions = 4;             ///< that links are seen along, evenly over half a turn
  double first_direction = 0;     ///< degrees
};

/// Where there is neither minutes nor samples, as many samples as the shipped weights saw.
struct LifterTrainOptions : TrainOptions {
  static constexpr const char* kNetwork = "lifter";
  int frames = 40;  ///< of a sequence
};

/// The gains of PointFilter. Beside the weights it writes their numbers as point_gains.inc, for the source
/// code.
struct PointsTrainOptions : TrainOptions {
  static constexpr const char* kNetwork = "points";
};

/// Losses of paper 3 that may be left out, for its ablations.
struct MarionetteLosses {
  bool volume = true;              ///< L_vol
  bool trajectory = true;          ///< L_traj
  bool local = true, time = true;  ///< L_local, L_time
};

/// The network of slots: keypoints and tree of a kind, from scans alone.
struct MarionetteSlotsTrainOptions : TrainOptions {
  static constexpr const char* kNetwork = "marionette-slots";
  std::string kind = "person";  ///< of kBodyKinds
  MarionetteLosses losses;
};

/// Paper 3's own detector of keypoints; what is not the paper's choice is for its ablations.
struct MarionettePaperTrainOptions : TrainOptions {
  static constexpr const char* kNetwork = "marionette-paper";
  std::string kind = "person";  ///< of kBodyKinds
  int grid = 32;                ///< cells along an edge, a multiple of 32; the paper's 64
  int width = 32;               ///< channels of the features, a multiple of 16; the paper's 128
  MarionetteLosses losses;
};

/// The dynamics of bodies of one kind. Where there is neither minutes nor samples, as many samples as the
/// shipped weights saw.
struct MarionetteDynamicsTrainOptions : TrainOptions {
  static constexpr const char* kNetwork = "marionette-dynamics";
  std::string kind = "person";     ///< one of kBodyKinds
  std::string form = "rotations";  ///< or "positions", the paper's baseline
};

using AnyTrainOptions =
    std::variant<SkeletonTrainOptions, PartTrainOptions, MotionTrainOptions, DeformationTrainOptions,
                 MotionSpaceTrainOptions, StyleTrainOptions, StyleJudgeTrainOptions, ProportionsTrainOptions,
                 Pose2dTrainOptions, LifterTrainOptions, PointsTrainOptions, MarionetteSlotsTrainOptions,
                 MarionettePaperTrainOptions, MarionetteDynamicsTrainOptions>;

/// Trains until the minutes or samples are used up, going on from the checkpoint where there is one. 0 when
/// it came to the end, 1 when it was cancelled. Throws Error.
int train(const AnyTrainOptions& options);

}  // namespace understudy::nn
