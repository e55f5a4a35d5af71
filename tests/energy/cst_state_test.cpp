// Stresses of one triangle for reports: against the nodal forces of every law, and closed forms.
#include "energy/kernels/cst_prestress.hpp"
#include "energy/kernels/cst_stvk.hpp"
#include "energy/kernels/cst_tension_field.hpp"
#include "support/single_triangle.hpp"
#include "support/tissue_answers.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace coapt {
namespace {

Eigen::Matrix2d sheared(double xx, double xy, double yy) {
  Eigen::Matrix2d F;
  F << xx, xy, 0.1, yy;
  return F;
}

template <typename Entry>
class StateOfLaw : public testing::Test {};
TYPED_TEST_SUITE(StateOfLaw, MembraneLaws, LawNames);

// P of the nodal forces; tau = P F^T is J times the Cauchy stress. J = 1 but for the laws with a bulk
// modulus, whose stress is that of a sheet of another thickness in every direction.
TYPED_TEST(StateOfLaw, GivesTheStressesOfTheNodalForces) {
  using Law = decltype(TypeParam::law(1));
  for (const bool relaxes : {false, true})
    for (const double angle : {0.0, 0.6, 2.0})
      for (const Eigen::Matrix2d& F :
           {sheared(1.3, 0.2, 1.1), sheared(1.25, 0.3, 0.7), sheared(0.9, -0.1, 0.8)}) {
        const Single<Law> single(TypeParam::law(1), F, angle, relaxes);
        const MembraneState state = KernelOf<Law>::Type::state(single.rest, single.x);
        const Eigen::Matrix2d P = single.nominal(), tau = P * F.transpose();
        const double scale = 1e-12 + 1e-9 * P.norm();
        double J = 1;
        if constexpr (requires(Law law) { law.bulk; })
          if (single.rest.law.bulk > 0 && tau.norm() > scale) J = tau.norm() / state.cauchy.norm();
        EXPECT_NEAR(J * state.cauchy.sum(), tau.trace(), scale);
        EXPECT_NEAR(J * J * state.cauchy.prod(), tau.determinant(), scale * (1e-3 + P.norm()));
        EXPECT_GE(state.cauchy[0], state.cauchy[1]);
        // The squared singular values of P have the sum |P|^2 and the product det^2 P.
        EXPECT_NEAR(state.first_piola.norm(), P.norm(), scale);
        EXPECT_NEAR(std::abs(state.first_piola.prod()), std::abs(P.determinant()), scale * (1e-3 + P.norm()));
        EXPECT_GE(state.first_piola[0], state.first_piola[1]);
      }
}

// A strip of constant volume under uniaxial tension: sigma = mu (l^2 - 1/l), P = sigma/l, S = sigma/l^2. Held
// narrower than it is free to be, it wrinkles and its material is stressed as before.
TEST(MembraneStateOf, AStripIsThatOfTheUniaxialTest) {
  const double mu = 0.4;
  for (const double l : {1.1, 1.8, 3.0})
    for (const double narrowing : {1.0, 0.8}) {
      const Eigen::Matrix2d F = Eigen::Vector2d(l, narrowing / std::sqrt(l)).asDiagonal();
      const Single<NeoHookeanLaw> strip(NeoHookeanLaw{{mu}, 0}, F);
      const MembraneState state = CstNeoHookean::state(strip.rest, strip.x);
      const double sigma = mu * (l * l - 1 / l);
      EXPECT_NEAR(state.cauchy[0], sigma, 1e-9 * sigma);
      EXPECT_NEAR(state.cauchy[1], 0, 1e-9 * sigma);
      EXPECT_NEAR(state.first_piola[0], sigma / l, 1e-9 * sigma);
      EXPECT_NEAR(state.stress[0], sigma / (l * l), 1e-9 * sigma);
    }
}

// With a bulk modulus K the thickness is the law's. The stress across vanishes, so with J = l1 l2 l3
//   sigma_i = mu J^(-5/3) (l_i^2 - l3^2),   sigma_1 + sigma_2 = 3 K (J - 1).
TEST(MembraneStateOf, ACompressibleSheetCountsItsOwnThickness) {
  const double mu = 0.4;
  for (const double bulk : {0.5, 3.0, 400.0})
    for (const auto& [l1, l2] : {std::pair{1.4, 1.2}, std::pair{2.0, 1.0}}) {
      const Eigen::Matrix2d F = Eigen::Vector2d(l1, l2).asDiagonal();
      const Single<NeoHookeanLaw> sheet(NeoHookeanLaw{{mu}, bulk}, F);
      const MembraneState state = CstNeoHookean::state(sheet.rest, sheet.x);
      const double J = 1 + state.cauchy.sum() / (3 * bulk), l3 = J / (l1 * l2);
      EXPECT_NEAR(state.cauchy[0], mu * std::pow(J, -5.0 / 3) * (l1 * l1 - l3 * l3), 1e-8);
      EXPECT_NEAR(state.cauchy[1], mu * std::pow(J, -5.0 / 3) * (l2 * l2 - l3 * l3), 1e-8);
      // The force along over the deformed cross-section.
      EXPECT_NEAR(state.first_piola[0], state.cauchy[0] * l2 * l3, 1e-9);
    }
}

// The same strip narrower than it is free to be: J is that of the free width, l2 = l3 = sqrt(J/l1), so that
// sigma = mu J^(-5/3) (l1^2 - J/l1) and sigma = 3 K (J - 1).
TEST(MembraneStateOf, ACompressibleStripThatWrinklesHasTheStressOfTheFreeOne) {
  const double mu = 0.4, bulk = 1.5, l = 2;
  for (const double width : {0.6, 0.3}) {
    const Single<NeoHookeanLaw> strip(NeoHookeanLaw{{mu}, bulk}, Eigen::Vector2d(l, width).asDiagonal());
    const MembraneState state = CstNeoHookean::state(strip.rest, strip.x);
    ASSERT_EQ(state.regime, MembraneRegime::Wrinkled);
    const double J = 1 + state.cauchy[0] / (3 * bulk);
    EXPECT_NEAR(state.cauchy[0], mu * std::pow(J, -5.0 / 3) * (l * l - J / l), 1e-8);
    EXPECT_NEAR(state.cauchy[1], 0, 1e-12);
  }
}

// Plane stress of St. Venant-Kirchhoff says what a triangle resists, not how thick it is: J = 1 by
// convention. Uniaxial: S = E (l^2 - 1)/2, P = l S, and sigma = l^2 S, the force over the cross-section A0/l.
// l2 = l3, so that one equation for the volume gives the width. Where an exponential is steep it is a guess.
TEST(MembraneStateOf, AStripIsFreeOfStressAcrossAtTheWidthThatTheLawGives) {
  for (const double bulk : {0.0, 3.0, 20.0, 400.0})
    for (const double l : {1.001, 1.1, 1.3}) {
      const NeoHookeanLaw neo_hookean{{0.4}, bulk};
      const ExponentialLaw exponential{{0.01, 0.0075, 2}, bulk};
      const StretchEnergy a = neo_hookean.evaluate(l, neo_hookean.free_width(l).width),
                          b = exponential.evaluate(l, exponential.free_width(l).width);
      EXPECT_LT(std::abs(a.w2), 1e-8 * a.w1) << l << ", bulk " << bulk;
      EXPECT_LT(std::abs(b.w2), 1e-8 * b.w1) << l << ", bulk " << bulk;
    }
}

TEST(MembraneStateOf, StVenantKirchhoffKeepsItsVolume) {
  const double young = 2, poisson = 0.3, h = 0.4, l = 1.5, e = 0.5 * (l * l - 1);
  const double across = std::sqrt(1 - 2 * poisson * e);
  CstVector x;
  x << 0, 0, 0, l, 0, 0, 0, across, 0;
  const Vec3 X0 = Vec3::Zero(), X1 = Vec3::UnitX(), X2 = Vec3::UnitY();
  const auto expect = [&](const MembraneState& state) {
    EXPECT_NEAR(state.cauchy[0], l * l * young * e, 1e-12);
    EXPECT_NEAR(state.cauchy[1], 0, 1e-12);
    EXPECT_NEAR(state.first_piola[0], l * young * e, 1e-12);
    EXPECT_TRUE(state.has_thickness);
  };
  expect(CstStVK::state(CstStVK::rest(X0, X1, X2, young, poisson, h), x));
  expect(CstTensionField::state(CstTensionField::rest(X0, X1, X2, young, poisson, h), x));
}

// A pushed strip: both are negative.
TEST(MembraneStateOf, APushedTriangleHasNegativeStresses) {
  CstVector x;
  x << 0, 0, 0, 0.9, 0, 0, 0, 0.8, 0;
  const MembraneState state =
      CstStVK::state(CstStVK::rest(Vec3::Zero(), Vec3::UnitX(), Vec3::UnitY(), 2, 0.3, 0.4), x);
  EXPECT_LT(state.cauchy[0], 0);
  EXPECT_LT(state.first_piola[0], 0);
  EXPECT_NEAR(state.first_piola[0], 0.9 * state.stress[0], 1e-12);
  EXPECT_NEAR(state.first_piola[1], 0.8 * state.stress[1], 1e-12);
}

TEST(MembraneStateOf, PrestressHasAStressWhereItHasAThickness) {
  CstVector x;
  x << 0, 0, 0, 2, 0, 0, 0, 1, 0;
  const auto state = [&](double thickness) {
    return CstPrestress::state(
        CstPrestress::rest(Vec3::Zero(), Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitX(), 3, 1, thickness), x);
  };
  EXPECT_NEAR(state(0.5).cauchy[0], 4 * 3 / 0.5, 1e-12);  // l^2 S
  EXPECT_NEAR(state(0.5).cauchy[1], 1 / 0.5, 1e-12);
  EXPECT_FALSE(state(0).has_thickness);
}

// A triangle that has collapsed to a line has no stretch across, and still finite numbers.
TEST(MembraneStateOf, ACollapsedTriangleIsFinite) {
  CstVector x;
  x << 0, 0, 0, 1.2, 0, 0, 0.6, 0, 0;
  const MembraneState state =
      CstStVK::state(CstStVK::rest(Vec3::Zero(), Vec3::UnitX(), Vec3::UnitY(), 2, 0.3, 0.4), x);
  EXPECT_TRUE(state.cauchy.allFinite() && state.first_piola.allFinite());
  EXPECT_TRUE(CstStVK::state(CstStVK::rest(Vec3::Zero(), Vec3::UnitX(), Vec3::UnitY(), 2, 0.3, 0.4),
                             CstVector::Zero())
                  .cauchy.allFinite());
}

}  // namespace
}  // namespace coapt
