// Stress rows S16, S18 and S19: evaluations that fail, and the same answer to the last bit.
#include "support/disc_scene.hpp"
#include "support/valve_scene.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <thread>

namespace coapt {
namespace {

// --- S16 --------------------------------------------------------------------------------------------------

// Contributes nothing, until a node rises above a height: then it fails, in one of several ways, at one node.
class Failing final : public EnergyTerm {
 public:
  enum class Way { NaN, Infinity, NaNGradient, Throws, ThrowsAtTheHessian };
  Failing(int node, double height, Way way)
      : EnergyTerm("failing"), node_(node), height_(height), way_(way) {}

  std::string_view type() const override { return "failing"; }
  TermRole role() const override { return TermRole::Internal; }
  const Stencils& stencils() const override { return stencils_; }
  double evaluate(const Points& x, Sink& sink) const override {
    if (x.row(2).maxCoeff() <= height_) return 0;
    switch (way_) {
      case Way::NaN:
        return kNaN;
      case Way::Infinity:
        return kInfinity;
      case Way::NaNGradient:
        if (sink.wants_gradient()) sink.add_gradient(node_, Vec3::Constant(kNaN));
        return 0;
      case Way::Throws:
        throw std::runtime_error("this term broke");
      case Way::ThrowsAtTheHessian:
        if (sink.wants_hessian()) throw std::runtime_error("this term has no Hessian here");
        return 0;
    }
    return 0;
  }

 private:
  int node_;
  double height_;
  Way way_;
  Stencils stencils_;
};

class Failure : public testing::TestWithParam<std::tuple<Failing::Way, std::string>> {};

TEST_P(Failure, S16EndsWithAFiniteIterate) {
  const auto& [way, solver] = GetParam();
  const DiscScene scene{smooth_disc_mesh(8)};
  const double height = scene.solve().x.row(2).maxCoeff();
  for (const bool is_reached : {false, true}) {  // the failure lies beyond the solution, or before it
    Terms terms = scene.terms();
    terms.push_back(std::make_unique<Failing>(grid_node(8, 4, 4), (is_reached ? 0.5 : 1.05) * height, way));
    const Equilibrium found = find_equilibrium(scene.mesh.vertices, scene.fixed(), std::move(terms),
                                               {.solver = solver,
                                                .tolerance = 1e-8,
                                                .max_iterations = solver == "newton" ? 300 : 2000,
                                                .max_seconds = 20});
    std::printf("S16 %s: %s, %d iterations\n", solver.c_str(), found.result.message.c_str(),
                found.result.iterations);
    EXPECT_TRUE(found.x.allFinite());
    EXPECT_TRUE(std::isfinite(found.result.energy) && std::isfinite(found.result.residual));
    EXPECT_LE(found.x.row(2).maxCoeff(), 1.05 * height);
    if (is_reached)
      EXPECT_NE(found.result.status, Status::Converged);
    else
      EXPECT_EQ(found.result.status, Status::Converged) << found.result.message;
  }
}

INSTANTIATE_TEST_SUITE_P(Ways, Failure,
                         testing::Combine(testing::Values(Failing::Way::NaN, Failing::Way::Infinity,
                                                          Failing::Way::NaNGradient, Failing::Way::Throws),
                                          testing::Values("newton", "lbfgs")));

// A line search asks for no Hessian and sees nothing: newton ends where the first one is missing, and says
// so.
TEST(HessianFailure, S16EndsWithTheLastFiniteIterate) {
  const DiscScene scene{smooth_disc_mesh(8)};
  for (const std::string solver : {"newton", "lbfgs"}) {
    Terms terms = scene.terms();
    terms.push_back(std::make_unique<Failing>(grid_node(8, 4, 4), 0.05, Failing::Way::ThrowsAtTheHessian));
    const Equilibrium found = find_equilibrium(scene.mesh.vertices, scene.fixed(), std::move(terms),
                                               {.solver = solver, .tolerance = 1e-8});
    std::printf("S16 Hessian, %s: %s\n", solver.c_str(), found.result.message.c_str());
    EXPECT_TRUE(found.x.allFinite());
    EXPECT_GT(found.x.row(2).maxCoeff(), 0.05);
    EXPECT_TRUE(std::isfinite(found.result.energy) && std::isfinite(found.result.residual));
    EXPECT_EQ(found.result.status, solver == "newton" ? Status::Stalled : Status::Converged);
  }
}

// --- S18, S19 ---------------------------------------------------------------------------------------------

void expect_equal_bits(const Equilibrium& a, const Equilibrium& b) {
  EXPECT_TRUE((a.x.array() == b.x.array()).all());
  EXPECT_EQ(a.result.energy, b.result.energy);
  EXPECT_EQ(a.result.residual, b.result.residual);
  EXPECT_EQ(a.result.iterations, b.result.iterations);
}

TEST(Valve, S18GivesTheSameBitsTwice) {
  const ValveScene scene({});
  expect_equal_bits(scene.solve_in({}, 1e-8), scene.solve_in({}, 1e-8));
}

TEST(Valve, S19GivesTheSameBitsFromSeveralThreads) {
  const ValveScene scene({});
  const Equilibrium alone = scene.solve_in({}, 1e-8);
  std::vector<Equilibrium> found(4);
  std::vector<std::thread> threads;
  for (Equilibrium& one : found) threads.emplace_back([&] { one = scene.solve_in({}, 1e-8); });
  for (std::thread& thread : threads) thread.join();
  for (const Equilibrium& one : found) expect_equal_bits(one, alone);
}

}  // namespace
}  // namespace coapt
