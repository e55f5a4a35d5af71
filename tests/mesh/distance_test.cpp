#include "core/error.hpp"
#include "mesh/distance/surface_distance.hpp"
#include "mesh/distance/triangle_distance.hpp"
#include "mesh/distance/triangle_tree.hpp"
#include "support/mesh_samples.hpp"

#include <gtest/gtest.h>

#include <random>

namespace coapt {
namespace {

TEST(TriangleDistance, IsExactInAllSevenRegions) {  // VERIFICATION F1a
  const Vec3 a(0, 0, 0), b(1, 0, 0), c(0, 1, 0);
  const auto distance = [&](double x, double y, double z) {
    return point_triangle_distance({x, y, z}, a, b, c);
  };
  EXPECT_NEAR(distance(.25, .25, .5), 0.5, 1e-14);
  EXPECT_NEAR(distance(-1, -1, 1), std::sqrt(3.0), 1e-14);
  EXPECT_NEAR(distance(2, -.5, 0), std::sqrt(1.25), 1e-14);
  EXPECT_NEAR(distance(-.5, 2, .5), std::sqrt(1.5), 1e-14);
  EXPECT_NEAR(distance(.5, -1, 0), 1, 1e-14);
  EXPECT_NEAR(distance(1, 1, 0), std::sqrt(0.5), 1e-14);
  EXPECT_NEAR(distance(-1, .5, 2), std::sqrt(5.0), 1e-14);
  EXPECT_NEAR(distance(.2, .2, 0), 0, 1e-14);
  EXPECT_NEAR(distance(0, 0, 0), 0, 1e-14);
}

TEST(TriangleDistance, FallsBackToEdgesAndVertices) {  // VERIFICATION F1b
  const Vec3 p(.5, .1, .2), o(0, 0, 0), e(1, 0, 0);
  EXPECT_NEAR(point_triangle_distance(p, o, e, {.5, 1e-12, 0}), std::sqrt(.05), 1e-12);
  EXPECT_NEAR(point_triangle_distance(p, o, e, {.5, 0, 0}), std::sqrt(.05), 1e-12);
  EXPECT_NEAR(point_triangle_distance(p, o, o, o), std::sqrt(.30), 1e-12);
}

TEST(TriangleDistance, MeasuresSegmentsInEveryPosition) {  // VERIFICATION F1c
  const Vec3 o(0, 0, 0), e(1, 0, 0);
  EXPECT_NEAR(segment_distance({-1, 0, 0}, e, {0, -1, 1}, {0, 1, 1}), 1, 1e-14);
  EXPECT_NEAR(segment_distance(o, e, {.25, 1, 0}, {.75, 1, 0}), 1, 1e-14);
  EXPECT_NEAR(segment_distance(o, e, {2, 1, 0}, {3, 1, 0}), std::sqrt(2.0), 1e-14);
  EXPECT_NEAR(segment_distance(o, e, {3, 0, 0}, {4, 0, 0}), 2, 1e-14);
  EXPECT_NEAR(segment_distance(o, {2, 0, 0}, e, {3, 0, 0}), 0, 1e-14);
  EXPECT_NEAR(segment_distance(o, e, {0, 1, 0}, {1, 1, 1e-9}), 1, 1e-9);
  EXPECT_NEAR(segment_distance(o, e, {2, -1, 0}, {2, 1, 0}), 1, 1e-14);
  EXPECT_NEAR(segment_distance(o, o, {1, 1, 0}, {1, -1, 0}), 1, 1e-14);
}

TEST(TriangleDistance, WeightsGiveTheClosestPoint) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto any = [&] { return Vec3(uniform(random), uniform(random), uniform(random)); };
  for (int i = 0; i < 200; ++i) {
    const Vec3 a = any(), b = any(), c = any(), p = any();
    const ClosestOnTriangle found = closest_on_triangle(p, a, b, c);
    EXPECT_GE(found.weights.minCoeff(), 0);
    EXPECT_NEAR(found.weights.sum(), 1, 1e-14);
    const Vec3 point = found.weights[0] * a + found.weights[1] * b + found.weights[2] * c;
    EXPECT_LT((point - found.point).norm(), 1e-13);
    // No point of the triangle is closer: the distance is convex, so the directions to the corners suffice.
    for (const Vec3& corner : {a, b, c}) EXPECT_LE((p - found.point).dot(corner - found.point), 1e-13);
  }
}

TEST(TriangleTree, FindsTheClosestPointThatAllTrianglesHave) {
  const TriangleMesh mesh = wavy_sheet(12);
  const TriangleTree tree(mesh.vertices, mesh.triangles);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-0.5, 1.5);
  for (int i = 0; i < 100; ++i) {
    const Vec3 p(uniform(random), uniform(random), uniform(random));
    double best = kInfinity;
    for (int t = 0; t < mesh.triangle_count(); ++t) {
      const Eigen::Vector3i corner = mesh.triangles.col(t);
      best = std::min(best, closest_on_triangle(p, mesh.vertices.col(corner[0]), mesh.vertices.col(corner[1]),
                                                mesh.vertices.col(corner[2]))
                                .distance_squared);
    }
    EXPECT_EQ(tree.closest(p).distance_squared, best);
  }
}

