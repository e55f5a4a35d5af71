// Triangles made rounder, and the shortest edges of a mesh taken out.
#include "mesh/remesh/round_triangles.hpp"

#include "core/random_source.hpp"
#include "mesh/shapes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace coapt {
namespace {

TEST(CollapseShortEdges, MakesAPointOfTwoThatAllButCoincide) {
  constexpr int kColumns = 40, kRows = 6;
  TriangleMesh mesh;
  mesh.vertices.resize(3, kColumns * kRows);
  mesh.triangles.resize(3, 2 * kColumns * (kRows - 1));
  Eigen::Index t = 0;
  for (int row = 0; row < kRows; ++row)
    for (int column = 0; column < kColumns; ++column) {
      const double angle = 2 * std::numbers::pi * column / kColumns;
      mesh.vertices.col(row * kColumns + column) = Vec3(6 * std::cos(angle), 6 * std::sin(angle), row);
      if (row + 1 == kRows) continue;
      const int next = (column + 1) % kColumns, a = row * kColumns + column, b = row * kColumns + next;
      mesh.triangles.col(t++) << a, b, b + kColumns;
      mesh.triangles.col(t++) << a, b + kColumns, a + kColumns;
    }
  const int moved = 2 * kColumns + 10;
  mesh.vertices.col(moved) = 0.03 * mesh.vertices.col(moved) + 0.97 * mesh.vertices.col(moved + 1);
  ASSERT_LT(least_angle(mesh), 3);
  const Eigen::Index before = mesh.triangles.cols();
  collapse_short_edges(mesh, 0.5);
  EXPECT_GT(least_angle(mesh), 15);
  EXPECT_EQ(mesh.triangles.cols(), before - 2);
  EXPECT_EQ(boundary_loops(mesh.triangles).size(), 2u);
}

TEST(CollapseShortEdges, CutsOffATinyEarOfARim) {
  // A fan whose first sector is narrow, and a small triangle on its rim that keeps that from becoming a
  // point.
  TriangleMesh mesh;
  mesh.vertices = Points::Zero(3, 9);
  const double degrees[] = {0, 9, 60, 120, 180, 240, 300};
  for (int k = 0; k < 7; ++k) {
    const double angle = std::numbers::pi / 180 * degrees[k];
    mesh.vertices.col(k + 1) = Vec3(std::cos(angle), std::sin(angle), 0);
  }
  mesh.vertices.col(8) = 1.13 * Vec3(std::cos(0.08), std::sin(0.08), 0);
  mesh.triangles.resize(3, 8);
  for (int k = 0; k < 7; ++k) mesh.triangles.col(k) << 0, k + 1, (k + 1) % 7 + 1;
  mesh.triangles.col(7) << 1, 8, 2;
  ASSERT_LT(least_angle(mesh), 10);
  collapse_short_edges(mesh, 0.2);
  EXPECT_EQ(mesh.triangles.cols(), 6);
  EXPECT_GT(least_angle(mesh), 50);
}

TEST(RoundTriangles, MakesAnglesLargerOnTheSameSurface) {
  TriangleMesh mesh = disc(10, 600);
  const TriangleMesh surface = mesh;
  RandomSource random(1);
  for (int v = 0; v < mesh.vertex_count(); ++v)
    if (mesh.vertices.col(v).norm() < 9.5)
      for (int axis : {0, 1}) mesh.vertices(axis, v) += 0.35 * random.between(-1, 1);
  const double before = least_angle(mesh);
  round_triangles(mesh, surface, 20);
  EXPECT_LT(before, 20);
  EXPECT_GT(least_angle(mesh), 28);
  EXPECT_LT(mesh.vertices.row(2).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_EQ(boundary_loops(mesh.triangles).size(), 1u);
  EXPECT_NEAR(surface_area(mesh.vertices, mesh.triangles), surface_area(surface.vertices, surface.triangles),
              3);
}

}  // namespace
}  // namespace coapt
