// Chords of each nonlinear law in whole solves: any ratio of stiffness (S4), loads however great and one that
// is too much (S10), solutions exactly on a knee or at the onset of tension (S11).
#include "energy/load_dead.hpp"
#include "support/sheets.hpp"
#include "support/tissue_laws.hpp"
#include "support/valve_scene.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <numbers>

namespace coapt {
namespace {

constexpr double kArea = 0.5;

template <typename Law>
double force_at(const Law& law, double elongation, double smoothing = 0) {
  return CableLaw<Law>::elastic(CableLaw<Law>::rest(1, kArea, smoothing, law), elongation).force;
}

std::unique_ptr<EnergyTerm> weight_on(int node, double weight, const Points& X) {
  Points load = Points::Zero(3, X.cols());
  load(2, node) = -weight;
  return std::make_unique<LoadDead>("weight", "load_field", load, X);
}

template <typename Entry>
class ChordState : public testing::Test {};
TYPED_TEST_SUITE(ChordState, ChordLaws, LawNames);

// --- S4 ---------------------------------------------------------------------------------------------------

// The secant moduli at a strain of 5 % are 4e2, 1e4 and 1e6 times the leaflets'.
TYPED_TEST(ChordState, S4HoldsAValveOrSaysSoAtAnyRatioOfStiffness) {
  ValveOptions options;
  options.young = 0.1;
  options.triangles = 200;
  const ValveScene scene(options);
  const double secant = TypeParam::law(1).at(0.05).stress / 0.05;
  for (const double ratio : {4e2, 1e4, 1e6}) {
    Terms terms = scene.terms();
    for (auto& term : terms)
      if (term->name() == "chords")
        term =
            chord_term({scene.chords.data(), scene.chords.data() + scene.chords.size()}, scene.chord_lengths,
                       scene.chord_areas, options.smoothing, TypeParam::law(ratio * options.young / secant));
    const Equilibrium found = find_equilibrium(scene.X, scene.fixed, std::move(terms), scene.method());
    std::printf("S4 %s chords, ratio %.0e: %s, %d iterations\n", TypeParam::kName, ratio,
                found.result.message.c_str(), found.result.iterations);
    EXPECT_TRUE(found.x.allFinite());
    if (found.result.status == Status::Converged)
      EXPECT_LE(found.result.residual, 1e-8);
    else
      EXPECT_EQ(found.result.status, Status::Stalled) << found.result.message;
    if (ratio < 1e3) {
      EXPECT_EQ(found.result.status, Status::Converged) << found.result.message;
    }
  }
}

// --- S10 --------------------------------------------------------------------------------------------------

template <typename Law>
Equilibrium hung(const Law& law, double weight) {
  Points X(3, 2);
  X << 0, 0.1, 0, -0.05, 0, -0.9;  // slack at the start
  return find_equilibrium(
      X, fixed_nodes(2, {0}),
      terms_of(chord_term({0, 1}, Vector::Ones(1), Vector::Constant(1, kArea), 0.002, law),
               weight_on(1, weight, X)),
      {.tolerance = 1e-9, .max_iterations = 1000});
}

TYPED_TEST(ChordState, S10CarriesAnyWeight) {
  const auto law = TypeParam::law(1);
  for (const double weight : {force_at(law, 0.01), force_at(law, 0.5), 100 * force_at(law, 0.5)}) {
    const Equilibrium found = hung(law, weight);
    const double length = found.x.col(1).norm();
    std::printf("S10 %s, weight %.3g: length %.6f, %d iterations\n", TypeParam::kName, weight, length,
                found.result.iterations);
    ASSERT_EQ(found.result.status, Status::Converged) << found.result.message;
    EXPECT_NEAR(force_at(law, length - 1, 0.002) / weight, 1, 1e-8);
    EXPECT_NEAR(found.x(2, 1), -length, 1e-8 * length);
  }
}

// Ogden's law with an exponent next to zero, as fits of real chords have: 3 mu ln(l)/l at the most, at l = e.
TEST(ChordStates, S10OgdenChordsOfSmallExponentsTear) {
  const double mu = 33.75;
  const OgdenLine law{{mu, 0, 0}, {1.5e-4, 0, 0}};
  const double greatest = kArea * 3 * mu / std::numbers::e;
  const Equilibrium held = hung(law, 0.95 * greatest), torn = hung(law, 1.05 * greatest);
  std::printf("S10 small exponents: %s (length %.4f); %s, %d iterations\n", held.result.message.c_str(),
              held.x.col(1).norm(), torn.result.message.c_str(), torn.result.iterations);
  ASSERT_EQ(held.result.status, Status::Converged) << held.result.message;
  EXPECT_LT(held.x.col(1).norm(), std::numbers::e);
  EXPECT_EQ(torn.result.status, Status::NoEquilibrium);
  EXPECT_NE(torn.result.message.find("grows without bound"), std::string::npos);
  EXPECT_TRUE(torn.x.allFinite());
}

// --- S11 --------------------------------------------------------------------------------------------------

// A weight at the origin hangs on a chord stretched by `elongation`. A second chord, aslant, has its rest
// length times `slack` between its ends there.
template <typename Law>
Equilibrium on_two_chords(const Law& law, double elongation, double slack, double smoothing) {
  Points exact(3, 3);
  exact << 0, 1, 0, 0, 0, 0, 1 + elongation, 0.5, 0;
  const Points start = exact + Vec3(0.02, -0.01, 0.03) * Eigen::RowVector3d(0, 0, 1);
  const Vector lengths = Eigen::Vector2d(1, slack * exact.col(1).norm());
  return find_equilibrium(
      start, fixed_nodes(3, {0, 1}),
      terms_of(chord_term({0, 2, 1, 2}, lengths, Vector::Constant(2, kArea), smoothing, law),
               weight_on(2, force_at(law, elongation, smoothing), exact)),
      {.tolerance = 1e-8, .max_iterations = 1000});
}

TYPED_TEST(ChordState, S11ConvergesExactlyAtItsKneeAndAtTheOnsetOfTension) {
  const auto law = laws::with_sharp_knees<TypeParam>(1);
  const double knee = TypeParam::knee().value_or(0.1);
  for (const double smoothing : {0.0, 0.002}) {
    const Equilibrium smooth = on_two_chords(law, 0.5 * knee, 2, smoothing);
    ASSERT_EQ(smooth.result.status, Status::Converged) << smooth.result.message;
    const struct {
      const char* name;
      double elongation, slack;
    } kBorders[] = {{"knee", knee, 2}, {"onset", 0.5 * knee, 1}, {"both", knee, 1}};
    for (const auto& border : kBorders) {
      const Equilibrium found = on_two_chords(law, border.elongation, border.slack, smoothing);
      std::printf("S11 %s chord, %s, smoothing %g: %d iterations, its smooth twin %d, error %.1e\n",
                  TypeParam::kName, border.name, smoothing, found.result.iterations, smooth.result.iterations,
                  found.x.col(2).norm());
      EXPECT_EQ(found.result.status, Status::Converged) << found.result.message;
      EXPECT_LE(found.result.iterations, 3 * smooth.result.iterations) << border.name;
      EXPECT_LT(found.x.col(2).norm(), 1e-6) << border.name;
    }
  }
}

}  // namespace
}  // namespace coapt
