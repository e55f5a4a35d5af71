// Newton's method and what it stands on: the exact, unsymmetric tangent of follower pressure, GMRES, shifts.
#include "optim/newton.hpp"

#include "energy/load_dead.hpp"
#include "linear/gmres.hpp"
#include "optim/harmonic_extension.hpp"
#include "optim/lbfgs.hpp"
#include "support/equilibrium.hpp"
#include "support/meshes.hpp"
#include "support/sanitized.hpp"
#include "support/valve_scene.hpp"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <utility>

namespace coapt {
namespace {

// The valve at a state off equilibrium, its leaflets' free edges moving.
struct ShakenValve {
  ValveScene scene{{}};
  Objective objective{scene.X, scene.fixed, scene.terms()};
  Vector q = objective.unknowns(shaken(scene.X, 0.05, 4));
};

Vector shaken_direction(Eigen::Index size) {
  Vector v(size);
  for (Eigen::Index k = 0; k < size; ++k) v[k] = std::sin(1 + 2.7 * static_cast<double>(k));
  return v.normalized();
}

TEST(FollowerTangent, IsTheDerivativeOfTheExactForce) {
  ShakenValve valve;
  valve.objective.set_path_anchor(valve.q);
  Vector g, ahead, behind;
  SparseMatrix h;
  valve.objective.hessian(valve.q, g, h);
  ASSERT_TRUE(valve.objective.has_skew_tangent());
  const Vector v = shaken_direction(valve.q.size());
  Vector product = h.selfadjointView<Eigen::Lower>() * v;
  const Vector symmetric = product;
  valve.objective.add_skew_product(v, product);
  const double step = 1e-6;
  valve.objective.gradient(valve.q + step * v, ahead);
  valve.objective.gradient(valve.q - step * v, behind);
  const Vector difference = (ahead - behind) / (2 * step);
  EXPECT_LT((difference - product).norm(), 1e-6 * product.norm());
  EXPECT_GT((difference - symmetric).norm(), 1e-4 * product.norm());  // the skew part is there
  EXPECT_NEAR(v.dot(product - symmetric), 0, 1e-12 * product.norm());
}

// The same for the remainder of the surface closed by fans, term by term.
TEST(FollowerTangent, IsTheDerivativeOfTheRemainderWithFansToo) {
  const ValveScene scene{{}};
  Points x = shaken(scene.X, 0.05, 5);
  for (const auto& term : scene.terms()) {
    if (!term->has_circulatory_force()) continue;
    for (const bool has_fans : {false, true}) {
      if (has_fans) term->rebuild_potential(x);
      std::vector<TangentBlock> blocks;
      term->add_circulatory_tangent(x, blocks);
      const Points v = shaken_direction(x.size()).reshaped(3, x.cols());
      Points product = Points::Zero(3, x.cols());
      for (const TangentBlock& block : blocks) product.col(block.row) += block.value * v.col(block.column);
      Points ahead = Points::Zero(3, x.cols()), behind = ahead;
      term->add_circulatory_force(x + 1e-5 * v, ahead);
      term->add_circulatory_force(x - 1e-5 * v, behind);
      EXPECT_GT(product.norm(), 0);
      EXPECT_LT(((ahead - behind) / 2e-5 - product).norm(), 1e-8 * product.norm()) << has_fans;
      EXPECT_TRUE(!has_fans || term->simplify());
    }
  }
}

// Simpson's rule is exact for pressure along a straight step: the merit's slope is the exact force's.
TEST(FollowerTangent, WorkAlongAStraightPathIsExact) {
  ShakenValve valve;
  valve.objective.set_path_anchor(valve.q);
  const Vector d = 3 * shaken_direction(valve.q.size());
  Vector g;
  const auto slope_error = [&](double s, double h) {
    const double rise =
        valve.objective.value(valve.q + (s + h) * d) - valve.objective.value(valve.q + (s - h) * d);
    valve.objective.gradient(valve.q + s * d, g);
    return std::abs(rise / (2 * h) - g.dot(d)) / std::abs(g.dot(d));
  };
  for (const double s : {0.3, 1.0, 2.0}) EXPECT_LT(slope_error(s, 1e-4), 1e-6) << s;
}

// A coarse valve of soft leaflets: the symmetric part of the tangent has negative eigenvalues at its
// equilibrium, where steps that project them away converge slowly and linearly (154 iterations in all, some
// 130 of them below 1e-3).
TEST(FollowerTangent, IsWhatTheLastStepsTakeWhereItsSymmetricPartIsIndefinite) {
  const ValveScene scene({.triangles = 200, .young = 0.05});
  Objective objective(scene.X, scene.fixed, scene.terms());
  SolverOptions options;
  options.factorisation = make_multifrontal_factorisation;
  Problem problem{objective, objective.unknowns(scene.X), scene.method().motion};
  problem.stability.factorisation = make_multifrontal_factorisation;
  StopRule stop;
  stop.tolerance = 1e-9;
  stop.max_iterations = 500;
  const Result result = solve(*make_newton(options), problem, stop);
  ASSERT_EQ(result.status, Status::Converged) << result.message;
  EXPECT_FALSE(result.certificate.is_conservative);
  EXPECT_GT(result.certificate.stability.negative_modes, 0);
  EXPECT_FALSE(is_unstable(result.certificate.stability.verdict));
  const auto near = std::find_if(result.trace.begin(), result.trace.end(),
                                 [](const Iteration& iteration) { return iteration.residual < 1e-3; });
  const auto last = result.trace.end() - near;
  std::printf("valve of 200 triangles: %d iterations, the last %td below 1e-3; %s\n", result.iterations, last,
              summary(result.certificate).c_str());
  EXPECT_LE(last, 20);
  EXPECT_LE(result.iterations, 60);
}

TEST(Gmres, SolvesWhatADenseSolverSolves) {
  const Eigen::MatrixXd B =
      0.4 * Eigen::MatrixXd::NullaryExpr(30, 30, [](Eigen::Index i, Eigen::Index j) {
        return std::sin(3.0 * static_cast<double>(i) + 7.0 * static_cast<double>(j * j));
      });
  const Vector b = shaken_direction(30);
  const auto apply = [&](const Vector& v, Vector& out) { out = B * v; };
  Gmres gmres(30);
  Vector x;
  gmres.solve(apply, b, 1e-12, x);
  const Vector exact = (Eigen::MatrixXd::Identity(30, 30) + B).lu().solve(b);
  EXPECT_LT((x - exact).norm(), 1e-10 * exact.norm());
  EXPECT_LE(gmres.solve(apply, b, 1e-2, x), 29);  // a loose tolerance takes fewer
  EXPECT_LT((x + B * x - b).norm(), 1.01e-2);
  EXPECT_EQ(gmres.solve(apply, Vector::Zero(30), 1e-2, x), 0);
  EXPECT_EQ(x.norm(), 0);
}

Result solve_valve(const ValveScene& scene, const SolverOptions& options, const std::string& solver,
                   const Continuation& continuation = {}) {
  Objective objective(scene.X, scene.fixed, scene.terms());
  const auto method = built_in_solvers().at(solver)(options);
  StopRule stop;
  stop.tolerance = 1e-9;
  return solve(*method, {objective, objective.unknowns(scene.X), scene.method().motion, continuation}, stop);
}

TEST(Newton, ReachesOneShapeByEveryRoute) {
  if (is_sanitized()) GTEST_SKIP() << "switched off under the sanitizers: time";
  const ValveScene scene{{}};
  const Result plain = solve_valve(scene, {}, "newton");
  ASSERT_EQ(plain.status, Status::Converged) << plain.message;
  EXPECT_LE(plain.iterations, 20);
  EXPECT_LE(plain.factorisations, 24);
  EXPECT_NE(plain.route.find("work along the path"), std::string::npos);

  SolverOptions trust_region, preconditioned;
  trust_region.globalisation = Globalisation::TrustRegion;
  preconditioned.is_preconditioned = true;
  const Result others[] = {
      solve_valve(scene, trust_region, "newton"), solve_valve(scene, preconditioned, "lbfgs"),
      solve_valve(scene, {}, "newton", {4, 1, 1}), solve_valve(scene, {}, "newton", {1, 4, 0.1})};
  for (const Result& other : others) {
    EXPECT_EQ(other.status, Status::Converged) << other.message;
    EXPECT_NEAR(other.energy, plain.energy, 1e-7 * std::abs(plain.energy));
  }
  const Result plain_lbfgs = solve_valve(scene, {}, "lbfgs");
  EXPECT_LT(4 * others[1].iterations, plain_lbfgs.iterations);  // what the metric is there for
}

// The branches of the chords pull from the start, far harder than the load: the kinks are rounded, and sharp
// again in the end.
struct TightValve {
  TightValve() {
    for (Eigen::Index k = 0; k < scene.chords.cols(); ++k)
      if (!scene.fixed(0, scene.chords(0, k))) scene.chord_lengths[k] *= 0.5;
  }
  ValveScene scene{{}};

