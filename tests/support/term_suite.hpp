// Everything that a term must pass before it lands, in one call:
//
//   EXPECT_EQ(examine_term(test_case), "");            every defect is one line of the answer
//   EXPECT_EQ(compare_with_autodiff(test_case, f), ""); f: the energy written anew, templated on its scalar
//
// Derivatives: slopes of the Taylor remainders |E(x+hd) - E(x) - h g.d| ~ h^2 and
// |... - h^2/2 d.Hd| ~ h^3, worst of 20 seeded directions (slope_of_remainder says how a slope is read);
// central differences of E against g and of g against H; the same numbers from Objective::hessian.
// Parts (EnergyTerm::part): the same derivatives by the nodes that move, where they are and within their
// reach. Symmetries: rotation, translation, renumbering, units. State: purity along two histories, no energy
// or force at rest where the law says so, and nothing is zero at the state under test.
#pragma once

#include "energy/objective.hpp"
#include "energy/term.hpp"
#include "support/autodiff.hpp"
#include "support/frame.hpp"

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace coapt {

struct TermCase {
  std::string label;
  // Builds the term as seen from a frame: with frame.points(X), frame.triangles(T), moduli in its units.
  std::function<std::unique_ptr<EnergyTerm>(const Frame&)> make;
  Points rest;       // X, 3 x node_count
  Points state;      // where derivatives are tested: the term is active there
  double reach = 1;  // largest step of the ladders [length]: within it no cut-off or kink is crossed
  bool is_zero_at_rest = true;       // energy and force vanish at X
  bool ignores_rigid_motion = true;  // of the current positions alone
  bool has_hessian = true;           // false: the second derivative has a kink or is zero at the state
  double far_away = 100;             // distance for the test of translation [length]
};

// Energy, gradient (3 x node_count) and full dense Hessian, assembled without Objective.
struct TermValues {
  double energy = 0;
  Points gradient;
  Eigen::MatrixXd hessian;
};

TermValues evaluate_term(EnergyTerm& term, const Points& x);

// The slope of log(remainder) over log(step), read over the smallest decade of steps whose remainders
// all exceed their round-off by a factor of 100: there a wrong derivative, however small its error,
// shows its lower slope, while at larger steps it can hide behind the next order. Steps fall by
// half decades. Infinite when no remainder rises above round-off: the expansion is exact.
double slope_of_remainder(const std::vector<double>& steps, const std::vector<double>& remainders,
                          const std::vector<double>& round_off);

// Defects, one line each; empty when the term passes.
std::string examine_term(const TermCase& test_case);

// Parts of examine_term, for tests of what is not quite a term.
std::string examine_derivatives(const TermCase& test_case);
std::string examine_symmetries(const TermCase& test_case);
std::string examine_state(const TermCase& test_case);

// Largest difference of gradient and Hessian to automatic differentiation must be below
// `tolerance` relative to the largest entry.
// energy: templated call operator `T operator()(const std::vector<AutoVec<T>>& x)` on node positions.
template <typename Energy>
std::string compare_with_autodiff(const TermCase& test_case, const Energy& energy, double tolerance = 1e-10) {
  const auto term = test_case.make({});
  const TermValues ours = evaluate_term(*term, test_case.state);
  const SecondOrder exact = differentiate_twice(energy, test_case.state);
  std::string defects;
  const auto compare = [&](const std::string& what, double difference, double scale) {
    if (difference > tolerance * scale)
      defects += test_case.label + ": " + what + " differs from automatic differentiation by " +
                 std::to_string(difference / scale * 1e10) + "e-10\n";
  };
  compare("energy", std::abs(ours.energy - exact.value), std::abs(exact.value));
  const Eigen::Map<const Vector> g(ours.gradient.data(), ours.gradient.size());
  compare("gradient", (g - exact.gradient).cwiseAbs().maxCoeff(), exact.gradient.cwiseAbs().maxCoeff());
  if (test_case.has_hessian)
    compare("Hessian", (ours.hessian - exact.hessian).cwiseAbs().maxCoeff(),
            exact.hessian.cwiseAbs().maxCoeff());
  return defects;
}

}  // namespace coapt
