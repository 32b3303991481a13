// Algorithm 1 of paper 3 on graphs that one can draw, and Algorithm 2 on surfaces of a few points.
#include "retarget/marionette/affinity_tree.hpp"

#include "retarget/base/error.hpp"
#include "retarget/marionette/keypoint_skin.hpp"

namespace understudy {
namespace {

struct Edge {
  int from, to;
  float affinity;
};
RowMatrix affinity(int keypoints, const std::vector<Edge>& edges) {
  RowMatrix made = RowMatrix::Zero(keypoints, keypoints);
  for (const Edge& edge : edges) made(edge.from, edge.to) = edge.affinity;
  return made;
}
/// In one matrix, and a second that has nothing to say.
std::vector<RowMatrix> with_empty(const RowMatrix& first) {
  return {first, RowMatrix::Zero(first.rows(), first.cols())};
}
std::vector<Edge> both_ways(std::vector<Edge> edges) {
  const size_t count = edges.size();
  for (size_t e = 0; e < count; ++e) edges.push_back({edges[e].to, edges[e].from, edges[e].affinity});
  return edges;
}

TEST(TreeOfAffinity, HangsAChainOnItsMiddle) {
  // 0 - 1 - 2 - 3 - 4: keypoint 2 has 1 + 2 + 1 + 2 steps to the others, 1 and 3 have 7. The ends' second
  // neighbours are those two steps away.
  const auto chain = affinity(
      5, both_ways({{0, 1, 0.9f}, {1, 2, 0.9f}, {2, 3, 0.9f}, {3, 4, 0.9f}, {0, 2, 0.1f}, {2, 4, 0.1f}}));
  const std::vector<int> tree = tree_of_affinity(with_empty(chain));
  EXPECT_EQ(tree[2], -1);
  EXPECT_EQ(tree[1], 2);
  EXPECT_EQ(tree[3], 2);
}

TEST(TreeOfAffinity, EachMatrixGivesANeighbour) {
  const RowMatrix star = affinity(4, {{0, 3, 0.9f}, {1, 3, 0.9f}, {2, 3, 0.9f}, {3, 0, 0.9f}});
  EXPECT_EQ(tree_of_affinity({star}), (std::vector<int>{3, 3, 3, -1}));
  // One matrix leads up the chain 0 - 1 - 2 - 3 - 4, the other down.
  const RowMatrix up = affinity(5, {{0, 1, 0.9f}, {1, 2, 0.9f}, {2, 3, 0.9f}, {3, 4, 0.9f}, {4, 2, 0.1f}}),
                  down = affinity(5, {{4, 3, 0.9f}, {3, 2, 0.9f}, {2, 1, 0.9f}, {1, 0, 0.9f}, {0, 2, 0.1f}});
  const std::vector<int> tree = tree_of_affinity({up, down});
  EXPECT_EQ(tree[2], -1);
  EXPECT_EQ(tree[1], 2);
  EXPECT_EQ(tree[3], 2);
}

TEST(TreeOfAffinity, OnePieceIsJoinedToTheOtherRootToRoot) {
  // A star about 1 of four and a star about 5 of three, a neighbour each: 0 2 3 - 1, 4 6 - 5.
  const RowMatrix pieces =
      affinity(7, {{0, 1, 1}, {2, 1, 1}, {3, 1, 1}, {1, 0, 1}, {4, 5, 1}, {6, 5, 1}, {5, 4, 1}});
  EXPECT_EQ(tree_of_affinity({pieces}), (std::vector<int>{1, -1, 1, 1, 5, 1, 5}));
}

TEST(TreeOfAffinity, AnyNumberOfPiecesBecomesOneTree) {
  std::vector<Edge> pairs;
  for (int i = 0; i < 12; i += 2) pairs.push_back({i, i + 1, 1}), pairs.push_back({i + 1, i, 1});
  const std::vector<int> tree = tree_of_affinity({affinity(12, pairs)});
  EXPECT_EQ(std::count(tree.begin(), tree.end(), -1), 1);
  for (int k = 0; k < 12; ++k) {
    int at = k, steps = 0;
    while (at >= 0 && steps++ < 12) at = tree[static_cast<size_t>(at)];
    EXPECT_EQ(at, -1) << k;
  }
}

/// 0 the root, in the middle of 1 to 5; 1 and 2 are neighbours and equally far from 0 (the larger of both
/// directions counts for the way), but one of them is more affine to the root in A_0j.
std::vector<RowMatrix> same_rank(float to_one, float to_two) {
  const RowMatrix A = affinity(6, {{1, 0, 0.9f},
                                   {2, 0, 0.9f},
                                   {3, 0, 0.9f},
                                   {4, 0, 0.9f},
                                   {5, 0, 0.9f},
                                   {1, 2, 0.8f},
                                   {2, 1, 0.8f},
                                   {0, 1, to_one},
                                   {0, 2, to_two}});
  return with_empty(A);
}

TEST(TreeOfAffinity, OfNeighboursAsFarFromTheRootOneMayHangOnTheOther) {
  EXPECT_EQ(tree_of_affinity(same_rank(0.5f, 0.4f))[1], 0);
  EXPECT_EQ(tree_of_affinity(same_rank(0.5f, 0.4f))[2], 1) << "A_01 > A_02";
  EXPECT_EQ(tree_of_affinity(same_rank(0.4f, 0.5f))[1], 2) << "A_02 > A_01";
  EXPECT_EQ(tree_of_affinity(same_rank(0.4f, 0.5f))[2], 0);
}

TEST(TreeOfAffinity, AnEdgeOfMoreAffinityBreaksTheTie) {
  // 3 is two steps from the root 0, by 1 and by 2; by 2 more nearly, so 1 is the lower in rank of the two.
  const RowMatrix A = affinity(7, {{1, 0, 0.5f},
                                   {2, 0, 0.9f},
                                   {3, 1, 0.5f},
                                   {3, 2, 0.5f},
                                   {0, 1, 0.5f},
                                   {0, 2, 0.9f},
                                   {1, 3, 0.4f},
                                   {2, 3, 0.4f},
                                   {4, 0, 1},
                                   {5, 0, 1},
                                   {6, 0, 1},
                                   {4, 5, 0.1f},
                                   {5, 6, 0.1f},
                                   {6, 4, 0.1f}});
  const std::vector<int> tree = tree_of_affinity(with_empty(A));
  EXPECT_EQ(tree[0], -1);
  EXPECT_EQ(tree[3], 1) << "the youngest among the ancestors";
}

TEST(TreeOfAffinity, NoThreeHangOnEachOther) {
  // 1 2 3 and the leaves 7 8 9 about the root 0; 4 5 6 behind, each beside two of 1 2 3 and beside each
  // other, all equally far. By 1, 5 is before 4; by 2, 6 before 5; by 3, 4 before 6: the paper's rule alone
  // would close a ring.
  std::vector<Edge> edges = both_ways({{0, 1, 1}, {0, 2, 1}, {0, 3, 1}});
  for (const Edge& edge : std::vector<Edge>{{4, 1, 0.9f},
                                            {4, 3, 0.9f},
                                            {5, 1, 0.9f},
                                            {5, 2, 0.9f},
                                            {6, 2, 0.9f},
                                            {6, 3, 0.9f},
                                            {4, 5, 0.7f},
                                            {5, 6, 0.7f},
                                            {6, 4, 0.7f},
                                            {1, 4, 0.3f},
                                            {1, 5, 0.6f},
                                            {2, 5, 0.3f},
                                            {2, 6, 0.6f},
                                            {3, 6, 0.3f},
                                            {3, 4, 0.6f}})
    edges.push_back(edge);
  for (const int leaf : {7, 8, 9})
    for (const int to : {0, 7, 8, 9})
      if (to != leaf) edges.push_back({leaf, to, to == 0 ? 1 : 0.1f});
  const RowMatrix A = affinity(10, edges);
  const std::vector<int> tree = tree_of_affinity({A, A, A});
  EXPECT_EQ(tree[0], -1);
  EXPECT_EQ(tree[4], 5);
  EXPECT_EQ(tree[5], 6);
  EXPECT_TRUE(tree[6] == 2 || tree[6] == 3) << tree[6] << ", where it would hang on 4";
}

TEST(TreeOfAffinity, RefusesWhatIsNoAffinity) {
  EXPECT_THROW(tree_of_affinity({}), Error);
  EXPECT_THROW(tree_of_affinity({RowMatrix::Zero(3, 2)}), Error);
  EXPECT_THROW(tree_of_affinity({RowMatrix::Zero(3, 3), RowMatrix::Zero(2, 2)}), Error);
  EXPECT_THROW(tree_of_affinity({RowMatrix::Constant(3, 3, std::nanf(""))}), Error);
  EXPECT_THROW(tree_of_affinity({3, RowMatrix::Zero(3, 3)}), Error) << "as many neighbours as keypoints";
}

/// Keypoints 0 - 1 - 2 along x, a metre apart.
FoundKeypoints in_a_row() {
  FoundKeypoints found;
  found.places = Points::Zero(3, 3);
  for (int k = 0; k < 3; ++k) found.places(k, 0) = static_cast<float>(k);
  found.intensity = {1, 1, 1};
  return found;
}
Points along_x(const std::vector<float>& places) {
  Points points = Points::Zero(static_cast<Eigen::Index>(places.size()), 3);
  for (size_t i = 0; i < places.size(); ++i) points(static_cast<Eigen::Index>(i), 0) = places[i];
  return points;
}

TEST(SkinOfKeypoints, AVertexBetweenTwoIsSharedByThem) {
  // Bones are at 0 (the root), 0.5 and 1.5. The box is two metres, so exp(-8 d^2).
  const RowMatrix W = skin_of_keypoints(along_x({0, 0.5f, 1.25f, 2}), in_a_row(), {-1, 0, 1}).dense(3);
  EXPECT_EQ(W.row(0), (Eigen::RowVector3f(1, 0, 0))) << "the root's bone";
  EXPECT_TRUE(W.row(1).isApprox(Eigen::RowVector3f(0.5f, 0.5f, 0), 1e-5f));
  const float child = std::exp(-8 * 0.5625f), parent = std::exp(-8 * 0.0625f);
  EXPECT_TRUE(W.row(2).isApprox(Eigen::RowVector3f(0, parent, child) / (parent + child), 1e-5f));
  EXPECT_GT(W(3, 2), 0.99f);
}

TEST(SkinOfKeypoints, FaintOnesAreSkippedAndTheirChildrenHangOnTheNextAbove) {
  FoundKeypoints found = in_a_row();
  found.intensity[1] = 0.19f;
  const RowMatrix W = skin_of_keypoints(along_x({0, 1, 2}), found, {-1, 0, 1}).dense(3);
  EXPECT_TRUE(W.row(1).isApprox(Eigen::RowVector3f(0.5f, 0, 0.5f), 1e-5f)) << "the middle of 0 and 2";
  EXPECT_EQ(W.col(1).sum(), 0);
}

TEST(SkinOfKeypoints, AFaintRootLeavesItsChildrenAlone) {
  FoundKeypoints found = in_a_row();
  found.intensity[0] = 0;
  const RowMatrix W = skin_of_keypoints(along_x({0, 1, 2}), found, {-1, 0, 1}).dense(3);
  EXPECT_EQ(W.row(0), (Eigen::RowVector3f(0, 1, 0)));
  found.intensity = {0, 0, 0};
  EXPECT_THROW(skin_of_keypoints(along_x({0}), found, {-1, 0, 1}), Error);
  EXPECT_THROW(skin_of_keypoints(along_x({0}), in_a_row(), {-1, 0}), Error);
}

TEST(SkinOfKeypoints, FarVerticesHaveWeightsToo) {
  const RowMatrix W = skin_of_keypoints(along_x({0, 0.5f, 1000}), in_a_row(), {-1, 0, 1}).dense(3);
  EXPECT_TRUE(W.allFinite());
  EXPECT_NEAR(W.row(2).sum(), 1, 1e-6);
}

}  // namespace
}  // namespace understudy
