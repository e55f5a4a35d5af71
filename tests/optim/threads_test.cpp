// Solves side by side and solves shared by threads: what ThreadSanitizer watches (preset tsan).
#include "energy/contact_barrier.hpp"
#include "optim/solver.hpp"
#include "support/meshes.hpp"
#include "support/valve_scene.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <thread>
#include <utility>
#include <vector>

namespace coapt {
namespace {

// Leaflets in contact, after a few steps: every part of a solve has been used by then.
Equilibrium a_few_steps(const ValveScene& scene, int threads) {
  Method method = scene.method(1e-9);
  Equilibrium found;
  Objective objective(scene.X, scene.fixed, scene.terms());
  objective.use_threads(threads);
  Problem problem{objective, objective.unknowns(scene.X), method.motion};
  const auto solver = built_in_solvers().at("newton")({});
  found.result = solve(*solver, problem, {.tolerance = 1e-9, .max_iterations = 4});
  found.x = objective.positions(found.result.q);
  return found;
}

TEST(SolvesSideBySide, OfEightObjectivesInEightThreadsGiveTheSameBits) {
  const ValveScene scene({.triangles = 150, .contact_gap = 0.5});
  const Equilibrium alone = a_few_steps(scene, 1);
  ASSERT_EQ(alone.result.iterations, 4) << alone.result.message;
  std::vector<Equilibrium> found(8);
  std::vector<std::thread> threads;
  for (Equilibrium& one : found) threads.emplace_back([&] { one = a_few_steps(scene, 1); });
  for (std::thread& thread : threads) thread.join();
  for (const Equilibrium& one : found) {
    EXPECT_TRUE((one.x.array() == alone.x.array()).all());
    EXPECT_EQ(one.result.energy, alone.result.energy);
  }
}

TEST(SharedSolve, ByFourThreadsGivesTheBitsOfOne) {
  const ValveScene scene(
      {.triangles = 5000, .contact_gap = 0.2});  // worth threads (energy/pour_elements.hpp)
  const Equilibrium alone = a_few_steps(scene, 1), shared = a_few_steps(scene, 4);
  ASSERT_GT(alone.result.iterations, 0) << alone.result.message;
  EXPECT_TRUE((shared.x.array() == alone.x.array()).all());
  EXPECT_EQ(shared.result.energy, alone.result.energy);
  EXPECT_EQ(shared.result.residual, alone.result.residual);
}

// Every pair has nodes of both sheets, which lie in the parts of different threads.
TEST(SharedAssembly, OfSheetsInContactGivesTheBitsOfOneThread) {
  const TriangleMesh lower = grid_mesh(20, 20), upper = grid_mesh(21, 21);
  const int n = lower.vertex_count(), count = n + upper.vertex_count();
  Points rest(3, count), state(3, count);
  rest << lower.vertices, upper.vertices.colwise() + Vec3(0, 0, 5);
  state << lower.vertices, upper.vertices.colwise() + Vec3(0.003, 0.002, 0.012);
  Triangles triangles(3, lower.triangle_count() + upper.triangle_count());
  triangles << lower.triangles, upper.triangles.array() + n;
  ContactBarrierOptions options;
  options.gap = 0.02;
  options.pressure = 1;
  std::vector<std::unique_ptr<EnergyTerm>> terms;
  terms.push_back(make_contact_barrier("contact", rest, triangles, options));
  Objective objective(rest, Eigen::Array<bool, 3, Eigen::Dynamic>::Constant(3, count, false),
                      std::move(terms));
  const Vector q = objective.unknowns(state);
  for (const Projection projection : {Projection::None, Projection::PositiveSemidefinite}) {
    Vector g1, g;
    SparseMatrix h1, h;
    objective.use_threads(1);
    const double energy = objective.hessian(q, g1, h1, projection);
    ASSERT_GT(objective.terms()[0]->counters().elements, 4000);  // kWorthThreads of pour_elements.hpp
    for (const int threads : {2, 3, 4}) {
      objective.use_threads(threads);
      EXPECT_EQ(objective.hessian(q, g, h, projection), energy) << threads;
      EXPECT_TRUE((g.array() == g1.array()).all()) << threads;
      EXPECT_TRUE((h.coeffs() == h1.coeffs()).all()) << threads;
      EXPECT_EQ(objective.gradient(q, g), energy) << threads;
      EXPECT_TRUE((g.array() == g1.array()).all()) << threads;
    }
  }
}

}  // namespace
}  // namespace coapt
