// Surfaces over time: folders of PLY or OBJ frames, and vertex caches.
#pragma once

#include <string>

#include "retarget/base/part_file.hpp"
#include "retarget/math/types.hpp"

namespace understudy {

/// What stays the same over time. Everything but the vertices may be missing.
struct SurfaceTopology {
  int64_t vertex_count = 0;
  Faces faces{0, 3};     ///< none: a cloud
  Points colors{0, 3};   ///< [V, 3] in 0..1
  RowMatrix uvs;         ///< [U, 2], v up as OBJ and PLY have it
  Faces uv_faces{0, 3};  ///< beside faces, rows of uvs
};

/// The mesh as the text of an OBJ file, colours behind the positions.
std::string obj_text(const SurfaceTopology& topology, const Points& vertices, const std::string& comment);
/// As a binary PLY; texture coordinates where each vertex has one, no comment where it is empty.
std::string ply_bytes(const SurfaceTopology& topology, const Points& vertices, const std::string& comment);

enum class SequenceFormat { Ply, Obj };

/// FOLDER/frame_00001.ply ..., each written as it comes; the folder appears whole, see PartFolder.
class SequenceWriter {
 public:
  SequenceWriter(const std::string& folder, SequenceFormat format, SurfaceTopology topology);
  /// [V, 3] metres. Throws Error for another number of vertices, or when the disk is full.
  void push(const Points& vertices);
  void finish() { folder_.finish(); }

 private:
  PartFolder folder_;
  SequenceFormat format_;
  SurfaceTopology topology_;
  int64_t frames_ = 0;
};

/// A point cache (.pc2): positions of every vertex in every frame, as Blender's Mesh Cache modifier, 3ds Max
/// and Maya read it. Beside it PATH.obj, the mesh it moves: same vertices, same order.
class PointCacheWriter {
 public:
  /// rest: the mesh's vertices.
  PointCacheWriter(const std::string& path, const SurfaceTopology& topology, const Points& rest);
  void push(const Points& vertices);
  void finish();

 private:
  int64_t vertex_count_;
  PartFile mesh_, cache_;
  int32_t frames_ = 0;
};

}  // namespace understudy
