// Stress row S12: a path through a limit point. A shallow arch under a rising load snaps through to the other
// side; which of its equilibria a run ends in is what its path says, and the run reports the snap and how far
// apart the branches are.
#include "energy/load_dead.hpp"
#include "support/meshes.hpp"
#include "support/sheets.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

namespace coapt {
namespace {

constexpr double kPi = std::numbers::pi;

// A strip of span 1 and Eh = 1, z = b sin(pi x) at rest and hinged at its ends, under the load q sin(pi x)
// downwards. In the theory of shallow arches it stays z = a sin(pi x), with
//   q(a) = pi^4 (D (b - a) + a (b^2 - a^2) / 4),
// which rises to a limit at a = sqrt((b^2 - 4 D) / 3), falls to another at minus that, and rises again. With
// b/sqrt(D) = 3.5 there is no way out sideways before the limit (from 4.69 on there would be).
class ShallowArch : public testing::Test {
 protected:
  static constexpr int kCells = 32, kRows = 2;
  static constexpr double kRise = 0.035, kBending = 1e-4;

  ShallowArch() : mesh_(grid_mesh(kCells, kRows, 1, static_cast<double>(kRows) / kCells)) {
    fixed_ = FixedMask::Constant(3, mesh_.vertex_count(), false);
    fixed_.row(1).setConstant(true);
    for (int v = 0; v < mesh_.vertex_count(); ++v)
      if (std::abs(mesh_.vertices(0, v) - 0.5) > 0.5 - 1e-9) fixed_.col(v).setConstant(true);
    areas_ = nodal_areas(mesh_.vertices, mesh_.triangles);
    // Hinges on halved squares are stiffer than the plate: what counts is the stiffness of this strip, that
    // is what it sags when flat, by q / (D pi^4).
    const double q = 1e-9;
    hinge_stiffness_ = 1;
    const Equilibrium sagged = find_equilibrium(mesh_.vertices, fixed_, terms(q), {.tolerance = 1e-10});
    hinge_stiffness_ = kBending * -crown(sagged.x) * std::pow(kPi, 4) / q;
    mesh_.vertices.row(2) = kRise * (kPi * mesh_.vertices.row(0)).array().sin();
  }

  static double load_at(double a) {
    return std::pow(kPi, 4) * (kBending * (kRise - a) + 0.25 * a * (kRise * kRise - a * a));
  }
  static double limit() { return std::sqrt((kRise * kRise - 4 * kBending) / 3); }
  static double limit_load() { return load_at(limit()); }
  static double root(double load, double low, double high) {  // where load_at falls
    for (int k = 0; k < 100; ++k) {
      const double middle = 0.5 * (low + high);
      (load_at(middle) > load ? low : high) = middle;
    }
    return low;
  }
  static double upright(double load) { return root(load, limit(), kRise); }
  static double inverted(double load) { return root(load, -3 * kRise, -limit()); }

  Terms terms(double load) const {
    Points forces = Points::Zero(3, mesh_.vertex_count());
    for (int v = 0; v < mesh_.vertex_count(); ++v)
      forces(2, v) = -load * areas_[v] * std::sin(kPi * mesh_.vertices(0, v));
    return terms_of(membrane_term(mesh_.vertices, mesh_.triangles, {1, 0, 0}),
                    bending_term(mesh_.vertices, mesh_.triangles, hinge_stiffness_),
                    std::make_unique<LoadDead>("load", "load_field", forces, mesh_.vertices));
  }
  Equilibrium loaded(const Points& from, double load, int steps) const {
    Method method{.tolerance = 1e-9, .max_iterations = 2000};
    method.continuation.load_steps = steps;
    const Equilibrium found = find_equilibrium(from, fixed_, terms(load), method);
    std::printf("S12 arch, %.2f of the limit load in %d steps: crown %.5f, %d iterations, %s\n",
                load / limit_load(), steps, crown(found.x), found.result.iterations,
                found.result.message.c_str());
    EXPECT_EQ(found.result.status, Status::Converged) << found.result.message;
    EXPECT_LE(found.result.residual, 1e-9);
    return found;
  }
  static double crown(const Points& x) { return x(2, grid_node(kCells, kCells / 2, 1)); }

