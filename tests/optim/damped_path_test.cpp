// A damped path: one shape whatever the order of nodes, the frame and the method.
#include "optim/damped_path.hpp"

#include "optim/monitor.hpp"
#include "support/contact_scene.hpp"
#include "support/meshes.hpp"
#include "support/sanitized.hpp"
#include "support/valve_scene.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace coapt {
namespace {

constexpr int kSteps = 20;

// A valve in contact, with its prescribed motion spread over the path.
struct DampedValve {
  ValveScene scene{{.triangles = 300, .contact_gap = 0.5}};

  Method method(const Frame& frame = {}) const {
    Method method = scene.method(1e-9, frame);
    method.max_iterations = 100000;
    method.continuation.damped_steps = kSteps;
    method.motion.positions = [open = frame.points(scene.X), closed = frame.points(scene.closed)](double t) {
      return Points((1 - t) * open + t * closed);
    };
    return method;
  }

  // Positions in the scene's own frame.
  Equilibrium solve(const Frame& frame, const std::string& solver) const {
    Method how = method(frame);
    how.solver = solver;
    Equilibrium found =
        find_equilibrium(frame.points(scene.X), scene.fixed_in(frame), scene.terms(frame), how);
    Points back = found.x;
    for (int k = 0; k < back.cols(); ++k)
      back.col(k) = frame.rotation.transpose() * found.x.col(frame.node(k));
    found.x = back;
    return found;
  }
};

// How many steps it took until all loads were on.
int steps_to_the_loads(const Result& result) {
  std::set<double> loads;
  for (const Iteration& iterate : result.trace) loads.insert(iterate.path);
  return static_cast<int>(loads.size());
}

TEST(DampedPath, LeadsToOneShapeByEveryMethodAndInEveryFrame) {
  if (is_sanitized()) GTEST_SKIP() << "switched off under the sanitizers: time";
  const DampedValve valve;
  const Equilibrium given = valve.solve({}, "newton");
  ASSERT_EQ(given.result.status, Status::Converged) << given.result.message;
  const int at_rest = given.result.damped_steps - steps_to_the_loads(given.result);
  EXPECT_LE(at_rest, 1) << "its shape is stable, so that a hundredth of the dampers is left";
  EXPECT_GT(at_rest, 0) << "it goes on at the full problem until it is at rest";
  const std::vector<int> held = valve.scene.held_nodes(given.x);
  ASSERT_GT(held.size(), 100u);
  const Frame renumbered = renumbered_frame(static_cast<int>(valve.scene.X.cols()));
  for (const auto& [frame, solver] : {std::pair<Frame, std::string>{renumbered, "newton"},
                                      {rotated_frame(), "newton"},
                                      {{}, "lbfgs"},
                                      {{}, "bfgs"}}) {
    const Equilibrium other = valve.solve(frame, solver);
    ASSERT_EQ(other.result.status, Status::Converged) << other.result.message;
    double most = 0;
    for (const int node : held) most = std::max(most, (other.x - given.x).col(node).norm());
    EXPECT_LT(most, 1e-6) << solver;
  }
}

TEST(DampedPath, TakesLongerStepsWhereTheShapeIsStable) {
  const Equilibrium found = DampedValve().solve({}, "newton");
  ASSERT_EQ(found.result.status, Status::Converged) << found.result.message;
  EXPECT_LT(steps_to_the_loads(found.result), kSteps / 4);
  double before = 0;
  for (const Iteration& iterate : found.result.trace) {
    EXPECT_LE(iterate.path - before, 8.0 / kSteps + 1e-12) << iterate.iteration;
    before = iterate.path;
  }
}

// As the meshes of a cascade do, whose start is a shape of a coarser one.
TEST(DampedPath, BegunNearItsEndGoesOnAtTheFullProblem) {
  if (is_sanitized()) GTEST_SKIP() << "switched off under the sanitizers: time";
  const DampedValve valve;
  const Equilibrium given = valve.solve({}, "newton");
  Points start = given.x;
  for (const int node : valve.scene.held_nodes(given.x))
    if (!valve.scene.fixed(2, node)) start(2, node) += 0.02 * std::sin(node);
  Method method = valve.method();
  method.motion = {};
  method.continuation.is_loaded = true;
  const Equilibrium found = find_equilibrium(start, valve.scene.fixed, valve.scene.terms(), method);
  ASSERT_EQ(found.result.status, Status::Converged) << found.result.message;
  EXPECT_GE(found.result.damped_steps, 1);
  EXPECT_LT(found.result.iterations, given.result.iterations / 2);
  for (const int node : valve.scene.held_nodes(given.x))
    EXPECT_LT((found.x - given.x).col(node).norm(), 1e-6) << node;
}

TEST(DampedPath, KeepsFacetsApartAtEveryIterate) {
  if (is_sanitized()) GTEST_SKIP() << "switched off under the sanitizers: time";
  const DampedValve valve;
  const ValveScene& scene = valve.scene;
  const Judged judged = solve_judged(scene.X, scene.fixed, scene.terms(), scene.triangles,
                                     scene.triangles.cols(), valve.method());
  EXPECT_EQ(judged.found.result.status, Status::Converged) << judged.found.result.message;
  EXPECT_EQ(judged.intersections, 0);
  EXPECT_GT(judged.iterates, kSteps);
}

TEST(DampedPath, SaysWhereItWasCutShort) {
  const DampedValve valve;
  Method method = valve.method();
  method.max_iterations = 8;
  const Equilibrium found = find_equilibrium(valve.scene.X, valve.scene.fixed, valve.scene.terms(), method);
  EXPECT_EQ(found.result.status, Status::IterationLimit);
  EXPECT_NE(found.result.message.find("of the damped path"), std::string::npos) << found.result.message;
  EXPECT_TRUE(found.x.allFinite());
  const std::vector<Iteration>& trace = found.result.trace;
  EXPECT_EQ(trace.front().path, 3.0 / kSteps);
  EXPECT_TRUE(std::is_sorted(trace.begin(), trace.end(),
                             [](const Iteration& a, const Iteration& b) { return a.path < b.path; }));
  EXPECT_LT(trace.back().path, 1);
  EXPECT_GT(found.result.residual, 1e-3) << "with all loads, and without dampers";
}

// Accepts where it is for ever.
class IdleSolver : public Solver {
 public:
  std::string_view name() const override { return "idle"; }
  Status minimize(Objective&, Vector& q, Monitor& monitor) override {
    Vector g;
    for (;;) {
      const double energy = monitor.gradient(q, g);
      if (const auto why = monitor.accept(q, energy, g)) return *why;
    }
  }
};

// A crawl from a coarser mesh's shape would otherwise take all the iterations of the run.
TEST(DampedPath, GivesUpAStartNearItsEndWhoseStepsTakeTooLong) {
  const TriangleMesh mesh = grid_mesh(4, 4);
  const FixedMask fixed = fixed_nodes(mesh.vertex_count(), rim_of(mesh));
  Objective objective(mesh.vertices, fixed, terms_of(membrane_term(mesh.vertices, mesh.triangles, {})));
  Points start = mesh.vertices;
  for (Eigen::Index v = 0; v < start.cols(); ++v)
    if (!fixed(0, v)) start(0, v) += 0.01;
  Problem problem{objective, objective.unknowns(start)};
  problem.continuation.damped_steps = 20;
  problem.continuation.is_loaded = true;
  IdleSolver solver;
  const Result result = solve(solver, problem, {.tolerance = 1e-9, .max_iterations = 100000});
  EXPECT_EQ(result.status, Status::Stalled) << result.message;
  EXPECT_EQ(result.damped_steps, 1);
  EXPECT_EQ(result.iterations, 200);
  EXPECT_NE(result.message.find("step 1 of the damped path"), std::string::npos) << result.message;
}

// Without loads there is nothing that dampers could be measured by, and nothing that they must hold.
TEST(DampedPath, TakesItsStepsWithoutDampersWhereNothingLoads) {
  const TriangleMesh mesh = grid_mesh(4, 4);
  const auto solver = built_in_solvers().at("newton")({});
  // It follows what holds it: shares of 1; 1, 1; 1, 2; 1, 2, 4, 4; 2, 4, 6; 3, 6, 8, 3; 3, 6 and then 8s.
  for (const auto& [shares, steps] :
       {std::pair{1, 1}, {2, 2}, {3, 2}, {11, 4}, {12, 3}, {20, 4}, {100, 14}}) {
    Objective objective(mesh.vertices, fixed_nodes(mesh.vertex_count(), rim_of(mesh)),
                        terms_of(membrane_term(mesh.vertices, mesh.triangles, {})));
    Problem problem{objective, objective.unknowns()};
    problem.motion.positions = [&](double t) { return Points((1 + 0.1 * t) * mesh.vertices); };
    problem.continuation.damped_steps = shares;
    const Result result = solve(*solver, problem, {.tolerance = 1e-9});
    EXPECT_EQ(result.status, Status::Converged) << result.message;
    EXPECT_EQ(result.damped_steps, steps) << shares;
    EXPECT_LT((objective.positions(result.q) - 1.1 * mesh.vertices).norm(), 1e-6) << "stretched evenly";
  }
}

}  // namespace
}  // namespace coapt
