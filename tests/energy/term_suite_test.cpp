// The suite itself must fail where a term is wrong: each law below is a line spring with one mistake.
#include "support/term_suite.hpp"

#include "energy/element_term.hpp"
#include "energy/kernels/axial.hpp"

#include <gtest/gtest.h>

namespace coapt {
namespace {

enum class Mistake {
  None,
  GradientSign,
  GradientOffByAThousandth,
  NoGeometricStiffness,
  HessianOffByAThousandth,
  UnsymmetricHessian,
  Zero,
  DependsOnTheAxes,
  DependsOnTheOrigin,
  ForceAtRest,
};

// W = k/2 (l - r)^2 with the mistake in its derivatives or in itself.
template <Mistake kMistake>
struct Spring {
  static constexpr int kNodes = 2;
  static constexpr std::string_view kType = "spring";
  static constexpr TermRole kRole = TermRole::Internal;
  struct Rest {
    double stiffness, length;
  };

  static double evaluate(const Rest& rest, const Eigen::Vector<double, 6>& x, Eigen::Vector<double, 6>* g,
                         Eigen::Matrix<double, 6, 6>* H) {
    Vec3 difference = x.tail<3>() - x.head<3>();
    if (kMistake == Mistake::DependsOnTheAxes) difference[0] *= 1.001;
    const double l = difference.norm();
    const double e = l - rest.length + (kMistake == Mistake::ForceAtRest ? 0.01 * rest.length : 0);
    AxialLaw law{0.5 * rest.stiffness * e * e, rest.stiffness * e, rest.stiffness};
    if (kMistake == Mistake::Zero) law = {};
    expand_axial(law, difference, l, g, H);
    if (g != nullptr) spoil(law, x, *g);
    if (H != nullptr) spoil(law, difference / l, l, *H);
    return law.energy + (kMistake == Mistake::DependsOnTheOrigin ? 1e-3 * rest.stiffness * x.sum() : 0);
  }

