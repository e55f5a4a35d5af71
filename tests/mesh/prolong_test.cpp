// Shapes carried over from a coarser mesh: how they are fitted, and what slivers need.
#include "mesh/remesh/prolong.hpp"

#include "mesh/remesh/relieve_slivers.hpp"
#include "mesh/shapes.hpp"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <limits>

namespace coapt {
namespace {

TEST(GreatestDistortion, IsThatOfThePrincipalStretches) {
  const TriangleMesh mesh = square(2, 8);
  const auto expect = [&](const Points& X, const Points& x, double stretch, double shrinkage) {
    const Distortion found = greatest_distortion(mesh.triangles, X, x);
    EXPECT_NEAR(found.stretch, stretch, 1e-12);
    if (std::isfinite(shrinkage))
      EXPECT_NEAR(found.shrinkage, shrinkage, 1e-12);
    else
      EXPECT_EQ(found.shrinkage, shrinkage);
  };
  const Points& X = mesh.vertices;
  const Eigen::AngleAxisd turn(0.7, Vec3(1, 2, 3).normalized());
  expect(X, turn.toRotationMatrix() * X, 1, 1);
  expect(X, Vec3(3, 0.5, 1).asDiagonal() * X, 3, 2);
  expect(X, Vec3(0.4, 0.25, 1).asDiagonal() * X, 1, 4);
  Points sheared = X;
  sheared.row(0) += X.row(1);
  const double golden = (1 + std::sqrt(5.0)) / 2;
  expect(X, sheared, golden, golden);
  expect(X, Vec3(1, 0, 1).asDiagonal() * X, 1, std::numeric_limits<double>::infinity());
  expect(Points::Zero(3, mesh.vertex_count()), X, 1, 1);  // without an area there is no stretch
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
  ASSERT_GT(greatest_distortion(sheet.mesh.triangles, X, x).stretch, 10);
  relieve_slivers(sheet.mesh.triangles, X, sheet.may_move, {1.2, 1.2}, x);
  EXPECT_LT(greatest_distortion(sheet.mesh.triangles, X, x).stretch, 1.2 + 1e-9);
  EXPECT_LT((x - moved).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(RelieveSlivers, MovesAnotherVertexWhereTheApexIsHeld) {
  SheetWithCap sheet;
  const Points& X = sheet.mesh.vertices;
  Points x = X;
  x(2, sheet.apex) += 0.03;
  const Points before = x;
  const double worst = greatest_distortion(sheet.mesh.triangles, X, x).stretch;
  sheet.may_move[static_cast<size_t>(sheet.apex)] = 0;
  relieve_slivers(sheet.mesh.triangles, X, sheet.may_move, {1.2, 1.2}, x);
  EXPECT_LT(greatest_distortion(sheet.mesh.triangles, X, x).stretch, 0.2 * worst);
  EXPECT_EQ(x.col(sheet.apex), before.col(sheet.apex));
  std::fill(sheet.may_move.begin(), sheet.may_move.end(), 0);
  x = before;
  relieve_slivers(sheet.mesh.triangles, X, sheet.may_move, {1.2, 1.2}, x);
  EXPECT_EQ(x, before) << "nothing may move";
}

TEST(RelieveSlivers, LeavesAloneWhatIsDistortedLess) {
  SheetWithCap sheet;
  const Points& X = sheet.mesh.vertices;
  Points x = Vec3(1.4, 1.1, 1).asDiagonal() * X;
  const Points before = x;
  relieve_slivers(sheet.mesh.triangles, X, sheet.may_move, {1.5, 1.2}, x);
  EXPECT_EQ(x, before);
}

// A flat sheet takes an affine motion exactly, also where what is carried over does not meet.
TEST(FitToGradients, FindsTheMotionThatHasThem) {
  const TriangleMesh mesh = square(2, 200);
  Eigen::Matrix3d gradient;
  gradient << 1.2, 0.3, 0, -0.1, 0.9, 0, 0.2, 0.1, 1;
  const Points expected = gradient * mesh.vertices;
  std::vector<char> may_move(static_cast<size_t>(mesh.vertex_count()), 1);
  Points x = expected;
  for (int v = 0; v < mesh.vertex_count(); ++v)
    if (v % 5 == 0)
      may_move[static_cast<size_t>(v)] = 0;
    else
      x.col(v) += Vec3(std::sin(v), std::cos(v), std::sin(2 * v)) / 20;
  const std::vector<Eigen::Matrix3d> gradients(may_move.size(), gradient);
  fit_to_gradients(mesh.triangles, mesh.vertices, gradients, may_move, x);
  EXPECT_LT((x - expected).cwiseAbs().maxCoeff(), 1e-12);
}

// A sheet of uneven triangles that is rolled up, which stretches nothing.
TEST(FitToGradients, StretchesUnevenTrianglesLessThanWhatIsCarriedOver) {
  TriangleMesh mesh = square(2, 3200);  // edges of 0.05
  for (int v = 0; v < mesh.vertex_count(); ++v)
    mesh.vertices.col(v) += 0.012 * Vec3(std::sin(7.0 * v), std::cos(11.0 * v), 0);
  const auto rolled = [](const Points& X) {
    Points x = X;
    for (auto p : x.colwise()) p = Vec3(std::sin(p[0]), p[1], 1 - std::cos(p[0]));
    return x;
  };
  CoarsenOptions options;
  options.share = 0.05;
  const Coarsening coarsening = coarsen(mesh, options);
  const Points coarse = rolled(coarsening.mesh.vertices), truth = rolled(mesh.vertices);
  Points x = prolonged(coarsening, mesh.vertices, coarse);
  const auto mean_square_strain = [&] {
    double sum = 0;
    for (const auto t : mesh.triangles.colwise()) {
      const Distortion found = greatest_distortion(Triangles(t), mesh.vertices, x);
      sum += std::pow(found.stretch - 1, 2) + std::pow(found.shrinkage - 1, 2);
    }
    return sum / mesh.triangle_count();
  };
  const auto farthest = [&] { return (x - truth).colwise().norm().maxCoeff(); };
  const double before = mean_square_strain(), away = farthest();
  std::vector<char> may_move;
  for (const int host : coarsening.host) may_move.push_back(host >= 0);
  fit_to_gradients(mesh.triangles, mesh.vertices, prolonged_gradients(coarsening, coarse), may_move, x);
  std::printf("a rolled sheet: mean square strain %.2e carried over, %.2e fitted; %.4f and %.4f away\n",
              before, mean_square_strain(), away, farthest());
  EXPECT_LT(mean_square_strain(), 0.7 * before);
  EXPECT_LT(farthest(), away);
}

}  // namespace
}  // namespace coapt
