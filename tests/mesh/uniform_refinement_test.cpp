#include "mesh/remesh/uniform_refinement.hpp"

#include "mesh/mesh_check.hpp"
#include "support/meshes.hpp"

#include <gtest/gtest.h>

#include <set>

namespace coapt {
namespace {

// A bent sheet in two regions.
TriangleMesh bent_sheet() {
  TriangleMesh mesh = grid_mesh(5, 3, 5, 3);
  mesh.vertices.row(2) = (0.7 * mesh.vertices.row(0).array()).sin();
  mesh.region_names = {"left", "right"};
  for (int t = 0; t < mesh.triangle_count(); ++t) mesh.regions.push_back(t % 3 == 0);
  return mesh;
}

TEST(CutInFour, AddsTheMiddleOfEachEdgeBehindTheVertices) {
  const TriangleMesh mesh = bent_sheet();
  const FinerMesh finer = refined_uniformly(mesh);
  const std::vector<Edge> all = edges(mesh.triangles);
  ASSERT_EQ(finer.parents.size(), all.size());
  ASSERT_EQ(finer.mesh.vertex_count(), mesh.vertex_count() + static_cast<int>(all.size()));
  EXPECT_EQ(finer.mesh.vertices.leftCols(mesh.vertex_count()), mesh.vertices);
  std::set<std::array<int, 2>> cut;
  for (size_t k = 0; k < finer.parents.size(); ++k) {
    const auto [a, b] = finer.parents[k];
    EXPECT_LT(a, b);
    cut.insert({a, b});
    const Vec3 middle = 0.5 * (mesh.vertices.col(a) + mesh.vertices.col(b));
    EXPECT_EQ(Vec3(finer.mesh.vertices.col(mesh.vertex_count() + static_cast<int>(k))), middle);
  }
  for (const Edge& edge : all) EXPECT_TRUE(cut.contains({edge.a, edge.b})) << edge.a << "-" << edge.b;
}

// The parts of a triangle follow each other, each a quarter of it with its normal, the first three at its
// corners, the last in the middle.
TEST(CutInFour, CutsEachTriangleIntoFourOfItsPlaneAndRegion) {
  const TriangleMesh mesh = bent_sheet();
  const FinerMesh finer = refined_uniformly(mesh);
  ASSERT_EQ(finer.mesh.triangle_count(), 4 * mesh.triangle_count());
  ASSERT_EQ(finer.mesh.regions.size(), static_cast<size_t>(finer.mesh.triangle_count()));
  EXPECT_EQ(finer.mesh.region_names, mesh.region_names);
  for (int t = 0; t < mesh.triangle_count(); ++t) {
    const Vec3 whole = area_vector(mesh.vertices, mesh.triangles.col(t));
    for (int part = 0; part < 4; ++part) {
      const Eigen::Vector3i corners = finer.mesh.triangles.col(4 * t + part);
      EXPECT_LT((area_vector(finer.mesh.vertices, corners) - 0.25 * whole).norm(), 1e-14);
      EXPECT_EQ(finer.mesh.regions[static_cast<size_t>(4 * t + part)], mesh.regions[static_cast<size_t>(t)]);
      const auto old = (corners.array() < mesh.vertex_count()).count();
      EXPECT_EQ(old, part < 3 ? 1 : 0);
      if (part < 3) {
        EXPECT_EQ(corners[0], mesh.triangles(part, t));
      }
    }
  }
}

TEST(CutInFour, KeepsTheTopologyOfAnySurface) {
  for (const TriangleMesh& mesh :
       {bent_sheet(), disc_mesh(3), sphere_mesh(1), joined(disc_mesh(1), grid_mesh(1, 1))}) {
    const TriangleMesh fine = refined_uniformly(mesh).mesh;
    EXPECT_EQ(check_mesh(fine).size(), check_mesh(mesh).size());
    const auto euler = [](const TriangleMesh& m) {
      return m.vertex_count() - static_cast<int>(edges(m.triangles).size()) + m.triangle_count();
    };
    EXPECT_EQ(euler(fine), euler(mesh));
    const auto before = boundary_loops(mesh.triangles), after = boundary_loops(fine.triangles);
    ASSERT_EQ(after.size(), before.size());
    for (size_t k = 0; k < before.size(); ++k) {
      ASSERT_EQ(after[k].size(), 2 * before[k].size());
      for (size_t i = 0; i < before[k].size(); ++i) EXPECT_EQ(after[k][2 * i], before[k][i]);
    }
  }
}

// Three triangles on one edge, and the empty mesh: whatever the topology, an edge is halved once.
TEST(CutInFour, AsksOnceForEachEdge) {
  Triangles fan(3, 3);
  fan << 0, 1, 0, 1, 0, 1, 2, 3, 4;
  std::vector<std::pair<int, int>> asked;
  const Triangles fine = refined_uniformly(fan, [&](int a, int b) {
    asked.emplace_back(std::minmax(a, b));
    return 5 + static_cast<int>(asked.size()) - 1;
  });
  EXPECT_EQ(asked.size(), 7u);
  EXPECT_EQ(std::set(asked.begin(), asked.end()).size(), 7u);
  EXPECT_EQ(fine.cols(), 12);
  EXPECT_EQ(fine.maxCoeff(), 11);
  const FinerMesh nothing = refined_uniformly(TriangleMesh());
  EXPECT_EQ(nothing.mesh.vertex_count() + nothing.mesh.triangle_count(), 0);
  EXPECT_TRUE(nothing.parents.empty());
}

}  // namespace
}  // namespace coapt