 private:
  static void spoil(const AxialLaw&, const Eigen::Vector<double, 6>&, Eigen::Vector<double, 6>& g) {
    if (kMistake == Mistake::GradientSign) g = -g;
    if (kMistake == Mistake::GradientOffByAThousandth) g *= 1.001;
    if (kMistake == Mistake::DependsOnTheOrigin) g.array() += 1e-3;
  }
  static void spoil(const AxialLaw& law, const Vec3& n, double l, Eigen::Matrix<double, 6, 6>& H) {
    if (kMistake == Mistake::HessianOffByAThousandth) H *= 1.001;
    if (kMistake == Mistake::UnsymmetricHessian) H(0, 4) *= 1.01;
    if (kMistake != Mistake::NoGeometricStiffness) return;
    const Eigen::Matrix3d missing = law.force / l * (Eigen::Matrix3d::Identity() - n * n.transpose());
    H.block<3, 3>(0, 0) -= missing;
    H.block<3, 3>(3, 3) -= missing;
    H.block<3, 3>(0, 3) += missing;
    H.block<3, 3>(3, 0) += missing;
  }
};

template <Mistake kMistake>
std::string verdict() {
  TermCase c;
  c.label = "spring";
  c.rest.resize(3, 3);
  c.rest << 0, 1, 1, 0, 0, 1, 0, 0, 0;
  c.state.resize(3, 3);
  c.state << 0.1, 1.2, 1.3, 0.2, -0.1, 1.4, 0.1, 0.3, -0.2;
  c.reach = 0.2;
  c.make = [](const Frame& f) -> std::unique_ptr<EnergyTerm> {
    using Law = Spring<kMistake>;
    return std::make_unique<ElementTerm<Law>>(
        "spring", f.nodes({0, 1, 1, 2}),
        std::vector<typename Law::Rest>(2, {1.0 * f.force / f.length, 1.0 * f.length}));
  };
  return examine_term(c);
}

bool says(const std::string& verdict, const std::string& text) {
  return verdict.find(text) != std::string::npos;
}

TEST(TermSuite, PassesACorrectLaw) { EXPECT_EQ(verdict<Mistake::None>(), ""); }

TEST(TermSuite, FailsAGradientOfTheWrongSign) {
  EXPECT_TRUE(says(verdict<Mistake::GradientSign>(), "Taylor slope of the gradient"));
  EXPECT_TRUE(says(verdict<Mistake::GradientSign>(), "central difference of the energy"));
}

TEST(TermSuite, FailsAGradientThatIsOffByOnePartInAThousand) {
  EXPECT_TRUE(says(verdict<Mistake::GradientOffByAThousandth>(), "Taylor slope of the gradient"));
  EXPECT_TRUE(says(verdict<Mistake::GradientOffByAThousandth>(), "central difference of the energy"));
}

TEST(TermSuite, FailsAHessianWithoutItsGeometricPart) {
  EXPECT_TRUE(says(verdict<Mistake::NoGeometricStiffness>(), "Taylor slope of the Hessian"));
}

TEST(TermSuite, FailsAHessianThatIsOffByOnePartInAThousand) {
  EXPECT_TRUE(says(verdict<Mistake::HessianOffByAThousandth>(), "Taylor slope of the Hessian"));
  EXPECT_TRUE(says(verdict<Mistake::HessianOffByAThousandth>(), "central difference of the gradient"));
}

TEST(TermSuite, FailsAHessianThatIsNotSymmetric) {
  EXPECT_TRUE(says(verdict<Mistake::UnsymmetricHessian>(), "not symmetric"));
}

TEST(TermSuite, FailsATermThatDoesNothing) {
  EXPECT_TRUE(says(verdict<Mistake::Zero>(), "energy is zero"));
  EXPECT_TRUE(says(verdict<Mistake::Zero>(), "gradient is zero"));
  EXPECT_TRUE(says(verdict<Mistake::Zero>(), "Hessian is zero"));
}

TEST(TermSuite, FailsATermThatKnowsTheAxes) {
  EXPECT_TRUE(says(verdict<Mistake::DependsOnTheAxes>(), "energy depends on the orientation of the axes"));
}

TEST(TermSuite, FailsATermThatKnowsTheOriginOrTheUnits) {
  EXPECT_TRUE(says(verdict<Mistake::DependsOnTheOrigin>(), "energy depends on the place of the origin"));
  EXPECT_TRUE(says(verdict<Mistake::DependsOnTheOrigin>(), "depend on units"));
}

TEST(TermSuite, FailsAForceAtRest) { EXPECT_TRUE(says(verdict<Mistake::ForceAtRest>(), "force at rest")); }

// A term whose value depends on what it was asked before, as a contact list gone stale would make it.
class Forgetful final : public EnergyTerm {
 public:
  Forgetful() : EnergyTerm("forgetful") {}
  std::string_view type() const override { return "forgetful"; }
  TermRole role() const override { return TermRole::Internal; }
  const Stencils& stencils() const override { return stencils_; }
  bool prepare(const Points& x) override {
    if (first_ == 0) first_ = x(0, 0);
    return false;
  }
  double evaluate(const Points& x, Sink& sink) const override {
    const double e = x(0, 0) - 1e-9 * first_;
    if (sink.wants_gradient()) sink.add_gradient(0, Vec3(e, 0, 0));
    if (sink.wants_hessian()) sink.add_block(0, 1, 0, 0, Eigen::Matrix3d(Vec3(1, 0, 0).asDiagonal()));
    return 0.5 * e * e;
  }

 private:
  Stencils stencils_{1, {0}};
  double first_ = 0;
};

TEST(TermSuite, FailsATermThatRemembersItsHistory) {
  TermCase c;
  c.label = "forgetful";
  c.rest = Points::Zero(3, 1);
  c.state = Points::Constant(3, 1, 0.7);
  c.is_zero_at_rest = false;
  c.make = [](const Frame&) -> std::unique_ptr<EnergyTerm> { return std::make_unique<Forgetful>(); };
  const TermCase at_state = c;
  const auto traveller = c.make({});
  evaluate_term(*traveller, Points::Constant(3, 1, 5.0));
  EXPECT_NE(evaluate_term(*traveller, c.state).energy, evaluate_term(*c.make({}), c.state).energy);
  // The traveller of the suite is built afresh, so it forgets from its first, different position on.
  EXPECT_TRUE(says(examine_state(at_state), "depend on the history"));
}

TEST(SlopeOfRemainder, IsReadWhereAnErrorCannotHideBehindTheNextOrder) {
  std::vector<double> steps, right, wrong, floor;
  for (int rung = 2; rung <= 10; ++rung) {
    const double h = std::pow(10.0, -0.5 * rung);
    steps.push_back(h);
    right.push_back(h * h);
    wrong.push_back(h * h + 1e-4 * h);  // looks quadratic over the larger steps
    floor.push_back(1e-15);
  }
  EXPECT_NEAR(slope_of_remainder(steps, right, floor), 2, 1e-9);
  EXPECT_LT(slope_of_remainder(steps, wrong, floor), 1.5);
}

}  // namespace
}  // namespace coapt
