// Every membrane law far outside what tissue is measured at: stretches from 0.2 to 3, uniaxial, biaxial and
// sheared, with the published numbers of real leaflets. Energy, gradient and Hessian against differences, and
// the minimum that the law takes over its change of volume, or over its wrinkles, against brute force. Where
// an exponential overflows the energy is infinite, and nothing else.
#include "support/single_triangle.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>
#include <random>
#include <vector>

namespace coapt {
namespace {

constexpr double kMostFinite = 1e120;  // whose second derivatives are finite too
// Next to where it overflows itself an energy may count as infinite, as its derivatives are.
constexpr double kDerivativesOverflow = 1e295;

// Numbers of published leaflets [MPa]: the tricuspid valve of Mathur et al. 2022, with the bulk modulus 2/D
// that it prints and incompressible, and a bioprosthetic leaflet.
std::vector<ExponentialLaw> published_exponentials() {
  std::vector<ExponentialLaw> all{{{0.067608, 0.0132848, 38.1878}, 0}};
  for (const double bulk : {0.0, 2 / 20.06689, 20.0})
    for (const ExponentialInvariant& leaflet :
         {ExponentialInvariant{0.001, 0.000124, 4.568202}, ExponentialInvariant{0.001, 0.000188, 14.85959},
          ExponentialInvariant{0.001, 0.000191, 17.75149}})
      all.push_back({leaflet, bulk});
  return all;
}

std::vector<Eigen::Matrix2d> extreme_states() {
  std::vector<Eigen::Matrix2d> all;
  for (const double l : {0.203, 0.52, 0.81, 1.021, 1.31, 1.703, 1.852, 2.104, 2.61, 2.998}) {
    for (const double width : {0.211, 0.655, 1 / std::sqrt(l) + 1e-3, 0.993, 1.013 * l})
      all.push_back(plane(l, 0, width));
    all.push_back(plane(l, 0.4, 0.91));
    all.push_back(plane(1.04, 0.5 * l, l));
  }
  return all;
}

template <typename Law>
double energy_at(const Single<Law>& s, const CstVector& x) {
  return KernelOf<Law>::Type::evaluate(s.rest, x, nullptr, nullptr);
}

// Along one direction by differences: slope and curvature of the energy.
template <typename Law>
void expect_derivatives(const Law& law, const Eigen::Matrix2d& F, bool relaxes) {
  using Kernel = typename KernelOf<Law>::Type;
  const Single<Law> s(law, F, 0.3, relaxes);
  SCOPED_TRACE(testing::Message() << "F = " << F(0, 0) << " " << F(0, 1) << " " << F(1, 1)
                                  << (relaxes ? ", relaxed" : ", resisting"));
  ASSERT_FALSE(std::isnan(s.energy));
  ASSERT_GE(s.energy, 0);
  if (s.energy > kMostFinite) return;
  ASSERT_TRUE(s.g.allFinite() && s.H.allFinite());
  CstVector d;
  d << 0.3, -0.7, 0.2, -0.5, 0.4, 0.1, 0.6, 0.35, -0.8;
  const double h = 1e-5;
  const auto slope = [&](double t) {
    CstVector g;
    Kernel::evaluate(s.rest, s.x + t * d, &g, nullptr);
    return g.dot(d);
  };
  const auto work = [&](double t) { return energy_at(s, s.x + t * d) - energy_at(s, s.x - t * d); };
  const double by_energy = (8 * work(h) - work(2 * h)) / (12 * h);
  EXPECT_NEAR(by_energy, s.g.dot(d), 1e-5 * s.g.norm() * d.norm() + 1e-9 * s.energy / h + 1e-16);
  const auto change = [&](double t) { return slope(t) - slope(-t); };
  const double by_slope = (8 * change(h) - change(2 * h)) / (12 * h);
  EXPECT_NEAR(by_slope, d.dot(s.H * d), 1e-4 * s.H.norm() * d.squaredNorm() + 1e-10 * s.g.norm() / h + 1e-14);
}

template <typename Law>
void expect_right_everywhere(const Law& law) {
  for (const Eigen::Matrix2d& F : extreme_states())
    for (const bool relaxes : {true, false}) expect_derivatives(law, F, relaxes);
}

TEST(ExtremeStates, DerivativesOfPublishedLawsHold) {
  for (const ExponentialLaw& law : published_exponentials()) {
    SCOPED_TRACE(testing::Message() << "c2 " << law.invariant.c2 << ", bulk " << law.bulk);
    expect_right_everywhere(law);
  }
  expect_right_everywhere(OrthotropicLaw{0.1, 0.02, {5.9, 0.15, 0.01}, {1.2, 0.25, 0.01}, 0.3, 0.02});
  expect_right_everywhere(MayNewmanYinLaw{0.000399, 4.325, 1446.5});
  expect_right_everywhere(CrimpedFibreLaw{0.01, CrimpedFibre(48, 12, 1.6, 0.01), 0.1});
}

template <typename Entry>
class ExtremeState : public testing::Test {};
TYPED_TEST_SUITE(ExtremeState, MembraneLaws, LawNames);

TYPED_TEST(ExtremeState, DerivativesHold) { expect_right_everywhere(TypeParam::law(1)); }

// Chords from slack to four times their length: energy, force and stiffness.
template <typename Law>
void expect_line_derivatives(const Law& law) {
  const auto rest = CableLaw<Law>::rest(2, 0.3, 0.002, law);
  for (const double e : {-0.8, -0.1, 0.0007, 0.0031, 0.013, 0.09, 0.21, 0.7, 1.3, 3.0}) {
    const AxialLaw at = CableLaw<Law>::elastic(rest, e);
    ASSERT_FALSE(std::isnan(at.energy)) << e;
    ASSERT_GE(at.energy, 0) << e;
    if (at.energy > kMostFinite) continue;
    const double h = 1e-6 * std::max(std::abs(e), 0.01);
    const AxialLaw above = CableLaw<Law>::elastic(rest, e + h), below = CableLaw<Law>::elastic(rest, e - h);
    const double change = 2 * h * rest.length;
    EXPECT_NEAR((above.energy - below.energy) / change, at.force, 1e-6 * at.force + 1e-12) << e;
    EXPECT_NEAR((above.force - below.force) / change, at.stiffness, 1e-5 * at.stiffness + 1e-9) << e;
  }
}

TEST(ExtremeStates, DerivativesOfPublishedChordsHold) {
  // The tricuspid valve of Mathur et al. 2022, leaflet by leaflet.
  expect_line_derivatives(
      OgdenLine{{18.884147787, 22.682992286, 19.502933935}, {98.253655, 98.251894, 98.253229}});
  expect_line_derivatives(
      OgdenLine{{4.241553985, 2.724796147, 3.7265674e-5}, {55.914887, 55.915477, 70.715073}});
  expect_line_derivatives(
      OgdenLine{{33.753478488, 1.4596286e-5, 0.020343017}, {1.531671e-4, 3.48813e-4, 113.447387}});
  expect_line_derivatives(ToeLine{24.2, 0.0925907, 0.113, 48.8});
  expect_line_derivatives(BilinearLine{0.1, {5.9, 0.25, 0.01}});
  expect_line_derivatives(CrimpedLine{CrimpedFibre(48, 12, 1.6, 0.01)});
  expect_line_derivatives(
      CrimpedLine{CrimpedFibre(48, 1.35 / 5, 5, 0.01), 0.01});  // strut chord of Toma et al. 2016
}

// The energy is the work of the force along the way: nothing jumps on it.
TEST(ExtremeStates, NothingJumpsOnTheWay) {
  for (const ExponentialLaw& law : published_exponentials())
    for (const double across : {0.5, 0.9, 1.0}) {  // widths, as a power of the stretch: -1 is uniaxial
      const auto at = [&](double l) { return Single<ExponentialLaw>(law, plane(l, 0, std::pow(l, across))); };
      const double step = 0.0005;
      for (double l = 1.01; l < 2.6; l += step) {
        const auto left = at(l), middle = at(l + 0.5 * step), right = at(l + step);
        if (!(right.energy < kMostFinite)) break;
        const CstVector d = right.x - left.x;  // the way is all but straight
        const double work = (left.g.dot(d) + 4 * middle.g.dot(d) + right.g.dot(d)) / 6;
        ASSERT_NEAR(right.energy - left.energy, work, 2e-3 * work) << law.bulk << " at " << l;
      }
    }
}

// Least energy over all changes of volume, in long double.
long double least_over_volume(const ExponentialLaw& law, long double l1, long double l2) {
  const ExponentialInvariant& i = law.invariant;
  const auto energy = [&](long double log_volume) {
    const long double J = std::exp(log_volume), bar = std::pow(J, -2.0L / 3);
    const long double j = bar * (l1 * l1 + l2 * l2 + J * J / (l1 * l1 * l2 * l2)) - 3;
    return 0.5L * (i.c0 * j + i.c1 * std::expm1(i.c2 * j * j) + law.bulk * (J - 1) * (J - 1));
  };
  // A grid, then thirds between its neighbours: the energy has one minimum.
  constexpr long double kStep = 0.05L;
  long double best = 0;
  for (long double at = -25; at <= 10; at += kStep)
    if (energy(at) < energy(best)) best = at;
  long double low = best - kStep, high = best + kStep;
  for (int k = 0; k < 200; ++k) {
    const long double third = (high - low) / 3;
    if (energy(low + third) < energy(high - third))
      high -= third;
    else
      low += third;
  }
  return energy(low);
}

TEST(ExtremeStates, CompressibleLawsTakeTheVolumeOfLeastEnergy) {
  for (const ExponentialLaw& law : published_exponentials()) {
    if (law.bulk == 0) continue;
    for (const auto& [l1, l2] : {std::pair{1.7, 1.7},
                                 {2.1, 1.0},
                                 {2.0, 2.0},
                                 {3.0, 3.0},
                                 {3.0, 1.0},
                                 {0.2, 0.2},
                                 {1.3, 0.7},
                                 {1.05, 1.01}}) {
      const auto expected = static_cast<double>(least_over_volume(law, l1, l2));
      const double energy = law.evaluate(l1, l2).energy;
      if (std::isinf(energy))
        EXPECT_GT(expected, 1e300) << l1 << " x " << l2;
      else
        EXPECT_NEAR(energy, expected, 1e-9 * expected) << l1 << " x " << l2 << ", bulk " << law.bulk;
    }
  }
}

// The same by hand: figures that the audit of the law was made with.
TEST(ExtremeStates, TheSeptalLeafletHasTheEnergyThatItHas) {
  const ExponentialLaw septal{{0.001, 0.000191, 17.75149}, 2 / 20.06689};
  EXPECT_NEAR(septal.evaluate(1.7, 1.7).energy, 0.1297, 1e-4);
  EXPECT_NEAR(septal.evaluate(2.1, 1.0).energy, 0.2346, 1e-4);
  EXPECT_GT(septal.evaluate(2.0, 2.0).w11, 0);
}

// No width that wrinkles leave has less energy.
TEST(ExtremeStates, RelaxedLawsTakeTheWidthOfLeastEnergy) {
  for (const ExponentialLaw& law : published_exponentials())
    for (const double l : {1.2, 1.7, 1.9, 2.5, 2.553, 3.0}) {
      const double relaxed = Single<ExponentialLaw>(law, plane(l, 0, 0.205)).density();
      double least = std::numeric_limits<double>::infinity();
      for (double width = 0.205; width < l; width += 1e-3)
        least = std::min(least, law.evaluate(l, width).energy);
      if (std::isinf(least) || std::isinf(relaxed)) {
        EXPECT_TRUE(std::isinf(relaxed)) << l;
        EXPECT_GT(least, kDerivativesOverflow) << l;
        continue;
      }
      EXPECT_LE(relaxed, least * (1 + 1e-9)) << l << ", bulk " << law.bulk;
      EXPECT_GT(relaxed, 0.9 * least) << l << ", bulk " << law.bulk;
    }
}

// Least exponent Q of the law over all that wrinkles can hide, C + b b^T: a grid, then a search around its
// best point. The first axis lies along the fibre.
double least_exponent(const MayNewmanYinLaw& law, const Eigen::Matrix2d& C) {
  const auto exponent = [&](const Eigen::Vector2d& b) {
    const Eigen::Matrix2d wide = C + b * b.transpose();
    const double j = wide.trace() + 1 / wide.determinant() - 3, e = std::sqrt(wide(0, 0)) - 1;
    return law.c1 * j * j + law.c2 * e * e * e * e;
  };
  Eigen::Vector2d best = Eigen::Vector2d::Zero();
  for (int turn = 0; turn < 30; ++turn)
    for (double size = 0.05; size < 1.2; size += 0.05) {
      const double angle = std::numbers::pi * turn / 30;
      const Eigen::Vector2d b(size * std::cos(angle), size * std::sin(angle));
      if (exponent(b) < exponent(best)) best = b;
    }
  for (double step = 0.05; step > 1e-10; step *= 0.5)
    for (bool has_moved = true; has_moved;) {
      has_moved = false;
      for (int turn = 0; turn < 8; ++turn) {
        const double angle = 0.25 * std::numbers::pi * turn;
        const Eigen::Vector2d b = best + step * Eigen::Vector2d(std::cos(angle), std::sin(angle));
        if (!(exponent(b) < exponent(best))) continue;
        best = b;
        has_moved = true;
      }
    }
  return exponent(best);
}

// Along one direction, of the logarithm of the energy, which differences can follow up to where it overflows.
void expect_log_derivatives(const Single<MayNewmanYinLaw>& s) {
  CstVector d;
  d << 0.3, -0.7, 0.2, -0.5, 0.4, 0.1, 0.6, 0.35, -0.8;
  const double h = 3e-5;
  const auto log_at = [&](double t) { return std::log(energy_at(s, s.x + t * d)); };
  const double ahead = log_at(h), here = log_at(0), behind = log_at(-h);
  const double slope = (s.g / s.energy).dot(d), curvature = d.dot((s.H / s.energy) * d) - slope * slope;
  EXPECT_NEAR((ahead - behind) / (2 * h), slope, 1e-5 * (s.g / s.energy).norm() * d.norm());
  EXPECT_NEAR((ahead - 2 * here + behind) / (h * h), curvature,
              1e-4 * (s.H / s.energy).norm() * d.squaredNorm() + 1e-14 * here / (h * h));
}

// Both leaflets of the mitral valve of May-Newman and Yin 1998, up to where their energies overflow.
TEST(ExtremeStates, MayNewmanYinWrinklesToTheLeastEnergy) {
  std::mt19937 random(5);
  const auto between = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(random()) / static_cast<double>(std::mt19937::max());
  };
  for (const MayNewmanYinLaw& law :
       {MayNewmanYinLaw{0.000399, 4.325, 1446.5}, MayNewmanYinLaw{0.000414, 4.848, 305.4}}) {
    int finite = 0;
    for (int k = 0; k < 300; ++k) {
      const double l1 = between(1.1, 2.6), l2 = between(0.2, 0.9), angle = between(0, std::numbers::pi);
      SCOPED_TRACE(testing::Message() << law.c2 << ": " << l1 << " x " << l2 << " at " << angle);
      const Eigen::Matrix2d Q = Eigen::Rotation2Dd(angle).toRotationMatrix();
      const Eigen::Matrix2d F = Q * Eigen::Vector2d(l1, l2).asDiagonal() * Q.transpose();
      const Single<MayNewmanYinLaw> s(law, F);
      const double least = least_exponent(law, F.transpose() * F);
      if (std::isinf(s.energy)) {
        EXPECT_GT(least + std::log(law.c0), std::log(kDerivativesOverflow));
        continue;
      }
      ++finite;
      EXPECT_NEAR(std::log1p(s.density() / law.c0), least, 1e-8 * least);
      if (s.energy > 1e-6) expect_log_derivatives(s);
    }
    EXPECT_GT(finite, 200) << law.c2;
  }
}

}  // namespace
}  // namespace coapt
