#include "app/run/case_writer.hpp"

#include <algorithm>
#include <cmath>

#include "retarget/base/error.hpp"
#include "retarget/base/part_file.hpp"
#include "retarget/base/text.hpp"
#include "retarget/formats/surface_writer.hpp"

namespace understudy::app {

void make_scan_folder(const std::filesystem::path& folder) {
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
}

void write_scan(const std::filesystem::path& folder, size_t frame, const Points& points) {
  write_file((folder / printed("frame_%05zu.ply", frame)).string(), ply_bytes({}, points, ""),
             /*synced=*/false);
}

Points64 points_on_surface(NumpyRandom& random, const Points64& vertices, const Faces& faces, int64_t count) {
  std::vector<double> share(faces.rows());
  double all = 0;
  const auto corner = [&](int64_t f, int c) { return Eigen::Vector3d(vertices.row(faces(f, c))); };
  for (int64_t f = 0; f < faces.rows(); ++f)
    share[f] = all += (corner(f, 1) - corner(f, 0)).cross(corner(f, 2) - corner(f, 0)).norm();
  US_CHECK(all > 0, "a person without surface cannot be scanned");
  for (double& s : share) s /= all;
  std::vector<int64_t> drawn(count);
  for (int64_t& f : drawn)
    f = std::upper_bound(share.begin(), share.end() - 1, random.random()) - share.begin();
  Eigen::VectorXd u(count), w(count);
  for (double& x : u) x = std::sqrt(random.random());
  for (double& x : w) x = random.random();
  Points64 points(count, 3);
  for (int64_t i = 0; i < count; ++i) {
    const int64_t f = drawn[i];
    points.row(i) = (1 - u[i]) * corner(f, 0) + u[i] * (1 - w[i]) * corner(f, 1) + u[i] * w[i] * corner(f, 2);
  }
  return points;
}

void write_target(const std::string& path, const ExactPerson& person) {
  std::string text;
  for (const auto& v : person.vertices.rowwise()) text += printed("v %.6f %.6f %.6f\n", v[0], v[1], v[2]);
  for (const auto& f : person.faces.rowwise()) text += printed("f %d %d %d\n", f[0] + 1, f[1] + 1, f[2] + 1);
  write_file(path, text, /*synced=*/false);
}

uint64_t case_seed(const std::string& name, uint64_t seed) {
  for (const char c : name) seed = 131 * seed + static_cast<unsigned char>(c);
  return seed;
}

}  // namespace understudy::app