  Result solved(const std::string& solver, int max_iterations, double* sharp_residual) const {
    Objective objective(scene.X, scene.fixed, scene.terms()), untouched(scene.X, scene.fixed, scene.terms());
    StopRule stop;
    stop.tolerance = 1e-9;
    stop.max_iterations = max_iterations;
    const Vector q0 = objective.unknowns(scene.X);
    Vector g;
    objective.gradient(q0, g);
    EXPECT_GT(objective.relative_residual(q0, g), 2);
    const Result result = solve(*built_in_solvers().at(solver)({}), {objective, q0}, stop);
    *sharp_residual = untouched.true_residual(result.q);
    EXPECT_EQ(objective.true_residual(result.q), *sharp_residual);
    return result;
  }
};

// The shift starts at force over length, far above what a soft scene resists with, and has to come down.
TEST(Newton, FindsSoftEquilibriaAsFastAsStiffOnes) {
  Points X(3, 2);
  X << 0, 1, 0, 0, 0, 0;
  for (const double stiffness : {1e-3, 1e-2, 1.0, 1e3}) {
    Points force = Points::Zero(3, 2);
    force(0, 1) = 1;
    const Equilibrium found = find_equilibrium(
        X, fixed_nodes(2, {0}),
        terms_of(cable_term(Segments(Eigen::Vector2i(0, 1)), stiffness, Vector::Constant(1, 1.0)),
                 std::make_unique<LoadDead>("pull", "load_field", force, X)),
        1e-10, "newton");
    EXPECT_EQ(found.result.status, Status::Converged) << stiffness << ": " << found.result.message;
    EXPECT_NEAR(found.x(0, 1), 1 + 1 / stiffness, 1e-8 / stiffness);
    EXPECT_LE(found.result.iterations, 15) << stiffness;
  }
}

TEST(RoundedKinks, LeadToTheSharpEquilibrium) {
  const TightValve valve;
  double residual = 1, other_residual = 1;
  const Result result = valve.solved("newton", 1000, &residual);
  EXPECT_EQ(result.status, Status::Converged) << result.message;
  EXPECT_LE(residual, 1e-9);
  EXPECT_LE(result.iterations, 40);
  int rounds = 0, rises = 0;
  for (size_t k = 1; k < result.trace.size(); ++k) {
    const Iteration &before = result.trace[k - 1], &now = result.trace[k];
    const double rise = now.energy - before.energy, noise = 1e-12 * std::abs(before.energy) + 1e-13;
    if (now.outer_iteration == before.outer_iteration) {
      EXPECT_LE(rise, noise) << "iterate " << now.iteration;
    } else {
      ++rounds;  // the same shape under sharper kinks
      EXPECT_EQ(now.iteration, before.iteration);
      EXPECT_EQ(now.step, 0);
      if (std::abs(rise) > noise) ++rises;
    }
  }
  EXPECT_GE(rounds, 3);
  EXPECT_GT(rises, 0);
  const Result other = valve.solved("lbfgs", 100000, &other_residual);
  EXPECT_EQ(other.status, Status::Converged) << other.message;
  EXPECT_NEAR(result.energy, other.energy, 1e-7 * std::abs(other.energy));
}

// A stop at the start of every node, made ten times as stiff each time that it proves too soft.
class Hardening final : public EnergyTerm {
 public:
  explicit Hardening(Points start) : EnergyTerm("hardening"), start_(std::move(start)) {}
  std::string_view type() const override { return "hardening"; }
  TermRole role() const override { return TermRole::Contact; }
  const Stencils& stencils() const override { return stencils_; }
  double evaluate(const Points& x, Sink& sink) const override {
    for (int k = 0; sink.wants_gradient() && k < x.cols(); ++k)
      sink.add_gradient(k, stiffness_ * (x.col(k) - start_.col(k)));
    return 0.5 * stiffness_ * (x - start_).squaredNorm();
  }
  bool escalate_stiffness(const Points& x) override {
    const bool is_too_soft = (x - start_).cwiseAbs().maxCoeff() > 0.05;
    if (is_too_soft) stiffness_ *= 10;
    return is_too_soft;
  }
  bool restore_stiffness() override { return std::exchange(stiffness_, 1) != 1; }

