#include "retarget/formats/mesh_reader.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <cmath>
#include <limits>
#include <set>
#include <sstream>

#include "retarget/formats/bytes.hpp"
#include "retarget/formats/file_formats.hpp"
#include "tests/retarget/formats/support.hpp"

namespace understudy {
namespace {

using namespace test;

// The four corners of every face, as positions: vertex numbers may differ (STL).
std::set<std::vector<float>> corner_sets(const Mesh& mesh) {
  std::set<std::vector<float>> out;
  for (Eigen::Index f = 0; f < mesh.faces.rows(); ++f) {
    std::vector<std::vector<float>> corners;
    for (int c = 0; c < 3; ++c) {
      const auto p = mesh.vertices.row(mesh.faces(f, c));
      corners.push_back({p.x(), p.y(), p.z()});
    }
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    std::vector<float> flat;
    for (const auto& corner : corners) flat.insert(flat.end(), corner.begin(), corner.end());
    out.insert(flat);
  }
  return out;
}

TEST(MeshReader, ReadsTheSameTetrahedronFromEveryFormat) {
  const Mesh wanted{four_points(), four_faces(), Points(0, 3)};
  for (const auto& sample : all_samples()) {
    const Mesh mesh = parse_mesh(sample.bytes, "x" + sample.suffix);
    SCOPED_TRACE(sample.suffix + ": " + sample.bytes.substr(0, 40));
    ASSERT_EQ(mesh.vertices.rows(), 4);
    EXPECT_EQ(mesh.faces.rows(), sample.has_faces ? 4 : 0);
    EXPECT_EQ(mesh.is_cloud(), !sample.has_faces);
    EXPECT_EQ(mesh.colors.rows(), 0);
    if (sample.suffix != ".stl") EXPECT_EQ(mesh.vertices, wanted.vertices);
    if (sample.has_faces) EXPECT_EQ(corner_sets(mesh), corner_sets(wanted));
  }
}

TEST(MeshReader, SurvivesEveryTruncation) {
  for (const auto& sample : all_samples()) {
    for (size_t size = 0; size < sample.bytes.size(); ++size) {
      const Warnings warnings;
      try {
        const Mesh mesh = parse_mesh(sample.bytes.substr(0, size), "x" + sample.suffix);
        for (Eigen::Index i = 0; i < mesh.faces.size(); ++i)
          ASSERT_LT(mesh.faces.data()[i], mesh.vertices.rows());
      } catch (const Error& error) {
        ASSERT_TRUE(contains(error.what(), "x" + sample.suffix + ": ")) << error.what();
      }
    }
  }
}

TEST(MeshReader, TruncatedBinaryIsAnErrorAtEveryByte) {
  for (const auto& sample : all_samples()) {
    if (sample.bytes.find('\0') == std::string::npos) continue;
    for (size_t size = 1; size < sample.bytes.size(); ++size)
      ASSERT_NE(error_of([&] { parse_mesh(sample.bytes.substr(0, size), "x" + sample.suffix); }), "")
          << sample.suffix << " cut at " << size << " of " << sample.bytes.size();
  }
}

TEST(MeshReader, RefusesHeadersThatPromiseBillions) {
  const std::string count = "4294967295";
  const auto message = [](const std::string& bytes, const char* name) {
    return error_of([&] { parse_mesh(bytes, name); });
  };
  EXPECT_EQ(message(ascii_ply(count), "a.ply").rfind("a.ply: the header says 4294967295 rows of 'vertex'", 0),
            0u);
  std::string ply = binary_ply(false);
  ply.replace(ply.find("vertex 4"), 8, "vertex " + count);
  EXPECT_TRUE(contains(message(ply, "a.ply"), "4294967295"));
  ply = binary_ply(false);
  ply.replace(ply.find("face 4"), 6, "face 9223372036854775807");
  EXPECT_TRUE(contains(message(ply, "a.ply"), "9223372036854775807"));
  EXPECT_TRUE(contains(message("OFF\n" + count + " 4 6\n" + point_lines(), "a.off"), count));
  EXPECT_TRUE(contains(
      message("OFF BINARY\n" + bytes_of(0x7fffffff, true) + bytes_of(4, true) + bytes_of(6, true), "a.off"),
      "2147483647"));
  std::string stl = binary_stl();
  stl.replace(80, 4, bytes_of(uint32_t{0xffffffff}));
  EXPECT_TRUE(contains(message(stl, "a.stl"), count));
  for (const std::string encoding : {"ascii", "binary", "binary_compressed"}) {
    std::string pcd = pcd_header(encoding);
    pcd.replace(pcd.find("POINTS 4"), 8, "POINTS 2147483647");
    EXPECT_NE(message(pcd + std::string(64, '\1'), "a.pcd"), "") << encoding;
  }
  std::string gltf = gltf_text();
  gltf.replace(gltf.find("\"count\":4"), 9, "\"count\":" + count);
  EXPECT_TRUE(contains(message(gltf, "a.gltf"), count));
}

TEST(MeshReader, KeepsNanAndInfinityAndFinitePointsDropsThem) {
  const Mesh mesh = parse_mesh("nan 0 0\n1 2 3\n4 -inf 0\n1e999 0 0\n5 6 1e-60\n", "a.xyz");
  ASSERT_EQ(mesh.vertices.rows(), 5);
  EXPECT_TRUE(std::isnan(mesh.vertices(0, 0)));
  EXPECT_EQ(mesh.vertices(2, 1), -std::numeric_limits<float>::infinity());
  EXPECT_EQ(finite_count(mesh.vertices), 2);
  Points wanted(2, 3);
  wanted << 1, 2, 3, 5, 6, 0;
  EXPECT_EQ(finite_points(mesh.vertices), wanted);
}

TEST(MeshReader, BelievesTheContentAgainstTheSuffix) {
  const Warnings warnings;
  EXPECT_EQ(parse_mesh(binary_ply(true), "a.obj").faces.rows(), 4);
  EXPECT_EQ(parse_mesh(off_text(), "a").faces.rows(), 4);
  EXPECT_EQ(parse_mesh(glb_bytes(), "a.ply").faces.rows(), 4);
}

TEST(MeshReader, WarnsOfWrongSuffixesOnceAFolder) {
  const auto warns = [](const std::string& path) {
    Warnings warnings;
    parse_mesh(binary_ply(true), path);
    return warnings.contain("these files are PLY despite their suffix");
  };
  EXPECT_TRUE(warns("scans/1.obj"));
  EXPECT_FALSE(warns("scans/2.obj"));
  EXPECT_TRUE(warns("scans/2.off"));
  EXPECT_TRUE(warns("others/1.obj"));
}

TEST(MeshReader, SaysInOneSentenceThatAFileIsSomethingElse) {
  const std::string png = "\x89PNG\r\n\x1a\n" + std::string(200, '\5');
  EXPECT_EQ(error_of([&] { parse_mesh(png, "a.ply"); }), "a.ply: is not PLY despite its suffix");
  EXPECT_TRUE(contains(error_of([&] { parse_mesh(png, "a.xyz"); }), "a.xyz: "));
  EXPECT_EQ(error_of([&] { parse_mesh(png, "a.obj"); }), "a.obj: is not OBJ despite its suffix");
  EXPECT_NE(error_of([&] { parse_mesh(png, "a.stl"); }), "");
  EXPECT_TRUE(contains(error_of([&] { parse_mesh(png, "a.png"); }), "not a known mesh or point cloud"));
  EXPECT_EQ(error_of([&] { parse_mesh("", "a.ply"); }), "a.ply: is empty");
}

TEST(MeshReader, NamesTheReasonWhenAFileCannotBeOpened) {
  const TempFolder folder;
  EXPECT_TRUE(contains(error_of([&] { read_mesh(folder.path("no.ply")); }), "no such file"));
  EXPECT_TRUE(contains(error_of([&] { read_mesh(folder.path()); }), "is a folder"));
  EXPECT_TRUE(contains(error_of([&] { read_mesh("/dev/zero"); }), "is a pipe or a device"));
  EXPECT_TRUE(
      contains(error_of([&] { read_mesh(folder.write("a.ply", "x") + "/b.ply"); }), "Not a directory"));
}

TEST(MeshReader, NamesThePermissionThatIsMissing) {
  const TempFolder folder;
  ::chmod(folder.path().c_str(), 0755);
  const std::string path = folder.write("secret.ply", ascii_ply());
  ::chmod(path.c_str(), 0);
  const bool root = ::geteuid() == 0;
  if (root) ASSERT_EQ(::seteuid(65534), 0);  // root may read everything
  const std::string message = error_of([&] { read_mesh(path); });
  if (root) ASSERT_EQ(::seteuid(0), 0);
  EXPECT_EQ(message, path + ": cannot be opened (Permission denied)");
}

TEST(Ply, ReadsAnyOrderAndTypeOfProperties) {
  std::string ply =
      "ply\r\nformat binary_big_endian 1.0\r\nelement camera 1\r\nproperty double fov\r\nproperty list uchar "
      "float k\r\n"
      "element face 1\r\nproperty uchar flags\r\nproperty list ushort uchar vertex_index\r\nproperty float "
      "quality\r\n"
      "element vertex 4\r\nproperty uchar blue\r\nproperty double z\r\nproperty short y\r\nproperty uchar "
      "red\r\n"
      "property int x\r\nproperty uchar green\r\nelement rest 9\r\nproperty double cut_off\r\nend_header\r\n";
  ply += bytes_of(1.0, true) + '\2' + bytes_of(1.0f, true) + bytes_of(2.0f, true);
  ply += '\7' + bytes_of(uint16_t{4}, true) + std::string("\0\1\2\3", 4) + bytes_of(0.5f, true);
  for (int i = 0; i < 4; ++i)
    ply += std::string(1, '\xff') + bytes_of(0.25 * i, true) + bytes_of(static_cast<int16_t>(-i), true) +
           std::string(1, '\0') + bytes_of(100000 * i, true) + std::string(1, '\x33');
  const Mesh mesh = parse_mesh(ply, "a.ply");
  EXPECT_EQ(mesh.vertices.row(3), Eigen::RowVector3f(300000, -3, 0.75f));
  EXPECT_TRUE(mesh.colors.row(1).isApprox(Eigen::RowVector3f(0, 0.2f, 1)));
  ASSERT_EQ(mesh.faces.rows(), 2);  // a square as two triangles
  EXPECT_EQ(mesh.faces.row(1), Eigen::RowVector3i(0, 2, 3));
}

TEST(Ply, ReadsTriangleStrips) {
  const Mesh mesh = parse_mesh(
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
      "element tristrips 1\nproperty list int int vertex_indices\nend_header\n" +
          point_lines() + "8 0 1 2 3 -1 3 2 1\n",
      "a.ply");
  Faces wanted(3, 3);
  wanted << 0, 1, 2, 2, 1, 3, 3, 2, 1;
  EXPECT_EQ(mesh.faces, wanted);
}

TEST(Ply, RefusesFacesThatNameNoVertex) {
  std::string ply = ascii_ply();
  ply.replace(ply.find("3 0 2 1"), 7, "3 0 9 1");
  EXPECT_EQ(error_of([&] { parse_mesh(ply, "a.ply"); }),
            "a.ply: a face names vertex 9, the file has 4 vertices");
  ply.replace(ply.find("3 0 9 1"), 7, "3 0 -1 1");
  EXPECT_NE(error_of([&] { parse_mesh(ply, "a.ply"); }), "");
}

TEST(Obj, ReadsColoursPolygonsAndContinuedLines) {
  const Mesh mesh = parse_mesh(
      "v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 1 1 0 0 0 1\nv 0 1 \\\n 0 0.5 0.5 0.5\nf 1 2 3 4 # square\n", "a.obj");
  EXPECT_EQ(mesh.faces.rows(), 2);
  EXPECT_EQ(mesh.colors.row(3), Eigen::RowVector3f(0.5f, 0.5f, 0.5f));
  EXPECT_EQ(mesh.vertices.row(3), Eigen::RowVector3f(0, 1, 0));
}

TEST(Obj, NamesTheLineThatIsWrong) {
  EXPECT_EQ(error_of([] { parse_mesh("v 0 0 0\nv 1 0 x\n", "a.obj"); }),
            "a.obj: line 2: 'x' is not a number");
  EXPECT_EQ(error_of([] { parse_mesh("v 0 0 0\nf 1 -2 1\n", "a.obj"); }),
            "a.obj: line 2: a face names vertex -2, which does not exist");
  EXPECT_NE(error_of([] { parse_mesh("v 0 0 0\nf 1 2 3\n", "a.obj"); }), "");
}

TEST(Off, ReadsColoursOfBothKindsAndStepsOverNormals) {
  const Mesh bytes = parse_mesh("COFF 2 0 0\n0 0 0 255 0 51 255\n1 0 0 0 255 0 255\n", "a.off");
  EXPECT_EQ(bytes.colors.row(0), Eigen::RowVector3f(1, 0, 0.2f));
  const Mesh both = parse_mesh("CNOFF\n1 0 0\n1 2 3 0 0 1 0.25 0.5 1 1\n", "a.off");
  EXPECT_EQ(both.colors.row(0), Eigen::RowVector3f(0.25f, 0.5f, 1));
  EXPECT_EQ(parse_mesh("STOFF\n1 0 0\n1 2 3 0 1\n", "a.off").vertices.row(0), Eigen::RowVector3f(1, 2, 3));
  EXPECT_NE(error_of([] { parse_mesh("4OFF\n1 0 0\n1 2 3 4\n", "a.off"); }), "");
}

TEST(Stl, MergesCornersAndTellsBinaryThatBeginsWithSolid) {
  const Mesh mesh = parse_mesh(binary_stl("solid but binary"), "a.stl");
  EXPECT_EQ(mesh.vertices.rows(), 4);
  EXPECT_EQ(mesh.faces.rows(), 4);
}

TEST(Xyz, ReadsHeadingsCountsCommasAndColours) {
  const Mesh csv = parse_mesh("\"Z\",\"X\",\"Y\",\"R\",\"G\",\"B\"\n3,1,2,255,0,51\n6,4,5,0,0,0\n", "a.csv");
  EXPECT_EQ(csv.vertices.row(1), Eigen::RowVector3f(4, 5, 6));
  EXPECT_EQ(csv.colors.row(0), Eigen::RowVector3f(1, 0, 0.2f));
  EXPECT_EQ(parse_mesh("2\n1 2 3\n4 5 6\n", "a.pts").vertices.rows(), 2);
  EXPECT_EQ(parse_mesh("// exported\r\n1;2;3\r\n\r\n4;5;6\r\n", "a.txt").vertices.rows(), 2);
  EXPECT_EQ(parse_mesh("1 2 3 0 -1 0\n4 5 6 0 0 1\n", "a.xyz").colors.rows(), 0);         // normals
  EXPECT_EQ(parse_mesh("1 2 3 9 10 20 30\n4 5 6 9 255 0 0\n", "a.xyz").colors(1, 0), 1);  // intensity first
  EXPECT_EQ(error_of([] { parse_mesh("1 2 3\n4 5\n", "a.xyz"); }), "a.xyz: line 2: fewer than 3 numbers");
}

TEST(Pcd, ReadsPackedColoursPaddingAndDoubles) {
  std::string pcd =
      "# .PCD v.7 - Point Cloud Data file format\nVERSION .7\nFIELDS rgb _ z y x\nSIZE 4 1 8 8 8\nTYPE U U F "
      "F F\n"
      "COUNT 1 3 1 1 1\nWIDTH 1\nHEIGHT 2\nDATA binary\n";
  for (int i = 0; i < 2; ++i)
    pcd += bytes_of(uint32_t{0x00ff0033}) + "pad" + bytes_of(3.0) + bytes_of(2.0) + bytes_of(1.0 + i);
  const Mesh mesh = parse_mesh(pcd, "a.pcd");
  EXPECT_EQ(mesh.vertices.row(1), Eigen::RowVector3f(2, 2, 3));
  EXPECT_EQ(mesh.colors.row(1), Eigen::RowVector3f(1, 0, 0.2f));
}

TEST(Pcd, RepeatsBackReferencesOfCompressedData) {
  // One literal byte 0 and a reference of 2+7+30 to it: 40 bytes of zeros, then 8 more literal ones.
  const std::string packed =
      std::string("\0\0", 2) + static_cast<char>(7 << 5) + '\x1e' + '\0' + '\7' + std::string(8, '\0');
  const Mesh mesh =
      parse_mesh(pcd_header("binary_compressed") + bytes_of(static_cast<uint32_t>(packed.size())) +
                     bytes_of(uint32_t{48}) + packed,
                 "a.pcd");
  EXPECT_EQ(mesh.vertices, Points::Zero(4, 3));
}

/// The names in a sentence of the README: "PLY, OBJ or GLB" from `begin` to `end`; none when it is not there.
std::vector<std::string> promised(const std::string& begin, const std::string& end) {
  const std::string readme = read_file(US_SOURCE_DIR "/README.md");
  const size_t from = readme.find(begin);
  if (from == readme.npos) return {};
  std::istringstream words(readme.substr(from, readme.find(end, from) - from).substr(begin.size()));
  std::vector<std::string> names;
  for (std::string word; words >> word;) {
    word.erase(std::remove(word.begin(), word.end(), ','), word.end());
    if (word.size() > 2 && std::isupper(static_cast<unsigned char>(word[1]))) names.push_back(word);
  }
  return names;
}

TEST(FileFormats, WhatTheReadmePromisesIsInTheTable) {
  const std::tuple<const char*, const char*, unsigned> sentences[] = {
      {"`SCANS` is a folder of ", " frames", kScanFrame},
      {"or one ", " of T x N x 3", kScanSequence},
      {"*Targets* are ", " or a cloud", kTarget},
      {"*Sources may be skeletons*: BVH, AMASS ", ". Their bones", kMotion}};
  for (const auto& [begin, end, use] : sentences) {
    const auto names = promised(begin, end);
    EXPECT_FALSE(names.empty()) << begin;
    for (const std::string& name : names) {
      std::istringstream either(name);
      for (std::string one; std::getline(either, one, '/');) EXPECT_TRUE(can_be("x." + one, use)) << one;
    }
  }
}

TEST(FileFormats, NoTwoOfOneUseHaveTheSameSuffix) {
  for (unsigned use = kScanFrame; use <= kCase; use *= 2) {
    std::set<std::string> seen;
    for (const std::string& suffix : format_suffixes(use)) EXPECT_TRUE(seen.insert(suffix).second) << suffix;
  }
}

}  // namespace
}  // namespace understudy
