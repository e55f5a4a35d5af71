// What draws and fits a surface to another: residuals from both sides, springs that slide, and whether noise
// explains what is left.
#include "core/error.hpp"
#include "mesh/shapes.hpp"
#include "sensitivity/determinacy.hpp"
#include "sensitivity/metrics/surface_residuals.hpp"
#include "sensitivity/target_attraction.hpp"
#include "support/term_suite.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace coapt {
namespace {

// A disc that is bent, of this many triangles about.
TriangleMesh bent_disc(int triangles, double height) {
  TriangleMesh mesh = disc(10, triangles);
  for (auto p : mesh.vertices.colwise()) p[2] = height * std::sin(0.31 * p[0] + 0.2) * std::cos(0.23 * p[1]);
  return mesh;
}

Points wave(const Points& x, double phase) { return Points((0.4 * x.array() + phase).sin()); }

TEST(SurfaceResiduals, DerivativesAreExactFromBothSides) {
  const TriangleMesh surface = bent_disc(60, 1.0), target = bent_disc(96, 1.7);
  const Points x = surface.vertices + 0.3 * wave(surface.vertices, 0.5), move = wave(surface.vertices, 1.3);
  for (const FitSides sides : {FitSides::Both, FitSides::Surface, FitSides::Target}) {
    const auto residuals = make_surface_residuals(surface.triangles, x, target, sides);
    const Vector r = residuals->values(x);
    const auto at = [&](double t) { return residuals->values(x + t * move); };
    const double h = 1e-5;
    const Vector slope = (8 * (at(h) - at(-h)) - (at(2 * h) - at(-2 * h))) / (12 * h);
    const Vector exact = residuals->derivatives(x, {move}).col(0);
    EXPECT_GT(exact.norm(), 0.1);
    EXPECT_LT((slope - exact).cwiseAbs().maxCoeff(), 1e-9 * exact.norm());
    // The transpose.
    const Vector weights = Vector::LinSpaced(r.size(), -1, 2).array().sin();
    EXPECT_NEAR(residuals->pull_back(x, weights).cwiseProduct(move).sum(), weights.dot(exact), 1e-12);
    EXPECT_EQ(residuals->noise_factors().size(), r.size());
    EXPECT_NEAR(residuals->noise_factors().squaredNorm(), 3, 1e-12);
  }
}

// A surface that ends short of the target is all the same on it: only the target's vertices tell.
TEST(SurfaceResiduals, TheTargetsSideSeesWhatIsShort) {
  const TriangleMesh target = bent_disc(96, 0);
  TriangleMesh smaller = target;
  smaller.vertices *= 0.8;
  const auto norm = [&](const TriangleMesh& surface, const TriangleMesh& of, FitSides sides) {
    return make_surface_residuals(surface.triangles, surface.vertices, of, sides)
        ->values(surface.vertices)
        .norm();
  };
  EXPECT_LT(norm(smaller, target, FitSides::Surface), 1e-12);
  const double seen = norm(smaller, target, FitSides::Target);
  EXPECT_GT(seen, 0.5);
  EXPECT_NEAR(norm(target, smaller, FitSides::Surface), seen, 1e-12);
  EXPECT_NEAR(std::pow(norm(smaller, target, FitSides::Both), 2), 0.5 * seen * seen, 1e-12);
  TriangleMesh nothing = target;
  nothing.vertices.setZero();
  EXPECT_THROW(make_surface_residuals(target.triangles, target.vertices, nothing), InputError);
}

TEST(SurfaceResiduals, PatchesTellWhatNeighboursShare) {
  const TriangleMesh target = bent_disc(216, 0);
  const auto residuals = make_surface_residuals(target.triangles, target.vertices, target);
  const Vector noise = residuals->noise_factors();
  std::mt19937 random(11);
  std::normal_distribution<double> normal;
  Vector independent = noise, shared = noise;
  for (Eigen::Index k = 0; k < noise.size(); ++k) independent[k] *= 0.95 * normal(random);
  for (Eigen::Index k = 0; k < noise.size(); ++k) shared[k] *= (k / 3) % 200 < 30 ? 1.6 : 0;
  const auto sums = [&](const Vector& r) { return residuals->patch_sums(r.cwiseQuotient(noise)); };
  EXPECT_NEAR(sums(independent).squaredNorm() / static_cast<double>(noise.size()), 0.9, 0.25);
  EXPECT_TRUE(is_explained_by_noise(independent, noise, sums(independent)));
  EXPECT_FALSE(is_explained_by_noise(2 * independent, noise, sums(2 * independent)));  // too much of it
  ASSERT_LT(shared.norm(), noise.norm());
  EXPECT_FALSE(is_explained_by_noise(shared, noise, sums(shared)));  // one patch is off
  Vector one = Vector::Zero(noise.size());
  one[7] = 7 * noise[7];
  EXPECT_FALSE(is_explained_by_noise(one, noise, Vector::Zero(noise.size())));
}

// A roof over a square: points above it have their closest points on its faces, and over its ridge on that.
TriangleMesh roof() {
  TriangleMesh mesh;
  mesh.vertices.resize(3, 6);
  mesh.vertices << -20, 20, 20, -20, -20, 20,  //
      -20, -20, 20, 20, 0, 0,                  //
      0, 0, 0, 0, 9, 9;
  mesh.triangles.resize(3, 4);
  mesh.triangles << 0, 0, 4, 4,  //
      1, 5, 5, 2,                //
      5, 4, 2, 3;
  return mesh;
}

TEST(TargetAttraction, IsAnEnergyWithExactDerivatives) {
  const TriangleMesh sheet = disc(6, 24);
  Points above = sheet.vertices;
  above.row(2).array() += 11;
  Points state = above + 0.2 * wave(above, 0.7);
  state.row(1) *= 1.4;  // some beyond the strip over the ridge
  const TermCase test_case{.label = "target attraction",
                           .make = [&](const Frame& frame) -> std::unique_ptr<EnergyTerm> {
                             TriangleMesh target = roof();
                             for (auto p : target.vertices.colwise())
                               p = frame.point(p);  // its nodes are no nodes of the scene
                             auto term = std::make_unique<TargetAttraction>(
                                 "attraction", frame.triangles(sheet.triangles), frame.points(above), target);
                             term->set_stiffness(0.3 * frame.force / std::pow(frame.length, 3));
                             return term;
                           },
                           .rest = above,
                           .state = state,
                           .reach = 0.02,
                           .is_zero_at_rest = false,
                           .ignores_rigid_motion = false};
  EXPECT_EQ(examine_term(test_case), "");
}

TEST(TargetAttraction, DrawsToTheSheetThatFacesTheSameWay) {
  // Two sheets 0.2 apart, face to face; the surface lies nearer to the wrong one.
  const TriangleMesh sheet = disc(5, 24);
  TriangleMesh both;
  const Eigen::Index n = sheet.vertices.cols(), m = sheet.triangles.cols();
  both.vertices.resize(3, 2 * n);
  both.vertices << sheet.vertices, sheet.vertices;
  both.vertices.row(2).tail(n).array() += 0.2;
  both.triangles.resize(3, 2 * m);
  both.triangles << sheet.triangles, sheet.triangles.array() + static_cast<int>(n);
  both.triangles.row(1).tail(m).swap(both.triangles.row(2).tail(m));
  Points x = 0.9 * sheet.vertices;
  x.row(2).setConstant(0.15);
  // At the start it faces as the lower one does, whichever is meant by that: it is nearest to that.
  Points start = x;
  start.row(2).setConstant(0.01);
  TargetAttraction springs("springs", sheet.triangles, start, both);
  springs.set_stiffness(2);
  Points gradient = Points::Zero(3, x.cols());
  Sink sink(gradient.data());
  const double area = surface_area(start, sheet.triangles);
  EXPECT_NEAR(springs.evaluate(x, sink), 0.5 * 2 * area * 0.15 * 0.15, 1e-12);
  EXPECT_NEAR(gradient.row(2).sum(), 2 * area * 0.15, 1e-12);
  EXPECT_LT(gradient.topRows(2).norm(), 1e-12);  // it slides
  springs.set_stiffness(0);
  Sink none;
  EXPECT_EQ(springs.evaluate(x, none), 0);
}

}  // namespace
}  // namespace coapt