 private:
  Points start_;
  Stencils stencils_;
  double stiffness_ = 1;
};

TEST(Trace, BeginsARoundWhereATermStiffens) {
  Points X = Points::Zero(3, 2), force = X;
  X(0, 1) = -10;
  force(0, 0) = 1;
  const Equilibrium found = find_equilibrium(
      X, fixed_nodes(2, {1}),
      terms_of(std::make_unique<Hardening>(X), std::make_unique<LoadDead>("pull", "load_field", force, X)),
      1e-8, "lbfgs");
  ASSERT_EQ(found.result.status, Status::Converged) << found.result.message;
  EXPECT_NEAR(found.x(0, 0), 0.01, 1e-9);  // stiffened twice
  const std::vector<Iteration>& trace = found.result.trace;
  EXPECT_EQ(trace.back().outer_iteration, trace.front().outer_iteration + 2);
  for (size_t k = 1; k < trace.size(); ++k)
    if (trace[k].outer_iteration == trace[k - 1].outer_iteration) {
      EXPECT_LT(trace[k].energy, trace[k - 1].energy + 1e-12);
    } else {
      EXPECT_GT(trace[k].energy, trace[k - 1].energy);
    }
}

TEST(Solve, DoesNotDependOnWhatAnEarlierOneMadeStiffer) {
  Points X = Points::Zero(3, 2), force = X;
  X(0, 1) = -10;
  force(0, 0) = 1;
  Objective objective(
      X, fixed_nodes(2, {1}),
      terms_of(std::make_unique<Hardening>(X), std::make_unique<LoadDead>("pull", "load_field", force, X)));
  const Problem problem{objective, objective.unknowns(X)};
  const Result first = solve(*make_newton(), problem, {}), second = solve(*make_newton(), problem, {});
  EXPECT_NEAR(first.q[0], 0.01, 1e-9);  // stiffened twice
  EXPECT_EQ(first.q, second.q);
  EXPECT_EQ(first.iterations, second.iterations);
}

// x^4 / 4 of the first node, which is asked where it stands whenever limits of stress are raised.
class Asked final : public EnergyTerm {
 public:
  explicit Asked(std::vector<double>& raised_at) : EnergyTerm("asked"), raised_at_(raised_at) {}
  std::string_view type() const override { return "asked"; }
  TermRole role() const override { return TermRole::Internal; }
  const Stencils& stencils() const override { return stencils_; }
  double evaluate(const Points& x, Sink& sink) const override {
    const double s = x(0, 0);
    if (sink.wants_gradient()) sink.add_gradient(0, Vec3(s * s * s, 0, 0));
    if (sink.wants_hessian()) sink.add_block(0, 2, 0, 0, Eigen::Matrix3d(Vec3(3 * s * s, 1, 1).asDiagonal()));
    return 0.25 * s * s * s * s;
  }
  bool limit_stress(const TensionScale& /*scale*/) override { return true; }
  double raise_stress_limits(const Points& x) override {
    raised_at_.push_back(x(0, 0));
    return 0;
  }

