#include "retarget/formats/surface_writer.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "retarget/base/error.hpp"
#include "retarget/base/text.hpp"

namespace understudy {
namespace {

template <class T>
void append_raw(std::string& out, const T* values, size_t count) {
  out.append(reinterpret_cast<const char*>(values), count * sizeof(T));
}

bool one_uv_a_vertex(const SurfaceTopology& t) {
  return t.uvs.rows() > 0 && t.uvs.rows() == t.vertex_count && t.uv_faces.rows() == t.faces.rows() &&
         t.uv_faces == t.faces;
}

void check(const SurfaceTopology& t, const std::string& path) {
  const auto inside = [](const Faces& faces, int64_t count) {
    return faces.rows() == 0 || (faces.minCoeff() >= 0 && faces.maxCoeff() < count);
  };
  US_CHECK(t.vertex_count > 0, path, ": there is no vertex to write");
  US_CHECK(inside(t.faces, t.vertex_count) && inside(t.uv_faces, t.uvs.rows()), path,
           ": a face names a vertex that does not exist");
  US_CHECK(t.colors.rows() == 0 || t.colors.rows() == t.vertex_count, path, ": has ", t.vertex_count,
           " vertices and ", t.colors.rows(), " colours");
  US_CHECK(t.uv_faces.rows() == 0 || t.uv_faces.rows() == t.faces.rows(), path,
           ": not every face has texture coordinates");
}

void check_frame(const Points& vertices, int64_t count, const std::string& path) {
  US_CHECK(vertices.rows() == count, path, ": a frame has ", vertices.rows(), " vertices, the first had ",
           count);
  US_CHECK(vertices.allFinite(), path, ": a vertex is not finite");
}

}  // namespace

std::string obj_text(const SurfaceTopology& t, const Points& vertices, const std::string& comment) {
  std::string out = "# " + comment + '\n';
  out.reserve(40 * vertices.rows() + 40 * t.faces.rows());
  for (Eigen::Index v = 0; v < vertices.rows(); ++v) {
    out += 'v';
    for (int axis = 0; axis < 3; ++axis) append_exact(out += ' ', vertices(v, axis));
    for (int c = 0; c < (t.colors.rows() > 0 ? 3 : 0); ++c)
      append_fixed(out += ' ', static_cast<double>(std::clamp(t.colors(v, c), 0.0f, 1.0f)), 4);
    out += '\n';
  }
  for (Eigen::Index u = 0; u < (t.uv_faces.rows() > 0 ? t.uvs.rows() : 0); ++u) {
    append_exact(out += "vt ", t.uvs(u, 0));
    append_exact(out += ' ', t.uvs(u, 1));
    out += '\n';
  }
  for (Eigen::Index f = 0; f < t.faces.rows(); ++f) {
    out += 'f';
    for (int k = 0; k < 3; ++k) {
      out += ' ' + std::to_string(t.faces(f, k) + 1);
      if (t.uv_faces.rows() > 0) out += '/' + std::to_string(t.uv_faces(f, k) + 1);
    }
    out += '\n';
  }
  return out;
}

std::string ply_bytes(const SurfaceTopology& t, const Points& vertices, const std::string& comment) {
  const bool colored = t.colors.rows() > 0, textured = one_uv_a_vertex(t);
  std::string out = "ply\nformat binary_little_endian 1.0\n" +
                    (comment.empty() ? "" : "comment " + comment + "\n") + "element vertex " +
                    std::to_string(vertices.rows()) +
                    "\nproperty float x\nproperty float y\nproperty float z\n";
  if (textured) out += "property float s\nproperty float t\n";
  if (colored) out += "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  if (t.faces.rows() > 0)
    out += "element face " + std::to_string(t.faces.rows()) + "\nproperty list uchar int vertex_indices\n";
  out += "end_header\n";
  for (Eigen::Index v = 0; v < vertices.rows(); ++v) {
    append_raw(out, vertices.row(v).data(), 3);
    if (textured) append_raw(out, t.uvs.row(v).data(), 2);
    for (int c = 0; c < (colored ? 3 : 0); ++c)
      out += static_cast<char>(std::lround(255 * std::clamp(t.colors(v, c), 0.0f, 1.0f)));
  }
  for (Eigen::Index f = 0; f < t.faces.rows(); ++f) {
    out += '\3';
    append_raw(out, t.faces.row(f).data(), 3);
  }
  return out;
}

SequenceWriter::SequenceWriter(const std::string& folder, SequenceFormat format, SurfaceTopology topology)
    : folder_(folder), format_(format), topology_(std::move(topology)) {
  check(topology_, folder);
}

void SequenceWriter::push(const Points& vertices) {
  check_frame(vertices, topology_.vertex_count, folder_.path());
  const bool ply = format_ == SequenceFormat::Ply;
  folder_.add(printed("frame_%05lld.%s", static_cast<long long>(++frames_), ply ? "ply" : "obj"),
              ply ? ply_bytes(topology_, vertices, PartFolder::kMark)
                  : obj_text(topology_, vertices, PartFolder::kMark));
}

PointCacheWriter::PointCacheWriter(const std::string& path, const SurfaceTopology& topology,
                                   const Points& rest)
    : vertex_count_(topology.vertex_count), mesh_(path + ".obj"), cache_(path) {
  check(topology, path);
  check_frame(rest, vertex_count_, path);
  US_CHECK(vertex_count_ < INT32_MAX, path, ": has too many vertices for a point cache");
  mesh_.write(obj_text(topology, rest, "the mesh that the point cache beside it moves"));
  struct {
    char magic[12] = "POINTCACHE2";
    int32_t version = 1, points;
    float start = 0, rate = 1;  // in frames: a cache has no seconds
    int32_t samples = 0;
  } head;
  head.points = static_cast<int32_t>(vertex_count_);
  cache_.write(&head, sizeof head);
}

void PointCacheWriter::push(const Points& vertices) {
  check_frame(vertices, vertex_count_, cache_.path());
  cache_.write(vertices.data(), static_cast<size_t>(vertices.size()) * sizeof(float));
  ++frames_;
}

void PointCacheWriter::finish() {
  std::string count;
  append_raw(count, &frames_, 1);
  cache_.rewrite(28, count);
  mesh_.finish();
  cache_.finish();
}

}  // namespace understudy
