// Laws that stiffen without bound, continued along their tangent beyond a limit: nothing changes below it,
// everything is finite beyond, derivatives hold on both sides, and raising leads back to the law.
#include "support/single_triangle.hpp"

#include <gtest/gtest.h>

namespace coapt {
namespace {

constexpr TensionScale kScale{0.05, 0.5};  // [N/mm], [N]

// A triangle of the law, stretched far beyond what any load asks for.
template <typename Law>
ElementTerm<typename KernelOf<Law>::Type> stretched_sheet(const Law& law, double l1, double l2, Points& x) {
  const Single<Law> s(law, plane(l1, 0.1, l2));
  x = Eigen::Map<const Points>(s.x.data(), 3, 3);
  return {"sheet", {0, 1, 2}, {s.rest}};
}

ElementTerm<CableOgden> stretched_chord(double stretch, Points& x) {
  x = Points::Zero(3, 2);
  x(0, 1) = 2 * stretch;
  return {"chord", {0, 1}, {CableOgden::rest(2, 0.3, 0.002, OgdenLine{{19, 22, 20}, {98, 98, 98}})}};
}

double energy_of(const EnergyTerm& term, const Points& x, Points* force = nullptr) {
  if (force == nullptr) {
    Sink none;
    return term.evaluate(x, none);
  }
  force->setZero(3, x.cols());
  Sink sink(force->data());
  return term.evaluate(x, sink);
}

// At x beyond the limits.
template <typename Term>
void expect_limited(Term& term, const Points& x) {
  EXPECT_TRUE(term.limit_stress(kScale));
  Points g, ahead, behind, d = Points::Zero(3, x.cols());
  d(0, 1) = 1;
  d(1, 1) = -0.4;
  const double energy = energy_of(term, x, &g), h = 1e-6;
  ASSERT_TRUE(std::isfinite(energy) && g.allFinite());
  const double by_energy =
      (energy_of(term, x + h * d, &ahead) - energy_of(term, x - h * d, &behind)) / (2 * h);
  EXPECT_NEAR(by_energy, g.cwiseProduct(d).sum(), 1e-6 * g.norm());
  double excess = term.raise_stress_limits(x);
  EXPECT_GT(excess, 0.1);
  int raises = 1;
  for (; excess > 0 && raises < 200; ++raises) {
    const double next = term.raise_stress_limits(x);
    EXPECT_LT(next, excess);
    excess = next;
  }
  EXPECT_LT(raises, 90);
  const double raised = energy_of(term, x);
  term.release_stress_limits();
  EXPECT_NEAR(raised, energy_of(term, x), 1e-9 * raised);
}

TEST(StressLimit, RaisingLeadsBackToTheLaw) {
  Points x;
  for (const double bulk : {0.0, 0.1}) {
    auto sheet = stretched_sheet(ExponentialLaw{{0.001, 0.000191, 17.75149}, bulk}, 1.9, 1.2, x);
    expect_limited(sheet, x);
    auto wrinkled = stretched_sheet(ExponentialLaw{{0.001, 0.000191, 17.75149}, bulk}, 1.9, 0.3, x);
    expect_limited(wrinkled, x);
  }
  auto fibrous = stretched_sheet(MayNewmanYinLaw{0.000399, 4.325, 1446.5}, 1.5, 1.1, x);
  expect_limited(fibrous, x);
  auto chord = stretched_chord(1.15, x);
  expect_limited(chord, x);
}

// Where even the law's exponential overflows.
TEST(StressLimit, MakesAnOverflowFinite) {
  Points x;
  auto sheet = stretched_sheet(ExponentialLaw{{0.001, 0.000191, 17.75149}, 0}, 3, 3, x);
  EXPECT_TRUE(std::isinf(energy_of(sheet, x)));
  sheet.limit_stress(kScale);
  EXPECT_TRUE(std::isfinite(energy_of(sheet, x)));
  auto chord = stretched_chord(5000, x);
  EXPECT_TRUE(std::isinf(energy_of(chord, x)));
  chord.limit_stress(kScale);
  EXPECT_TRUE(std::isfinite(energy_of(chord, x)));
}

TEST(StressLimit, ChangesNothingBelowIt) {
  Points x;
  auto sheet = stretched_sheet(ExponentialLaw{{0.001, 0.000191, 17.75149}, 0}, 1.05, 1.02, x);
  const double before = energy_of(sheet, x);
  sheet.limit_stress(kScale);
  EXPECT_EQ(energy_of(sheet, x), before);
  EXPECT_EQ(sheet.raise_stress_limits(x), 0);
  auto linear = stretched_sheet(NeoHookeanLaw{{0.3}, 0}, 2, 2, x);
  EXPECT_FALSE(linear.limit_stress(kScale));
}

// Rounding of kinks and limits are independent of each other.
TEST(StressLimit, OutlivesTheRoundingOfKinks) {
  Points x;
  auto chord = stretched_chord(1.15, x);
  chord.limit_stress(kScale);
  const double limited = energy_of(chord, x);
  chord.round_kinks(0.01);
  chord.round_kinks(0);
  EXPECT_EQ(energy_of(chord, x), limited);
}

}  // namespace
}  // namespace coapt
