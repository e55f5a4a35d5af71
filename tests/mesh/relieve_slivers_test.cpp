// Slivers that a shape carried over from a coarser mesh distorts.
#include "mesh/remesh/relieve_slivers.hpp"

#include "mesh/shapes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace coapt {
namespace {

TEST(Distortions, AreTheGreatestStretchOrItsInverse) {
  const TriangleMesh mesh = square(2, 8);
  const Triangles& t = mesh.triangles;
  const auto greatest = [&](const Points& x) { return distortions(t, mesh.vertices, x).maxCoeff(); };
  const Eigen::AngleAxisd turn(0.7, Vec3(1, 2, 3).normalized());
  EXPECT_NEAR(greatest(turn.toRotationMatrix() * mesh.vertices), 1, 1e-12);
  EXPECT_NEAR(greatest(Vec3(3, 0.5, 1).asDiagonal() * mesh.vertices), 3, 1e-12);
  EXPECT_NEAR(greatest(Vec3(3, 0.25, 1).asDiagonal() * mesh.vertices), 4, 1e-12);
  Points sheared = mesh.vertices;
  sheared.row(0) += sheared.row(1);  // stretches of the golden ratio and its inverse
  EXPECT_NEAR(greatest(sheared), (1 + std::sqrt(5.0)) / 2, 1e-12);
  EXPECT_EQ(greatest(Vec3(1, 0, 1).asDiagonal() * mesh.vertices), std::numeric_limits<double>::infinity());
  const Points flat = Points::Zero(3, mesh.vertex_count());
  EXPECT_EQ(distortions(t, flat, mesh.vertices).maxCoeff(), 1) << "without an area there is no stretch";
}

// A flat sheet with a cap: a vertex close to the middle of an inner edge.
struct SheetWithCap {
  SheetWithCap() : mesh(square(2, 32)) {
    constexpr int kInner = 12;
    const Eigen::Vector3i t = mesh.triangles.col(kInner);
    apex = mesh.vertex_count();
    const Vec3 a = mesh.vertices.col(t[0]), b = mesh.vertices.col(t[1]), c = mesh.vertices.col(t[2]);
    mesh.vertices.conservativeResize(3, apex + 1);
    mesh.vertices.col(apex) = 0.999 * 0.5 * (a + b) + 0.001 * c;
    mesh.triangles.conservativeResize(3, mesh.triangles.cols() + 2);
    mesh.triangles.col(kInner) << t[0], t[1], apex;
    mesh.triangles.rightCols<2>() << t[1], t[2], t[2], t[0], apex, apex;
    may_move.assign(static_cast<size_t>(apex) + 1, 1);
  }
  TriangleMesh mesh;
  int apex;
  std::vector<char> may_move;
};

TEST(RelieveSlivers, LetsOneOfTheirVerticesFollowTheTriangleBeside) {
  SheetWithCap sheet;
  const Points& X = sheet.mesh.vertices;
  const Points moved = Vec3(1.2, 1.1, 1).asDiagonal() * X;
  Points x = moved;
  x(2, sheet.apex) += 0.03;
  ASSERT_GT(distortions(sheet.mesh.triangles, X, x).maxCoeff(), 10);
  relieve_slivers(sheet.mesh.triangles, X, sheet.may_move, 1.2, x);
  EXPECT_LT(distortions(sheet.mesh.triangles, X, x).maxCoeff(), 1.2 + 1e-9);
  EXPECT_LT((x - moved).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(RelieveSlivers, MovesAnotherVertexWhereTheApexIsHeld) {
  SheetWithCap sheet;
  const Points& X = sheet.mesh.vertices;
  Points x = X;
  x(2, sheet.apex) += 0.03;
  const Points before = x;
  const double worst = distortions(sheet.mesh.triangles, X, x).maxCoeff();
  sheet.may_move[static_cast<size_t>(sheet.apex)] = 0;
  relieve_slivers(sheet.mesh.triangles, X, sheet.may_move, 1.2, x);
  EXPECT_LT(distortions(sheet.mesh.triangles, X, x).maxCoeff(), 0.2 * worst);
  EXPECT_EQ(x.col(sheet.apex), before.col(sheet.apex));
  std::fill(sheet.may_move.begin(), sheet.may_move.end(), 0);
  x = before;
  relieve_slivers(sheet.mesh.triangles, X, sheet.may_move, 1.2, x);
  EXPECT_EQ(x, before) << "nothing may move";
}

TEST(RelieveSlivers, LeavesAloneWhatIsDistortedLess) {
  SheetWithCap sheet;
  const Points& X = sheet.mesh.vertices;
  Points x = Vec3(1.4, 1.1, 1).asDiagonal() * X;
  const Points before = x;
  relieve_slivers(sheet.mesh.triangles, X, sheet.may_move, 1.5, x);
  EXPECT_EQ(x, before);
}

}  // namespace
}  // namespace coapt
