// The generated valve, whose free edges move under follower pressure: every solver ends where newton does,
// and what supports and loads leave there is as small as the residual.
#include "support/sanitized.hpp"
#include "support/valve_scene.hpp"

#ifdef COAPT_HAS_CERES
#include "optim/ceres/ceres_solver.hpp"
#endif
#ifdef COAPT_HAS_NLOPT
#include "optim/nlopt/nlopt_solver.hpp"
#endif

#include <gtest/gtest.h>

#include <cstdio>

namespace coapt {
namespace {

SolverTable valve_solvers() {
  SolverTable table = built_in_solvers();
#ifdef COAPT_HAS_CERES
  add_ceres_solver(table);
#endif
#ifdef COAPT_HAS_NLOPT
  add_nlopt_solver(table);
#endif
  return table;
}

constexpr double kTolerance = 1e-10;

// Closed by a solver, with a certificate where one is asked for.
Equilibrium closed(const ValveScene& scene, const std::string& solver, bool is_certified = false) {
  Objective objective(scene.X, scene.fixed, scene.terms());
  SolverOptions options;
  options.factorisation = make_multifrontal_factorisation;
  Problem problem{objective, objective.unknowns(scene.X), scene.method().motion};
  if (is_certified) problem.stability.factorisation = make_multifrontal_factorisation;
  StopRule stop;
  stop.tolerance = kTolerance;
  stop.max_seconds = 60;
  Equilibrium found;
  found.result = solve(*valve_solvers().at(solver)(options), problem, stop);
  found.x = objective.positions(found.result.q);
  return found;
}

// Solvers that know the gradient alone. The name, and whether it needs a true potential, hence rounds.
class GradientOnly : public testing::TestWithParam<std::pair<std::string, bool>> {};

TEST_P(GradientOnly, ReachesNewtonsValveToAMillionthOfAMillimetre) {
  if (is_sanitized()) GTEST_SKIP() << "switched off under the sanitizers: time";
  const auto& [solver, takes_rounds] = GetParam();
  if (!valve_solvers().contains(solver)) GTEST_SKIP() << "skipped: this build has no " << solver;
  const ValveScene scene({});
  const Equilibrium newton = closed(scene, "newton"), found = closed(scene, solver);
  ASSERT_EQ(newton.result.status, Status::Converged) << newton.result.message;
  ASSERT_EQ(found.result.status, Status::Converged) << found.result.message;
  const std::vector<int> held = scene.held_nodes(newton.x);
  const double distance = (found.x - newton.x)(Eigen::all, held).colwise().norm().maxCoeff();
  std::printf("valve, %s: %.1e mm from newton's over %zu held nodes, %d iterations, %s, %.2f s\n",
              solver.c_str(), distance, held.size(), found.result.iterations, found.result.route.c_str(),
              found.result.cpu_s);
  EXPECT_LE(found.result.residual, kTolerance);
  EXPECT_LT(distance, 1e-6);
  EXPECT_EQ(found.result.evaluations.hessian, 0);
  if (takes_rounds) {
    EXPECT_GT(found.result.outer_iterations, 1);
    EXPECT_EQ(found.result.route,
              "potential of the surface closed by a fan, remainder lagged and updated in " +
                  std::to_string(found.result.outer_iterations) + " outer iterations");
  } else {
    EXPECT_EQ(found.result.outer_iterations, 0);
    EXPECT_EQ(found.result.route, "exact force, with its work along the path as merit");
  }
}

INSTANTIATE_TEST_SUITE_P(Solvers, GradientOnly,
                         testing::Values(std::pair{"lbfgs", false}, std::pair{"ceres", true},
                                         std::pair{"nlopt", true}),
                         [](const auto& instance) { return instance.param.first; });

// Sums over all nodes of what is out of balance at each: no better than the residual, and no worse.
TEST(Balance, OfTheValveIsAsGoodAsTheResidual) {
  const Equilibrium found = closed(ValveScene({}), "newton", true);
  ASSERT_EQ(found.result.status, Status::Converged) << found.result.message;
  const Certificate& certificate = found.result.certificate;
  std::printf("valve, residual %.1e: balance of forces %.1e, of moments %.1e\n", found.result.residual,
              certificate.balance.force, certificate.balance.moment);
  EXPECT_TRUE(certificate.is_balance_clear);
  EXPECT_LE(certificate.balance.force, 1e-10);
  EXPECT_LE(certificate.balance.moment, 1e-10);
}

}  // namespace
}  // namespace coapt
