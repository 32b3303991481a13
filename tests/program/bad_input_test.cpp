// What the shipped program does with input that is wrong.
#include <signal.h>

#include <cmath>
#include <fstream>
#include <limits>

#include "retarget/formats/npz.hpp"
#include "tests/app/cli_fixture.hpp"

namespace understudy::tests {
namespace {

namespace fs = std::filesystem;

class BadInput : public ShippedProgram {
 protected:
  std::string folder(const std::string& name) {
    fs::create_directories(scratch.path(name));
    return scratch.path(name);
  }
  /// Good scans with frame 2 replaced by a file of these bytes.
  std::string with_bad_frame(const std::string& bytes) {
    const std::string path = scratch.path("scans");
    write_scans(path, kFrames);
    write_text(path + "/" + frame_name(2), bytes);
    return path;
  }
  /// All frames come out, and only frame 2 is flagged and repeats frame 1.
  void expect_frame_2_flagged(const std::string& source) {
    const Finished run = retarget(source, {"--out", out("a.npz"), "--report", out("a.json")});
    ASSERT_EQ(run.code, 0) << run.err;
    EXPECT_NE(run.err.find("frame 2 repeats the last pose"), std::string::npos) << run.err;
    EXPECT_NE(read_bytes(out("a.json")).find("\"flagged\": 1"), std::string::npos)
        << read_bytes(out("a.json"));
    const NpyArray joints = read_npz(out("a.npz")).at("joints");
    ASSERT_EQ(joints.shape[0], kFrames);
    for (int i = 0; i < 66; ++i) EXPECT_EQ(joints.values[2 * 66 + i], joints.values[66 + i]);
    for (const float x : joints.values) ASSERT_TRUE(std::isfinite(x));
  }
  static std::string ply(const std::string& count, const Points& points) {
    std::string bytes = "ply\nformat binary_little_endian 1.0\nelement vertex " + count +
                        "\nproperty float x\nproperty float y\nproperty float z\nend_header\n";
    return bytes.append(reinterpret_cast<const char*>(points.data()), static_cast<size_t>(points.size()) * 4);
  }
};

TEST_F(BadInput, EmptyFolder) {
  expect_clean_failure(retarget(folder("empty"), {"--out", out("a.glb")}), "empty");
}

TEST_F(BadInput, NoSuchSource) {
  expect_clean_failure(retarget(scratch.path("absent"), {"--out", out("a.glb")}), "absent");
}

TEST_F(BadInput, NoSuchTarget) {
  expect_clean_failure(run_program({"retarget", "--source", scans(), "--target", scratch.path("absent.obj"),
                                    "--out", out("a.glb")}),
                       "absent.obj");
}

TEST_F(BadInput, OneFrameIsAPoseAndSaysSo) {
  write_scans(folder("one"), 1);
  const Finished run = retarget(scratch.path("one"), {"--out", out("a.glb")});
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_NE(run.err.find("only one frame"), std::string::npos) << run.err;
  EXPECT_EQ(out_files(), std::vector<std::string>{"a.glb"});
}

TEST_F(BadInput, AFrameWithNoPoints) {
  expect_frame_2_flagged(with_bad_frame(ply("0", Points(0, 3))));
}

TEST_F(BadInput, AFrameWithThreePoints) {
  expect_frame_2_flagged(with_bad_frame(ply("3", person_points(2).topRows(3))));
}

TEST_F(BadInput, OnlyAFrameWithThreePoints) {
  write_text(folder("three") + "/" + frame_name(0), ply("3", person_points(0).topRows(3)));
  expect_clean_failure(retarget(scratch.path("three"), {"--out", out("a.glb")}), "three");
}

TEST_F(BadInput, AGroundWithoutAnybody) {
  Rng rng(1);
  Points ground(4000, 3);
  for (auto row : ground.rowwise()) row << rng.uniform(-2, 2), 0.004f * rng.normal(), rng.uniform(-2, 2);
  for (const int frame : {0, 1}) write_text(folder("ground") + "/" + frame_name(frame), ply("4000", ground));
  const std::string says = "no frame in it could be used: " + scratch.path("ground");
  expect_clean_failure(retarget(scratch.path("ground"), {"--out", out("a.glb")}), says);
  expect_clean_failure(run_program({"measure", scratch.path("ground"), "--out", out("a.json")}), says);
  expect_clean_failure(retarget(scratch.path("ground"), {"--units", "m", "--up", "y", "--out", out("a.glb")}),
                       "no frame in it could be used: nobody is seen in it");
}

TEST_F(BadInput, AFrameOfNanAndInfinity) {
  Points points = person_points(2);
  points.topRows(1000).setConstant(std::numeric_limits<float>::quiet_NaN());
  points.bottomRows(1500).setConstant(std::numeric_limits<float>::infinity());
  expect_frame_2_flagged(with_bad_frame(ply("2500", points)));
}

TEST_F(BadInput, SomeCoordinatesThatAreNoNumbersAreLeftOut) {
  Points points = person_points(2);
  points.topRows(20).setConstant(std::numeric_limits<float>::quiet_NaN());
  const Finished run = retarget(with_bad_frame(ply("2500", points)), {"--report", out("a.json")});
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_NE(read_bytes(out("a.json")).find("\"flagged\": 0"), std::string::npos);
}

TEST_F(BadInput, ATruncatedFrame) {
  expect_frame_2_flagged(with_bad_frame(ply("2500", person_points(2).topRows(900))));
}

TEST_F(BadInput, AFrameWhoseHeaderLies) {
  expect_frame_2_flagged(with_bad_frame(ply("4294967295", person_points(2))));
}

TEST_F(BadInput, ATargetWhoseHeaderLies) {
  write_text(scratch.path("liar.ply"), ply("4294967295", person_points(0)));
  expect_clean_failure(run_program({"retarget", "--source", scans(), "--target", scratch.path("liar.ply"),
                                    "--out", out("a.glb")}),
                       "liar.ply");
}

TEST_F(BadInput, ATruncatedTarget) {
  write_text(scratch.path("half.obj"), "v 1 2\nf 1 2 3\n");
  expect_clean_failure(run_program({"retarget", "--source", scans(), "--target", scratch.path("half.obj"),
                                    "--out", out("a.glb")}),
                       "half.obj");
}

TEST_F(BadInput, AnArrayCutShort) {
  std::string npy("\x93NUMPY\x01\x00\x46\x00", 10);
  std::string dict = "{'descr': '<f4', 'fortran_order': False, 'shape': (4000000000, 100, 3), }";
  dict.resize(0x46 - 1, ' ');
  write_text(scratch.path("a.npy"), npy + dict + "\n1234");
  expect_clean_failure(retarget(scratch.path("a.npy"), {"--out", out("a.glb")}), "a.npy");
}

TEST_F(BadInput, MixedFormats) {
  write_scans(folder("mixed"), 2);
  for (const char* name : {"frame_00002.xyz", "frame_00003.xyz"})
    write_text(scratch.path("mixed/") + name, "0 0 0\n");
  expect_clean_failure(retarget(scratch.path("mixed"), {"--out", out("a.glb")}), "mixed");
}

TEST_F(BadInput, ASuffixThatIsWrongIsToldAndTheBytesAreBelieved) {
  write_cloud(scratch.path("target.stl"), person_points(0));
  const Finished run = run_program(
      {"retarget", "--source", scans(), "--target", scratch.path("target.stl"), "--out", out("a.glb")});
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_NE(run.err.find("target.stl"), std::string::npos) << run.err;
}

TEST_F(BadInput, AFileThatIsNoMesh) {
  write_text(scratch.path("letter.ply"), "Dear reader,\nthis is no mesh.\n");
  expect_clean_failure(run_program({"retarget", "--source", scans(), "--target", scratch.path("letter.ply"),
                                    "--out", out("a.glb")}),
                       "letter.ply");
}

TEST_F(BadInput, NoPermissionToRead) {
  write_scans(folder("secret"), 1);
  fs::permissions(scratch.path("secret"), fs::perms::none);
  ProgramOptions options;
  options.obey_permissions = true;
  const Finished run = retarget(scratch.path("secret"), {"--out", out("a.glb")}, options);
  fs::permissions(scratch.path("secret"), fs::perms::owner_all);
  expect_clean_failure(run, "secret");
}

TEST_F(BadInput, NoPermissionToWrite) {
  expect_clean_failure(retarget(scans(), {"--out", "/proc/a.glb"}), "/proc/a.glb");
}

TEST_F(BadInput, AnOutputFormatThatIsNotKnown) {
  expect_clean_failure(retarget(scans(), {"--out", out("a.mp3")}), "a.mp3");
}

TEST_F(BadInput, ATargetThatIsNoPersonIsUsedWhereToldSoWithAWarning) {
  std::string box;
  for (int i = 0; i < 1000; ++i)
    box += "v " + std::to_string(0.1 * (i % 10)) + ' ' + std::to_string(0.1 * (i / 10 % 10)) + ' ' +
           std::to_string(0.1 * (i / 100)) + '\n';
  write_text(scratch.path("box.obj"), box);
  std::vector<std::string> arguments = {"retarget", "--source",  scans(), "--target", scratch.path("box.obj"),
                                        "--out",    out("a.glb")};
  expect_clean_failure(run_program(arguments), "--use-anyway");
  arguments.push_back("--use-anyway");
  const Finished run = run_program(arguments);
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_NE(run.err.find("warning"), std::string::npos) << run.err;
}

TEST_F(BadInput, AFullDisk) {
  for (const char* name : {"a.glb", "a.npz", "a.png"}) {
    ProgramOptions options;
    options.file_size_limit = 4096;
    expect_clean_failure(
        retarget(scans(), {std::string(name) == "a.png" ? "--preview" : "--out", out(name)}, options), name);
  }
}

TEST_F(BadInput, WeightsThatAreMissing) {
  ProgramOptions options;
  options.environment = {"UNDERSTUDY_WEIGHTS=" + folder("none")};
  expect_clean_failure(retarget(scans(), {"--out", out("a.glb")}, options), "weights");
  expect_clean_failure(retarget(scans(), {"--out", out("a.glb"), "--weights", folder("none")}), "weights");
}

TEST_F(BadInput, WeightsOfAnotherVersion) {
  fs::copy(US_SOURCE_DIR "/assets/weights", scratch.path("weights"), fs::copy_options::recursive);
  const std::string path = scratch.path("weights/skeleton.weights");
  std::string bytes = read_bytes(path);
  const size_t at = bytes.find("\"version\":");
  ASSERT_NE(at, std::string::npos);
  bytes[at + 10] = '9';
  write_text(path, bytes);
  expect_clean_failure(retarget(scans(), {"--out", out("a.glb"), "--weights", scratch.path("weights")}),
                       "version");
}

TEST_F(BadInput, WeightsCutShort) {
  fs::copy(US_SOURCE_DIR "/assets/weights", scratch.path("weights"), fs::copy_options::recursive);
  fs::resize_file(scratch.path("weights/skeleton.weights"), 5000);
  expect_clean_failure(retarget(scans(), {"--out", out("a.glb"), "--weights", scratch.path("weights")}),
                       "skeleton.weights");
}

TEST_F(BadInput, CtrlC) {
  write_scans(folder("live"), 2);
  Program program({"retarget", "--source", scratch.path("live"), "--target", target(), "--follow", "--out",
                   out("a.glb"), "--report", out("a.json")});
  ASSERT_TRUE(program.wait_for("frame 0 "));
  program.send(SIGINT);
  expect_clean_failure(program.finish(), "interrupted");
}

}  // namespace
}  // namespace understudy::tests
