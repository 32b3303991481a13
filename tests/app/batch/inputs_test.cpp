#include "app/batch/inputs.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "retarget/base/error.hpp"
#include "tests/app/program.hpp"
#include "tests/app/sample_files.hpp"

namespace understudy::app {
namespace {

namespace fs = std::filesystem;
using tests::write_text;

class BatchInputs : public testing::Test {
 protected:
  std::string made(const std::string& name, const std::string& text) {
    fs::create_directories(fs::path(scratch.path(name)).parent_path());
    write_text(scratch.path(name), text);
    return scratch.path(name);
  }
  std::string hash(const std::string& name) { return hash_of(files_of(scratch.path(name))); }
  tests::ScratchFolder scratch;
};

TEST_F(BatchInputs, OfAFolderAreItsOwnFiles) {
  made("scans/b.ply", "2"), made("scans/a.ply", "1"), made("scans/.hidden", "x"),
      made("scans/out/c.ply", "3");
  EXPECT_EQ(files_of(scratch.path("scans")),
            (std::vector<std::string>{scratch.path("scans/a.ply"), scratch.path("scans/b.ply")}));
  const std::string before = hash("scans");
  made("scans/out/c.ply", "another");
  EXPECT_EQ(hash("scans"), before);
  made("scans/b.ply", "3");
  EXPECT_NE(hash("scans"), before) << "another content";
  made("scans/b.ply", "2");
  EXPECT_EQ(hash("scans"), before) << "the old one again";
  fs::rename(scratch.path("scans/b.ply"), scratch.path("scans/c.ply"));
  EXPECT_NE(hash("scans"), before) << "another name";
}

TEST_F(BatchInputs, OfAFileAreThoseThatItNames) {
  made("t.obj", "mtllib my cloth.mtl\nv 0 0 0\n"), made("my cloth.mtl", "newmtl a\nmap_Kd cloth.png\n");
  made("cloth.png", "red"), made("other.png", "x");
  EXPECT_EQ(files_of(scratch.path("t.obj")).size(), 3u);
  const std::string before = hash("t.obj");
  made("cloth.png", "blue");
  EXPECT_NE(hash("t.obj"), before);

  made("t.gltf", R"({"buffers": [{"uri": "t.bin"}, {"uri": "data:,x"}], "images": [{"uri": "gone.png"}]})");
  made("t.bin", "1");
  EXPECT_EQ(files_of(scratch.path("t.gltf")).size(), 2u);
  made("scans.lst", "a/1.ply\n\n  a/2.ply\n"), made("a/1.ply", "1"), made("a/2.ply", "2");
  EXPECT_EQ(files_of(scratch.path("scans.lst")).size(), 3u);
}

TEST_F(BatchInputs, ThatAreMissingAreNamed) {
  const std::string path = scratch.path("nowhere");
  EXPECT_EQ(failure_of([&] { files_of(path); }).find(path + ": "), 0u);
}

TEST_F(BatchInputs, AreKnownAgainByStampOrContent) {
  const std::string path = made("a.ply", "one");
  const InputRecord record = record_input(path);
  EXPECT_EQ(record.bytes, 3);
  EXPECT_TRUE(is_as_recorded(record));
  InputRecord by_stamp = record, by_content = record;
  by_stamp.hash = "not looked at";
  by_content.stamp = "of another time";
  EXPECT_TRUE(is_as_recorded(by_stamp));
  EXPECT_TRUE(is_as_recorded(by_content)) << "a copy";
  made("a.ply", "two");
  EXPECT_FALSE(is_as_recorded(record));
  EXPECT_EQ(to_json(input_record(to_json(record))).dump(), to_json(record).dump());
}

}  // namespace
}  // namespace understudy::app
