#include "mesh/triangle_mesh.hpp"

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <utility>

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

TEST(TriangleMesh, FindsEdgesInOrderWhateverMeetsThere) {
  std::mt19937 random(3);
  std::uniform_int_distribution<int> vertex(0, 30);
  Triangles triangles(3, 200);  // of which many share an edge, and some have a corner twice
  std::map<std::pair<int, int>, std::vector<int>> expected;
  for (int t = 0; t < triangles.cols(); ++t) {
    for (int k = 0; k < 3; ++k) triangles(k, t) = vertex(random);
    for (int k = 0; k < 3; ++k)
      expected[std::minmax({triangles(k, t), triangles((k + 1) % 3, t)})].push_back(t);
  }
  const std::vector<Edge> found = edges(triangles);
  ASSERT_EQ(found.size(), expected.size());
  auto next = expected.begin();
  for (const Edge& edge : found) {
    EXPECT_EQ(std::pair(edge.a, edge.b), next->first);
    EXPECT_EQ(edge.triangles, next->second);
    ++next;
  }
  EXPECT_TRUE(edges(Triangles(3, 0)).empty());
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
