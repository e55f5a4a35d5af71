#include "mesh/distance/separate.hpp"

#include "mesh/distance/intersections.hpp"
#include "support/contact_scene.hpp"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace coapt {
namespace {

constexpr double kGap = 0.01;

SeparationOptions options_for(const TriangleMesh& mesh) {
  SeparationOptions options;
  options.membrane_count = mesh.triangle_count();
  options.gap = kGap;
  return options;
}

void expect_separated(const TriangleMesh& mesh, const Separation& separation) {
  EXPECT_TRUE(separation.pairs_left.empty()) << separation.pairs_left.size() << " pairs left";
  EXPECT_TRUE(intersecting_pairs(separation.x, mesh.triangles).empty());
  const double moved = (separation.x - mesh.vertices).colwise().norm().maxCoeff();
  EXPECT_EQ(separation.largest_displacement, moved);
}

TEST(Separate, LeavesASheetAloneThatMeetsNothing) {
  const TriangleMesh sheet = grid_mesh(5, 5);
  const Separation separation = separate(sheet.vertices, sheet.triangles, options_for(sheet));
  EXPECT_EQ(separation.x, sheet.vertices);
  EXPECT_EQ(separation.passes, 0);
}

TEST(Separate, PushesAVertexBackOutOfAFace) {
  TriangleMesh mesh;
  mesh.vertices.resize(3, 6);
  mesh.vertices << -1, 1, 0, 0, 0.2, -0.2, -1, -1, 1, 0, 0.1, 0.1, 0, 0, 0, -0.02, 1, 1;
  mesh.triangles.resize(3, 2);
  mesh.triangles << 0, 3, 1, 4, 2, 5;
  ASSERT_EQ(intersecting_pairs(mesh.vertices, mesh.triangles).size(), 1u);
  const Separation separation = separate(mesh.vertices, mesh.triangles, options_for(mesh));
  expect_separated(mesh, separation);
  EXPECT_EQ(separation.x.rightCols(2), mesh.vertices.rightCols(2));  // on the right side already
  EXPECT_NEAR(separation.largest_displacement, 0.5 * (0.02 + kGap), 0.3 * kGap);
  EXPECT_GT((separation.x(2, 3) - separation.x.leftCols(3).row(2).array()).minCoeff(), 0.9 * kGap);
}

TEST(Separate, PushesCoincidentSheetsApartAlongTheirNormals) {
  const TriangleMesh sheet = grid_mesh(6, 5), mesh = joined(sheet, sheet);
  const Separation separation = separate(mesh.vertices, mesh.triangles, options_for(mesh));
  expect_separated(mesh, separation);
  const int n = sheet.vertex_count();
  EXPECT_LT(separation.x.leftCols(n).row(2).maxCoeff(), 0);
  EXPECT_GT(separation.x.rightCols(n).row(2).minCoeff(), 0);
  EXPECT_LT(separation.largest_displacement, 3 * kGap);
  // Turned with its normals, the first sheet still goes against them.
  TriangleMesh turned = mesh;
  turned.triangles.row(1).swap(turned.triangles.row(2));
  const Separation other = separate(turned.vertices, turned.triangles, options_for(turned));
  EXPECT_GT(other.x.leftCols(n).row(2).minCoeff(), 0);
}

TEST(Separate, KeepsHeldNodesAndMovesTheOtherSheetTheWholeWay) {
  const TriangleMesh sheet = grid_mesh(6, 5), mesh = joined(sheet, sheet);
  const int n = sheet.vertex_count();
  SeparationOptions options = options_for(mesh);
  options.is_held.assign(static_cast<size_t>(2 * n), false);
  std::fill_n(options.is_held.begin(), n, true);
  const Separation separation = separate(mesh.vertices, mesh.triangles, options);
  expect_separated(mesh, separation);
  EXPECT_EQ(separation.x.leftCols(n), sheet.vertices);
  EXPECT_GT(separation.x.rightCols(n).row(2).minCoeff(), 0.9 * kGap);
}

TEST(Separate, PushesTheRimOfASheetThatCutsAnotherOut) {
  // A standing sheet whose lowest row of vertices hangs through the lying one.
  const TriangleMesh lying = grid_mesh(9, 9);
  TriangleMesh standing = grid_mesh(7, 7, 0.6, 0.6);
  const Eigen::AngleAxisd upright(0.5 * 3.141592653589793, Vec3::UnitX());
  standing.vertices = upright.toRotationMatrix() * standing.vertices;
  const TriangleMesh mesh = joined(lying, moved(standing, {0.213, 0.487, -0.03}));
  ASSERT_GT(intersecting_pairs(mesh.vertices, mesh.triangles).size(), 10u);
  const Separation separation = separate(mesh.vertices, mesh.triangles, options_for(mesh));
  expect_separated(mesh, separation);
  EXPECT_LT(separation.largest_displacement, 0.1);
}

TEST(Separate, LeavesPairsWhereSheetsCrossInTheirMiddle) {
  const TriangleMesh lying = grid_mesh(8, 8);
  TriangleMesh standing = lying;
  standing.vertices = Eigen::AngleAxisd(1.3, Vec3::UnitX()).toRotationMatrix() * standing.vertices;
  TriangleMesh mesh = joined(lying, moved(standing, {0.05, 0.41, -0.52}));
  SeparationOptions options = options_for(mesh);
  options.most_passes = 40;
  options.is_held.assign(static_cast<size_t>(mesh.vertex_count()), false);
  for (const auto& loop : boundary_loops(lying.triangles))  // both rims stay: there is no way out
    for (const int v : loop)
      for (const int sheet : {0, 1})
        options.is_held[static_cast<size_t>(v + sheet * lying.vertex_count())] = true;
  const Separation separation = separate(mesh.vertices, mesh.triangles, options);
  EXPECT_FALSE(separation.pairs_left.empty());
  EXPECT_LE(separation.passes, 40);
}

TEST(Separate, LeavesExcludedPairsAndObstaclesAmongThemselvesAlone) {
  const TriangleMesh sheet = grid_mesh(3, 3), mesh = joined(sheet, sheet);
  SeparationOptions options = options_for(mesh);
  options.membrane_count = 0;
  EXPECT_EQ(separate(mesh.vertices, mesh.triangles, options).x, mesh.vertices);
  options.membrane_count = mesh.triangle_count();
  options.excluded = intersecting_pairs(mesh.vertices, mesh.triangles);
  EXPECT_EQ(separate(mesh.vertices, mesh.triangles, options).x, mesh.vertices);
}

}  // namespace
}  // namespace coapt
