// The relaxed membrane: every regime through the term suite, and what happens at the borders.
#include "energy/element_term.hpp"
#include "energy/kernels/cst_tension_field.hpp"
#include "membrane_patch.hpp"
#include "support/oracles.hpp"
#include "support/term_suite.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <set>

namespace coapt {
namespace {

constexpr double kSheetYoung = 2.0, kSheetPoisson = 0.35, kSheetThickness = 0.4;

struct TensionLaw {
  double prestress = 0, residual = 0;
};

TermCase patch_case(const std::string& label, const Eigen::Matrix3d& f, const TensionLaw& law,
                    double shake = 0.02) {
  const TriangleMesh mesh = patch();
  TermCase c;
  c.label = label;
  c.rest = mesh.vertices;
  c.state = shaken(f * mesh.vertices, shake, 4);
  c.reach = 0.05;
  c.is_zero_at_rest = law.prestress == 0;
  c.make = [mesh, law](const Frame& frame) -> std::unique_ptr<EnergyTerm> {
    const Points X = frame.points(mesh.vertices);
    const Triangles t = frame.triangles(mesh.triangles);
    std::vector<CstTensionField::Rest> rest;
    for (int k = 0; k < t.cols(); ++k)
      rest.push_back(CstTensionField::rest(X.col(t(0, k)), X.col(t(1, k)), X.col(t(2, k)),
                                           kSheetYoung * frame.force / (frame.length * frame.length),
                                           kSheetPoisson, kSheetThickness * frame.length,
                                           law.prestress * frame.force / frame.length, law.residual));
    return std::make_unique<ElementTerm<CstTensionField>>("membrane", triangle_nodes(t), rest);
  };
  return c;
}

oracle::TensionField patch_oracle(const TensionLaw& law) {
  const TriangleMesh mesh = patch();
  return {{mesh.triangles, mesh.vertices, kSheetYoung, kSheetPoisson, kSheetThickness, law.prestress},
          law.residual};
}

std::set<MembraneRegime> regimes(const TermCase& c) {
  const auto term = c.make({});
  const auto& membrane = dynamic_cast<const ElementTerm<CstTensionField>&>(*term);
  std::set<MembraneRegime> found;
  for (size_t e = 0; e < membrane.rest().size(); ++e) {
    CstVector x;
    for (int a = 0; a < 3; ++a) x.segment<3>(3 * a) = c.state.col(membrane.stencils().nodes[3 * e + a]);
    found.insert(CstTensionField::regime(membrane.rest()[e], x));
  }
  return found;
}

using Regimes = std::set<MembraneRegime>;
const Regimes kTaut{MembraneRegime::Taut}, kWrinkled{MembraneRegime::Wrinkled};

TEST(CstTensionField, PassesTheSuiteTaut) {
  for (const TensionLaw law : {TensionLaw{}, TensionLaw{0.6, 0}, TensionLaw{0.3, 0.1}}) {
    const TermCase c = patch_case("taut", deformation(1.3, 0, 1.2), law);
    EXPECT_EQ(regimes(c), kTaut);
    EXPECT_EQ(examine_term(c), "");
    EXPECT_EQ(compare_with_autodiff(c, patch_oracle(law)), "");
  }
}

TEST(CstTensionField, PassesTheSuiteWrinkled) {
  for (const TensionLaw law :
       {TensionLaw{}, TensionLaw{0.1, 0}, TensionLaw{0, 0.05}, TensionLaw{0.1, 0.05}}) {
    const TermCase c = patch_case("wrinkled", deformation(1.4, 0.1, 0.6), law);
    EXPECT_EQ(regimes(c), kWrinkled);
    EXPECT_EQ(examine_term(c), "");
    EXPECT_EQ(compare_with_autodiff(c, patch_oracle(law)), "");
  }
}

// With the residual stiffness even slack triangles have derivatives to test.
TEST(CstTensionField, PassesTheSuiteSlackWithResidualStiffness) {
  for (const TensionLaw law : {TensionLaw{0, 0.05}, TensionLaw{0.05, 0.05}}) {
    const TermCase c = patch_case("slack", deformation(0.6, 0.05, 0.7), law);
    EXPECT_EQ(regimes(c), Regimes{MembraneRegime::Slack});
    EXPECT_EQ(examine_term(c), "");
    EXPECT_EQ(compare_with_autodiff(c, patch_oracle(law)), "");
  }
}

TEST(CstTensionField, PassesTheSuiteWhereAllRegimesMeet) {
  TermCase c = patch_case("mixed", deformation(1.02, 0.05, 0.97), {}, 0.12);
  EXPECT_EQ(regimes(c), (Regimes{MembraneRegime::Slack, MembraneRegime::Wrinkled, MembraneRegime::Taut}));
  c.reach = 1e-3;
  EXPECT_EQ(examine_term(c), "");
  EXPECT_EQ(compare_with_autodiff(c, patch_oracle({})), "");
}

TEST(CstTensionField, CostsNothingWhereItIsSlack) {
  const TermCase c = patch_case("slack", deformation(0.6, 0.05, 0.7), {});
  const TermValues slack = evaluate_term(*c.make({}), c.state);
  EXPECT_EQ(slack.energy, 0);
  EXPECT_EQ(slack.gradient.norm(), 0);
  EXPECT_EQ(slack.hessian.norm(), 0);
}

// One triangle under F = diag(stretch1, stretch2), turned by an angle in its plane.
struct Single {
  CstTensionField::Rest rest;
  CstVector x, g;
  CstMatrix H;
  double energy = 0;
};

Single single(double e1, double e2, double turn = 0, const TensionLaw& law = {}) {
  Points X(3, 3);
  X << 0, 1.1, 0.3, 0, 0.1, 0.9, 0, 0, 0;
  Single s;
  s.rest = CstTensionField::rest(X.col(0), X.col(1), X.col(2), kSheetYoung, kSheetPoisson, kSheetThickness,
                                 law.prestress, law.residual);
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  R.topLeftCorner<2, 2>() << std::cos(turn), -std::sin(turn), std::sin(turn), std::cos(turn);
  const Vec3 stretch(std::sqrt(1 + 2 * e1), std::sqrt(1 + 2 * e2), 1);
  const Points x = stretch.asDiagonal() * (R * X);
  s.x = Eigen::Map<const CstVector>(x.data());
  s.energy = CstTensionField::evaluate(s.rest, s.x, &s.g, &s.H);
  return s;
}

// Energy and force cross each border without a jump: they differ by no more than the strain between them.
TEST(CstTensionField, IsContinuouslyDifferentiableAtBothBorders) {
  const double nu = kSheetPoisson;
  for (const double prestress : {0.0, 0.2})
    for (const double turn : {0.0, 0.4, 1.3, std::numbers::pi / 2}) {
      const TensionLaw law{prestress, 0};
      const double shift = single(0, 0, 0, law).rest.shift;
      for (const double d : {1e-4, 1e-7, 1e-10}) {
        const double e1 = 0.2 - shift, border = -nu * 0.2 - shift;  // taut | wrinkled
        const Single taut = single(e1, border + d, turn, law), wrinkled = single(e1, border - d, turn, law);
        EXPECT_EQ(CstTensionField::regime(taut.rest, taut.x), MembraneRegime::Taut);
        EXPECT_EQ(CstTensionField::regime(wrinkled.rest, wrinkled.x), MembraneRegime::Wrinkled);
        EXPECT_LT((taut.g - wrinkled.g).norm(), 3 * d);
        EXPECT_LT(std::abs(taut.energy - wrinkled.energy), d);
        const Single last = single(d - shift, -0.2 - shift, turn, law),
                     slack = single(-d - shift, -0.2 - shift, turn, law);  // wrinkled | slack
        EXPECT_EQ(CstTensionField::regime(last.rest, last.x), MembraneRegime::Wrinkled);
        EXPECT_EQ(CstTensionField::regime(slack.rest, slack.x), MembraneRegime::Slack);
        EXPECT_LT((last.g - slack.g).norm(), 3 * d);
        EXPECT_LT(std::abs(last.energy - slack.energy), d * d);
      }
    }
}

// At rest all borders meet: the force is zero, the stiffness that of the taut membrane, nothing is NaN.
TEST(CstTensionField, CountsAsTautAtRest) {
  const Single rest = single(0, 0, 0.7);
  EXPECT_EQ(CstTensionField::regime(rest.rest, rest.x), MembraneRegime::Taut);
  EXPECT_LT(rest.g.norm(), 1e-15);
  EXPECT_TRUE(rest.H.allFinite());
  EXPECT_GT(rest.H.norm(), 0.1);
}

// Equal principal strains have no major direction; nothing may depend on one.
TEST(CstTensionField, NeedsNoDirectionWhereThePrincipalStrainsCoincide) {
  for (const double e : {0.2, 1e-9, -1e-9, -0.2}) {
    const Single equal = single(e, e);
    EXPECT_TRUE(equal.g.allFinite() && equal.H.allFinite()) << e;
    const Single near = single(e * (1 + 1e-12), e);
    EXPECT_LT((equal.H - near.H).norm(), 1e-9) << e;
  }
  Single collapsed = single(0.1, 0.1);
  collapsed.x.setZero();
  EXPECT_EQ(CstTensionField::evaluate(collapsed.rest, collapsed.x, &collapsed.g, &collapsed.H), 0);
  EXPECT_TRUE(collapsed.g.allFinite() && collapsed.H.allFinite());
}

TEST(CstTensionField, NeverPushes) {
  for (const double prestress : {0.0, 0.3})
    for (const double e1 : {-0.3, -0.05, 0.1, 0.4})
      for (const double e2 : {-0.35, -0.1, 0.02, 0.2}) {
        const Single s = single(e1, e2, 0.3, {prestress, 0});
        const Eigen::Vector2d stress = CstTensionField::state(s.rest, s.x).stress;
        EXPECT_GE(stress.minCoeff(), 0) << e1 << " " << e2;
        const double smallest = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(s.H).eigenvalues()[0];
        EXPECT_GE(smallest, -1e-13 * s.H.norm()) << e1 << " " << e2;
      }
}

// Uniaxial tension of a wrinkled strip: E h E1 along, nothing across.
TEST(CstTensionField, PullsAlongTheMajorDirectionAlone) {
  const Single s = single(0.2, -0.4, 0.5);
  const Eigen::Vector2d stress = CstTensionField::state(s.rest, s.x).stress;
  const double area = 0.5 * (1.1 * 0.9 - 0.1 * 0.3);
  EXPECT_NEAR(stress[0], kSheetYoung * 0.2, 1e-14);
  EXPECT_EQ(stress[1], 0);
  EXPECT_NEAR(s.energy, area * kSheetThickness * kSheetYoung * 0.5 * 0.2 * 0.2, 1e-14);
}

}  // namespace
}  // namespace coapt
