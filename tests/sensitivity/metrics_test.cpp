// Smooth metrics against shapes whose figures are known in closed form.
#include "sensitivity/metrics/metrics_contact.hpp"
#include "sensitivity/metrics/metrics_opening.hpp"
#include "sensitivity/metrics/metrics_surface.hpp"
#include "support/trough_valve.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace coapt {
namespace {

// A square 20 wide, without its cells |x|, |y| < `half`.
TriangleMesh square_with_hole(double half) {
  TriangleMesh mesh =
      grid_sheet(40, 40, [](double u, double v) { return Vec3(20 * u - 10, 20 * v - 10, 0); });
  std::vector<int> kept;
  for (int t = 0; t < mesh.triangle_count(); ++t) {
    const Vec3 centre = mesh.vertices(Eigen::all, mesh.triangles.col(t)).rowwise().mean();
    if (centre.cwiseAbs().maxCoeff() > half) kept.push_back(t);
  }
  mesh.triangles = Triangles(mesh.triangles(Eigen::all, kept));
  return mesh;
}

std::vector<int> rim_of_square() {
  const auto at = [](int i, int j) { return 41 * j + i; };
  return {at(0, 0), at(20, 0), at(40, 0), at(40, 40), at(0, 40)};
}

TEST(SmoothMetrics, OrificeIsTheAreaOfTheHole) {
  for (const double half : {2.0, 3.0}) {
    const TriangleMesh mesh = square_with_hole(half);
    const auto orifice = make_opening_area("orifice", mesh.triangles, rim_of_square(), mesh.vertices);
    // Blurred corners are rounded off: by less than the square of the blur each.
    EXPECT_NEAR(orifice->evaluate(mesh.vertices, nullptr), 4 * half * half, 1.0);
  }
  const TriangleMesh whole = square_with_hole(0);
  const auto closed = make_opening_area("closed", whole.triangles, rim_of_square(), whole.vertices);
  EXPECT_LT(closed->evaluate(whole.vertices, nullptr), 0.05);
}

TEST(SmoothMetrics, CoaptationIsThatOfTheTrough) {
  const TroughValve valve = trough_valve({});
  const Points& X = valve.mesh.vertices;
  Points open = X;  // at rest the leaflets are apart
  for (int v = 0; v < open.cols(); ++v) open(0, v) += (v < open.cols() / 2 ? -5 : 5);
  const auto area = make_contact_zone_area("area", valve.mesh.triangles, open, {.range = 0.8});
  const auto height = make_contact_zone_height("height", valve.mesh.triangles, open, Vec3(0, 0, 2),
                                               {.range = 0.8, .sharpness = 20});
  // Both faces of 64, and the slopes as far as they are within range: 0.8 apart at most, 3 in 10 steep.
  EXPECT_GT(area->evaluate(X, nullptr), 126);
  EXPECT_LT(area->evaluate(X, nullptr), 128 + 2 * 16 * 0.8);
  EXPECT_GT(height->evaluate(X, nullptr), 3.6);
  EXPECT_LT(height->evaluate(X, nullptr), 4.3);
  EXPECT_EQ(area->evaluate(open, nullptr), 0);
  EXPECT_EQ(height->evaluate(open, nullptr), 0);
}

TEST(SmoothMetrics, DistanceIsThatOfTheTarget) {
  const TriangleMesh plane = square_with_hole(0);
  TriangleMesh above = plane;
  above.vertices.row(2).setConstant(0.3);
  const auto mean = make_surface_distance("mean", plane.triangles, plane.vertices, above, {.rounding = 1e-6});
  EXPECT_NEAR(mean->evaluate(plane.vertices, nullptr), 0.3, 2e-6);
  Points bent = plane.vertices;
  bent(2, 20 * 41 + 20) = -0.7;  // one vertex 1 away
  const auto greatest = make_surface_distance("greatest", plane.triangles, plane.vertices, above,
                                              {.rounding = 1e-6, .sharpness = 100});
  EXPECT_NEAR(greatest->evaluate(bent, nullptr), 1 + std::log(1.0 / 1600) / 100, 1e-3);
  double squares = 0;
  for (const auto& residual : make_distance_residuals("fit", plane.triangles, plane.vertices, above, 1e-6))
    squares += std::pow(residual->evaluate(plane.vertices, nullptr), 2);
  EXPECT_NEAR(squares, 0.09, 1e-5);
}

}  // namespace
}  // namespace coapt
