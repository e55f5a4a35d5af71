#include "mesh/rim_order.hpp"

#include "support/mesh_samples.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace coapt {
namespace {

TEST(RimOrder, KnowsALoopBegunElsewhereOrTurned) {
  EXPECT_TRUE(is_same_loop({1, 2, 3, 4}, {3, 4, 1, 2}));
  EXPECT_TRUE(is_same_loop({1, 2, 3, 4}, {2, 1, 4, 3}));
  EXPECT_FALSE(is_same_loop({1, 2, 3, 4}, {1, 3, 2, 4}));
  EXPECT_FALSE(is_same_loop({1, 2, 3, 4}, {1, 2, 3}));
  EXPECT_FALSE(is_same_loop({1, 2, 3}, {1, 2, 5}));
}

// Vertices of a sheet of 2 x 2 squares: 0 1 2 / 3 4 5 / 6 7 8.
TEST(RimOrder, PutsVerticesInTheOrderOfTheirRim) {
  const Triangles sheet = wavy_sheet(2).triangles;
  const RimLoop sorted = rim_loop({0, 1, 2, 3, 5, 6, 7, 8}, sheet);
  EXPECT_TRUE(sorted.is_reordered);
  EXPECT_EQ(sorted.vertices.front(), 0);
  EXPECT_TRUE(is_same_loop(sorted.vertices, {0, 1, 2, 5, 8, 7, 6, 3}));
  EXPECT_TRUE(is_same_loop(rim_loop({8, 0, 2, 1}, sheet).vertices, {0, 1, 2, 8})) << "a part of the rim";
  for (const std::vector<int>& kept :
       {std::vector<int>{8, 5, 2, 1, 0, 3, 6, 7}, {0, 4, 8, 2}, {0, 2, 1, 0}, {0, 1}, {}}) {
    EXPECT_FALSE(rim_loop(kept, sheet).is_reordered);
    EXPECT_EQ(rim_loop(kept, sheet).vertices, kept);
  }
}

TEST(RimOrder, SaysWhereAWholeRimAndVerticesOfAnotherAreNamed) {
  Triangles apart(3, 16);
  apart.leftCols(8) = wavy_sheet(2).triangles;
  apart.rightCols(8) = wavy_sheet(2).triangles.array() + 9;
  EXPECT_TRUE(rim_loop({0, 1, 2, 3, 5, 6, 7, 8, 9, 10}, apart).spans_rims());
  EXPECT_FALSE(rim_loop({0, 1, 2, 9, 10, 11}, apart).spans_rims()) << "parts of rims, as of three leaflets";
  EXPECT_FALSE(rim_loop({0, 1, 2, 3, 5, 6, 7, 8}, apart).spans_rims());
}

}  // namespace
}  // namespace coapt
