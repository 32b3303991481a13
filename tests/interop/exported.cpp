#include "tests/interop/exported.hpp"

#include <algorithm>
#include <cstdlib>
#include <functional>

#include "retarget/base/error.hpp"
#include "retarget/character/gltf_character.hpp"
#include "retarget/character/read_character.hpp"
#include "tests/app/program.hpp"
#include "tests/retarget/character/characters.hpp"

namespace understudy::tests {
namespace {

constexpr int kPoses = 33;

struct Plan {
  std::string name;
  MadeCharacter made;
  CharacterExportOptions options;
  std::string suffix = ".glb";
  bool cloud = false, robot = false;
};

Plan plan(const std::string& name, Naming naming, const std::function<void(Plan&)>& change = {}) {
  Plan out;
  out.name = name;
  out.made.naming = naming;
  if (change) change(out);
  return out;
}

std::vector<Plan> plans() {
  return {
      plan("mixamo_a_pose_in_centimetres", Naming::Mixamo,
           [](Plan& p) {
             p.made.arms_down_deg = 45;
             p.made.unit = 0.01f;
           }),
      plan("rigify_nodes_unlike_bind_pose", Naming::Rigify,
           [](Plan& p) {
             p.made.nodes_posed = true;
             p.made.heading_deg = 90;
           }),
      plan("vrm_two_skins_text", Naming::Vrm,
           [](Plan& p) {
             p.made.separate_skins = true;
             p.made.arms_down_deg = 30;
             p.made.legs_apart_deg = 10;
             p.suffix = ".gltf";
           }),
      plan("unreal_nested_scales", Naming::Unreal,
           [](Plan& p) {
             p.made.nested_scales = true;
             p.made.heading_deg = 180;
           }),
      plan("biped_eight_influences", Naming::Biped, [](Plan& p) { p.made.influences = 8; }),
      plan("mixamo_several_clips_few_keys", Naming::Mixamo,
           [](Plan& p) {
             p.options.t_pose_clip = p.options.in_place = true;
             p.options.reduce_mm = 2;
           }),
      plan("rigify_with_shapes", Naming::Rigify,
           [](Plan& p) {
             p.made.arms_down_deg = 45;
             p.options.shapes = 3;
           }),
      plan("bare_on_our_joints_with_shapes", Naming::None,
           [](Plan& p) {
             p.made.rigged = false;
             p.made.arms_down_deg = 45;
             p.options.their_rig = false;
             p.options.shapes = 3;
           }),
      plan("mixamo_on_our_joints_eight_influences", Naming::Mixamo,
           [](Plan& p) {
             p.made.unit = 0.01f;
             p.options.their_rig = false;
             p.options.influences = 8;
           }),
      plan("cloud", Naming::None,
           [](Plan& p) {
             p.cloud = true;
             p.made.rigged = false;
             p.options.their_rig = false;
           }),
      plan("robot_of_hard_parts", Naming::Mixamo, [](Plan& p) { p.robot = true; }),
  };
}

Character character_for(const Plan& plan) {
  if (plan.robot) return make_robot();
  Character made = make_character(plan.made);
  if (!plan.cloud) return made;
  Mesh points;
  points.vertices.resize(made.vertex_count(), 3);
  points.vertices << made.parts[0].vertices, made.parts[1].vertices;
  return character_of_mesh(points, "cloud");
}

Points of_all_parts(const Points& merged, const std::vector<int>& map) {
  Points out(static_cast<Eigen::Index>(map.size()), 3);
  for (size_t v = 0; v < map.size(); ++v) out.row(static_cast<Eigen::Index>(v)) = merged.row(map[v]);
  return out;
}

/// Where the files go: a folder that goes away, or, to look at them by hand, the one that the environment
/// names.
std::string path_for(const std::string& name) {
  static const ScratchFolder scratch;
  const char* kept = std::getenv("UNDERSTUDY_KEEP_EXPORTS");
  return kept == nullptr ? scratch.path(name) : std::string(kept) + "/" + name;
}

/// The screen deforms with no more influences than the file can hold: what is left out is no matter here.
std::shared_ptr<Deformer> with_largest(const Deformer& deformer, int count) {
  RowMatrix weights = deformer.weights();
  for (Eigen::Index v = 0; v < weights.rows(); ++v) {
    std::vector<float> sorted(weights.row(v).data(), weights.row(v).data() + weights.cols());
    std::nth_element(sorted.begin(), sorted.begin() + count, sorted.end(), std::greater<float>());
    const float least = sorted[static_cast<size_t>(count)];
    weights.row(v) = (weights.row(v).array() > least).select(weights.row(v), 0.0f).eval();
    weights.row(v) /= weights.row(v).sum();
  }
  return deformer.with_weights(weights);
}

struct Ready {
  std::shared_ptr<const PreparedCharacter> character;
  std::shared_ptr<const Deformer> screen;
  std::vector<Pose> poses;
};

Ready make_ready(const Plan& plan, const Vec3& from) {
  KnownExtractor before(made_joints(plan.made)), after(made_joints({}));
  const auto prepared =
      std::make_shared<PreparedCharacter>(prepare_character(character_for(plan), &before, &after));
  const PreparedCharacter& character = *prepared;
  auto bulging = std::make_shared<BulgingDeformer>(plan.options.shapes > 0 ? 0.02f : 0.0f);
  bulging->bind(character.target.mesh.vertices, character.target.joints);
  std::shared_ptr<Deformer> screen = with_largest(*bulging, plan.options.influences);
  if (plan.options.their_rig) {
    screen = std::make_shared<RigDeformer>(character, plan.options.shapes > 0 ? bulging : nullptr);
    screen->bind(character.target.mesh.vertices, character.target.joints);
  }
  std::vector<Pose> poses = made_motion(kPoses, character.target.joints);
  for (Pose& pose : poses) {
    if (plan.options.in_place) {  // as the export does it
      pose.root.x() = character.target.joints(Pelvis, 0);
      pose.root.z() = character.target.joints(Pelvis, 2);
    }
    pose.root += from;
  }
  return {prepared, screen, poses};
}

/// Several plans are several performers of one file; name, suffix and what is kept of one are the first's.
Exported export_it(const std::vector<Plan>& cast) {
  const Plan& plan = cast[0];
  std::vector<Ready> ready;
  for (const Plan& one : cast)
    ready.push_back(make_ready(one, static_cast<float>(ready.size()) * Vec3(1.5f, 0, -0.7f)));
  Exported out;
  out.name = plan.name;
  out.options = plan.options;
  out.prepared = ready[0].character;
  out.path = path_for(plan.name + plan.suffix);
  std::vector<CharacterPerformance> performances;
  for (size_t k = 0; k < cast.size(); ++k) {
    const std::vector<Pose>& poses = ready[k].poses;
    std::vector<CharacterClip> clips = {{"walk", out.fps, poses}};
    if (plan.options.t_pose_clip) clips.push_back({"walk back", 30, {poses.rbegin(), poses.rend()}});
    performances.push_back(
        {*ready[k].character, *ready[k].screen, std::move(clips), cast[k].options, cast[k].name});
  }
  out.cost_mm = export_character(out.path, performances).largest_mm;
  out.file = read_character(out.path);
  out.clip = plan.options.t_pose_clip ? 1 : 0;
  for (size_t i = 0; i < kFramesShown; ++i) {
    const size_t frame = i * (kPoses - 1) / (kFramesShown - 1);
    out.times.push_back(static_cast<float>(static_cast<double>(frame) / out.fps));
    out.poses.push_back(ready[0].poses[frame]);
    Points shown(0, 3);
    for (const Ready& one : ready) {
      const Points own = of_all_parts(one.screen->deform(one.poses[frame]), one.character->surface.map);
      shown.conservativeResize(shown.rows() + own.rows(), 3);
      shown.bottomRows(own.rows()) = own;
    }
    out.screen.push_back(std::move(shown));
  }
  for (const double frame : {0.4, 17.7}) out.times.push_back(static_cast<float>(frame / out.fps));
  return out;
}

/// Two of one character and a third with shapes.
std::vector<Plan> three_performers() {
  const std::vector<Plan> all = plans();
  const auto with_shapes =
      std::find_if(all.begin(), all.end(), [](const Plan& plan) { return plan.options.shapes > 0; });
  std::vector<Plan> cast = {all[0], all[0], *with_shapes};
  cast[0].name = "three_performers";
  return cast;
}

/// As an engine sees it that knows only the first few influences of each vertex.
Character with_influences(Character character, int count) {
  for (auto& part : character.parts) {
    if (part.joints.cols() <= count) continue;
    part.joints = part.joints.leftCols(count).eval();
    part.weights = part.weights.leftCols(count).eval();
    for (Eigen::Index v = 0; v < part.weights.rows(); ++v) part.weights.row(v) /= part.weights.row(v).sum();
  }
  return character;
}

}  // namespace

Points Exported::ours_at(float seconds, int influences) const {
  return vertices_at(with_influences(file, influences), clip, seconds);
}

PlayJob Exported::job(const std::string& program) const {
  return {path, path + "." + program, clip, fps, times};
}

const std::vector<Exported>& all_exported() {
  static const std::vector<Exported> all = [] {
    std::vector<Exported> out;
    for (const Plan& plan : plans()) out.push_back(export_it({plan}));
    return out;
  }();
  return all;
}

const std::vector<Exported>& all_played() {
  static const std::vector<Exported> all = [] {
    std::vector<Exported> out = all_exported();
    out.push_back(export_it(three_performers()));
    return out;
  }();
  return all;
}

bool needs_eight(const Exported& exported) {
  for (const auto& part : exported.file.parts)
    if (part.joints.cols() > 4) return true;
  return false;
}

double largest_mm(const Points& a, const Points& b) {
  US_CHECK(a.rows() == b.rows(), a.rows(), " vertices against ", b.rows());
  return 1000.0 * static_cast<double>((a - b).rowwise().norm().maxCoeff());
}

Agreement agreement(const Exported& exported, const std::vector<Points>& theirs, int influences) {
  US_CHECK(theirs.size() == exported.times.size(), exported.name, ": was played at ", theirs.size(),
           " times");
  Agreement out;
  for (size_t t = 0; t < theirs.size(); ++t) {
    out.ours_mm =
        std::max(out.ours_mm, largest_mm(theirs[t], exported.ours_at(exported.times[t], influences)));
    if (t < kFramesShown) out.screen_mm = std::max(out.screen_mm, largest_mm(theirs[t], exported.screen[t]));
  }
  return out;
}

}  // namespace understudy::tests
