// Nonlinear cables: the term suite, and their curves against closed forms.
#include "energy/kernels/cable_law.hpp"

#include "support/term_suite.hpp"
#include "support/tissue_laws.hpp"

#include <gtest/gtest.h>

namespace coapt {
namespace {

constexpr auto bilinear = laws::BilinearChord::law;
constexpr auto ogden = laws::OgdenChord::law;
constexpr auto toe = laws::ToeChord::law;

template <typename Entry>
class ChordLaw : public testing::Test {};
TYPED_TEST_SUITE(ChordLaw, ChordLaws, LawNames);

template <typename Law>
TermCase line_case(const std::string& label, Law (*law_of)(double), double smoothing, double stretch) {
  TermCase c;
  c.label = label;
  Points chain(3, 4);
  chain << 0, 0.9, 0.9, 0.1, 0, 0.1, 0.5, 0.7, 0, 0.2, -0.1, 0.1;
  c.rest = 0.5 * chain;  // all slack
  c.state = stretch * chain;
  c.reach = 2e-3;
  c.make = [=](const Frame& f) -> std::unique_ptr<EnergyTerm> {
    const double stress = f.force / (f.length * f.length);
    const std::vector<double> lengths{0.75, 0.65, 0.6};
    std::vector<typename CableLaw<Law>::Rest> rest;
    for (const double length : lengths)
      rest.push_back(
          CableLaw<Law>::rest(length * f.length, 0.3 * f.length * f.length, smoothing, law_of(stress)));
    return std::make_unique<ElementTerm<CableLaw<Law>>>("lines", f.nodes({0, 1, 1, 2, 2, 3}), rest);
  };
  return c;
}

template <typename Law>
void expect_passes(const std::string& label, Law (*law_of)(double)) {
  EXPECT_EQ(examine_term(line_case(label + ", taut", law_of, 0.002, 1.0)), "");
  EXPECT_EQ(examine_term(line_case(label + ", rounded", law_of, 0.9, 1.0)), "");
}

TYPED_TEST(ChordLaw, PassesTheSuite) { expect_passes(TypeParam::kName, TypeParam::law); }

TEST(CableLaw, FollowsTheClosedForms) {
  const auto b = CableBilinear::rest(2, 0.3, 0.002, bilinear(1));
  const auto o = CableOgden::rest(2, 0.3, 0.002, ogden(1));
  for (const double e : {0.01, 0.1, 0.3, 0.6}) {
    EXPECT_NEAR(CableBilinear::elastic(b, e).force,
                0.3 * (e + (e <= 0.15   ? 0
                            : e >= 0.25 ? 9 * (e - 0.2)
                                        : 45 * (e - 0.15) * (e - 0.15))),
                1e-12);
    const double l = 1 + e;
    // Uniaxial Cauchy stress s = sum 2 mu/alpha (l^alpha - l^(-alpha/2)) over the stretch.
    const double cauchy =
        2.0 / 6 * (std::pow(l, 6) - std::pow(l, -3)) + 1.0 / 12 * (std::pow(l, 12) - std::pow(l, -6));
    EXPECT_NEAR(CableOgden::elastic(o, e).force / (0.3 * cauchy / l), 1, 1e-13);
  }
  const auto t = CableToe::rest(2, 0.3, 0, toe(1));
  EXPECT_NEAR(CableToe::elastic(t, 0.1).force, 0.3 * 0.9 * std::expm1(4.5) / std::expm1(6.75), 1e-13);
  EXPECT_NEAR(CableToe::elastic(t, 0.2).force, 0.3 * 30 * 0.08, 1e-13);
  EXPECT_EQ(CableOgden::elastic(o, -0.1).force, 0);
  EXPECT_EQ(CableOgden::elastic(o, 0).stiffness, 0);
}

// An exponent next to zero, as fits of real chords have, must not cancel the energy away.
TEST(CableLaw, OgdenEnergyKeepsItsDigitsAtSmallExponents) {
  const OgdenLine law{{33.75, 0, 0}, {1.5e-4, 0, 0}};
  for (const double e : {1e-3, 0.01, 0.1}) {
    // alpha -> 0: 2 mu/alpha^2 (1/2 + 2/8) (alpha ln l)^2, with a correction of the order of alpha.
    const double limit = 1.5 * 33.75 * std::pow(std::log1p(e), 2);
    EXPECT_NEAR(law.at(e).energy / limit, 1, 1e-4);
    const double h = 1e-6;
    EXPECT_NEAR((law.at(e + h).energy - law.at(e - h).energy) / (2 * h) / law.at(e).stress, 1, 1e-6);
  }
}

// Beyond a stretch of e such a law softens, and its exact Hessian is not positive.
TEST(CableLaw, ProjectedHessiansArePositive) {
  const auto rest = CableOgden::rest(1, 0.3, 0, OgdenLine{{33.75, 0, 0}, {1.5e-4, 0, 0}});
  const Eigen::Vector<double, 6> x{0, 0, 0, 3, 1, -2};
  Eigen::Vector<double, 6> g, projected_g;
  Eigen::Matrix<double, 6, 6> H, projected;
  EXPECT_EQ(CableOgden::evaluate(rest, x, &g, &H),
            CableOgden::evaluate_projected(rest, x, &projected_g, &projected));
  EXPECT_EQ(g, projected_g);
  const auto least = [](const Eigen::Matrix<double, 6, 6>& h) {
    return Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 6, 6>>(h).eigenvalues()[0];
  };
  EXPECT_LT(least(H), -0.1);
  EXPECT_GE(least(projected), -1e-12);
}

TEST(CableLaw, CanBeRoundedMoreForAWhile) {
  ElementTerm<CableOgden> term("cable", {0, 1}, {CableOgden::rest(2, 0.3, 0.002, ogden(1))});
  Points x = Points::Zero(3, 2);
  x(0, 1) = 2.3;
  Sink value_only;
  const double sharp = term.evaluate(x, value_only);
  EXPECT_TRUE(term.round_kinks(0.5));
  EXPECT_LT(term.evaluate(x, value_only), 0.9 * sharp);
  term.round_kinks(0);
  EXPECT_EQ(term.evaluate(x, value_only), sharp);
}

// As a solver's continuation needs it: a wide rounding carries the same force at a few times the elongation,
// not at one that the law itself would answer with a force of another magnitude.
TEST(CableLaw, StaysSoftAndMovesLittleHoweverWideTheRounding) {
  const OgdenLine steep{{19, 22, 20}, {98, 98, 98}};
  const auto given = CableOgden::rest(2, 0.3, 0.002, steep);
  const double sought = CableOgden::elastic(given, 0.01).force;
  double before = 0.01;
  for (const double share : {0.003, 0.01, 0.03, 0.1, 0.3, 1.0}) {
    const auto wide = CableOgden::rounded(given, share);
    double low = 0, high = 1;
    for (int k = 0; k < 60; ++k) {
      const double e = 0.5 * (low + high);
      const AxialLaw law = CableOgden::elastic(wide, e);
      EXPECT_GT(law.stiffness, 0) << share << " at " << e;
      (law.force < sought ? low : high) = e;
    }
    EXPECT_GE(low, before * (1 - 1e-9)) << share;
    EXPECT_LT(low, 2 * before) << share;
    before = low;
  }
  EXPECT_LT(before, 0.05);
}

}  // namespace
}  // namespace coapt
