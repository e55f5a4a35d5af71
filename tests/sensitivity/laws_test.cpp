// Stiffness, thickness and rest length of elements of every law, against terms that are made anew.
#include "energy/element_term.hpp"
#include "energy/kernels/tether_cubic.hpp"
#include "sensitivity/parameters/line_access.hpp"
#include "sensitivity/parameters/line_lengths.hpp"
#include "sensitivity/parameters/stiffness_factor.hpp"
#include "support/equilibrium.hpp"
#include "support/tissue_laws.hpp"

#include <gtest/gtest.h>

namespace coapt {
namespace {

// Forces at x, then the energy.
Vector state_of(const EnergyTerm& term, const Points& x) {
  Points g = Points::Zero(3, x.cols());
  Sink sink(g.data());
  Vector all(g.size() + 1);
  all[g.size()] = term.evaluate(x, sink);
  all.head(g.size()) = g.reshaped();
  return all;
}

// Derivatives of a parameter of one number against those of terms that make(value) gives, at x: forward,
// adjoint, of the energy; then what set() makes against make().
template <typename Make>
void expect_exact(Parameter& parameter, EnergyTerm& term, const Points& x, const Make& make) {
  const double start = parameter.value()[0], h = 2e-4 * std::max(std::abs(start), 0.1);
  const auto at = [&](double s) { return state_of(*make(start + s * h), x); };
  const Vector slope = (8 * (at(1) - at(-1)) - (at(2) - at(-2))) / (12 * h);
  const Eigen::Index n = slope.size() - 1;
  ASSERT_GT(slope.head(n).norm(), 1e-3);
  EXPECT_LT((state_of(term, x) - at(0)).norm(), 1e-12 * at(0).norm());
  Points forward = Points::Zero(3, x.cols());
  parameter.push_forward(x, Vector::Ones(1), forward);
  EXPECT_LT((forward.reshaped() - slope.head(n)).norm(), 1e-7 * slope.head(n).norm());
  std::srand(1);
  const Points weights = Points::Random(3, x.cols());
  EXPECT_NEAR(parameter.pull_back(x, weights)[0], forward.cwiseProduct(weights).sum(),
              1e-12 * forward.norm());
  EXPECT_NEAR(parameter.energy_derivative(x, term)[0], slope[n], 1e-7 * slope.norm());
  parameter.set(Vector::Constant(1, start + 500 * h));
  EXPECT_LT((state_of(term, x) - at(500)).norm(), 1e-12 * at(500).norm());
}

Points stretched(const Points& X, double by) {
  std::srand(2);
  return by * X + 0.05 * Points::Random(3, X.cols());
}

template <typename Entry>
class MembraneFactors : public testing::Test {};
TYPED_TEST_SUITE(MembraneFactors, MembraneLaws, LawNames);

// The number stands for a stress, with which all moduli go, and for a thickness.
TYPED_TEST(MembraneFactors, OfStiffnessAndThicknessAreExact) {
  TriangleMesh mesh;
  mesh.vertices = (Points(3, 4) << 0, 2, 0.3, 2.2, 0, 0.1, 1.5, 1.8, 0, 0.2, -0.1, 0.3).finished();
  mesh.triangles = (Triangles(3, 2) << 0, 1, 1, 3, 2, 2).finished();
  const Points fibres = (Points(3, 2) << 1, 1, 0.3, 0.2, 0, 0).finished(), x = stretched(mesh.vertices, 1.2);
  const auto of_stress = [&](double stress) {
    return tissue_term(mesh, TypeParam::law(stress), 0.8, fibres);
  };
  const auto of_thickness = [&](double h) { return tissue_term(mesh, TypeParam::law(2), h, fibres); };
  const auto stiff = of_stress(2), thick = of_thickness(0.8);
  expect_exact(*make_stiffness_factor("stiffness", {{.term = stiff.get()}}, 2), *stiff, x, of_stress);
  expect_exact(*make_stiffness_factor("thickness", {{.term = thick.get(), .is_size = true}}, 0.8), *thick, x,
               of_thickness);
}

// Lines of like length over a path that is drawn out.
struct Path {
  std::vector<int> nodes = {0, 1, 1, 2, 2, 3};
  double length = 2;
  Points x = stretched((Points(3, 4) << 0, 1.9, 3.8, 5.7, 0, 0.5, 0.2, 0.8, 0, 0, 0.6, 0.4).finished(), 1.1);
};

// Lengths of a group in each of their measures, each on terms of its own.
template <typename Make>
void expect_exact_lengths(const Path& path, const Make& of_length) {
  struct Case {
    LengthMeasure measure;
    std::function<double(double)> length;  // that the number stands for
  };
  const double r = path.length;
  const Case cases[] = {{LengthMeasure::Length, [](double number) { return number; }},
                        {LengthMeasure::Change, [r](double number) { return r + number; }},
                        {LengthMeasure::Factor, [r](double number) { return r * number; }}};
  for (const Case& each : cases) {
    SCOPED_TRACE(static_cast<int>(each.measure));
    const auto term = of_length(r);
    const auto lengths = make_line_lengths("lengths", *term, {{0, 1, 2}}, each.measure);
    for (int line = 0; line < 3; ++line) {
      const double h = 1e-4, l = line_length(*term, line, path.x);
      const double number = lengths->value()[0];
      const auto force = [&](double s) {
        const auto made = of_length(each.length(number + s * h));
        return line_access(*made)->at(line, l).law.force;
      };
      const double slope = (8 * (force(1) - force(-1)) - (force(2) - force(-2))) / (12 * h);
      EXPECT_NEAR(lengths->tension_derivative(path.x, *term, line)[0], slope, 1e-7 * std::abs(slope));
    }
    expect_exact(*lengths, *term, path.x, [&](double number) { return of_length(each.length(number)); });
  }
}

template <typename Entry>
class ChordNumbers : public testing::Test {};
TYPED_TEST_SUITE(ChordNumbers, ChordLaws, LawNames);

TYPED_TEST(ChordNumbers, OfStiffnessAndLengthAreExact) {
  const Path path;
  const auto made = [&](double stress, double length) {
    return chord_term(path.nodes, Vector::Constant(3, length), Vector::Constant(3, 0.4), 0.002,
                      TypeParam::law(stress));
  };
  const auto of_stress = [&](double stress) { return made(stress, path.length); };
  const auto term = of_stress(5);
  expect_exact(*make_stiffness_factor("stiffness", {{.term = term.get()}}, 5), *term, path.x, of_stress);
  expect_exact_lengths(path, [&](double length) { return made(5, length); });
}

TEST(ChordNumbers, OfLinearCablesAreExact) {
  const Path path;
  const Segments ends = Eigen::Map<const Segments>(path.nodes.data(), 2, 3);
  expect_exact_lengths(path, [&](double length) { return cable_term(ends, 7, Vector::Constant(3, length)); });
}

TEST(ChordNumbers, OfTethersAreExact) {
  const Path path;
  const auto made = [&](double strength, double length) {
    const std::vector<TetherCubic::Rest> rest(3, TetherCubic::Rest{.strength = strength, .length = length});
    return std::make_unique<ElementTerm<TetherCubic>>("tethers", path.nodes, rest);
  };
  const auto of_strength = [&](double strength) { return made(strength, path.length); };
  const auto term = of_strength(3);
  expect_exact(*make_stiffness_factor("strength", {{.term = term.get()}}, 3), *term, path.x, of_strength);
  expect_exact_lengths(path, [&](double length) { return made(3, length); });
}

}  // namespace
}  // namespace coapt
