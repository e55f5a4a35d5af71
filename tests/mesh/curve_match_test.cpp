#include "mesh/curve_match.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace coapt {
namespace {

Points ring(int count, double radius, double begin, bool is_reversed = false) {
  Points points(3, count);
  for (int k = 0; k < count; ++k) {
    const double angle = begin + (is_reversed ? -1 : 1) * 2 * std::numbers::pi * k / count;
    points.col(k) << radius * std::cos(angle), radius * std::sin(angle), 0.2 * radius * std::cos(2 * angle);
  }
  return points;
}

TEST(CurveMatch, FindsStartAndDirection) {
  const Points loop = ring(60, 15, 0);
  for (const bool is_reversed : {false, true}) {
    const Points matched = matched_by_length(loop, ring(600, 14, 1.234, is_reversed));
    EXPECT_LT((matched - ring(60, 14, 0)).colwise().norm().maxCoeff(), 0.02) << is_reversed;
    EXPECT_GT((matched - loop).colwise().norm().minCoeff(), 0.9);
  }
}

TEST(CurveMatch, GivesTheLoopItselfBack) {
  const Points loop = ring(40, 15, 0.3);
  EXPECT_LT((matched_by_length(loop, loop) - loop).colwise().norm().maxCoeff(), 1e-9);
}

TEST(CurveMatch, SmoothCurvePassesThroughItsPoints) {
  const Points points = ring(8, 15, 0);
  const Points curve = smooth_closed_curve(points, 32);
  ASSERT_EQ(curve.cols(), 8 * 32);
  for (int k = 0; k < 8; ++k) EXPECT_EQ(Vec3(curve.col(32 * k)), Vec3(points.col(k)));
  // Between them it is much nearer to the ring than the polygon is.
  EXPECT_LT(std::abs(curve.col(16).head<2>().norm() - 15), 0.15);
  EXPECT_GT(15 - points.leftCols(2).rowwise().mean().head<2>().norm(), 1);
}

TEST(CurveMatch, MeasuresTheDistanceOfARim) {
  EXPECT_LT(mean_distance(ring(50, 15, 0.1), ring(500, 15, 0)), 0.001);
  EXPECT_NEAR(mean_distance(ring(50, 16, 0.1), ring(500, 15, 0)), 1, 0.05);
}

}  // namespace
}  // namespace coapt
