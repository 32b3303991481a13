// The tree of keypoints from what links cost, on hand-worked matrices.
#include "retarget/marionette/link_tree.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "retarget/base/error.hpp"

namespace understudy {
namespace {

TEST(LinkTree, CheapestLinksMakeTheTreeAndItsMiddleIsTheRoot) {
  // A chain 0 - 1 - 2 - 3 - 4: links get dearer by the distance along it.
  RowMatrix chain(5, 5);
  for (int a = 0; a < 5; ++a)
    for (int b = 0; b < 5; ++b) chain(a, b) = static_cast<float>(std::abs(a - b));
  EXPECT_EQ(tree_of_links(chain), (std::vector<int>{1, 2, -1, 2, 3}));
}

TEST(LinkTree, OneOfThePairIsEnough) {
  RowMatrix costs = RowMatrix::Constant(3, 3, 9);
  costs(2, 0) = 1;  // 2 carries 0 well, though not the other way about
  costs(1, 2) = 2;
  EXPECT_EQ(tree_of_links(costs), (std::vector<int>{2, 2, -1}));
}

TEST(LinkTree, OneKeypointIsItsOwnRoot) {
  EXPECT_EQ(tree_of_links(RowMatrix::Zero(1, 1)), std::vector<int>{-1});
}

TEST(LinkTree, RefusesWhatIsNoMatrixOfCosts) {
  EXPECT_THROW(tree_of_links(RowMatrix(0, 0)), Error);
  EXPECT_THROW(tree_of_links(RowMatrix::Zero(3, 2)), Error);
  EXPECT_THROW(tree_of_links(RowMatrix::Constant(3, 3, std::nanf(""))), Error);
}

}  // namespace
}  // namespace understudy
