// Nonlinear and fibrous membranes: every law in every regime through the term suite and against the law
// written anew; what relaxing it leaves.
#include "membrane_patch.hpp"
#include "support/single_triangle.hpp"
#include "support/term_suite.hpp"
#include "support/tissue_answers.hpp"

#include <gtest/gtest.h>

#include <set>

namespace coapt {
namespace {

constexpr double kTissueThickness = 0.4;
const Vec3 kFibre = Vec3(std::cos(0.4), std::sin(0.4), 0);

template <typename Entry>
class TissueLaw : public testing::Test {};
TYPED_TEST_SUITE(TissueLaw, MembraneLaws, LawNames);

template <typename Law>
TermCase patch_case(const std::string& label, Law (*law_of)(double), const Eigen::Matrix3d& f,
                    bool relaxes = true, double shake = 0.02) {
  const TriangleMesh mesh = patch();
  TermCase c;
  c.label = label;
  c.rest = mesh.vertices;
  c.state = shaken(f * mesh.vertices, shake, 4);
  c.reach = 2e-3;
  c.make = [mesh, law_of, relaxes](const Frame& frame) -> std::unique_ptr<EnergyTerm> {
    using K = KernelOf<Law>;
    const Points X = frame.points(mesh.vertices);
    const Triangles t = frame.triangles(mesh.triangles);
    const double stress = frame.force / (frame.length * frame.length);
    std::vector<typename K::Type::Rest> rest;
    for (int k = 0; k < t.cols(); ++k)
      rest.push_back(K::rest(X.col(t(0, k)), X.col(t(1, k)), X.col(t(2, k)), frame.rotation * kFibre,
                             law_of(stress), kTissueThickness * frame.length, relaxes));
    return std::make_unique<ElementTerm<typename K::Type>>("membrane", triangle_nodes(t), rest);
  };
  return c;
}

template <typename Kernel>
std::set<MembraneRegime> regimes_of(const TermCase& c) {
  const auto term = c.make({});
  const auto& membrane = dynamic_cast<const ElementTerm<Kernel>&>(*term);
  std::set<MembraneRegime> found;
  for (size_t e = 0; e < membrane.rest().size(); ++e) {
    CstVector x;
    for (int a = 0; a < 3; ++a) x.segment<3>(3 * a) = c.state.col(membrane.stencils().nodes[3 * e + a]);
    found.insert(Kernel::state(membrane.rest()[e], x).regime);
  }
  return found;
}

using Regimes = std::set<MembraneRegime>;
const Regimes kTaut{MembraneRegime::Taut}, kWrinkled{MembraneRegime::Wrinkled};
const Regimes kAll{MembraneRegime::Slack, MembraneRegime::Wrinkled, MembraneRegime::Taut};

template <typename Law>
void expect_passes_everywhere(const std::string& label, Law (*law_of)(double)) {
  using Kernel = typename KernelOf<Law>::Type;
  const TermCase taut = patch_case(label + ", taut", law_of, deformation(1.3, 0.05, 1.2));
  EXPECT_EQ(regimes_of<Kernel>(taut), kTaut) << label;
  EXPECT_EQ(examine_term(taut), "");
  const TermCase wrinkled = patch_case(label + ", wrinkled", law_of, deformation(1.35, 0.1, 0.6));
  EXPECT_EQ(regimes_of<Kernel>(wrinkled), kWrinkled) << label;
  EXPECT_EQ(examine_term(wrinkled), "");
  TermCase mixed = patch_case(label + ", mixed", law_of, deformation(1.02, 0.05, 0.97), true, 0.12);
  mixed.reach = 1e-3;
  EXPECT_EQ(regimes_of<Kernel>(mixed), kAll) << label;
  EXPECT_EQ(examine_term(mixed), "");
  const TermCase pressed = patch_case(label + ", compressed", law_of, deformation(0.9, 0.05, 1.1), false);
  EXPECT_EQ(examine_term(pressed), "");
}

TYPED_TEST(TissueLaw, PassesTheSuiteInEveryRegime) {
  expect_passes_everywhere(TypeParam::kName, TypeParam::law);
}

// Below, in and beyond the windows of the knees.
TYPED_TEST(TissueLaw, AgreesWithAutomaticDifferentiationOfItsFormula) {
  const TriangleMesh mesh = patch();
  const auto density = Answer<TypeParam>::density();
  const oracle::Tissue<decltype(density)> energy{mesh.triangles, mesh.vertices, kFibre, kTissueThickness,
                                                 density};
  for (const auto& f : {deformation(1.3, 0.05, 1.2), deformation(1.22, 0.05, 1.15),
                        deformation(1.1, 0.3, 1.05), deformation(0.9, 0.1, 0.95)})
    EXPECT_EQ(compare_with_autodiff(patch_case(TypeParam::kName, TypeParam::law, f, false), energy, 1e-8),
              "");
}

// Two populations that cross at any other angle than a right one couple stretch and shear.
TEST(Tissue, ObliquePopulationsPassTheSuiteInEveryRegime) {
  const auto law = [](double stress) { return laws::CrimpedPopulations::oblique(stress, 1.1); };
  expect_passes_everywhere<CrimpedFibreLaw>("oblique populations", law);
  const TriangleMesh mesh = patch();
  oracle::CrimpedPopulations density = Answer<laws::CrimpedPopulations>::density();
  density.angle = 1.1;
  const oracle::Tissue<oracle::CrimpedPopulations> energy{mesh.triangles, mesh.vertices, kFibre,
                                                          kTissueThickness, density};
  for (const auto& f :
       {deformation(1.3, 0.05, 1.2), deformation(1.1, 0.3, 1.05), deformation(0.9, 0.1, 0.95)})
    EXPECT_EQ(compare_with_autodiff(patch_case<CrimpedFibreLaw>("oblique", law, f, false), energy, 1e-8), "");
}

// The definition: no shortening P >= 0 that wrinkles might hide leaves less energy; and the stress pulls.
template <typename Law>
void expect_least(const std::string& label, const Law& law) {
  for (const double angle : {0.0, 0.5, 1.2})
    for (const auto& F :
         {plane(1.3, 0.2, 0.7), plane(1.1, -0.3, 0.95), plane(1.02, 0, 1e-7), plane(1.2, 0, 0)}) {
      const Single<Law> relaxed(law, F, angle);
      ASSERT_TRUE(relaxed.g.allFinite() && relaxed.H.allFinite()) << label;
      const MembraneState state = KernelOf<Law>::Type::state(relaxed.rest, relaxed.x);
      EXPECT_GE(state.stress[1], -1e-12 * state.stress[0]) << label;
      double least = std::numeric_limits<double>::infinity();
      for (double a = -1.5; a <= 1.5; a += 0.02)
        for (double b = -1.5; b <= 1.5; b += 0.02) {
          // F' with F'^T F' = C + (a, b)(a, b)^T, in the plane: its Cholesky factor.
          const Eigen::Vector2d p(a, b);
          const Eigen::Matrix2d C = F.transpose() * F + p * p.transpose();
          if (C.determinant() < 1e-6) continue;
          least = std::min(least, Single(law, C.llt().matrixU(), angle, false).density());
        }
      EXPECT_LE(relaxed.density(), least * (1 + 1e-9) + 1e-15) << label;
      EXPECT_GT(relaxed.density(), 0.8 * least - 1e-4) << label;  // the grid is that close
    }
}

TYPED_TEST(TissueLaw, RelaxedEnergyIsTheLeastThatWrinklesLeave) {
  expect_least(TypeParam::kName, TypeParam::law(1));
}

// Across each border energy and force go on without a jump.
template <typename Law>
void expect_smooth_borders(const std::string& label, const Law& law) {
  for (const double angle : {0.0, 0.6}) {
    // Taut to wrinkled: narrow a stretched triangle and find the border by bisection.
    double wide = 1.1, narrow = 0.6;
    const auto regime = [&](double width) {
      const Single<Law> s(law, plane(1.2, 0, width), angle);
      return KernelOf<Law>::Type::state(s.rest, s.x).regime;
    };
    ASSERT_EQ(regime(wide), MembraneRegime::Taut) << label;
    ASSERT_EQ(regime(narrow), MembraneRegime::Wrinkled) << label;
    while (wide - narrow > 1e-10) {
      const double mid = 0.5 * (wide + narrow);
      (regime(mid) == MembraneRegime::Taut ? wide : narrow) = mid;
    }
    const Single<Law> taut(law, plane(1.2, 0, wide), angle), loose(law, plane(1.2, 0, narrow), angle);
    EXPECT_LT((taut.g - loose.g).norm(), 1e-8 * taut.g.norm()) << label;
    const Single<Law> last(law, plane(1 + 1e-9, 0, 0.8), angle), slack(law, plane(1 - 1e-9, 0, 0.8), angle);
    EXPECT_LT(last.g.norm(), 1e-7) << label;
    EXPECT_EQ(slack.g.norm(), 0) << label;
    EXPECT_EQ(slack.energy, 0) << label;
  }
}

TYPED_TEST(TissueLaw, IsContinuouslyDifferentiableAtBothBorders) {
  expect_smooth_borders(TypeParam::kName, TypeParam::law(1));
}

// A facet that all but collapses across its tension: exponentials of its compression overflow, and must not
// be taken for tension.
TEST(Tissue, ACollapsedFacetIsWrinkledHoweverStiffTheLaw) {
  ExponentialLaw stiff{{0.001, 0.0002, 17}, 0};
  MayNewmanYinLaw fibrous{0.0004, 4.3, 1446};
  for (const double width : {0.3, 0.2, 0.15, 0.1, 0.01, 1e-4, 1e-8, 0.0}) {
    const Single a(stiff, plane(1.1, 0, width));
    const Single b(fibrous, plane(1.1, 0, width));
    EXPECT_NEAR(a.energy, Single(stiff, plane(1.1, 0, 0.5)).energy, 1e-12 * a.energy) << width;
    EXPECT_NEAR(b.nominal()(0, 0), Single(fibrous, plane(1.1, 0, 0.5)).nominal()(0, 0), 1e-9) << width;
    EXPECT_TRUE(a.g.allFinite() && a.H.allFinite() && b.g.allFinite() && b.H.allFinite()) << width;
  }
}

template <typename Law>
void expect_positive_projection(const std::string& label, const Law& law) {
  for (const bool relaxes : {true, false})
    for (const auto& F : {plane(1.3, 0.2, 0.7), plane(0.8, -0.3, 0.7), plane(1.3, 0.1, 1.2)}) {
      const Single<Law> s(law, F, 0.4, relaxes);
      CstVector g;
      CstMatrix H;
      EXPECT_EQ(KernelOf<Law>::Type::evaluate_projected(s.rest, s.x, &g, &H), s.energy) << label;
      EXPECT_EQ(g, s.g) << label;
      const Eigen::SelfAdjointEigenSolver<CstMatrix> eigen(H);
      EXPECT_GE(eigen.eigenvalues()[0], -1e-12 * std::max(1e-3, eigen.eigenvalues()[8])) << label;
      // Where the exact Hessian is positive already it is the same.
      const Eigen::SelfAdjointEigenSolver<CstMatrix> exact(s.H);
      if (exact.eigenvalues()[0] > -1e-13 * exact.eigenvalues()[8]) {
        EXPECT_LT((H - s.H).norm(), 1e-9 * s.H.norm()) << label;
      }
    }
}

TYPED_TEST(TissueLaw, ProjectedHessiansArePositive) {
  expect_positive_projection(TypeParam::kName, TypeParam::law(1));
}

}  // namespace
}  // namespace coapt
