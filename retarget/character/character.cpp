#include "retarget/character/character.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/math/rotation.hpp"

namespace understudy {
namespace {

constexpr int kMaxDepth = 1000, kMaxInfluences = 8;

bool invertible(const Mat4& M) {
  const Mat3 linear = M.topLeftCorner<3, 3>();
  const float scale = linear.norm();
  return M.allFinite() && scale > 1e-12f && std::abs((linear / scale).determinant()) > 1e-6f;
}

// From the space the bones were bound in to the world. The file does not have it: the node of the mesh does
// where its size agrees with the skeleton's, as exporters keep the mesh where it was bound; else the root
// joint.
Mat4 bind_to_world(const Mat4& root_world, const Mat4& inverse_bind, const Mat4* mesh_world) {
  const Mat4 posed = root_world * inverse_bind;
  const Mat3 linear = posed.topLeftCorner<3, 3>();
  const float scale = uniform_scale(linear);
  if (mesh_world != nullptr && invertible(*mesh_world)) {
    const Mat3 of_mesh = mesh_world->topLeftCorner<3, 3>();
    const float mesh_scale = uniform_scale(of_mesh);
    if (std::abs(mesh_scale / scale - 1) < 0.02f &&
        geodesic_angle(of_mesh / mesh_scale, linear / scale) < 1.75f)
      return *mesh_world;
  }
  const Mat3 upright = nearest_quarter_turn(linear / scale) * scale;
  const Vec3 joint = inverse_bind.inverse().topRightCorner<3, 1>();  // in the bind pose
  return affine(upright, root_world.topRightCorner<3, 1>() - upright * joint);
}

// Where the bones of one skin were bound; `placed` knows those of the skins before it.
void place_skin(const Character& character, int skin_index, const std::vector<Mat4>& world,
                std::vector<bool>& placed, std::vector<Mat4>& bind) {
  const CharacterSkin& skin = character.skins[skin_index];
  const Mat4* mesh_world = nullptr;
  for (const auto& part : character.parts)
    if (part.skin == skin_index) mesh_world = &world[part.node];
  int root = -1;
  Mat4 B = Mat4::Identity();
  bool known = false;
  for (size_t j = 0; j < skin.joints.size() && !known; ++j) {
    if (!invertible(skin.inverse_bind[j])) continue;
    const size_t node = skin.joints[j];
    if (placed[node]) {
      B = bind[node] * skin.inverse_bind[j];
      known = true;
    }
    if (root < 0 || skin.joints[j] < skin.joints[root]) root = j;
  }
  if (!known && root >= 0) {
    const size_t j = root;
    const Mat4& root_world = world[skin.joints[j]];
    if (invertible(root_world)) B = bind_to_world(root_world, skin.inverse_bind[j], mesh_world);
  }
  for (size_t j = 0; j < skin.joints.size(); ++j) {
    const size_t node = skin.joints[j];
    if (placed[node]) continue;
    placed[node] = true;
    bind[node] = invertible(skin.inverse_bind[j]) ? Mat4(B * skin.inverse_bind[j].inverse()) : world[node];
  }
}

// The value of a track at a time: `width` numbers.
std::vector<float> track_at(const CharacterTrack& track, float seconds, size_t width) {
  const bool cubic = track.interpolation == TrackInterpolation::Cubic;
  const size_t step = cubic ? 3 * width : width, skip = cubic ? width : 0;
  const auto key = [&](size_t i) { return track.values.data() + i * step + skip; };
  const size_t last = track.times.size() - 1;
  const auto above = std::upper_bound(track.times.begin(), track.times.end(), seconds);
  const size_t next = above - track.times.begin();
  if (next == 0) return {key(0), key(0) + width};
  if (next > last || track.interpolation == TrackInterpolation::Step)
    return {key(next - 1), key(next - 1) + width};
  const float span = track.times[next] - track.times[next - 1], u = (seconds - track.times[next - 1]) / span;
  std::vector<float> out(width);
  if (cubic) {  // Hermite, as glTF defines it
    const float *a = key(next - 1), *b = key(next), *out_a = a + width, *in_b = b - width;
    const float u2 = u * u, u3 = u2 * u;
    for (size_t i = 0; i < width; ++i)
      out[i] = (2 * u3 - 3 * u2 + 1) * a[i] + span * (u3 - 2 * u2 + u) * out_a[i] + (3 * u2 - 2 * u3) * b[i] +
               span * (u3 - u2) * in_b[i];
    return out;
  }
  if (track.path == TrackPath::Rotation) {
    const Eigen::Map<const Eigen::Vector4f> a(key(next - 1)), b(key(next));
    const Eigen::Quaternionf q = Eigen::Quaternionf(a).slerp(u, Eigen::Quaternionf(b));
    return {q.x(), q.y(), q.z(), q.w()};
  }
  for (size_t i = 0; i < width; ++i) out[i] = (1 - u) * key(next - 1)[i] + u * key(next)[i];
  return out;
}

Points part_in_world(const Character& character, const CharacterPart& part, const std::vector<Mat4>& world,
                     const std::vector<float>* shape_weights) {
  Points rest = part.vertices;
  if (shape_weights != nullptr)
    for (size_t s = 0; s < std::min(part.shapes.size(), shape_weights->size()); ++s)
      if ((*shape_weights)[s] != 0) rest += (*shape_weights)[s] * part.shapes[s];
  if (part.skin < 0) {
    const Mat4& M = world[part.node];
    return (rest * M.topLeftCorner<3, 3>().transpose()).rowwise() + M.topRightCorner<3, 1>().transpose();
  }
  Points out(rest.rows(), 3);
  const CharacterSkin& skin = character.skins[part.skin];
  std::vector<Mat4> bones;
  for (size_t j = 0; j < skin.joints.size(); ++j)
    bones.push_back(world[skin.joints[j]] * skin.inverse_bind[j]);
  for (Eigen::Index v = 0; v < rest.rows(); ++v) {
    Eigen::Matrix<float, 3, 4> M = Eigen::Matrix<float, 3, 4>::Zero();
    for (Eigen::Index k = 0; k < part.joints.cols(); ++k)
      if (part.weights(v, k) > 0) M += part.weights(v, k) * bones[part.joints(v, k)].topRows<3>();
    out.row(v) = (M.leftCols<3>() * rest.row(v).transpose() + M.col(3)).transpose();
  }
  return out;
}

void check_part(const Character& character, const CharacterPart& part, const std::string& path) {
  const Eigen::Index count = part.vertices.rows();
  const auto fits = [&](Eigen::Index rows) { return rows == 0 || rows == count; };
  US_CHECK(part.node >= 0 && part.node < ssize(character.nodes), path, ": the part '", part.name,
           "' is on no node");
  US_CHECK(part.skin < ssize(character.skins) && part.material < ssize(character.materials), path,
           ": the part '", part.name, "' names a skin or material that does not exist");
  US_CHECK(part.vertices.allFinite(), path, ": a vertex of the part '", part.name, "' is not finite");
  US_CHECK(fits(part.normals.rows()) && fits(part.tangents.rows()) && fits(part.colors.rows()), path,
           ": the part '", part.name, "' has more or fewer normals, tangents or colours than vertices");
  for (const auto& uv : part.uvs)
    US_CHECK(uv.rows() == count && uv.cols() == 2, path, ": the part '", part.name,
             "' has more or fewer texture coordinates than vertices");
  for (const auto& shape : part.shapes)
    US_CHECK(shape.rows() == count && shape.allFinite(), path, ": a morph target of the part '", part.name,
             "' does not fit its vertices");
  US_CHECK(part.faces.rows() == 0 || (part.faces.minCoeff() >= 0 && part.faces.maxCoeff() < count), path,
           ": a face of the part '", part.name, "' names a vertex that does not exist");
  if (part.skin < 0) return;
  const int bones = character.skins[part.skin].joints.size();
  US_CHECK(part.joints.rows() == count && part.weights.rows() == count &&
               part.joints.cols() == part.weights.cols() && part.joints.cols() <= kMaxInfluences,
           path, ": the skin of the part '", part.name, "' does not fit its vertices");
  US_CHECK(count == 0 || (part.joints.minCoeff() >= 0 && part.joints.maxCoeff() < bones), path,
           ": the part '", part.name, "' is bound to a bone that its skin does not have");
  US_CHECK(part.weights.allFinite() && (count == 0 || part.weights.minCoeff() >= 0), path,
           ": a skin weight of the part '", part.name, "' is negative or not finite");
}

}  // namespace

Mat4 affine(const Mat3& linear, const Vec3& translation) {
  Mat4 out = Mat4::Identity();
  out.topLeftCorner<3, 3>() = linear;
  out.topRightCorner<3, 1>() = translation;
  return out;
}

float uniform_scale(const Mat3& linear) {
  return std::cbrt(std::abs(linear.determinant()));
}

Mat4 Transform::matrix() const {
  return affine(rotation.toRotationMatrix() * scale.asDiagonal(), translation);
}

Transform Transform::from(const Mat4& matrix) {
  Transform out;
  out.translation = matrix.topRightCorner<3, 1>();
  const Mat3 M = matrix.topLeftCorner<3, 3>();
  const float sign = M.determinant() < 0 ? -1.0f : 1.0f;
  out.scale = sign * M.colwise().norm().transpose();
  Mat3 R = M;
  for (int c = 0; c < 3; ++c)
    if (std::abs(out.scale[c]) > 1e-20f) R.col(c) /= out.scale[c];
  out.rotation = Eigen::Quaternionf(R.allFinite() ? nearest_rotation(R) : Mat3(Mat3::Identity()));
  out.rotation.normalize();
  return out;
}

float CharacterAnimation::duration() const {
  float last = 0;
  for (const auto& track : tracks)
    if (!track.times.empty()) last = std::max(last, track.times.back());
  return last;
}

Eigen::Index Character::vertex_count() const {
  Eigen::Index count = 0;
  for (const auto& part : parts) count += part.vertices.rows();
  return count;
}

std::vector<Mat4> Character::world() const {
  std::vector<Mat4> out;
  for (const auto& node : nodes) {
    const Mat4 local = node.local.matrix();
    out.push_back(node.parent < 0 ? local : Mat4(out[node.parent] * local));
  }
  return out;
}

bool Character::is_at_or_below(int node, int other) const {
  while (node >= 0 && node != other) node = nodes[node].parent;
  return node >= 0;
}

void check_character(const Character& character, const std::string& path) {
  std::vector<int> depth;
  for (size_t n = 0; n < character.nodes.size(); ++n) {
    const CharacterNode& node = character.nodes[n];
    US_CHECK(node.parent < static_cast<int>(n), path, ": its nodes are not in order");
    depth.push_back(node.parent < 0 ? 1 : depth[node.parent] + 1);
    US_CHECK(depth.back() <= kMaxDepth, path, ": its nodes are more than ", kMaxDepth, " levels deep");
    US_CHECK(node.local.matrix().allFinite(), path, ": the transform of the node '", node.name,
             "' is not finite");
  }
  for (const auto& skin : character.skins) {
    US_CHECK(!skin.joints.empty() && skin.inverse_bind.size() == skin.joints.size(), path, ": the skin '",
             skin.name, "' has no joints, or another number of bind matrices");
    for (const int joint : skin.joints)
      US_CHECK(joint >= 0 && joint < ssize(character.nodes), path, ": the skin '", skin.name,
               "' names a node that does not exist");
    for (const Mat4& matrix : skin.inverse_bind)
      US_CHECK(matrix.allFinite(), path, ": a bind matrix of the skin '", skin.name, "' is not finite");
  }
  for (const auto& part : character.parts) check_part(character, part, path);
  US_CHECK(character.vertex_count() > 0 || !character.animations.empty(), path, ": holds no mesh");
  US_CHECK(character.vertex_count() <= 16000000, path, ": has more than 16 million vertices");
}

Points posed_vertices(const Character& character, const std::vector<Mat4>& world,
                      const std::vector<std::vector<float>>& shape_weights) {
  Points out(character.vertex_count(), 3);
  Eigen::Index at = 0;
  for (const auto& part : character.parts) {
    const auto* weights = shape_weights.empty() ? nullptr : &shape_weights[part.node];
    out.middleRows(at, part.vertices.rows()) = part_in_world(character, part, world, weights);
    at += part.vertices.rows();
  }
  return out;
}

PosedNodes nodes_at(const Character& character, int animation, float seconds) {
  Character posed;  // only its nodes
  posed.nodes = character.nodes;
  std::vector<std::vector<float>> shapes;
  for (const auto& node : character.nodes) shapes.push_back(node.shape_weights);
  if (animation >= 0) {
    US_CHECK(animation < ssize(character.animations), "there is no animation number ", animation);
    for (const auto& track : character.animations[animation].tracks) {
      Transform& local = posed.nodes[track.node].local;
      std::vector<float>& weights = shapes[track.node];
      if (track.path == TrackPath::Shapes) {
        weights = track_at(track, seconds, weights.size());
      } else if (track.path == TrackPath::Rotation) {
        const auto q = track_at(track, seconds, 4);
        local.rotation = Eigen::Quaternionf(q[3], q[0], q[1], q[2]).normalized();
      } else {
        const auto p = track_at(track, seconds, 3);
        (track.path == TrackPath::Scale ? local.scale : local.translation) = Vec3(p[0], p[1], p[2]);
      }
    }
  }
  return {posed.world(), std::move(shapes)};
}

Points vertices_at(const Character& character, int animation, float seconds) {
  const PosedNodes posed = nodes_at(character, animation, seconds);
  return posed_vertices(character, posed.world, posed.shape_weights);
}

BindPose bind_pose(const Character& character) {
  const std::vector<Mat4> world = character.world();
  BindPose out;
  out.is_bone.assign(character.nodes.size(), false);
  out.nodes = world;
  for (size_t s = 0; s < character.skins.size(); ++s) place_skin(character, s, world, out.is_bone, out.nodes);
  std::vector<bool> moved = out.is_bone;
  for (size_t n = 0; n < character.nodes.size(); ++n) {  // what hangs on a bone goes with it
    const int p = character.nodes[n].parent;
    if (moved[n] || p < 0 || !moved[p]) continue;
    out.nodes[n] = out.nodes[p] * character.nodes[n].local.matrix();
    moved[n] = true;
  }
  out.vertices = posed_vertices(character, out.nodes);
  return out;
}

Points MergedSurface::in_file_order(const Points& rows) const {
  US_CHECK(rows.rows() == mesh.vertices.rows(), "the surface has ", mesh.vertices.rows(), " vertices, not ",
           rows.rows());
  return rows(in_file, Eigen::all);
}

Points MergedSurface::merged(const Points& of_parts) const {
  Points out(mesh.vertices.rows(), 3);
  for (Eigen::Index v = 0; v < of_parts.rows(); ++v) out.row(map[v]) = of_parts.row(v);
  return out;
}

MergedSurface merged_surface(const Character& character, const Points& positions) {
  US_CHECK(positions.rows() == character.vertex_count(), "the surface has ", positions.rows(),
           " positions for ", character.vertex_count(), " vertices");
  MergedSurface out;
  std::unordered_map<std::string, int> known;
  known.reserve(positions.rows());
  out.map.reserve(positions.rows());
  std::vector<Eigen::Index> first;  // of each merged vertex, the row it came from
  std::vector<int> corners;
  Eigen::Index at = 0;
  for (size_t p = 0; p < character.parts.size(); ++p) {
    const CharacterPart& part = character.parts[p];
    for (Eigen::Index v = 0; v < part.vertices.rows(); ++v) {
      // Corners in one place that move together are one vertex; two parts that only touch stay two.
      std::string key(reinterpret_cast<const char*>(positions.row(at + v).data()), 3 * sizeof(float));
      const int mover = part.skin < 0 ? -1 - part.node : part.skin;
      key.append(reinterpret_cast<const char*>(&mover), sizeof mover);
      if (part.skin >= 0) {
        const size_t k = part.joints.cols();
        key.append(reinterpret_cast<const char*>(part.joints.row(v).data()), k * sizeof(int));
        key.append(reinterpret_cast<const char*>(part.weights.row(v).data()), k * sizeof(float));
      }
      const auto [entry, is_new] = known.try_emplace(std::move(key), first.size());
      if (is_new) first.push_back(at + v);
      out.map.push_back(entry->second);
    }
    for (Eigen::Index f = 0; f < part.faces.size(); ++f)
      corners.push_back(out.map[at + part.faces.data()[f]]);
    at += part.vertices.rows();
  }
  out.in_file = out.map;
  const auto& numbers = character.file_vertices;
  if (!numbers.empty()) {
    US_CHECK(numbers.size() == out.map.size(), character.called(), ": has ", out.map.size(),
             " vertices, but ", numbers.size(), " numbers of them");
    out.in_file.assign(static_cast<size_t>(*std::max_element(numbers.begin(), numbers.end())) + 1, 0);
    for (size_t i = 0; i < numbers.size(); ++i) out.in_file[numbers[i]] = out.map[i];
  }
  out.mesh.vertices = positions(first, Eigen::all);
  out.mesh.faces = Eigen::Map<const Faces>(corners.data(), corners.size() / 3, 3);
  return out;
}

}  // namespace understudy
