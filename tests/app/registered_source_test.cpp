#include "app/run/registered_source.hpp"

#include <gtest/gtest.h>

#include <array>
#include <fstream>
#include <set>

#include "retarget/base/error.hpp"
#include "retarget/base/text.hpp"
#include "retarget/body/builtin_person.hpp"
#include "tests/app/program.hpp"
#include "tests/app/sample_files.hpp"

namespace understudy::app {
namespace {

using tests::ScratchFolder;

/// The built-in person as OBJ frames of one topology, one centimetre further along z in each.
class Captures : public testing::Test {
 protected:
  void write_frame(int number, Eigen::Index faces = -1) const {
    static const ShapedBody body = builtin_person();
    std::ofstream file(scratch.path(printed("frame_%05d.obj", number)));
    for (Eigen::Index v = 0; v < body.vertices.rows(); ++v)
      file << "v " << body.vertices(v, 0) << ' ' << body.vertices(v, 1) << ' '
           << body.vertices(v, 2) + 0.01f * static_cast<float>(number) << '\n';
    for (Eigen::Index f = 0; f < (faces < 0 ? body.faces.rows() : faces); ++f)
      file << "f " << body.faces(f, 0) + 1 << ' ' << body.faces(f, 1) + 1 << ' ' << body.faces(f, 2) + 1
           << '\n';
  }
  std::unique_ptr<Source> opened(Registered registered) const {
    SourceOptions options;
    options.path = scratch.path("");
    options.quiet = true;
    return hide_topology(open_source(options), options, registered);
  }
  ScratchFolder scratch;
};

using Place = std::array<float, 3>;
Place place(const Points& points, Eigen::Index v) {
  return {points(v, 0), points(v, 1), points(v, 2)};
}

/// The triangles by their places, however they are numbered.
std::multiset<std::array<Place, 3>> triangles(const Points& vertices, const Faces& faces) {
  std::multiset<std::array<Place, 3>> all;
  for (Eigen::Index f = 0; f < faces.rows(); ++f)
    all.insert({place(vertices, faces(f, 0)), place(vertices, faces(f, 1)), place(vertices, faces(f, 2))});
  return all;
}

TEST_F(Captures, OfOneTopologyAreShuffledAndKeptInOrderBeside) {
  for (const int number : {0, 1, 2}) write_frame(number);
  const auto source = opened(Registered::Auto);
  const auto first = source->next(), second = source->next();
  ASSERT_TRUE(first && second);
  EXPECT_EQ(first->number, 0);  // what was looked at to decide is not lost
  ASSERT_EQ(first->registered.rows(), first->mesh.vertices.rows());
  EXPECT_NEAR((second->registered - first->registered).col(2).minCoeff(), 0.01f, 1e-5);
  EXPECT_NEAR((second->registered - first->registered).col(2).maxCoeff(), 0.01f, 1e-5);
  // The same surface, but a number tells nothing: neither in the frame nor from frame to frame.
  const ShapedBody body = builtin_person();
  EXPECT_EQ(triangles(first->mesh.vertices, first->mesh.faces), triangles(first->registered, body.faces));
  EXPECT_GT((first->mesh.vertices - first->registered).rowwise().norm().mean(), 0.1f);
  EXPECT_GT((second->mesh.vertices - first->mesh.vertices).rowwise().norm().mean(), 0.1f);
  EXPECT_NE(first->mesh.faces, second->mesh.faces);
}

TEST_F(Captures, OfOtherTopologiesAreLeftAsTheyAre) {
  write_frame(0);
  write_frame(1, 100);
  const auto frame = opened(Registered::Auto)->next();
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->registered.rows(), 0);
  EXPECT_EQ(frame->mesh.faces, builtin_person().faces);
}

TEST_F(Captures, AreNotJudgedInAFrameOfAnotherTopology) {
  for (const int number : {0, 1, 3}) write_frame(number);
  write_frame(2, 100);
  const auto source = opened(Registered::Auto);
  std::vector<bool> judged;
  while (const auto frame = source->next()) judged.push_back(frame->registered.rows() > 0);
  EXPECT_EQ(judged, (std::vector<bool>{true, true, false, true}));
}

TEST_F(Captures, ObeyTheUser) {
  for (const int number : {0, 1}) write_frame(number, 100 * number + 100);
  EXPECT_EQ(opened(Registered::Yes)->next()->registered.rows(), builtin_person().vertices.rows());
  tests::write_text(scratch.path("frame_00002.obj"), "v 0 0 0\nv 0 1 0\nv 1 0 0\nf 1 2 3\n");
  const auto source = opened(Registered::Yes);
  source->next(), source->next();
  EXPECT_THROW(source->next(), Error);
  for (const int number : {1, 2}) write_frame(number, 100);
  EXPECT_EQ(opened(Registered::No)->next()->registered.rows(), 0);
}

}  // namespace
}  // namespace understudy::app
