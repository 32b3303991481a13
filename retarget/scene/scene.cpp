#include "retarget/scene/scene.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "retarget/base/index.hpp"
#include "retarget/scene/cell_sets.hpp"

namespace understudy {
namespace {

constexpr float kOneSet = 0.97f;                        // share of the cells that hang together
constexpr float kDenseBody = 300;                       // cells of 5 cm on a body one metre long, at most
constexpr float kSole_m = 0.025f, kSoleBand_m = 0.12f;  // beside and below a body's points: its soles
constexpr float kSureAlone = 0.5f;                      // quality
constexpr float kSureInSkirts = 0.7f;                   // mean confidence
constexpr int kStray = 50;  // a set of fewer than one in so many cells is no part of anything
constexpr int kFewestCells = 8;
constexpr int64_t kMostLooked = 20000;  // points that are looked at

/// The points in some cells; of a mesh its triangles.
Mesh points_in(const Mesh& scan, const Cells& cells, const CellSet& set) {
  const std::vector<char> is_in = flags_of(cells, set);
  std::vector<char> kept(scan.vertices.rows(), 0);
  const std::vector<int>& cell = cells.of_vertex();
  int64_t count = 0;
  for (size_t v = 0; v < cell.size(); ++v) count += kept[v] = cell[v] >= 0 && is_in[cell[v]];
  if (!scan.is_cloud() || count <= kMostLooked) return kept_part(scan, kept);
  const int64_t step = count / kMostLooked + 1;
  int64_t at = 0;
  for (char& one : kept)
    if (one) one = at++ % step == 0;
  return kept_part(scan, kept);
}

Vec3 point_of(const Mesh& scan, int v) {
  return scan.vertices.row(v).transpose();
}

}  // namespace

float scene_cell_m(int64_t points) {
  const auto count = static_cast<float>(std::max<int64_t>(points, 1));
  return std::clamp(1.3f * std::sqrt(4 / count), 0.05f, 0.12f);
}

Scene::Scene(std::shared_ptr<SkeletonExtractor> extractor) : extractor_(std::move(extractor)) {}

void Scene::restart() {
  *this = Scene(extractor_);
}

SceneFrame Scene::push(const Mesh& scan, float dt) {
  SceneFrame result;
  const Cells cells(scan, scene_cell_m(scan.is_cloud() ? scan.vertices.rows() : 1000000));
  const LookAtCells look = [&](const CellSet& set) {
    return extractor_ ? look_for_person(*extractor_, points_in(scan, cells, set)) : PersonEvidence{};
  };
  CellFrame frame{cells, scan, {}, look, dt};
  result.ground = ground_.push(cells);
  alone_ = is_alone(frame);
  if (*alone_) {
    result.alone = people_.push_alone(frame);
  } else {
    frame.taken = without_scenery(cells);
    result.owner = owners(frame, people_.push(frame, flat_));
    // One frame of somebody alone that is unlike the others does not make a scene.
    if (people_.list().size() == 1 && !people_.any_thing() && flat_.empty() && accepted_cells_ > 0)
      alone_.reset();
  }
  result.people = people_.list();
  result.left_out = people_.left_out();
  return result;
}

/// Decides cheaply: no ground, one set of cells as large as one body. What is near it, pieces of a floor and
/// of things about somebody among it, is looked at once: the extractor knows such.
bool Scene::is_alone(const CellFrame& frame) {
  const Cells& cells = frame.cells;
  if (!extractor_ || cells.count() < kFewestCells) return true;
  if (!flat_.empty() || (alone_ && !*alone_)) return false;
  const int total = cells.count();
  CellSet all(total), large;
  std::iota(all.begin(), all.end(), 0);
  size_t most_cells = 0;
  for (const CellSet& set : connected_sets(cells, std::vector<char>(total, 1))) {
    if (kStray * ssize(set) >= total) large.insert(large.end(), set.begin(), set.end());
    most_cells = std::max(most_cells, set.size());
  }
  if (!is_body_sized(cells, large)) return false;
  const float longest = large.empty() ? 0 : extent_of(cells, large).size().maxCoeff();
  const float in_cells = longest / cells.size_m();  // a surface grows with its square
  const float most = kDenseBody * 0.0025f * in_cells * in_cells;
  const auto largest = static_cast<float>(most_cells);
  const bool is_plain = largest >= kOneSet * static_cast<float>(total) && static_cast<float>(total) <= most;
  if ((is_plain && !ground_.last()) || total <= accepted_cells_) return true;
  const PersonEvidence evidence = frame.look(all);
  // A wide skirt is far from all bones; things beside somebody make the extractor unsure.
  const bool is_in_skirts = !ground_.last() && evidence.covered >= 0.5f && !is_implausible(evidence.seen) &&
                            evidence.seen.confidence.mean() >= kSureInSkirts;
  if (!is_in_skirts && (evidence.quality < kSureAlone || evidence.covered < 0.9f)) return false;
  accepted_cells_ = total + total / 2;
  return true;
}

std::vector<char> Scene::without_scenery(const Cells& cells) const {
  std::vector<char> taken(cells.count(), 1);
  for (int c = 0; c < cells.count(); ++c) {
    const Vec3 p = cells.mean(c);
    // Whatever is below the ground is noise of it.
    const std::optional<Ground>& ground = ground_.last();
    const bool on_ground = ground && ground->plane.above(p) <= ground->thickness_m;
    if (on_ground ||
        std::any_of(flat_.begin(), flat_.end(), [&](const FlatPart& part) { return part.holds(p); }))
      taken[c] = 0;
  }
  return taken;
}

/// Of the ground what is just below somebody are their soles.
std::vector<int> Scene::owners(const CellFrame& frame, const std::vector<int>& of_cell) const {
  const std::vector<int>& cell = frame.cells.of_vertex();
  std::vector<int> owner(cell.size(), People::kNobody);
  const std::optional<Ground>& ground = ground_.last();
  CellMap above(1024);
  std::vector<int> low;
  const auto place_of = [](const Vec3& p) {
    return CellMap::Place(static_cast<int>(std::floor(p.x() / kSole_m)), 0,
                          static_cast<int>(std::floor(p.z() / kSole_m)));
  };
  for (int v = 0; v < ssize(cell); ++v) {
    if (cell[v] < 0) continue;
    const int whose = of_cell[cell[v]];
    owner[v] = frame.taken[cell[v]] ? whose : People::kScenery;
    if (!ground) continue;
    const Vec3 p = point_of(frame.scan, v);
    const float height = ground->plane.above(p) - ground->thickness_m;
    if (height <= 0) {
      owner[v] = People::kScenery;
      if (height > -2 * ground->thickness_m) low.push_back(v);
    } else if (height <= kSoleBand_m && whose > 0) {
      for (int x = -1; x <= 1; ++x)
        for (int z = -1; z <= 1; ++z) above.at(place_of(p) + CellMap::Place(x, 0, z), whose);
    }
  }
  for (const int v : low)
    if (const int whose = above.find(place_of(point_of(frame.scan, v))); whose > 0) owner[v] = whose;
  return owner;
}

Mesh part_of(const Mesh& scan, const SceneFrame& frame, int id) {
  if (frame.owner.empty()) return frame.alone == id ? scan : Mesh{};
  std::vector<char> kept(frame.owner.size());
  for (size_t v = 0; v < kept.size(); ++v) kept[v] = frame.owner[v] == id;
  return kept_part(scan, kept);
}

}  // namespace understudy
