// NumPy arrays: .npy and .npz files.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "retarget/math/types.hpp"

namespace understudy {

using IntegerMatrix = Eigen::Matrix<int64_t, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// One array, converted to float (numbers of any NumPy type) or kept as text (type U).
struct NpyArray {
  std::vector<int64_t> shape;
  std::vector<float> values;        ///< C order
  std::string text;                 ///< for a scalar string; of several the first
  std::vector<int64_t> whole = {};  ///< of an array of integers the same without loss, up to 9e15; beyond: -1
  std::vector<std::string> texts = {};  ///< of an array of strings, C order; 65,536 at most
  int64_t size() const { return static_cast<int64_t>(values.size()); }
  /// As a matrix of `cols` columns. Throws Error (naming `what`) when it does not divide.
  RowMatrix matrix(int64_t cols, const std::string& what) const;
  /// The same of whole numbers without loss; what a float array has behind the point is cut off.
  IntegerMatrix integers(int64_t cols, const std::string& what) const;
};

using Npz = std::map<std::string, NpyArray>;

/// Reads one .npy from bytes in memory; `source` names it in errors. Sizes are checked before anything is
/// allocated.
NpyArray parse_npy(const std::string& bytes, const std::string& source);
/// Reads every array of a .npz (zip, stored or deflated). Arrays of other kinds (objects) are left out.
Npz read_npz(const std::string& path);
/// Names of its arrays; nothing else is read.
std::vector<std::string> npz_names(const std::string& path);
/// The array `name` of `npz`, or an Error naming the file and the array.
const NpyArray& require(const Npz& npz, const std::string& name, const std::string& source);
/// Writes float32 arrays, beside the path first, then renamed.
void write_npz(const std::string& path, const Npz& npz);

}  // namespace understudy
