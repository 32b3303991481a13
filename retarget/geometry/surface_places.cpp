#include "retarget/geometry/surface_places.hpp"

#include <algorithm>
#include <limits>

#include "retarget/base/error.hpp"

namespace understudy {
namespace {

constexpr int kNearVertices = 4;

/// Shares of the corners a, b, c in the point of their triangle that is nearest to p (Ericson, Real-Time
/// Collision Detection, 5.1.5).
Vec3 nearest_in_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
  const float d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return {1, 0, 0};
  const float d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) return {0, 1, 0};
  const float vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0 && d1 > d3) return {1 - d1 / (d1 - d3), d1 / (d1 - d3), 0};
  const float d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6) return {0, 0, 1};
  const float vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0 && d2 > d6) return {1 - d2 / (d2 - d6), 0, d2 / (d2 - d6)};
  const float va = d3 * d6 - d5 * d4, along = (d4 - d3) + (d5 - d6);
  if (va <= 0 && d4 >= d3 && d5 >= d6 && along > 0) return {0, 1 - (d4 - d3) / along, (d4 - d3) / along};
  const float sum = va + vb + vc;
  if (!(sum > 0)) return {1, 0, 0};  // the corners lie on one line
  return {va / sum, vb / sum, vc / sum};
}

/// Which faces are about each vertex.
class FacesAbout {
 public:
  FacesAbout(Eigen::Index vertices, const Faces& faces) : first_(vertices + 1, 0), faces_(faces.size()) {
    for (const int v : faces.reshaped()) ++first_[v + 1];
    for (size_t v = 1; v < first_.size(); ++v) first_[v] += first_[v - 1];
    std::vector<int> next = first_;
    for (Eigen::Index f = 0; f < faces.rows(); ++f)
      for (const int v : faces.row(f)) faces_[next[v]++] = static_cast<int>(f);
  }
  const int* begin(int v) const { return faces_.data() + first_[v]; }
  const int* end(int v) const { return faces_.data() + first_[v + 1]; }

 private:
  std::vector<int> first_, faces_;
};

}  // namespace

RowMatrix SurfacePlaces::of(const RowMatrix& rows) const {
  RowMatrix here(size(), rows.cols());
  for (Eigen::Index i = 0; i < size(); ++i)
    here.row(i) = share(i, 0) * rows.row(corners(i, 0)) + share(i, 1) * rows.row(corners(i, 1)) +
                  share(i, 2) * rows.row(corners(i, 2));
  return here;
}

Points SurfacePlaces::on(const Points& vertices) const {
  return of(vertices);
}

SurfacePlaces nearest_places(const Mesh& surface, const Points& points) {
  US_CHECK(surface.vertices.rows() > 0, "nothing is near on a surface without vertices");
  US_CHECK(points.allFinite(), "a point that is not finite is near nothing");
  std::vector<int> used(surface.faces.data(), surface.faces.data() + surface.faces.size());
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  if (surface.is_cloud())
    for (int v = 0; v < surface.vertices.rows(); ++v) used.push_back(v);
  const FacesAbout about(surface.vertices.rows(), surface.faces);
  const Points corners = surface.vertices(used, Eigen::all);
  const auto wanted = std::min<Eigen::Index>(surface.is_cloud() ? 1 : kNearVertices, corners.rows());
  const IntMatrix near = nearest_neighbours(corners, points, static_cast<int>(wanted));
  SurfacePlaces places{Faces(points.rows(), 3), RowMatrix(points.rows(), 3)};
  const auto corner = [&](int f, int c) { return Vec3(surface.vertices.row(surface.faces(f, c))); };
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    const Vec3 p = points.row(i);
    places.corners.row(i).setConstant(used[near(i, 0)]);
    places.share.row(i) << 1, 0, 0;
    float best = std::numeric_limits<float>::infinity();
    for (const int n : near.row(i))
      for (const int* f = about.begin(used[n]); f != about.end(used[n]); ++f) {
        const Vec3 a = corner(*f, 0), b = corner(*f, 1), c = corner(*f, 2);
        const Vec3 share = nearest_in_triangle(p, a, b, c);
        const float away = (share[0] * a + share[1] * b + share[2] * c - p).squaredNorm();
        if (away >= best) continue;
        best = away;
        places.corners.row(i) = surface.faces.row(*f);
        places.share.row(i) = share.transpose();
      }
  }
  return places;
}

}  // namespace understudy