 private:
  std::vector<double>& raised_at_;
  Stencils stencils_{2, {0, 1}};
};

TEST(StressLimits, AreRaisedOnceWhatIsStretchedHasGivenWay) {
  std::vector<double> raised_at;
  Points X(3, 2), force = Points::Zero(3, 2);
  X << 10, 0, 0, 0, 0, 0;  // a residual of 999
  force(0, 0) = 1;
  const Equilibrium found =
      find_equilibrium(X, fixed_nodes(2, {1}),
                       terms_of(std::make_unique<Asked>(raised_at),
                                std::make_unique<LoadDead>("pull", "load_field", force, X)),
                       1e-8, "newton");
  ASSERT_EQ(found.result.status, Status::Converged) << found.result.message;
  EXPECT_NEAR(found.x(0, 0), 1, 1e-8);
  EXPECT_GT(found.result.iterations, 8);  // a third off x in each
  ASSERT_FALSE(raised_at.empty());
  for (const double x : raised_at) EXPECT_LE(x * x * x - 1, 1);  // the residual
}

// No residual of a sum of forces is below its rounding.
TEST(Newton, SaysWhereRoundOffForbidsMore) {
  const ValveScene scene({.triangles = 200});
  Objective objective(scene.X, scene.fixed, scene.terms());
  StopRule stop;
  stop.tolerance = 1e-17;
  const Result result =
      solve(*make_newton(), {objective, objective.unknowns(scene.X), scene.method().motion}, stop);
  EXPECT_EQ(result.status, Status::Stalled);
  EXPECT_NE(result.message.find("round-off forbids more"), std::string::npos) << result.message;
  EXPECT_LT(result.residual, 1e-12);
  const auto there = std::find_if(result.trace.begin(), result.trace.end(),
                                  [](const Iteration& iterate) { return iterate.residual < 1e-12; });
  EXPECT_LE(result.trace.end() - there, 60);
}

TEST(RoundedKinks, AreSharpAgainWhenTheRunIsCutShort) {
  double residual = 0;
  const Result result = TightValve().solved("newton", 2, &residual);
  EXPECT_EQ(result.status, Status::IterationLimit);
  EXPECT_EQ(result.residual, residual);
}

TEST(Threads, AssembleTheSameBits) {
  ValveOptions options;
  options.triangles = 5000;  // worth threads (kWorthThreads of energy/pour_elements.hpp)
  const ValveScene scene(options);
  Objective objective(scene.X, scene.fixed, scene.terms());
  const Vector q = objective.unknowns(shaken(scene.X, 0.05, 3));
  Vector g1, g;
  SparseMatrix h1, h;
  const double energy = objective.hessian(q, g1, h1);
  for (const int threads : {2, 4, 8}) {
    objective.use_threads(threads);
    EXPECT_EQ(objective.hessian(q, g, h), energy) << threads;
    EXPECT_TRUE((g.array() == g1.array()).all()) << threads;
    EXPECT_TRUE((h.coeffs() == h1.coeffs()).all()) << threads;
  }
}

TEST(Continuation, EndsAtTheFullProblem) {
  const ValveScene scene{{}};
  Objective objective(scene.X, scene.fixed, scene.terms());
  Vector g, scaled;
  const Vector q = objective.unknowns(scene.X);
  const double energy = objective.gradient(q, g);
  objective.scale(0.5, 0.5);
  EXPECT_NEAR(objective.gradient(q, scaled), 0.5 * energy, 1e-12 * std::abs(energy));
  EXPECT_LT((scaled - 0.5 * g).norm(), 1e-14 * g.norm());
  objective.scale(1, 1);
  EXPECT_EQ(objective.gradient(q, scaled), energy);
}

// Coordinates may be prescribed at other nodes each: of those, one that stays leaves the next alone.
TEST(CarryAlong, TakesEachCoordinateBySupportsOfItsOwn) {
  const TriangleMesh mesh = disc_mesh(6);
  FixedMask fixed = FixedMask::Constant(3, mesh.vertex_count(), false);
  for (const auto& loop : boundary_loops(mesh.triangles))
    for (const int node : loop) fixed.col(node).setConstant(true);
  for (int node = 0; node < mesh.vertex_count(); node += 2) fixed(0, node) = true;
  Objective objective(mesh.vertices, fixed,
                      terms_of(sheet_term(SheetLaw::StVK, mesh.vertices, mesh.triangles, {})));
  const Vec3 shift(0.3, 0, 5);
  const Points target = mesh.vertices.colwise() + shift;
  const Vector carried = extended_harmonically(objective, objective.unknowns(mesh.vertices), target);
  EXPECT_LT((carried - objective.unknowns(target)).lpNorm<Eigen::Infinity>(), 1e-6);
}

TEST(CarryAlong, TakesASheetWhereItsRimGoesAndLeavesTheRestAlone) {
  const TriangleMesh mesh = disc_mesh(6);
  FixedMask fixed = FixedMask::Constant(3, mesh.vertex_count(), false);
  for (const auto& loop : boundary_loops(mesh.triangles))
    for (const int node : loop) fixed.col(node).setConstant(true);
  Objective objective(mesh.vertices, fixed,
                      terms_of(sheet_term(SheetLaw::StVK, mesh.vertices, mesh.triangles, {})));
  const Vec3 shift(0.3, -2, 5);
  const Points target = mesh.vertices.colwise() + shift;
  const Vector q = objective.unknowns(mesh.vertices);
  const Vector carried = extended_harmonically(objective, q, target);
  EXPECT_LT((carried - objective.unknowns(target)).lpNorm<Eigen::Infinity>(), 1e-6);
  EXPECT_LT((extended_harmonically(objective, q, mesh.vertices) - q).lpNorm<Eigen::Infinity>(), 1e-15);
}

}  // namespace
}  // namespace coapt
