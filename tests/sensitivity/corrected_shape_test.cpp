// Shapes of other numbers that are found without a solve, against those that are solved.
#include "sensitivity/tracked_valve.hpp"
#include "sensitivity/truss.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace coapt {
namespace {

double greatest(const Points& motion, const std::vector<int>& nodes) {
  return std::sqrt(motion(Eigen::all, nodes).colwise().squaredNorm().maxCoeff());
}

// Of a valve with contact and follower pressure: every kind of parameter, both ways.
TEST(CorrectedShape, IsThatOfASolve) {
  constexpr double kLeft = 1e-4;  // mm
  TrackedValve valve({.tolerance = 1e-9});
  valve.add_common();
  TrackedEquilibrium& tracked = valve.equilibrium;
  ASSERT_EQ(tracked.solve().status, Status::Converged);
  const Points start = tracked.positions();
  const Vector value = tracked.value(), q = tracked.unknowns();
  const std::vector<int> held = valve.scene.held_nodes(start);
  int found = 0;
  for (size_t p = 0; p < tracked.parameter_count(); ++p)
    for (const double size : {0.003, -0.003, 0.01}) {
      const Vector change = size * valve.direction(p, 7).cwiseMin(0.5 * value.cwiseAbs().cwiseMax(0.1));
      const Points predicted = start + tracked.response(change);
      const CorrectedShape shape = tracked.corrected(value + change, predicted, held, kLeft);
      EXPECT_EQ(tracked.value(), value) << "nothing has changed";
      EXPECT_EQ(tracked.unknowns(), q);
      EXPECT_EQ(tracked.positions(), start);
      if (!shape.is_found) continue;
      ++found;
      tracked.set(value + change);
      const WarmSolve solved = tracked.solve();
      ASSERT_EQ(solved.status, Status::Converged) << solved.message;
      const Points x = tracked.positions();
      EXPECT_LT(greatest(shape.x - x, held), 10 * kLeft) << tracked.parameter(p).name() << " " << size;
      EXPECT_NEAR(shape.distance, greatest(x - predicted, held), 10 * kLeft);
      tracked.resume_at(value, q);
      ASSERT_EQ(tracked.solve().status, Status::Converged);
    }
  EXPECT_GE(found, 20) << "of 24";
}

TEST(CorrectedShape, LetsTheCallerLookWhileTheNumbersAreThere) {
  TrackedValve valve({.tolerance = 1e-9});
  valve.equilibrium.add(make_pressure_value("pressure", valve.term("pressure")));
  TrackedEquilibrium& tracked = valve.equilibrium;
  ASSERT_EQ(tracked.solve().status, Status::Converged);
  const Vector value = tracked.value(), other = 1.01 * value;
  const Points start = tracked.positions();
  Vector seen;
  const CorrectedShape shape =
      tracked.corrected(other, start + tracked.response(other - value), valve.scene.held_nodes(start), 1e-4,
                        kInfinity, [&](const CorrectedShape& at) {
                          seen = tracked.value();
                          EXPECT_TRUE(at.is_found);
                        });
  ASSERT_TRUE(shape.is_found);
  EXPECT_EQ(seen, other);
  EXPECT_EQ(tracked.value(), value);
}

TEST(CorrectedShape, EndsWhereItGoesTooFar) {
  TrackedValve valve({.tolerance = 1e-9});
  valve.equilibrium.add(make_pressure_value("pressure", valve.term("pressure")));
  TrackedEquilibrium& tracked = valve.equilibrium;
  ASSERT_EQ(tracked.solve().status, Status::Converged);
  const Points start = tracked.positions();
  const std::vector<int> held = valve.scene.held_nodes(start);
  const CorrectedShape shape = tracked.corrected(1.05 * tracked.value(), start, held, 1e-6, 1e-3);
  EXPECT_FALSE(shape.is_found);
  EXPECT_GT(shape.distance, 1e-3);
}

// Beyond the snap there is an equilibrium, far off and on another branch: nothing is found near by.
TEST(CorrectedShape, IsNotFoundBeyondASnap) {
  Truss truss(0.0015);
  TrackedEquilibrium& tracked = truss.equilibrium;
  ASSERT_EQ(tracked.solve().status, Status::Converged);
  const Points start = tracked.positions();
  for (const double span : {1.0005, 1.012}) {
    const Vector value = Vector::Constant(1, span);
    const Points predicted = start + tracked.response(value - tracked.value());
    const CorrectedShape shape = tracked.corrected(value, predicted, {2}, 1e-6, 0.1);
    EXPECT_EQ(shape.is_found, span < 1.01) << span;
  }
}

// The first correction brings a stiff node home from far off, and the second is short beside it, whether the
// apex closes in or creeps towards its snap.
TEST(CorrectedShape, IsNotFoundByALongFirstStepBesideWhatCreeps) {
  constexpr double kLeft = 0.01;
  int found = 0, lost = 0;
  for (const double span : {1.001, 1.004, 1.006, 1.007, 1.0075, 1.008, 1.0085, 1.009, 1.0095, 1.01}) {
    Truss truss(0.0015);
    TrackedEquilibrium& tracked = truss.equilibrium;
    ASSERT_EQ(tracked.solve().status, Status::Converged);
    const Vector value = Vector::Constant(1, span);
    Points start = tracked.positions() + tracked.response(value - tracked.value());
    start(0, 3) += 0.1;
    const CorrectedShape shape = tracked.corrected(value, start, {2, 3}, kLeft, 0.3);
    tracked.set(value);
    ASSERT_EQ(tracked.solve().status, Status::Converged);
    const bool is_near = greatest(tracked.positions() - start, {2}) < 0.1;
    (is_near ? found : lost) += 1;
    const double off = greatest(tracked.positions() - shape.x, {2, 3});
    EXPECT_TRUE(!shape.is_found || off < 2 * kLeft) << span << ": off by " << off;
  }
  EXPECT_GE(found, 2);
  EXPECT_GE(lost, 2);
}

}  // namespace
}  // namespace coapt