std::vector<std::array<int, 2>> pairs_one_by_one(const TriangleMesh& mesh, double margin) {
  const auto low = [&](int t, int k) { return mesh.vertices.row(k)(mesh.triangles.col(t)).minCoeff(); };
  const auto high = [&](int t, int k) { return mesh.vertices.row(k)(mesh.triangles.col(t)).maxCoeff(); };
  std::vector<std::array<int, 2>> pairs;
  for (int s = 0; s < mesh.triangle_count(); ++s)
    for (int t = s + 1; t < mesh.triangle_count(); ++t) {
      bool near = true;
      for (int k = 0; k < 3; ++k)
        near = near && low(s, k) - high(t, k) <= margin && low(t, k) - high(s, k) <= margin;
      if (near) pairs.push_back({s, t});
    }
  return pairs;
}

TEST(TriangleTree, FindsAllPairsOfNearBoxesAlsoAfterAMove) {
  TriangleMesh mesh = wavy_sheet(7);
  TriangleTree tree(mesh.vertices, mesh.triangles);
  for (const double margin : {0.0, 0.05})
    EXPECT_EQ(tree.self_overlaps(margin), pairs_one_by_one(mesh, margin));
  mesh.vertices.row(2) = mesh.vertices.row(0).array().square();
  mesh.vertices.row(1).swap(mesh.vertices.row(2));
  tree.move(mesh.vertices);
  EXPECT_EQ(tree.self_overlaps(0), pairs_one_by_one(mesh, 0));

  std::vector<std::array<int, 2>> doubled;
  for (const auto& [s, t] : tree.overlaps(tree))
    if (s < t) doubled.push_back({s, t});
  EXPECT_EQ(doubled, pairs_one_by_one(mesh, 0));
  const Bounds all{mesh.vertices.rowwise().minCoeff().array(), mesh.vertices.rowwise().maxCoeff().array()};
  EXPECT_EQ(tree.overlapping(all).size(), static_cast<size_t>(mesh.triangle_count()));
  EXPECT_TRUE(tree.overlapping(bounds_around(Vec3(5.5, 5.5, 5.5), 0.5)).empty());
}

TEST(TriangleTree, StaysShallowWhenAllTrianglesCoincide) {
  TriangleMesh mesh = wavy_sheet(1);
  mesh.triangles = mesh.triangles.col(0).replicate(1, 2000).eval();
  const TriangleTree tree(mesh.vertices, mesh.triangles);
  EXPECT_EQ(tree.self_overlaps().size(), 2000u * 1999u / 2);
}

TEST(SurfaceDistance, OfAShiftedPlaneIsTheShift) {
  TriangleMesh plane = wavy_sheet(6);
  plane.vertices.row(2).setZero();
  TriangleMesh shifted = plane;
  shifted.vertices.row(2).array() += 0.25;
  const SurfaceDistance distance = surface_distance(shifted, plane);
  EXPECT_NEAR(distance.mean, 0.25, 1e-14);
  EXPECT_NEAR(distance.p95, 0.25, 1e-14);
  EXPECT_NEAR(distance.max, 0.25, 1e-14);
  EXPECT_EQ(distance.sample_count, 49 + 72 + 120);
  EXPECT_EQ(distance.vertex_distances.size(), 49);
}

TEST(SurfaceDistance, WeighsByArea) {
  TriangleMesh plane = wavy_sheet(8);
  plane.vertices.row(2).setZero();
  TriangleMesh slope = plane;  // z = x / 1000: the distance of a point is its height
  slope.vertices.row(2) = 1e-3 * plane.vertices.row(0).array();
  const SurfaceDistance distance = surface_distance(slope, plane);
  EXPECT_NEAR(distance.mean, 0.5e-3, 1e-8);  // the rule is exact for linear fields
  EXPECT_NEAR(distance.p95, 0.95e-3, 0.05e-3);
  EXPECT_NEAR(distance.max, 1e-3, 1e-12);
  const SurfaceDistance of_points = surface_distance(slope.vertices, plane);
  EXPECT_NEAR(of_points.max, 1e-3, 1e-12);
  EXPECT_EQ(of_points.sample_count, 81);
}

TEST(SurfaceDistance, RefusesAnEmptySurface) {
  EXPECT_THROW(surface_distance(wavy_sheet(1), TriangleMesh{}), InputError);
  EXPECT_THROW(surface_distance(TriangleMesh{}, wavy_sheet(1)), InputError);
}

TEST(SurfaceDistance, SeesHowFarTheTricuspidLeafletsMove) {
  if (!is_shared("data/trivalve11-healthy/leaflets_open.obj")) GTEST_SKIP() << kDataNotFound;
  const TriangleMesh open = read_mesh(shared_path("data/trivalve11-healthy/leaflets_open.obj")).mesh;
  const TriangleMesh closed =
      read_mesh(shared_path("data/trivalve11-healthy/leaflets_closed_reference.obj")).mesh;
  const SurfaceDistance there = surface_distance(open, closed), back = surface_distance(closed, open);
  RecordProperty("open_to_closed_mean", std::to_string(there.mean));
  // A vertex moves at least as far as to the nearest point of the other surface.
  const Vector moved = (open.vertices - closed.vertices).colwise().norm();
  EXPECT_NEAR(moved.mean(), 8.002, 5e-4);  // stated with the data
  EXPECT_TRUE((there.vertex_distances.array() <= moved.array() + 1e-12).all());
  EXPECT_LT(there.max, 18.29);
  EXPECT_GT(there.mean, 0.5);
  EXPECT_GT(back.mean, 0.5);
  const TriangleMesh sheet = wavy_sheet(9);
  EXPECT_LT(surface_distance(sheet, sheet).max, 1e-15);
}

}  // namespace
}  // namespace coapt
