// Stop rules, cancellation and broken evaluations, for every solver of the table alike.
#include "optim/monitor.hpp"

#include "core/error.hpp"
#include "energy/load_dead.hpp"
#include "optim/bfgs.hpp"
#include "support/equilibrium.hpp"
#include "support/meshes.hpp"

#ifdef COAPT_HAS_CERES
#include "optim/ceres/ceres_solver.hpp"
#endif
#ifdef COAPT_HAS_NLOPT
#include "optim/nlopt/nlopt_solver.hpp"
#endif

#include <gtest/gtest.h>

#include <chrono>
#include <stdexcept>
#include <thread>

namespace coapt {
namespace {

// A membrane pulled upwards, with a term that breaks once any node is higher than its limit.
enum class Breakage { None, NotANumber, Infinite, Throws, Slow };

class Breaking final : public EnergyTerm {
 public:
  Breaking(Breakage breakage, double limit) : EnergyTerm("breaking"), breakage_(breakage), limit_(limit) {}
  std::string_view type() const override { return "breaking"; }
  TermRole role() const override { return TermRole::Contact; }
  const Stencils& stencils() const override { return stencils_; }
  double evaluate(const Points& x, Sink& sink) const override {
    if (breakage_ == Breakage::Slow) std::this_thread::sleep_for(std::chrono::milliseconds(20));
    if (x.row(2).maxCoeff() <= limit_) return 0;
    if (breakage_ == Breakage::Throws) throw std::runtime_error("a term broke");
    if (breakage_ == Breakage::Infinite) return kInfinity;
    if (breakage_ == Breakage::NotANumber && sink.wants_gradient())
      sink.add_gradient(7, Vec3::Constant(kNaN));
    return breakage_ == Breakage::NotANumber ? kNaN : 0;
  }

 private:
  Stencils stencils_;
  Breakage breakage_;
  double limit_;
};

struct Pull {
  TriangleMesh mesh = grid_mesh(6, 6);
  std::unique_ptr<Objective> objective;

