#include "app/cli/file_preview.hpp"

#include <algorithm>

#include "app/cli/preview.hpp"
#include "render/contact_sheet.hpp"
#include "render/image.hpp"
#include "retarget/character/gltf_character.hpp"
#include "retarget/character/vertex_colors.hpp"
#include "retarget/formats/bytes.hpp"

namespace understudy::app {
namespace {

/// How somebody stands in the T-pose, facing as in the first frame: the preview looks from where the motion
/// begins.
struct StandingStill {
  explicit StandingStill(const ExportInput& input) {
    const PreparedCharacter& prepared = *input.body.character;
    joints = input.body.file.joints.value_or(prepared.target.joints);
    const Pose& first = input.clips[0].poses[0];
    heading = heading_of_joints(forward_kinematics(joints, first).joints);
    const Mat3 turn = rotation_about_y(heading);
    mesh = prepared.target.mesh;
    mesh.vertices = (mesh.vertices * turn.transpose()).eval();
    joints = (joints * turn.transpose()).eval();
    place = (first.root - Vec3(joints.row(Pelvis).transpose())).cwiseProduct(Vec3(1, 0, 1));
  }
  float heading = 0;
  Mesh mesh;
  Joints joints;
  Vec3 place;  ///< from here to where they begin
};

/// One alone stands as they are, with their joints; several where each of them begins.
void add_t_poses(const std::vector<StandingStill>& cast, render::SheetMoment& moment) {
  moment.source = cast[0].mesh;
  if (cast.size() == 1) {
    moment.skeleton = render::skeleton_view(cast[0].joints);
    return;
  }
  Mesh all;
  for (const StandingStill& one : cast) {
    const Eigen::Index before = all.vertices.rows(), faces = all.faces.rows();
    all.vertices.conservativeResize(before + one.mesh.vertices.rows(), 3);
    all.vertices.bottomRows(one.mesh.vertices.rows()) = one.mesh.vertices.rowwise() + one.place.transpose();
    all.faces.conservativeResize(faces + one.mesh.faces.rows(), 3);
    all.faces.bottomRows(one.mesh.faces.rows()) =
        (one.mesh.faces.array() + static_cast<int>(before)).matrix();
  }
  moment.source = std::move(all);
}

}  // namespace

void write_file_preview(const std::string& preview, const std::string& file,
                        const std::vector<ExportInput>& performers, const std::string& by) {
  const CharacterClip& clip = performers[0].clips[0];
  const Character written = parse_gltf_character(read_file(file), file);
  const int animation = performers[0].body.file.t_pose_clip ? 1 : 0;
  const std::vector<StandingStill> cast(performers.begin(), performers.end());
  std::vector<render::SheetMoment> moments;
  const size_t shown = std::min<size_t>(PreviewMoments::kShown, clip.poses.size());
  for (size_t i = 0; i < shown; ++i) {
    const size_t at = shown == 1 ? 0 : i * (clip.poses.size() - 1) / (shown - 1);
    render::SheetMoment moment;
    moment.frame = at;
    moment.seconds = static_cast<double>(at) / clip.fps;
    add_t_poses(cast, moment);
    MergedSurface surface =
        merged_surface(written, vertices_at(written, animation, static_cast<float>(moment.seconds)));
    paint(surface, written);
    moment.target = std::move(surface.mesh);
    moments.push_back(std::move(moment));
  }
  render::SheetOptions sheet;
  sheet.title = clip.name + " by " + by;
  sheet.heading = cast[0].heading;
  sheet.source_caption = "T-pose";
  sheet.target_caption = "Written file";
  render::write_png(preview, render::contact_sheet(moments, sheet));
}

}  // namespace understudy::app
