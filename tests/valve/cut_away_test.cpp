#include "mesh/remesh/cut_away.hpp"

#include "mesh/mesh_check.hpp"
#include "mesh/shapes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace coapt {
namespace {

// Below zero on one side of a line through the disc.
Vector half_plane(const TriangleMesh& mesh, double offset, double angle) {
  return (mesh.vertices.row(0) * std::cos(angle) + mesh.vertices.row(1) * std::sin(angle))
             .transpose()
             .array() -
         offset;
}

TEST(CutAway, LeavesTheAreaBeyondAStraightLine) {
  const double radius = 10;
  const TriangleMesh mesh = disc(radius, 800);
  for (const double angle : {0.0, 0.3, 1.1})
    for (const double offset : {-4.0, 0.0, 2.5}) {
      const CutMesh cut = cut_away(mesh, half_plane(mesh, offset, angle), 0.05);
      const double segment = radius * radius * std::acos(offset / radius) -
                             offset * std::sqrt(radius * radius - offset * offset);
      EXPECT_NEAR(surface_area(cut.mesh.vertices, cut.mesh.triangles), segment, 0.02 * segment)
          << angle << offset;
      ASSERT_EQ(cut.source_triangle.size(), static_cast<size_t>(cut.mesh.triangle_count()));
      for (const MeshDefect& defect : check_mesh(cut.mesh))
        EXPECT_EQ(defect.kind, MeshDefectKind::IsolatedVertex) << defect.message;
      // Boundary vertices lie on the line or on the rim of the disc.
      for (const auto& loop : boundary_loops(cut.mesh.triangles))
        for (const int v : loop) {
          const double level =
              std::cos(angle) * cut.mesh.vertices(0, v) + std::sin(angle) * cut.mesh.vertices(1, v);
          const bool is_near_line = std::abs(level - offset) < 0.1;
          EXPECT_TRUE(is_near_line || cut.mesh.vertices.col(v).norm() > radius - 0.1) << v;
          EXPECT_TRUE(!cut.is_on_cut[static_cast<size_t>(v)] || is_near_line) << v;
        }
    }
}

TEST(CutAway, KeepsNumbersRegionsAndSense) {
  TriangleMesh mesh = disc(10, 200);
  mesh.region_names = {"left", "right"};
  for (int t = 0; t < mesh.triangle_count(); ++t)
    mesh.regions.push_back(mesh.vertices(0, mesh.triangles(0, t)) > 0 ? 1 : 0);
  const CutMesh cut = cut_away(mesh, half_plane(mesh, 1, std::numbers::pi / 2), 0.2);
  EXPECT_EQ(cut.mesh.vertices.leftCols(mesh.vertex_count()), mesh.vertices);
  for (int t = 0; t < cut.mesh.triangle_count(); ++t) {
    const int source = cut.source_triangle[static_cast<size_t>(t)];
    EXPECT_EQ(cut.mesh.regions[static_cast<size_t>(t)], mesh.regions[static_cast<size_t>(source)]);
    EXPECT_GT(area_vector(cut.mesh.vertices, cut.mesh.triangles.col(t))
                  .dot(area_vector(mesh.vertices, mesh.triangles.col(source))),
              0);
  }
}

TEST(CutAway, DividesABoundaryEdge) {
  TriangleMesh mesh = disc(10, 50);
  const double area = surface_area(mesh.vertices, mesh.triangles);
  const std::vector<int> rim = boundary_loops(mesh.triangles).front();
  int triangle = -1;
  for (const Edge& edge : edges(mesh.triangles))
    if (edge.a == std::min(rim[0], rim[1]) && edge.b == std::max(rim[0], rim[1]))
      triangle = edge.triangles.front();
  ASSERT_GE(triangle, 0);
  divide_edge(mesh, triangle, rim[0], rim[1], 0.25);
  EXPECT_NEAR(surface_area(mesh.vertices, mesh.triangles), area, 1e-12 * area);
  EXPECT_TRUE(check_mesh(mesh).empty());
  const Vec3 middle = 0.75 * mesh.vertices.col(rim[0]) + 0.25 * mesh.vertices.col(rim[1]);
  EXPECT_LT((mesh.vertices.col(mesh.vertex_count() - 1) - middle).norm(), 1e-12);
  EXPECT_EQ(boundary_loops(mesh.triangles).front().size(), rim.size() + 1);
}

}  // namespace
}  // namespace coapt
