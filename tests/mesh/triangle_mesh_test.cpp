#include "mesh/triangle_mesh.hpp"

#include <gtest/gtest.h>

namespace coapt {
namespace {

TriangleMesh unit_square() {
  TriangleMesh mesh;
  mesh.vertices.resize(3, 4);
  mesh.vertices << 0, 1, 1, 0, 0, 0, 1, 1, 0, 0, 0, 0;
  mesh.triangles.resize(3, 2);
  mesh.triangles << 0, 0, 1, 2, 2, 3;
  return mesh;
}

TEST(TriangleMesh, FindsEachEdgeOnceWithItsTriangles) {
  const std::vector<Edge> found = edges(unit_square().triangles);
  ASSERT_EQ(found.size(), 5u);
  EXPECT_EQ(found[1].a, 0);
  EXPECT_EQ(found[1].b, 2);
  EXPECT_EQ(found[1].triangles, (std::vector<int>{0, 1}));
}

TEST(TriangleMesh, WalksTheBoundaryInTheDirectionOfItsTriangles) {
  const auto loops = boundary_loops(unit_square().triangles);
  ASSERT_EQ(loops.size(), 1u);
  EXPECT_EQ(loops[0], (std::vector<int>{0, 1, 2, 3}));
}

TEST(TriangleMesh, MeasuresAreaAndLength) {
  const TriangleMesh mesh = unit_square();
  EXPECT_DOUBLE_EQ(surface_area(mesh.vertices, mesh.triangles), 1.0);
  EXPECT_DOUBLE_EQ(nodal_areas(mesh.vertices, mesh.triangles).sum(), 1.0);
  EXPECT_NEAR(mean_edge_length(mesh.vertices, mesh.triangles), (4 + std::sqrt(2.0)) / 5, 1e-15);
}

}  // namespace
}  // namespace coapt