  TriangleMesh mesh_;
  FixedMask fixed_;
  Vector areas_;
  double hinge_stiffness_ = 0;
};

TEST_F(ShallowArch, S12SnapsThroughWhereItsBranchEndsAndSaysSo) {
  const double most = 1.3, load = most * limit_load();
  const Equilibrium coarse = loaded(mesh_.vertices, load, 12), fine = loaded(mesh_.vertices, load, 48);
  EXPECT_NEAR(crown(coarse.x), inverted(load), 0.01 * kRise);
  EXPECT_LT((coarse.x - fine.x).cwiseAbs().maxCoeff(), 1e-6);
  for (const auto& [found, steps] : {std::pair{&coarse, 12}, std::pair{&fine, 48}}) {
    ASSERT_EQ(found->result.branch_changes.size(), 1u);
    const BranchChange change = found->result.branch_changes[0];
    const double at = most * change.step / steps, before = most * change.before / steps;
    std::printf("S12 arch: snaps at %.3f of the limit load; at %.3f the branches are %.5f apart\n", at,
                before, change.distance);
    EXPECT_GT(at, 0.97);  // the limit load of a mesh this coarse, and of a rise that is not quite small
    EXPECT_LT(before, 1.03);
    EXPECT_LT(at, 1 + 2 * most / steps);
    const double load_before = std::min(before, 1.0) * limit_load();
    EXPECT_NEAR(change.distance, upright(load_before) - inverted(load_before), 0.03 * 2 * kRise);
    EXPECT_NE(found->result.message.find("left its branch of equilibria in step"), std::string::npos);
  }
}

// Below the limit load, and above the one at which it snaps back, there are two.
TEST_F(ShallowArch, S12StaysOnTheBranchOfItsPath) {
  const double load = 0.6 * limit_load();
  const Equilibrium up = loaded(mesh_.vertices, load, 12), at_once = loaded(mesh_.vertices, load, 1);
  const Equilibrium snapped = loaded(mesh_.vertices, 1.3 * limit_load(), 1),
                    down = loaded(snapped.x, load, 1);
  EXPECT_TRUE(up.result.branch_changes.empty());
  EXPECT_EQ(up.result.message.find("branch"), std::string::npos);
  EXPECT_LT((up.x - at_once.x).cwiseAbs().maxCoeff(), 1e-6);
  EXPECT_NEAR(crown(up.x), upright(load), 0.01 * kRise);
  EXPECT_NEAR(crown(down.x), inverted(load), 0.01 * kRise);
  const Equilibrium back = loaded(down.x, 0.1 * limit_load(), 1);  // below the other limit
  EXPECT_NEAR(crown(back.x), upright(0.1 * limit_load()), 0.01 * kRise);
}

// Pushed by its crown the arch passes both limit points of the load, for the crown leaves it no choice: no
// snap. Let go where no load holds it, it returns.
TEST_F(ShallowArch, S12PushedByItsCrownPassesTheLimitWithoutASnap) {
  FixedMask held = fixed_;
  Method method{.tolerance = 1e-9, .max_iterations = 2000};
  for (int j = 0; j <= kRows; ++j) held(2, grid_node(kCells, kCells / 2, j)) = true;
  method.motion.steps = 16;
  method.motion.positions = [&](double t) {
    Points x = mesh_.vertices;
    for (int j = 0; j <= kRows; ++j) x(2, grid_node(kCells, kCells / 2, j)) = kRise * (1 - 2 * t);
    return x;
  };
  const Equilibrium pushed = find_equilibrium(mesh_.vertices, held, terms(0), method);
  EXPECT_EQ(pushed.result.status, Status::Converged) << pushed.result.message;
  EXPECT_TRUE(pushed.result.branch_changes.empty()) << pushed.result.message;
  EXPECT_NEAR(crown(pushed.x), -kRise, 1e-12);
  const Equilibrium released = loaded(pushed.x, 0, 1);
  EXPECT_NEAR(crown(released.x), kRise, 1e-6);
}

}  // namespace
}  // namespace coapt
