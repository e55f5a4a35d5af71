// Two judges that share no code say the same.
#include "mesh/cgal/intersections_cgal.hpp"

#include "mesh/distance/intersections.hpp"
#include "support/mesh_samples.hpp"

#include <gtest/gtest.h>

#include <random>

namespace coapt {
namespace {

size_t agreed(const Points& points, const Triangles& triangles) {
  const auto own = intersecting_pairs(points, triangles), theirs = intersecting_pairs_cgal(points, triangles);
  EXPECT_EQ(own, theirs);
  return theirs.size();
}

// Each triangle with corners of its own.
Triangles loose(Eigen::Index count) {
  Triangles triangles(3, count);
  for (int c = 0; c < 3 * count; ++c) triangles(c % 3, c / 3) = c;
  return triangles;
}

TEST(Judges, AgreeOnRandomSoups) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-1, 1);
  size_t count = 0;
  for (int trial = 0; trial < 20; ++trial) {
    Points points(3, 900);
    for (auto p : points.colwise()) p = Vec3(uniform(random), uniform(random), uniform(random));
    for (int t = 0; t < 300; ++t)  // smaller triangles, so that some pairs meet and most do not
      for (int k = 1; k < 3; ++k)
        points.col(3 * t + k) = points.col(3 * t) + 0.3 * (points.col(3 * t + k) - points.col(3 * t));
    count += agreed(points, loose(300));
  }
  EXPECT_GT(count, 1000u);
}

// On a coarse lattice corners touch faces and edges, triangles share planes, and many have no area.
TEST(Judges, AgreeWhereTrianglesTouchLieInOnePlaneOrHaveNoArea) {
  std::mt19937 random(6);
  size_t count = 0, flat = 0;
  for (const int side : {2, 3, 5})
    for (const int depth : {1, 2, 5}) {
      Points points(3, 600);
      for (auto p : points.colwise())
        p = Vec3(random() % side, random() % side, random() % depth) * 0.1 + Vec3(1, 2, 3);
      const Triangles triangles = loose(200);
      for (const auto& t : triangles.colwise()) flat += area_vector(points, t).norm() < 1e-15;
      count += agreed(points, triangles);
    }
  EXPECT_GT(count, 10000u);
  EXPECT_GT(flat, 100u);
}

TEST(Judges, AgreeWithinARoundingErrorOfATouch) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(0, 1);
  size_t count = 0;
  const Triangles triangles = loose(2);
  for (int trial = 0; trial < 3000; ++trial) {
    Points points(3, 6);
    for (auto p : points.colwise()) p = Vec3(uniform(random), uniform(random), uniform(random));
    // A corner of the second on the plane, an edge or a corner of the first, as nearly as can be.
    const double a = uniform(random), b = trial % 3 == 0   ? (1 - a) * uniform(random)
                                          : trial % 3 == 1 ? 0
                                                           : 1 - a;
    points.col(3) = (1 - a - b) * points.col(0) + a * points.col(1) + b * points.col(2);
    if (trial % 2 == 0) points.col(4) = points.col(3) + Vec3(1, 0.2, 0.1);
    count += agreed(points, triangles);
  }
  EXPECT_GT(count, 300u);
  EXPECT_LT(count, 2900u);
}

TEST(Judges, AgreeOnSheetsFoldedThroughThemselves) {
  size_t count = 0;
  for (const double twist : {0.0, 1.0, 2.0, 4.0}) {
    TriangleMesh sheet = wavy_sheet(40);
    for (auto p : sheet.vertices.colwise()) {
      const double angle = twist * 3 * p[0];
      p = Vec3(std::cos(angle) * (0.3 + 0.2 * p[1]), std::sin(angle) * (0.3 + 0.2 * p[1]),
               p[1] + 0.3 * std::sin(7 * p[0]) * p[1]);
    }
    count += agreed(sheet.vertices, sheet.triangles);
  }
  EXPECT_GT(count, 1000u);
}

TEST(Judges, AgreeOnThePublishedValves) {
  if (!is_shared("data/trivalve11-healthy")) GTEST_SKIP() << kDataNotFound;
  const auto count = [](const std::string& name) {
    const TriangleMesh mesh = read_mesh(shared_path("data/" + name)).mesh;
    return agreed(mesh.vertices, mesh.triangles);
  };
  EXPECT_EQ(count("trivalve11-healthy/leaflets_closed_reference.obj"), 56u);
  EXPECT_EQ(count("trivalve11-healthy/leaflets_closed_reference_coarse.obj"), 84u);
  EXPECT_EQ(count("mitral-ct-normal1/leaflets_pressurised_reference_n32.obj"), 33u);
}

}  // namespace
}  // namespace coapt
