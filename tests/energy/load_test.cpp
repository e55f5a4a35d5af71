#include "core/error.hpp"
#include "energy/load_dead.hpp"
#include "energy/load_pressure.hpp"
#include "support/equilibrium.hpp"
#include "support/meshes.hpp"
#include "support/oracles.hpp"
#include "support/term_suite.hpp"

#include <gtest/gtest.h>

namespace coapt {
namespace {

constexpr double kPressure = 0.8;

FixedMask nothing_fixed(const Points& x) { return FixedMask::Constant(3, x.cols(), false); }

// (p/6) (x1 - x0) x (x2 - x0) to each corner, entry by entry.
Points direct_pressure_forces(const Points& x, const Triangles& triangles, double p) {
  Points f = Points::Zero(3, x.cols());
  for (Eigen::Index t = 0; t < triangles.cols(); ++t) {
    const Vec3 u = x.col(triangles(1, t)) - x.col(triangles(0, t)),
               v = x.col(triangles(2, t)) - x.col(triangles(0, t));
    const Vec3 normal(u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]);
    for (int a = 0; a < 3; ++a) f.col(triangles(a, t)) += p / 6 * normal;
  }
  return f;
}

TEST(LoadDead, PassesTheSuiteAsAPotentialWithoutStiffness) {
  const Points X = shaken(Points::Zero(3, 5), 1, 11);
  const Points forces = shaken(Points::Zero(3, 5), 1, 12);
  TermCase c;
  c.label = "dead";
  c.rest = X;
  c.state = shaken(X, 0.3, 13);
  c.is_zero_at_rest = false;  // the energy is zero, the force is not
  c.ignores_rigid_motion = false;
  c.has_hessian = false;
  c.make = [=](const Frame& f) -> std::unique_ptr<EnergyTerm> {
    return std::make_unique<LoadDead>("load", "load_field", f.forces(forces), f.points(X));
  };
  EXPECT_EQ(examine_term(c), "");
  EXPECT_EQ(compare_with_autodiff(c, oracle::DeadForces{forces, X}), "");
  EXPECT_EQ(evaluate_term(*c.make({}), X).energy, 0);
  EXPECT_EQ(evaluate_term(*c.make({}), c.state).hessian.norm(), 0);
}

TEST(LoadDead, FrozenPressureIsThatOfTheReferenceSurface) {
  TriangleMesh mesh = disc_mesh(3);
  mesh.vertices = shaken(mesh.vertices, 0.05, 14);
  const Points frozen = frozen_pressure_forces(mesh.vertices, mesh.triangles, kPressure);
  EXPECT_LT((frozen - direct_pressure_forces(mesh.vertices, mesh.triangles, kPressure)).norm(), 1e-15);
  const TriangleMesh flat = disc_mesh(3);
  const Points up = frozen_pressure_forces(flat.vertices, flat.triangles, kPressure);
  EXPECT_NEAR(up.row(2).sum(), kPressure * surface_area(flat.vertices, flat.triangles), 1e-14);
  EXPECT_EQ(up.topRows<2>().norm(), 0);
}

TEST(LoadDead, ForcesTowardALineAreNormalToItAndHaveTheGivenSize) {
  const Points X = shaken(Points::Zero(3, 6), 2, 15);
  const Vec3 a(0.3, -1, 0.2), b(1.1, 0.4, -0.5);
  const Vector sizes = Vector::LinSpaced(6, 0.5, 3);
  const Points f = forces_toward_line(X, sizes, a, b);
  for (int k = 0; k < 6; ++k) {
    EXPECT_NEAR(f.col(k).norm(), sizes[k], 1e-14);
    EXPECT_NEAR(f.col(k).dot((b - a).normalized()), 0, 1e-14);
    const Vec3 reached = X.col(k) + f.col(k).normalized() * (X.col(k) - a).cross((b - a).normalized()).norm();
    EXPECT_NEAR((reached - a).cross(b - a).norm(), 0, 1e-14);
  }
  Points on_line(3, 1);
  on_line.col(0) = 0.3 * a + 0.7 * b;
  const Points none = forces_toward_line(on_line, Vector::Ones(1), a, b);
  EXPECT_TRUE(none.allFinite());
}

TEST(LoadDead, AreaForcesSumToTractionTimesArea) {
  const TriangleMesh mesh = disc_mesh(4);
  const Vec3 traction(0.1, -0.2, 0.7);
  const Points f = area_forces(nodal_areas(mesh.vertices, mesh.triangles), traction);
  EXPECT_LT((f.rowwise().sum() - surface_area(mesh.vertices, mesh.triangles) * traction).norm(), 1e-14);
}

TermCase closed_case(bool is_follower) {
  const TriangleMesh mesh = sphere_mesh(0);
  TermCase c;
  c.label = is_follower ? "follower on a closed surface" : "volume";
  c.rest = mesh.vertices;
  c.state = shaken(mesh.vertices, 0.2, 16);
  c.is_zero_at_rest = false;
  c.far_away = 10;
  c.make = [mesh, is_follower](const Frame& f) -> std::unique_ptr<EnergyTerm> {
    const Points X = f.points(mesh.vertices);
    const double p = kPressure * f.force / (f.length * f.length);
    const auto make = is_follower ? make_follower_pressure : make_volume_pressure;
    return make("pressure", X, f.triangles(mesh.triangles), p, nothing_fixed(X));
  };
  return c;
}

TEST(LoadPressure, PassesTheSuiteOnAClosedSurface) {
  for (const bool is_follower : {false, true}) {
    const TermCase c = closed_case(is_follower);
    const TriangleMesh mesh = sphere_mesh(0);
    EXPECT_EQ(examine_term(c), "");
    EXPECT_EQ(compare_with_autodiff(c, oracle::ClosedPressure{mesh.triangles, kPressure}), "");
  }
}

TEST(LoadPressure, IsTheExactNodalForceOnAClosedSurface) {
  const TermCase c = closed_case(true);
  const auto term = c.make({});
  const Points exact = direct_pressure_forces(c.state, sphere_mesh(0).triangles, kPressure);
  EXPECT_LT((evaluate_term(*term, c.state).gradient + exact).norm(), 1e-14 * exact.norm());
  EXPECT_FALSE(term->has_circulatory_force());
  const Points ours = follower_pressure_forces(c.state, sphere_mesh(0).triangles, kPressure);
  EXPECT_LT((ours - exact).norm(), 1e-14 * exact.norm());
}

TEST(LoadPressure, IsExactAtEveryFreeNodeWhenTheRimIsFixed) {
  const TriangleMesh mesh = disc_mesh(3);
  FixedMask fixed = nothing_fixed(mesh.vertices);
  fixed.rightCols(18).setConstant(true);
  Points x = shaken(mesh.vertices, 0.1, 17);
  x.rightCols(18) = mesh.vertices.rightCols(18);
  const auto term = make_follower_pressure("p", mesh.vertices, mesh.triangles, kPressure, fixed);
  EXPECT_FALSE(term->has_circulatory_force());
  const Points difference =
      evaluate_term(*term, x).gradient + direct_pressure_forces(x, mesh.triangles, kPressure);
  EXPECT_LT(difference.leftCols(mesh.vertex_count() - 18).norm(), 1e-14);
}

// A quarter of a cushion: two rim stretches slide in the planes x = 0 and y = 0, the third in z = 0.
TEST(LoadPressure, IsExactWhereARimSlidesInCoordinatePlanes) {
  const TriangleMesh mesh = grid_mesh(4, 4);
  FixedMask fixed = nothing_fixed(mesh.vertices);
  for (int k = 0; k <= 4; ++k) {
    fixed(0, grid_node(4, 0, k)) = true;
    fixed(1, grid_node(4, k, 0)) = true;
    fixed(2, grid_node(4, 4, k)) = true;
    fixed(2, grid_node(4, k, 4)) = true;
  }
  Points x = shaken(mesh.vertices, 0.1, 18);
  x = fixed.select(mesh.vertices, x);
  const auto term = make_volume_pressure("p", mesh.vertices, mesh.triangles, kPressure, fixed);
  Points difference = evaluate_term(*term, x).gradient + direct_pressure_forces(x, mesh.triangles, kPressure);
  EXPECT_LT(fixed.select(Points::Zero(3, x.cols()), difference).norm(), 1e-14);
}

TEST(LoadPressure, RefusesTheVolumeModelOnAFreeRim) {
  const TriangleMesh mesh = disc_mesh(2);
  EXPECT_THROW(
      make_volume_pressure("p", mesh.vertices, mesh.triangles, kPressure, nothing_fixed(mesh.vertices)),
      InputError);
}

// An open cap with a free rim: the potential and the remainder.
struct OpenSurface {
  TriangleMesh mesh = disc_mesh(2);
  Points x;
  OpenSurface() {
    for (int v = 0; v < mesh.vertex_count(); ++v)
      mesh.vertices(2, v) = 0.4 * (1 - mesh.vertices.col(v).head<2>().squaredNorm());
    x = shaken(mesh.vertices, 0.1, 19);
  }
  std::unique_ptr<EnergyTerm> term(const Frame& f = {}) const {
    const Points X = f.points(mesh.vertices);
    return make_follower_pressure("p", X, f.triangles(mesh.triangles),
                                  kPressure * f.force / (f.length * f.length), nothing_fixed(X));
  }
};

TEST(LoadPressure, PassesTheSuiteWithThePotentialOfASurfaceWithAFreeRim) {
  const OpenSurface open;
  TermCase c;
  c.label = "follower on an open surface";
  c.rest = open.mesh.vertices;
  c.state = open.x;
  c.is_zero_at_rest = false;
  c.far_away = 10;
  c.make = [open](const Frame& f) { return open.term(f); };
  EXPECT_EQ(examine_derivatives(c), "");
  EXPECT_EQ(examine_state(c), "");
}

TEST(LoadPressure, PotentialAndRemainderAddUpToTheExactForceOnAnOpenSurface) {
  const OpenSurface open;
  const auto term = open.term();
  ASSERT_TRUE(term->has_circulatory_force());
  const Points exact = direct_pressure_forces(open.x, open.mesh.triangles, kPressure);
  for (const bool is_renewed : {false, true}) {
    if (is_renewed) term->rebuild_potential(open.x);
    Points force = -evaluate_term(*term, open.x).gradient;
    EXPECT_GT((force - exact).norm(), 1e-3 * exact.norm());  // the potential alone is wrong on the rim
    term->add_circulatory_force(open.x, force);
    EXPECT_LT((force - exact).norm(), 1e-14 * exact.norm());
  }
}

// What the objective calls the true residual is that of the exact load, whatever was held dead.
TEST(LoadPressure, TrueResidualIsThatOfTheExactForce) {
  const OpenSurface open;
  std::vector<std::unique_ptr<EnergyTerm>> terms;
  terms.push_back(open.term());
  FixedMask fixed = nothing_fixed(open.mesh.vertices);
  fixed.col(0).setConstant(true);
  Objective objective(open.mesh.vertices, fixed, std::move(terms));
  const Vector q = objective.unknowns(open.x);
  const Points x = objective.positions(q);
  const Points exact = direct_pressure_forces(x, open.mesh.triangles, kPressure);
  double largest = 0, reference = exact.col(0).norm();
  for (int v = 1; v < exact.cols(); ++v) largest = std::max(largest, exact.col(v).norm());
  reference = std::max(reference, largest);
  for (const double moved : {0.0, 0.3}) {
    objective.lag_circulatory_force(q + Vector::Constant(q.size(), moved));
    EXPECT_NEAR(objective.true_residual(q), largest / reference, 1e-12);
  }
  objective.lag_circulatory_force(q);
  Vector g;
  objective.gradient(q, g);  // at the point of renewal the potential's force is the exact one
  EXPECT_LT((g + objective.unknowns(exact)).norm(), 1e-13 * g.norm());
}

// Along the path the gradient is that of the exact force, and the energy its work.
TEST(LoadPressure, PathWorkGivesTheExactForceAndItsWorkAlongAStep) {
  const OpenSurface open;
  Objective objective(open.mesh.vertices, nothing_fixed(open.mesh.vertices), terms_of(open.term()));
  const Vector q0 = objective.unknowns(open.mesh.vertices), q1 = objective.unknowns(open.x);
  objective.set_path_anchor(q0);
  const auto exact = [&](const Vector& q) {
    return objective.unknowns(direct_pressure_forces(objective.positions(q), open.mesh.triangles, kPressure));
  };
  Vector g;
  const double start = objective.gradient(q0, g);
  EXPECT_LT((g + exact(q0)).norm(), 1e-14);
  const double end = objective.gradient(q1, g);
  EXPECT_LT((g + exact(q1)).norm(), 1e-14);
  // The exact force is quadratic along a straight step: Simpson's rule gives its work exactly, the
  // trapezoid for the remainder alone comes close for a small one.
  const Vector d = q1 - q0;
  for (const double h : {1e-2, 1e-3}) {
    const Vector q = q0 + h * d;
    const double work = h / 6 * (exact(q0) + 4 * exact(q0 + 0.5 * h * d) + exact(q)).dot(d);
    EXPECT_NEAR((start - objective.gradient(q, g)) / work, 1, 10 * h * h);
  }
  objective.gradient(q1, g);
  objective.advance(q1);  // the energy is continuous where the path goes on
  EXPECT_NEAR(objective.gradient(q1, g), end, 1e-14);
}

TEST(LoadPressure, BreaksNoBalanceOfForcesOnAnOpenSurface) {
  const OpenSurface open;
  const Points exact = direct_pressure_forces(open.x, open.mesh.triangles, kPressure);
  std::vector<std::unique_ptr<EnergyTerm>> terms;
  terms.push_back(open.term());
  Objective objective(open.x, FixedMask::Constant(3, open.x.cols(), true), std::move(terms));
  const Vector q = objective.unknowns(open.x);
  EXPECT_LT((objective.reactions(q) + exact).norm(), 1e-14);  // all fixed: supports carry the whole load
  EXPECT_LT(objective.balance(q).force, 1e-14);
  EXPECT_LT(objective.balance(q).moment, 1e-14);
}

}  // namespace
}  // namespace coapt
