// A scan in cubic cells: what is looked at where points are too many.
#pragma once

#include <cstdint>
#include <vector>

#include "retarget/geometry/mesh.hpp"

namespace understudy {

/// Numbers, 0 .. , of cells by their place. Grows with the cells alone.
class CellMap {
 public:
  using Place = Eigen::Vector3i;
  /// Room for so many before it grows.
  explicit CellMap(size_t expected = 16);
  /// The cell's number; `added` it gets where it has none.
  int& at(const Place& place, int added);
  /// -1: none.
  int find(const Place& place) const;
  size_t size() const { return used_; }

 private:
  struct Slot {
    uint64_t key;
    int number;  // -1: free
  };
  size_t slot_of(uint64_t key) const;
  void grow();

  std::vector<Slot> slots_;  // a power of two, open addressing
  size_t used_ = 0;
};

/// The cells that a scan's surface is in. A mesh's triangles are in all cells that they cross, however few
/// corners they have.
class Cells {
 public:
  using Place = CellMap::Place;
  /// Points that are not finite, or further out than 50 km, are in no cell. Throws Error for a size that is
  /// not positive.
  Cells(const Mesh& scan, float size_m);

  int count() const { return static_cast<int>(places_.size()); }
  float size_m() const { return size_; }
  /// Of each vertex the cell that it is in; -1: none. [V]
  const std::vector<int>& of_vertex() const { return of_vertex_; }
  const Place& place(int cell) const { return places_[cell]; }
  /// The mean of what is in a cell, metres.
  Vec3 mean(int cell) const { return means_.row(cell).transpose(); }
  const Points& means() const { return means_; }
  /// The cell at a place; -1: it is empty.
  int find(const Place& place) const { return map_.find(place); }
  Place place_of(const Vec3& point) const;

 private:
  void add(const Vec3& point, int vertex);
  void add_faces(const Mesh& scan);

  float size_, inverse_;
  CellMap map_;
  std::vector<Place> places_;
  std::vector<int> of_vertex_, counts_;
  Points means_{0, 3};
};

/// Cells that belong together, by number.
using CellSet = std::vector<int>;

/// A cell's 26 neighbours, nearest first.
const std::vector<CellMap::Place>& neighbour_cells();

/// Numbers of the connected sets among the cells for which `taken` is not 0, 0 .. ; -1: not taken. Cells
/// touch where they share a corner.
std::vector<int> connected_cells(const Cells& cells, const std::vector<char>& taken, int* count = nullptr);
/// The same sets, each with its cells in ascending order, by their lowest cell.
std::vector<CellSet> connected_sets(const Cells& cells, const std::vector<char>& taken);

}  // namespace understudy
