// Solves side by side and solves shared by threads: what ThreadSanitizer watches (preset tsan).
#include "optim/solver.hpp"
#include "support/valve_scene.hpp"

#include <gtest/gtest.h>

#include <thread>
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

}  // namespace
}  // namespace coapt
