// Broken files of every format: bytes changed, cut out and doubled with fixed seeds. Nothing but Error may
// come out.
#include "retarget/formats/mesh_reader.hpp"
#include "tests/retarget/formats/support.hpp"

namespace understudy {
namespace {

using namespace test;

std::string mutated(std::string bytes, Rng& rng) {
  static const std::string kInteresting[] = {"-1",  "4294967295",       "999999999999999999999",
                                             "nan", "\xff\xff\xff\xff", "\n"};
  for (int n = 1 + rng.below(4); n > 0 && !bytes.empty(); --n) {
    const auto at = static_cast<size_t>(rng.below(static_cast<int>(bytes.size())));
    switch (rng.below(5)) {
      case 0:
        bytes[at] = static_cast<char>(rng.below(256));
        break;
      case 1:
        bytes[at] = static_cast<char>(bytes[at] ^ (1 << rng.below(8)));
        break;
      case 2:
        bytes.erase(at, static_cast<size_t>(1 + rng.below(8)));
        break;
      case 3:
        bytes.insert(at, kInteresting[rng.below(6)]);
        break;
      default:
        bytes.insert(at, bytes.substr(at, static_cast<size_t>(1 + rng.below(30))));
        break;
    }
  }
  return bytes;
}

TEST(Fuzz, BrokenFilesGiveAnErrorOrAValidMesh) {
  const Warnings warnings;
  Rng rng(20);
  for (const auto& sample : all_samples()) {
    int errors = 0;
    for (int i = 0; i < 2000; ++i) {
      try {
        const Mesh mesh = parse_mesh(mutated(sample.bytes, rng), "x" + sample.suffix);
        ASSERT_LE(mesh.vertices.rows(), 100000);
        for (Eigen::Index k = 0; k < mesh.faces.size(); ++k) {
          ASSERT_GE(mesh.faces.data()[k], 0);
          ASSERT_LT(mesh.faces.data()[k], mesh.vertices.rows());
        }
        ASSERT_TRUE(mesh.colors.rows() == 0 || mesh.colors.rows() == mesh.vertices.rows());
      } catch (const Error&) {
        ++errors;
      }
    }
    EXPECT_GT(errors, 0) << sample.suffix;
  }
}

}  // namespace
}  // namespace understudy
