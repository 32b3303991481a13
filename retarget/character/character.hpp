// A character as an animator's file holds it: parts, materials, pictures, nodes, skins, shapes, animations.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <string>
#include <vector>

#include "retarget/geometry/mesh.hpp"
#include "retarget/skeleton/made_frames.hpp"

namespace understudy {

using Mat4 = Eigen::Matrix4f;

/// x -> linear x + translation.
Mat4 affine(const Mat3& linear, const Vec3& translation);
/// The factor by which a matrix scales, of several the mean.
float uniform_scale(const Mat3& linear);

/// A picture's bytes as they are in the file.
struct CharacterImage {
  std::string name, mime;  ///< "image/png" ...
  std::string bytes;
};

/// What is drawn with one material. Units and axes are the file's.
struct CharacterPart {
  std::string name;                                                            ///< of its mesh
  int node = -1;                                                               ///< that carries it
  int skin = -1;                                                               ///< none: it follows its node
  int material = -1;                                                           ///< none: the format's default
  Points vertices;                                                             ///< [V, 3]
  Points normals{0, 3};                                                        ///< [V, 3] or none
  RowMatrix tangents;                                                          ///< [V, 4] or none
  std::vector<RowMatrix> uvs;                                                  ///< [V, 2] each
  RowMatrix colors;                                                            ///< [V, 4] or none
  Faces faces{0, 3};                                                           ///< none: a cloud
  Eigen::Matrix<int, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> joints;  ///< [V, K <= 8] into the skin
  RowMatrix weights;                                                           ///< [V, K], rows sum to 1
  std::vector<Points> shapes;  ///< morph targets: [V, 3] each, added before the skin
};

/// A transform kept apart, as files and animations keep it.
struct Transform {
  Vec3 translation = Vec3::Zero(), scale = Vec3::Ones();
  Eigen::Quaternionf rotation = Eigen::Quaternionf::Identity();
  Mat4 matrix() const;
  /// The nearest such transform; shear is lost.
  static Transform from(const Mat4& matrix);
};

struct CharacterNode {
  std::string name;
  int parent = -1;
  Transform local;
  std::vector<float> shape_weights;  ///< of the shapes of the parts that it carries, as the file is opened
};

struct CharacterSkin {
  std::string name;
  std::vector<int> joints;         ///< nodes
  std::vector<Mat4> inverse_bind;  ///< one a joint
};

enum class TrackPath { Translation, Rotation, Scale, Shapes };
/// What glTF calls them.
constexpr std::array<const char*, 4> kTrackPaths = {"translation", "rotation", "scale", "weights"};
enum class TrackInterpolation { Linear, Step, Cubic };

/// One value of one node over time.
struct CharacterTrack {
  int node = 0;
  TrackPath path = TrackPath::Rotation;
  TrackInterpolation interpolation = TrackInterpolation::Linear;
  std::vector<float> times;   ///< [T] seconds, increasing
  std::vector<float> values;  ///< [T, 3], [T, 4] (x y z w) or [T, shapes]; cubic: [T, 3, the same]
};

struct CharacterAnimation {
  std::string name;
  std::vector<CharacterTrack> tracks;
  std::vector<MadeFrames> made{};  ///< frames that were not captured; written, not read
  float duration() const;
};

/// Parents come before their children among the nodes. Materials, textures and samplers are kept as the JSON
/// texts of glTF, which name images and textures by their number.
struct Character {
  std::string name;
  std::vector<CharacterNode> nodes;
  std::vector<CharacterPart> parts;
  std::vector<CharacterSkin> skins;
  std::vector<CharacterImage> images;
  std::vector<std::string> materials, textures, samplers;
  std::vector<std::string> extensions;  ///< that materials and textures use
  std::vector<std::string> required;    ///< those of them without which they mean nothing
  std::vector<CharacterAnimation> animations;
  /// Of each vertex of the parts, one part after the other, its number in the file, every number at least
  /// once; empty: they are the file's in its order.
  std::vector<int> file_vertices;
  std::string file;      ///< where it came from; may be empty
  std::string rights{};  ///< the file's copyright; empty: it says none

  /// Its name in error messages.
  const std::string& called() const { return file.empty() ? name : file; }
  Eigen::Index vertex_count() const;
  /// Transforms of the nodes to the world, from their own to the parents'.
  std::vector<Mat4> world() const;
  /// Whether a node is that other one or hangs on it.
  bool is_at_or_below(int node, int other) const;
};

/// Throws Error naming `path`: indices out of range, sizes that disagree, neither a vertex nor an animation,
/// numbers not finite.
void check_character(const Character& character, const std::string& path);

/// The vertices of all parts one after the other, [V, 3], in the world of these node transforms. weights: of
/// the shapes of each node; empty: none is applied.
Points posed_vertices(const Character& character, const std::vector<Mat4>& world,
                      const std::vector<std::vector<float>>& shape_weights = {});

/// The nodes at a time of one of the animations.
struct PosedNodes {
  std::vector<Mat4> world;
  std::vector<std::vector<float>> shape_weights;
};
/// animation -1: the nodes' own pose. Times outside take the first or last frame.
PosedNodes nodes_at(const Character& character, int animation, float seconds);

/// The same at a time of one of its animations (the nodes' own pose with animation -1), as every program that
/// plays the file must see it. Times outside take the first or last frame.
Points vertices_at(const Character& character, int animation, float seconds);

/// The pose in which the skin was bound, whatever pose the nodes are in.
struct BindPose {
  std::vector<Mat4> nodes;    ///< to the file's world, one a node
  Points vertices;            ///< [V, 3] of all parts, file's world
  std::vector<bool> is_bone;  ///< a node that a skin names
};
BindPose bind_pose(const Character& character);

/// All parts as one surface. Corners that differ in texture only are one vertex here.
struct MergedSurface {
  Mesh mesh;                 ///< without colours: paint() gives them
  std::vector<int> map;      ///< of each vertex of the parts, one part after the other, the vertex in mesh
  std::vector<int> in_file;  ///< of each vertex of the file, the vertex in mesh
  /// Rows [V, 3] of the mesh's vertices as rows of the file's: its own count and order.
  Points in_file_order(const Points& rows) const;
  /// Rows [V, 3] of the parts' vertices as rows of the mesh's.
  Points merged(const Points& of_parts) const;
};
/// positions [V, 3]: of all the parts' vertices.
MergedSurface merged_surface(const Character& character, const Points& positions);

}  // namespace understudy
