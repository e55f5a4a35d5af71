// Where relaxing a law is hard: strong anisotropy, next to no stiffness at rest, Poisson's ratios below zero,
// crimps as slender as hairs, toes as steep as walls.
#include "energy/kernels/cst_fibrous.hpp"
#include "energy/kernels/cst_isotropic.hpp"
#include "energy/laws/line_laws.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <random>

namespace coapt {
namespace {

constexpr double kThickness = 0.4;

// A triangle with its fibre along x, stretched in two directions of which the greater lies at an angle.
CstVector stretched(const Points& X, double major, double minor, double angle) {
  const Eigen::Matrix2d Q = Eigen::Rotation2Dd(angle).toRotationMatrix();
  Points x = X;
  x.topRows<2>() = Q * Eigen::Vector2d(major, minor).asDiagonal() * Q.transpose() * X.topRows<2>();
  return Eigen::Map<const CstVector>(x.data());
}

Points triangle() {
  Points X(3, 3);
  X << 0, 1.1, 0.3, 0, 0.1, 0.9, 0, 0, 0;
  return X;
}

// Of the law on that triangle, relaxed: no compression is left anywhere, and the energy is no greater than
// that of any shortening tried.
template <typename Law>
void expect_no_compression(const std::string& label, const Law& law) {
  using Kernel = CstFibrous<Law>;
  const Points X = triangle();
  const auto rest = Kernel::rest(X.col(0), X.col(1), X.col(2), Vec3::UnitX(), law, kThickness);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> major(1.001, 1.35), minor(0.3, 1.05), angle(0, std::numbers::pi);
  int wrinkled = 0;
  for (int k = 0; k < 4000; ++k) {
    const double a = major(random), b = minor(random), at = angle(random);
    const CstVector x = stretched(X, a, b, at);
    const MembraneState state = Kernel::state(rest, x);
    CstVector g;
    const double energy = Kernel::evaluate(rest, x, &g, nullptr);
    ASSERT_TRUE(std::isfinite(energy) && g.allFinite()) << label << ": " << a << " x " << b << " at " << at;
    EXPECT_GE(state.stress[1], -1e-9 * state.stress[0]) << label << ": " << a << " x " << b << " at " << at;
    wrinkled += state.regime == MembraneRegime::Wrinkled ? 1 : 0;
    for (const double width : {0.7, 0.85, 0.95, 1.0, 1.05}) {
      if (width <= b) continue;
      EXPECT_LE(energy,
                Kernel::evaluate(rest, stretched(X, a, width, at), nullptr, nullptr) * (1 + 1e-9) + 1e-14)
          << label << ": " << a << " x " << b << " at " << at;
    }
  }
  EXPECT_GT(wrinkled, 1000) << label;
}

OrthotropicLaw contrast(double ratio) {
  return {ratio, 1, {0, 0.25, 0.02}, {0, 0.25, 0.02}, 0.45, std::sqrt(ratio) / 2.9};
}

TEST(Relaxation, LeavesNoCompressionHoweverAnisotropicTheLaw) {
  expect_no_compression("10 to 1", contrast(10));
  expect_no_compression("50 to 1", contrast(50));
  expect_no_compression("May-Newman-Yin", MayNewmanYinLaw{0.000399, 4.325, 1446.5});
  expect_no_compression("crimped fibre", CrimpedFibreLaw{0.01, CrimpedFibre(48, 12, 1.6, 0.01), 0.1});
}

// A strip of negative Poisson's ratio grows wide as it is pulled, and wrinkles where it is held narrower.
TEST(Relaxation, GoesBeyondTheRestWidthWhereTheLawDoes) {
  const BilinearLaw law{1, -0.3, {0, 0.5, 0.01}};
  const Points X = triangle();
  const auto rest = CstBilinear::rest(X.col(0), X.col(1), X.col(2), law, kThickness);
  const double volume = 0.5 * (1.1 * 0.9 - 0.3 * 0.1) * kThickness;
  for (const double width : {0.8, 0.999, 1.0, 1.03, 1.059}) {
    const CstVector x = stretched(X, 1.2, width, 0.3);
    EXPECT_EQ(CstBilinear::state(rest, x).regime, MembraneRegime::Wrinkled) << width;
    EXPECT_NEAR(CstBilinear::evaluate(rest, x, nullptr, nullptr), volume * 0.5 * 0.04, 1e-13) << width;
    EXPECT_EQ(CstBilinear::state(rest, x).stress[1], 0) << width;
  }
  EXPECT_EQ(CstBilinear::state(rest, stretched(X, 1.2, 1.07, 0.3)).regime, MembraneRegime::Taut);
  const BilinearLaw extreme{1, -0.9, {0, 0.5, 0.01}};  // free at more than twice the rest width
  const auto wide = CstBilinear::rest(X.col(0), X.col(1), X.col(2), extreme, kThickness);
  EXPECT_NEAR(CstBilinear::evaluate(wide, stretched(X, 2.2, 1.5, 0), nullptr, nullptr),
              volume * 0.5 * 1.2 * 1.2, 1e-12);
}

TEST(CrimpedFibre, EnergyIsTheWorkOfItsStressHoweverSlender) {
  for (const double slenderness : {1.6, 3.0, 10.0, 100.0}) {
    const CrimpedFibre fibre(48, 12, slenderness, 0.001);
    const double end = fibre.limit() - 1;
    for (const double share : {0.2, 0.7, 0.95, 0.999, 1.0, 1.1}) {
      const double e = share * end, h = 1e-8 * end;
      const double work = (fibre.at(e + h).energy - fibre.at(e - h).energy) / (2 * h);
      EXPECT_NEAR(work / fibre.at(e).stress, 1, 1e-5) << slenderness << " at " << share;
    }
  }
}

TEST(ToeLine, StaysFiniteHoweverSteep) {
  const ToeLine steep{100, 0.08, 0.1, 1e4}, mild{100, 0.08, 0.1, 45};
  for (const double e : {0.0, 0.01, 0.071, 0.0999, 0.1, 0.2}) {
    const CurveValue w = steep.at(e);
    EXPECT_TRUE(std::isfinite(w.energy) && std::isfinite(w.stress) && std::isfinite(w.stiffness)) << e;
    EXPECT_GE(w.stress, 0);
  }
  EXPECT_NEAR(steep.at(0.2).stress, 100 * 0.12, 1e-12);
  const double h = 1e-6;
  EXPECT_NEAR((mild.at(0.05 + h).energy - mild.at(0.05 - h).energy) / (2 * h) / mild.at(0.05).stress, 1,
              1e-8);
}

// Mooney and Rivlin's second term: with positive mu it pulls, whatever the sign of alpha.
TEST(OgdenLine, PullsWithANegativeExponent) {
  const OgdenLine law{{1, 0, 0}, {-2, 0, 0}};
  EXPECT_NEAR(law.at(0.1).stress, (1.1 - std::pow(1.1, -2)) / 1.1, 1e-14);
  EXPECT_NEAR(law.at(1e-6).stiffness, 3, 1e-4);
}

}  // namespace
}  // namespace coapt
