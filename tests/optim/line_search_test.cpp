#include "optim/line_search.hpp"

#include "support/equilibrium.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace coapt {
namespace {

// One node whose energy is a function of its x coordinate.
class OneDimensional final : public EnergyTerm {
 public:
  using Law = std::function<std::pair<double, double>(double)>;  // energy and derivative
  explicit OneDimensional(Law law) : EnergyTerm("law"), law_(std::move(law)) {}
  std::string_view type() const override { return "law"; }
  TermRole role() const override { return TermRole::Load; }
  const Stencils& stencils() const override { return stencils_; }
  double evaluate(const Points& x, Sink& sink) const override {
    const auto [energy, slope] = law_(x(0, 0));
    if (sink.wants_gradient()) sink.add_gradient(0, Vec3(slope, 0, 0));
    return energy;
  }

 private:
  Stencils stencils_{1, {0}};
  Law law_;
};

struct Line {
  Objective objective;
  StopRule stop;
  Observer observer;
  Monitor monitor{objective, stop, observer};
  LinePoint from, to;
  Vector direction = Vector::Unit(3, 0);

  Line(const OneDimensional::Law& law, double at)
      : objective(Points::Zero(3, 1), FixedMask::Constant(3, 1, false),
                  terms_of(std::make_unique<OneDimensional>(law))) {
    from.q = at * Vector::Unit(3, 0);
    from.energy = monitor.gradient(from.q, from.g);
    monitor.accept(from.q, from.energy, from.g);
    direction *= from.g[0] > 0 ? -1 : 1;
    from.slope = from.g.dot(direction);
  }
  bool search(double first) { return search_line(monitor, from, direction, first, to); }
  bool is_wolfe() const {
    return to.energy <= from.energy + 1e-4 * to.step * from.slope && std::abs(to.slope) <= -0.9 * from.slope;
  }
};

TEST(LineSearch, SatisfiesTheWolfeConditionsFromAnyFirstStep) {
  for (const double first : {1e-6, 1e-2, 1.0, 1e3}) {
    Line line([](double x) { return std::pair{std::pow(x, 4) - x, 4 * std::pow(x, 3) - 1}; }, -1.0);
    ASSERT_TRUE(line.search(first)) << first;
    EXPECT_TRUE(line.is_wolfe()) << first;
    EXPECT_EQ(line.to.q, line.from.q + line.to.step * line.direction);
  }
}

TEST(LineSearch, BacksAwayFromInfiniteEnergies) {
  // A barrier at x = 1: infinite beyond, and the first step lands far beyond.
  Line line(
      [](double x) {
        return x < 1 ? std::pair{-x - 0.1 * std::log(1 - x), -1 + 0.1 / (1 - x)} : std::pair{kInfinity, 0.0};
      },
      0.0);
  ASSERT_TRUE(line.search(50));
  EXPECT_TRUE(line.is_wolfe());
  EXPECT_LT(line.to.q[0], 1);
}

TEST(LineSearch, BacksAwayFromEnergiesThatAreNotNumbers) {
  Line line([](double x) { return x < 1 ? std::pair{-x, -1.0 + x} : std::pair{kNaN, kNaN}; }, 0.0);
  line.search(3);
  EXPECT_TRUE(line.to.q.allFinite());
  EXPECT_LT(line.to.q[0], 1);
  EXPECT_LE(line.to.energy, line.from.energy);
}

TEST(LineSearch, AcceptsByTheSlopeWhereEnergiesDrownInRoundOff) {
  // Energy 1e6 + x^2/2: at x = 1e-7 the change, 5e-15, is far below the last digit of the sum.
  Line line([](double x) { return std::pair{1e6 + 0.5 * x * x, x}; }, 1e-7);
  ASSERT_TRUE(line.search(1e-7));
  EXPECT_EQ(line.to.energy, line.from.energy);
  EXPECT_LT(std::abs(line.to.slope), 0.9 * std::abs(line.from.slope));
}

TEST(LineSearch, GivesBackTheStartWhenNothingDescends) {
  // The slope lies: the energy rises along it.
  Line line([](double x) { return std::pair{std::abs(x), -1.0}; }, 0.0);
  EXPECT_FALSE(line.search(1));
  EXPECT_LE(line.to.energy, line.from.energy + 1e-12);
}

}  // namespace
}  // namespace coapt