  explicit Pull(Breakage breakage, double limit = 0.02) {
    FixedMask fixed = FixedMask::Constant(3, mesh.vertex_count(), false);
    for (int v = 0; v < mesh.vertex_count(); ++v) {
      const Vec3 X = mesh.vertices.col(v);
      fixed.col(v).setConstant(X[0] < 1e-9 || X[0] > 1 - 1e-9 || X[1] < 1e-9 || X[1] > 1 - 1e-9);
    }
    objective = std::make_unique<Objective>(
        mesh.vertices, fixed,
        terms_of(membrane_term(mesh.vertices, mesh.triangles, {1, 0.3, 0.1}),
                 std::make_unique<LoadDead>(
                     "load", "load_field",
                     area_forces(nodal_areas(mesh.vertices, mesh.triangles), Vec3(0, 0, 0.2)), mesh.vertices),
                 std::make_unique<Breaking>(breakage, limit)));
  }
  Problem problem() { return {*objective, objective->unknowns(mesh.vertices), {}}; }
};

class EverySolver : public testing::TestWithParam<std::string> {
 protected:
  std::unique_ptr<Solver> solver() const {
    SolverTable table = built_in_solvers();
#ifdef COAPT_HAS_CERES
    add_ceres_solver(table);
#endif
#ifdef COAPT_HAS_NLOPT
    add_nlopt_solver(table);
#endif
    return table.contains(GetParam()) ? table.at(GetParam())({}) : nullptr;
  }
  void SetUp() override {
    if (!solver()) GTEST_SKIP() << "skipped: this build has no " << GetParam();
  }
};

INSTANTIATE_TEST_SUITE_P(Table, EverySolver, testing::Values("newton", "lbfgs", "bfgs", "ceres", "nlopt"),
                         [](const auto& instance) { return instance.param; });

TEST_P(EverySolver, HonoursTheIterationLimit) {
  Pull run(Breakage::None);
  StopRule stop;
  stop.max_iterations = 3;
  const Result result = solve(*solver(), run.problem(), stop);
  EXPECT_EQ(result.status, Status::IterationLimit);
  EXPECT_EQ(result.iterations, 3);
  EXPECT_EQ(result.trace.size(), 4u);
  EXPECT_GT(result.residual, stop.tolerance);
}

TEST_P(EverySolver, HonoursTheTimeLimitWithinASecond) {
  Pull run(Breakage::Slow, 10);
  StopRule stop;
  stop.tolerance = 1e-12;
  stop.max_seconds = 0.2;
  const Result result = solve(*solver(), run.problem(), stop);
  EXPECT_EQ(result.status, Status::TimeLimit);
  EXPECT_LT(result.wall_s, 1.2);
  EXPECT_TRUE(result.q.allFinite());
}

TEST_P(EverySolver, KeepsTheLastAcceptedIterateWhenCancelled) {
  Pull run(Breakage::None);
  Vector last;
  int calls = 0;
  const Observer observer = [&](const Iteration& iteration, const Vector& q) {
    EXPECT_EQ(iteration.iteration, calls);
    last = q;
    return ++calls < 4;
  };
  const Result result = solve(*solver(), run.problem(), {}, observer);
  EXPECT_EQ(result.status, Status::Cancelled);
  EXPECT_EQ(calls, 4);
  EXPECT_EQ(result.q, last);
  EXPECT_NE(result.message.find("cancelled"), std::string::npos);
}

TEST_P(EverySolver, SurvivesAnEvaluationThatBreaks) {
  for (const Breakage breakage : {Breakage::NotANumber, Breakage::Infinite, Breakage::Throws}) {
    Pull run(breakage);
    StopRule stop;
    stop.max_seconds = 100;
    const Result result = solve(*solver(), run.problem(), stop);
    EXPECT_NE(result.status, Status::Converged);  // the equilibrium lies beyond the break
    EXPECT_NE(result.status, Status::TimeLimit);
    EXPECT_TRUE(result.q.allFinite());
    EXPECT_TRUE(std::isfinite(result.energy) && std::isfinite(result.residual)) << result.message;
    const Points x = run.objective->positions(result.q);
    EXPECT_LE(x.row(2).maxCoeff(), 0.02);
    EXPECT_GT(x.row(2).maxCoeff(), 0);  // it went as far as it could
  }
}

TEST_P(EverySolver, SaysSoWhenTheStartItselfCannotBeEvaluated) {
  for (const Breakage breakage : {Breakage::NotANumber, Breakage::Infinite}) {
    Pull run(breakage, -1);
    const Problem problem = run.problem();
    const Result result = solve(*solver(), problem, {});
    EXPECT_EQ(result.status, Status::NonFinite);
    EXPECT_EQ(result.q, problem.q0);
  }
}

TEST_P(EverySolver, ReportsResidualAndCountersOfTheObjective) {
  Pull run(Breakage::None);
  const Result result = solve(*solver(), run.problem(), {});
  EXPECT_EQ(result.status, Status::Converged) << result.message;
  EXPECT_EQ(result.residual, run.objective->true_residual(result.q));
  EXPECT_GE(result.evaluations.gradient, result.iterations);
  EXPECT_EQ(result.evaluations.hessian == 0, GetParam() != "newton");
  EXPECT_EQ(result.trace.back().iteration, result.iterations);
  EXPECT_GT(result.phase_s.at("gradient"), 0);
}

TEST(Bfgs, RefusesWhatItsMatrixCannotHoldAndNamesTheAlternative) {
  Pull run(Breakage::None);
  BfgsOptions options;
  options.max_unknowns = 10;
  try {
    solve(*make_bfgs(options), run.problem(), {});
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("at most 10"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("lbfgs"), std::string::npos);
  }
}

TEST(Solve, FollowsThePrescribedMotionInSteps) {
  Pull run(Breakage::None);
  Problem problem = run.problem();
  std::vector<double> visited;
  problem.motion.steps = 4;
  problem.motion.positions = [&](double t) {
    visited.push_back(t);
    Points x = run.mesh.vertices;
    x.row(2).array() += 0.5 * t;
    return x;
  };
  const Result moved = solve(*make_bfgs(), problem, {});
  EXPECT_EQ(moved.status, Status::Converged);
  EXPECT_EQ(std::vector<double>(visited.begin(), visited.begin() + 4),
            (std::vector<double>{0.25, 0.5, 0.75, 1}));
  Pull still(Breakage::None);
  const Result unmoved = solve(*make_bfgs(), still.problem(), {});
  const Points difference = run.objective->positions(moved.q) - still.objective->positions(unmoved.q);
  EXPECT_LT((difference.colwise() - Vec3(0, 0, 0.5)).cwiseAbs().maxCoeff(), 1e-5);
}

TEST(Monitor, StopsARunThatGainsNothing) {
  Pull run(Breakage::None);
  StopRule stop;
  stop.tolerance = 0;  // out of reach
  const Result result = solve(*make_bfgs(), run.problem(), stop);
  EXPECT_EQ(result.status, Status::Stalled);
  EXPECT_LT(result.residual, 1e-12);
}

}  // namespace
}  // namespace coapt
