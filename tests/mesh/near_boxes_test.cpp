// Bounds by which a search for contact rules pairs out.
#include "mesh/distance/near_boxes.hpp"

#include "mesh/distance/triangle_distance.hpp"

#include <gtest/gtest.h>

#include <array>
#include <random>

namespace coapt {
namespace {

// Bounds of nodes 0 to 3, all of which have a triangle, as ends of two edges.
std::array<NearBox, 2> edge_boxes(const Points& x, double reach) {
  const NearBoxes boxes(x, reach, std::vector<std::vector<int>>(static_cast<size_t>(x.cols()), {0}));
  std::array<NearBox, 2> edges;
  for (int k = 0; k < 4; ++k) edges[static_cast<size_t>(k / 2)].include(boxes.near(k, true));
  return edges;
}

TEST(NearBoxes, RuleOutNothingThatIsNearAndMuchThatABoxDoesNot) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> uniform(-1, 1);
  int near = 0, apart = 0, apart_by_boxes = 0, apart_by_both = 0;
  for (const double size : {1e-5, 1.0, 700.0})
    for (const double offset : {0.0, 40.0})
      for (int pair = 0; pair < 2000; ++pair) {
        Points x = Points::NullaryExpr(3, 4, [&] { return uniform(random); });
        x.rightCols(2) += 0.3 * (x.leftCols(2) - x.rightCols(2));
        x = size * (x.array() + offset).matrix();
        const double distance = segment_distance(x.col(0), x.col(1), x.col(2), x.col(3));
        for (const double share : {0.5, 0.999, 1.0}) {
          const auto [a, b] = edge_boxes(x, distance / share);
          EXPECT_TRUE(overlap(a, b)) << size << " " << offset << " " << share;
          ++near;
        }
        const auto [a, b] = edge_boxes(x, 0.3 * distance);
        ++apart;
        apart_by_boxes += !intersect(a.box, b.box);
        apart_by_both += !overlap(a, b);
      }
  EXPECT_EQ(near, 3 * apart);
  EXPECT_GT(apart_by_both, 1.3 * apart_by_boxes);
}

// Nodes apart along an axis or a diagonal, where one interval alone decides, in scenes far larger than that.
TEST(NearBoxes, DecideAlongTheirOwnDirections) {
  for (const Vec3& way : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1), Vec3(1, 1, 1), Vec3(1, 1, -1),
                          Vec3(1, -1, 1), Vec3(-1, 1, 1)})
    for (const double extent : {1.0, 30.0, 1e4})
      for (const double offset : {0.0, 0.37, 500.0})
        for (const double sign : {1.0, -1.0}) {
          Points x(3, 3);
          x.col(0) = Vec3::Constant(offset) + 0.3 * extent * Vec3(0.9, 0.5, 0.7);
          x.col(1) = x.col(0) + sign * way.normalized();
          x.col(2) = Vec3::Constant(offset + extent);
          const auto meet = [&](double reach) {
            const NearBoxes boxes(x, reach, std::vector<std::vector<int>>(3, {0}));
            return overlap(boxes.near(0, true), boxes.near(1, true));
          };
          EXPECT_TRUE(meet(1 + 1e-9)) << way.transpose() << " " << extent << " " << offset;
          EXPECT_FALSE(meet(0.99 - 1e-5 * extent));
          EXPECT_TRUE(meet(10 * extent)) << "beyond all";
        }
}

TEST(NearBoxes, OverlapWhereNothingMovesInNeither) {
  const Points x = Points::Random(3, 4);
  const NearBoxes boxes(x, 100, std::vector<std::vector<int>>(4, {0}));
  EXPECT_FALSE(overlap(boxes.near(0, false), boxes.near(1, false)));
  EXPECT_TRUE(overlap(boxes.near(0, true), boxes.near(1, false)));
  EXPECT_TRUE(overlap(boxes.near(0, true), boxes.near(1, true)));
}

TEST(NearBoxes, OfASceneWithoutExtentOverlapAndOfOneThatIsNotFiniteDoNot) {
  Points x = Points::Constant(3, 4, 7);
  EXPECT_TRUE(overlap(edge_boxes(x, 0)[0], edge_boxes(x, 0)[1]));
  const NearBoxes boxes(x, 0, std::vector<std::vector<int>>(4, {0}));
  for (const Vec3& way : {Vec3(0, 0, 0), Vec3(0, 1, 0)})
    EXPECT_TRUE(may_meet(boxes.swept(0, way, true), boxes.swept(1, Vec3::Zero(), true), 1));
  x(1, 2) = kInfinity;
  EXPECT_FALSE(overlap(edge_boxes(x, 1)[0], edge_boxes(x, 1)[1]));
}

}  // namespace
}  // namespace coapt
