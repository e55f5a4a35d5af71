#include "mesh/shapes.hpp"

#include "core/error.hpp"
#include "support/smallest_angle.hpp"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace coapt {
namespace {

constexpr double kPi = std::numbers::pi;

// Manifold and consistently oriented: every directed edge occurs once.
bool is_oriented_manifold(const TriangleMesh& mesh) {
  std::vector<std::pair<int, int>> directed;
  for (int t = 0; t < mesh.triangle_count(); ++t)
    for (int k = 0; k < 3; ++k) directed.emplace_back(mesh.triangles(k, t), mesh.triangles((k + 1) % 3, t));
  std::sort(directed.begin(), directed.end());
  return std::adjacent_find(directed.begin(), directed.end()) == directed.end();
}

double least_normal_z(const TriangleMesh& mesh) {
  double least = 1;
  for (int t = 0; t < mesh.triangle_count(); ++t)
    least = std::min(least, area_vector(mesh.vertices, mesh.triangles.col(t)).normalized().z());
  return least;
}

TEST(Disc, MeetsAnyCountFromEightyOnWithinATenthWithGoodTriangles) {
  for (const int wanted : {80, 100, 123, 200, 333, 1000, 2500, 10000, 40000}) {
    const TriangleMesh mesh = disc(2, wanted);
    EXPECT_NEAR(mesh.triangle_count(), wanted, 0.1 * wanted);
    EXPECT_TRUE(is_oriented_manifold(mesh));
    EXPECT_EQ(boundary_loops(mesh.triangles).size(), 1u);
    EXPECT_GT(smallest_angle(mesh), 35) << wanted;
    EXPECT_DOUBLE_EQ(least_normal_z(mesh), 1);
    EXPECT_NEAR(mesh.vertices.colwise().norm().maxCoeff(), 2, 1e-12);
  }
}

TEST(Disc, AreaConvergesWithOrderTwo) {
  auto error = [](int triangles) {
    const TriangleMesh mesh = disc(1, triangles);
    return kPi - surface_area(mesh.vertices, mesh.triangles);
  };
  const double order = std::log2(error(6 * 16 * 16) / error(6 * 32 * 32));
  EXPECT_NEAR(order, 2, 0.02);
}

TEST(Square, FillsTheSideWithEitherPattern) {
  for (const CellPattern pattern : {CellPattern::Diagonal, CellPattern::Cross})
    for (const int wanted : {400, 900, 2500, 10000}) {
      const TriangleMesh mesh = square(0.424264, wanted, pattern);
      EXPECT_NEAR(mesh.triangle_count(), wanted, 0.1 * wanted);
      EXPECT_TRUE(is_oriented_manifold(mesh));
      EXPECT_NEAR(surface_area(mesh.vertices, mesh.triangles), 0.424264 * 0.424264, 1e-12);
      EXPECT_NEAR(smallest_angle(mesh), 45, 1e-9);
      EXPECT_DOUBLE_EQ(least_normal_z(mesh), 1);
    }
}

TEST(Rectangle, KeepsItsCellsNearSquaresInAStrip) {
  const TriangleMesh mesh = rectangle(20, 1, 1000);
  EXPECT_NEAR(mesh.triangle_count(), 1000, 100);
  EXPECT_GT(smallest_angle(mesh), 40);
  EXPECT_NEAR(surface_area(mesh.vertices, mesh.triangles), 20, 1e-12);
  EXPECT_EQ(rectangle(1, 20, 1000).triangle_count(), mesh.triangle_count());
}

TEST(Sphere, IsClosedWithOutwardNormalsAndEvenTriangles) {
  for (const int wanted : {20, 80, 180, 1280, 2500, 10000}) {
    const TriangleMesh mesh = sphere(3, wanted);
    EXPECT_NEAR(mesh.triangle_count(), wanted, 0.1 * wanted);
    EXPECT_TRUE(is_oriented_manifold(mesh));
    EXPECT_TRUE(boundary_loops(mesh.triangles).empty());
    EXPECT_EQ(mesh.vertex_count() * 2, mesh.triangle_count() + 4);  // Euler's formula for a sphere
    EXPECT_GT(smallest_angle(mesh), 40) << wanted;
    for (int t = 0; t < mesh.triangle_count(); ++t)
      ASSERT_GT(
          area_vector(mesh.vertices, mesh.triangles.col(t)).dot(mesh.vertices.col(mesh.triangles(0, t))), 0);
  }
}

TEST(Tent, WithStraightEdgesIsAHyperbolicParaboloid) {
  TentOptions options;
  options.side = 2;
  options.corner_height = 1;
  const TriangleMesh mesh = tent(options);
  EXPECT_NEAR(mesh.triangle_count(), options.triangles, 0.1 * options.triangles);
  for (int i = 0; i < mesh.vertex_count(); ++i) {
    const double u = mesh.vertices(0, i) / 2, v = mesh.vertices(1, i) / 2;
    EXPECT_NEAR(mesh.vertices(2, i), (1 - u) * (1 - v) + u * v, 1e-12);
  }
}

TEST(Tent, PullsItsEdgesInToArcsOfTheGivenRadius) {
  TentOptions options;
  options.side = 10;
  options.corner_height = 0;
  options.edge_radius = 15;
  const TriangleMesh mesh = tent(options);
  EXPECT_TRUE(is_oriented_manifold(mesh));
  EXPECT_GT(least_normal_z(mesh), 0);
  EXPECT_GT(smallest_angle(mesh), 20);
  // The edge along x lies on the circle through its ends with its centre outside the sail.
  const Vec3 centre(5, -std::sqrt(15 * 15 - 5 * 5), 0);
  int on_edge = 0;
  const auto loops = boundary_loops(mesh.triangles);
  ASSERT_EQ(loops.size(), 1u);
  for (const int v : loops[0])
    if (std::abs((mesh.vertices.col(v) - centre).norm() - 15) < 1e-9) ++on_edge;
  EXPECT_EQ(on_edge, 15);  // 14 cells on each side
  options.corner_height = 5;
  const TriangleMesh sail = tent(options);
  EXPECT_GT(least_normal_z(sail), 0);
  EXPECT_GT(smallest_angle(sail), 20);
}

TEST(Shapes, RefuseWithEveryDefectNamed) {
  try {
    disc(-1, 2);
    FAIL() << "a disc of negative radius was made";
  } catch (const InputError& error) {
    ASSERT_EQ(error.defects().size(), 2u);
    EXPECT_NE(error.defects()[0].find("radius"), std::string::npos);
    EXPECT_NE(error.defects()[1].find("triangles"), std::string::npos);
  }
  EXPECT_THROW(sphere(kNaN, 80), InputError);
  EXPECT_THROW(square(1, 1), InputError);
  EXPECT_THROW(rectangle(1, 0, 100), InputError);
  TentOptions tight;
  tight.edge_radius = 6;
  EXPECT_THROW(tent(tight), InputError);
}

}  // namespace
}  // namespace coapt
