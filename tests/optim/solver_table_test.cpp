// Every solver on every scene: the same equilibrium, the same energy, a residual of 1e-8, and an energy that
// never rises between accepted iterates of a minimiser.
#include "energy/load_dead.hpp"
#include "energy/load_pressure.hpp"
#include "support/equilibrium.hpp"
#include "support/meshes.hpp"

#ifdef COAPT_HAS_CERES
#include "optim/ceres/ceres_solver.hpp"
#endif
#ifdef COAPT_HAS_NLOPT
#include "optim/nlopt/nlopt_solver.hpp"
#endif

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <thread>

namespace coapt {
namespace {

bool moves_masses(const std::string& solver) {
  return solver.starts_with("dynamic") || solver == "mass-spring";
}

// masses: of the nodes, for those that move them.
SolverTable all_solvers(int node_count = 0) {
  SolverTable table = built_in_solvers();
  for (auto& [name, factory] : table)
    if (moves_masses(name))
      factory = [node_count, make = factory](SolverOptions options) {
        options.masses = [node_count] { return Vector(Vector::Constant(node_count, 0.01)); };
        options.dynamic = {.time_step = 0.05, .relaxation_time = 0.1};
        return make(options);
      };
#ifdef COAPT_HAS_CERES
  add_ceres_solver(table);
#endif
#ifdef COAPT_HAS_NLOPT
  add_nlopt_solver(table);
#endif
  return table;
}

struct Scene {
  std::string name;
  std::unique_ptr<Objective> objective;
  Vector q0;
  bool floats = false;  // an unsupported body: equal but for a rigid motion
};

Scene disc_scene(const std::string& model) {
  const TriangleMesh mesh = disc_mesh(6);
  const double q = 0.02;
  FixedMask fixed = FixedMask::Constant(3, mesh.vertex_count(), false);
  fixed.rightCols(36).setConstant(true);
  Points start = mesh.vertices;
  for (int v = 0; v < mesh.vertex_count(); ++v) start(2, v) = 0.1 * (1 - mesh.vertices.col(v).squaredNorm());
  start = fixed.select(mesh.vertices, start);
  std::unique_ptr<EnergyTerm> load;
  if (model == "frozen")
    load = std::make_unique<LoadDead>(
        "p", "load_pressure", frozen_pressure_forces(mesh.vertices, mesh.triangles, q), mesh.vertices);
  else if (model == "volume")
    load = make_volume_pressure("p", mesh.vertices, mesh.triangles, q, fixed);
  else
    load = make_follower_pressure("p", mesh.vertices, mesh.triangles, q, fixed);
  auto objective = std::make_unique<Objective>(
      start, fixed, terms_of(membrane_term(mesh.vertices, mesh.triangles, {1, 0.3, 0.01}), std::move(load)));
  const Vector q0 = objective->unknowns(start);
  return {"disc_" + model, std::move(objective), q0, false};
}

// A sail held at one half of its rim only, the other half free: follower pressure without a potential.
Scene open_scene() {
  const TriangleMesh mesh = disc_mesh(4);
  FixedMask fixed = FixedMask::Constant(3, mesh.vertex_count(), false);
  Points start = mesh.vertices;
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    start(2, v) = 0.2 * (1 - mesh.vertices.col(v).squaredNorm());
    const bool is_on_rim = mesh.vertices.col(v).norm() > 1 - 1e-9;
    if (is_on_rim && mesh.vertices(0, v) < 0.75) fixed.col(v).setConstant(true);
  }
  auto objective = std::make_unique<Objective>(
      start, fixed,
      terms_of(membrane_term(mesh.vertices, mesh.triangles, {1, 0.3, 0.05}),
               make_follower_pressure("p", mesh.vertices, mesh.triangles, 0.02, fixed)));
  const Vector q0 = objective->unknowns(start);
  return {"sail_follower", std::move(objective), q0, false};
}

Scene catenary_scene() {
  const int n = 10;
  Points X(3, n + 1);
  Segments links(2, n);
  for (int k = 0; k <= n; ++k) X.col(k) = Vec3(static_cast<double>(k) / n, 0, -0.8 * k * (n - k) / n / n);
  for (int k = 0; k < n; ++k) links.col(k) << k, k + 1;
  Points weights = Points::Zero(3, n + 1);
  weights.row(2).segment(1, n - 1).setConstant(-1.0 / n);
  auto objective =
      std::make_unique<Objective>(X, fixed_nodes(n + 1, {0, n}),
                                  terms_of(cable_term(links, 100, Vector::Constant(n, 1.2 / n)),
                                           std::make_unique<LoadDead>("weight", "load_field", weights, X)));
  const Vector q0 = objective->unknowns(X);
  return {"catenary", std::move(objective), q0, false};
}

Scene square_scene() {
  const int n = 8;
  const TriangleMesh mesh = grid_mesh(n, n);
  FixedMask fixed = FixedMask::Constant(3, mesh.vertex_count(), false);
  for (int k = 0; k <= n; ++k)
    for (const int node : {grid_node(n, k, 0), grid_node(n, k, n), grid_node(n, 0, k), grid_node(n, n, k)})
      fixed.col(node).setConstant(true);
  auto objective = std::make_unique<Objective>(
      mesh.vertices, fixed,
      terms_of(membrane_term(mesh.vertices, mesh.triangles, {1, 0.3, 1}),
               std::make_unique<LoadDead>(
                   "load", "load_field",
                   area_forces(nodal_areas(mesh.vertices, mesh.triangles), Vec3(0, 0, 0.3)), mesh.vertices)));
  const Vector q0 = objective->unknowns(mesh.vertices);
  return {"prestressed_square", std::move(objective), q0, false};
}

Scene sphere_scene() {
  const TriangleMesh mesh = sphere_mesh(1);
  const FixedMask fixed = FixedMask::Constant(3, mesh.vertex_count(), false);
  auto objective = std::make_unique<Objective>(
      1.03 * mesh.vertices, fixed,
      terms_of(membrane_term(mesh.vertices, mesh.triangles, {1, 0.3, 0}),
               make_follower_pressure("p", mesh.vertices, mesh.triangles, 0.2, fixed)));
  const Vector q0 = objective->unknowns(1.03 * mesh.vertices);
  return {"sphere", std::move(objective), q0, true};
}

const std::map<std::string, std::function<Scene()>>& scenes() {
  static const std::map<std::string, std::function<Scene()>> table = {
      {"disc_frozen", [] { return disc_scene("frozen"); }},
      {"disc_volume", [] { return disc_scene("volume"); }},
      {"disc_follower", [] { return disc_scene("follower"); }},
      {"sail_follower", open_scene},
      {"catenary", catenary_scene},
      {"prestressed_square", square_scene},
      {"sphere", sphere_scene}};
  return table;
}

Result run(Scene& scene, const std::string& solver, double tolerance = 1e-8) {
  StopRule stop;
  stop.tolerance = tolerance;
  stop.max_seconds = 60;
  return solve(*all_solvers(scene.objective->node_count()).at(solver)({}), {*scene.objective, scene.q0, {}},
               stop);
}

class SolverOnScene : public testing::TestWithParam<std::tuple<std::string, std::string>> {};

TEST_P(SolverOnScene, ReachesTheCommonEquilibrium) {
  const auto& [solver, name] = GetParam();
  if (!all_solvers().contains(solver)) GTEST_SKIP() << "skipped: this build has no " << solver;
  Scene scene = scenes().at(name)(), reference_scene = scenes().at(name)();
  const Result reference = run(reference_scene, "lbfgs", 1e-10);
  ASSERT_EQ(reference.status, Status::Converged) << reference.message;
  const Result result = run(scene, solver);
  EXPECT_EQ(result.status, Status::Converged) << result.message;
  EXPECT_LE(result.residual, 1e-8);
  Vector g;
  scene.objective->gradient(result.q, g);
  if (!scene.objective->has_circulatory_force()) {  // there the energy depends on the moment of renewal
    EXPECT_EQ(scene.objective->relative_residual(result.q, g), result.residual);
    EXPECT_NEAR(result.energy / reference.energy, 1, 1e-9);
  }
  const Points x = scene.objective->positions(result.q),
               y = reference_scene.objective->positions(reference.q);
  if (scene.floats) {
    const auto radii = [](const Points& p) {
      return (p.colwise() - p.rowwise().mean()).colwise().norm().eval();
    };
    EXPECT_LT((radii(x) - radii(y)).cwiseAbs().maxCoeff(), 1e-6);
  } else {
    EXPECT_LT((x - y).cwiseAbs().maxCoeff(), 1e-6);
  }
  for (size_t k = 1; k < result.trace.size(); ++k) {
    const Iteration &before = result.trace[k - 1], &now = result.trace[k];
    if (before.outer_iteration != now.outer_iteration || moves_masses(solver))
      continue;  // long steps swing about the rest
    EXPECT_LE(now.energy, before.energy + 1e-12 * std::abs(before.energy) + 1e-13) << "iteration " << k;
  }
  EXPECT_EQ(result.trace.front().iteration, 0);
  EXPECT_GT(result.iterations, 0);
}

INSTANTIATE_TEST_SUITE_P(
    Table, SolverOnScene,
    testing::Combine(testing::Values("newton", "lbfgs", "bfgs", "dynamic", "dynamic-explicit", "mass-spring",
                                     "ceres", "nlopt"),
                     testing::Values("disc_frozen", "disc_volume", "disc_follower", "sail_follower",
                                     "catenary", "prestressed_square", "sphere")),
    [](const auto& instance) {
      std::string name = std::get<0>(instance.param) + "_on_" + std::get<1>(instance.param);
      std::replace(name.begin(), name.end(), '-', '_');
      return name;
    });

TEST(SolverTable, RunsTwiceToTheSameBits) {
  for (const auto& [solver, make] : all_solvers()) {
    Scene first = disc_scene("follower"), second = disc_scene("follower");
    const Result a = run(first, solver), b = run(second, solver);
    EXPECT_EQ(a.q, b.q) << solver;
    EXPECT_EQ(a.energy, b.energy) << solver;
    EXPECT_EQ(a.trace.size(), b.trace.size()) << solver;
  }
}

TEST(SolverTable, RunsInTwoThreadsToTheSameBitsAsInOne) {
  for (const auto& [solver, make] : all_solvers()) {
    Scene serial_disc = disc_scene("volume"), serial_sphere = sphere_scene();
    const Vector disc = run(serial_disc, solver).q, sphere = run(serial_sphere, solver).q;
    Scene parallel_disc = disc_scene("volume"), parallel_sphere = sphere_scene();
    Vector disc_again, sphere_again;
    std::thread one([&, name = solver] { disc_again = run(parallel_disc, name).q; });
    std::thread other([&, name = solver] { sphere_again = run(parallel_sphere, name).q; });
    one.join();
    other.join();
    EXPECT_EQ(disc, disc_again) << solver;
    EXPECT_EQ(sphere, sphere_again) << solver;
  }
}

TEST(SolverTable, SaysSoWhenThereIsNothingToDo) {
  for (const auto& [solver, make] : all_solvers()) {
    const TriangleMesh mesh = grid_mesh(3, 3);
    const FixedMask free = FixedMask::Constant(3, mesh.vertex_count(), false), all = !free;
    for (const bool everything_is_fixed : {true, false}) {
      Objective objective(mesh.vertices, everything_is_fixed ? all : free,
                          terms_of(membrane_term(mesh.vertices, mesh.triangles, {})));
      StopRule stop;
      stop.max_seconds = 5;
      const auto method = all_solvers(objective.node_count()).at(solver)({});
      const Result result = solve(*method, {objective, objective.unknowns(mesh.vertices), {}}, stop);
      EXPECT_EQ(result.status, Status::Converged) << solver << ": " << result.message;
      EXPECT_EQ(result.iterations, 0) << solver;
      EXPECT_FALSE(result.message.empty()) << solver;
      EXPECT_EQ(objective.positions(result.q), mesh.vertices) << solver;
    }
    Objective empty(Points(3, 0), FixedMask(3, 0), {});
    EXPECT_EQ(solve(*make({}), {empty, Vector(0), {}}, {}).status, Status::Converged) << solver;
  }
}

}  // namespace
}  // namespace coapt
