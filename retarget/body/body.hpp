// A parametric body in SMPL's form, and one person of it.
#pragma once

#include <memory>
#include <string>

#include "retarget/geometry/mesh.hpp"
#include "retarget/skeleton/skinning.hpp"

namespace understudy {

/// One person in T-pose: what can be posed. Facing +z, y up.
struct ShapedBody {
  Points vertices;                             ///< [V, 3] metres
  Faces faces;                                 ///< [F, 3]
  Joints joints;                               ///< [22, 3] metres
  RowMatrix weights;                           ///< [V, 22]
  std::shared_ptr<const RowMatrix> pose_dirs;  ///< [3V, 189] offsets by (R - I) of joints 1..21; may be null
};

/// A parametric body (SMPL and relatives; SMPL paper, eq. 2-9).
struct Body {
  Points template_vertices;                    ///< [V, 3]
  Faces faces;                                 ///< [F, 3]
  RowMatrix shape_dirs;                        ///< [3V, B]
  std::shared_ptr<const RowMatrix> pose_dirs;  ///< [3V, 189]; may be null
  RowMatrix joint_regressor;                   ///< [22, V]
  RowMatrix weights;                           ///< [V, 22]

  /// The person with these shape parameters; fewer than B are padded with zeros, more are an Error.
  ShapedBody shaped(const Eigen::VectorXf& betas) const;
};

/// Pose features of SMPL, (R - I) of joints 1..21 row-major, [189].
Eigen::VectorXf pose_features(const Rotations& local);

/// Vertices of the body in a pose, [V, 3] metres, with pose-corrective offsets where the body has them.
Points posed_vertices(const ShapedBody& body, const Pose& pose);

/// Reads an SMPL-format .npz: SMPL (24 joints), SMPL-H (52) or 22. Joints past the 22 are folded into their
/// ancestors. Throws Error naming the file and what is wrong.
Body read_smpl_body(const std::string& path);
/// Whether an .npz holds such a body, by the names of its arrays; false for what cannot be read.
bool is_smpl_body(const std::string& path);

/// What an AMASS-format file holds.
struct AmassArrays {
  RowMatrix angles;  ///< [T, >= 66] axis-angle
  RowMatrix trans;   ///< [T, 3] metres
  float fps = 30;
  std::vector<uint8_t> flags = {};  ///< [T]; empty: none
};
/// Throws Error naming the file and what is wrong.
AmassArrays read_amass_arrays(const std::string& path);

/// Reads an AMASS-format .npz (`poses` [T, >= 66] axis-angle, `trans` [T, 3], `mocap_framerate` or
/// `mocap_frame_rate`). z-up files (AMASS's own) are the caller's to turn. Throws Error naming the file.
Motion read_amass_motion(const std::string& path);

}  // namespace understudy
