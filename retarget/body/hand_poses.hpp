// Posed fingers: bones, named poses and limits of a hand file, for bodies whose hands have its vertices.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "retarget/base/rng.hpp"
#include "retarget/formats/npz.hpp"

namespace understudy {

constexpr int kHandAngles = 26, kHandJoints = 26, kFingers = 5, kFingerBones = 4;

/// Angles of thumb (6) and fingers (5 each), degrees, 0 in the T-pose's flat hand.
using HandAngles = Eigen::Matrix<float, kHandAngles, 1>;
/// A wrist, then four joints and the tip of each finger, [26, 3] metres.
using HandJointPoints = Eigen::Matrix<float, kHandJoints, 3, Eigen::RowMajor>;

/// Which vertices of a mesh are its hands'.
struct HandVertices {
  std::array<std::vector<int>, 2> rows;  ///< [H] left, right, in the hand file's order; empty: no such hands
  std::vector<int> place;  ///< [V] number in the left hand, H + number in the right, -1: neither

  bool empty() const { return place.empty(); }
};

/// A turn of part of a finger.
struct Hinge {
  int level;  ///< joint of the finger that it is about, 0: the one in the palm
  Vec3 axis;  ///< unit
  int angle;  ///< which of the angles
};
/// Of one finger, the outermost first.
using Hinges = std::vector<Hinge>;

/// Where random hands come from: numbers in 0 .. 1, normal ones, and whole ones below a count.
struct HandDraws {
  std::function<double()> uniform, normal;
  std::function<int(int)> below;
};

/// What a hand file holds. Left hands; a right one is the left one of a mirrored body.
class HandPoses {
 public:
  /// Reads a .npz: `left_idx`, `right_idx` [H], `weights` [H, 5, 4] over
  /// finger bones, `joint_reg` [26, H], `pose_angles` [P, 26] with `pose_names`, `dof_lo`, `dof_hi` [26],
  /// `thumb_nail` [3], `finger_roll` [5], and spheres (`sph_...`, `template_joints`) where overlaps are to be
  /// found. Throws Error naming the file.
  explicit HandPoses(const std::string& path);

  int vertex_count() const { return static_cast<int>(first_.size()) - 1; }  ///< H
  const std::vector<HandAngles>& poses() const { return poses_; }
  /// Throws Error for a name that the file does not have.
  const HandAngles& pose(const std::string& name) const;

  /// The hands of the body that the file is for, or of another that has the vertices of that one's hands in
  /// the same order, but for others before, between and after: dressed people. Told by skin weights, [V, 22];
  /// empty where they differ. Throws Error when the file names vertices that the body does not have.
  HandVertices vertices_of(const RowMatrix& body_weights, const RowMatrix& weights) const;

  /// Within the limits: near a pose of the file, between two, or each finger curled by itself, so that
  /// fingers do not overlap by more than 3 mm on the file's own hand.
  HandAngles sample(Rng& rng) const;
  /// The same with other random numbers.
  HandAngles sample(const HandDraws& random) const;
  /// What hands of people mostly do: flat, relaxed, gripping or closed, any pose of the file, or as sample().
  HandAngles draw(Rng& rng) const;
  /// How deep fingers overlap, metres, on the file's own hand; without spheres -1.
  float overlap(const HandAngles& angles) const;

  /// T-pose vertices [V, 3] with both hands posed (left, right); the other vertices are unchanged. Each joint
  /// bends, from the tip to the palm, by the share of its angle that the vertex's weights say, so that
  /// fingers keep their thickness.
  Points apply(const Points& vertices, const HandVertices& hands,
               const std::array<HandAngles, 2>& angles) const;

 private:
  friend class BentHands;
  /// How a vertex follows a finger.
  struct Follows {
    int finger;
    float share;                             // of the finger's motion
    std::array<float, kFingerBones> joints;  // of the angle of each joint
  };
  struct Summand {
    int joint, vertex;
    float weight;
  };
  struct Spheres {
    HandJointPoints joints;  // of the file's own hand
    Points centres;
    std::vector<int> finger, level;
    std::vector<float> radius;
    std::vector<std::array<int, 2>> pairs;
    std::vector<float> rest;  // overlap of each pair in the flat hand, metres
  };

  void read_weights(const RowMatrix& weights);
  void read_poses(const Npz& npz, const std::string& path);
  void read_spheres(const Npz& npz, const std::string& path);
  std::array<Hinges, kFingers> hinges(const HandJointPoints& joints) const;
  HandAngles near_pose(const HandAngles& pose, const HandDraws& random) const;
  HandAngles between_poses(const HandAngles& pose, const HandDraws& random) const;
  const HandAngles& any_pose(Rng& rng) const;
  const HandAngles& pose_of(const std::vector<int>& group, Rng& rng) const;

  std::string source_;
  std::array<std::vector<int>, 2> rows_;  // left, right
  std::vector<Follows> follows_;
  std::vector<int> first_;  // [H + 1] into follows_
  std::vector<Summand> joint_sum_;
  std::vector<HandAngles> poses_;
  std::vector<std::string> names_;
  std::vector<int> relaxed_, closed_;  // of poses_
  HandAngles lowest_, highest_;
  Vec3 thumb_nail_;
  std::array<float, kFingers> roll_;  // radians
  Spheres spheres_;
};

/// Both hands of one body with fingers posed; a vertex is worked out when it is asked for. The arguments must
/// outlive it.
class BentHands {
 public:
  BentHands(const HandPoses& poses, const HandVertices& hands, const Points& vertices,
            const std::array<HandAngles, 2>& angles);
  /// T-pose vertex number `row` of the mesh, metres.
  Vec3 vertex(int row) const;

 private:
  struct Hand {
    HandJointPoints joints;
    std::array<Hinges, kFingers> hinges;
    HandAngles radians;
  };
  Vec3 bent(const Hand& hand, int number, const Vec3& x) const;

  const HandPoses& poses_;
  const HandVertices& hands_;
  const Points& vertices_;
  std::array<Hand, 2> sides_;
};

}  // namespace understudy
