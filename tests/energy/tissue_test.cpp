// Nonlinear and fibrous membranes: every law in every regime through the term suite, against the laws written
// anew, and in states of uniform strain against closed forms.
#include "membrane_patch.hpp"
#include "support/term_suite.hpp"
#include "support/tissue_laws.hpp"
#include "support/tissue_oracles.hpp"

#include <gtest/gtest.h>

#include <set>

namespace coapt {
namespace {

constexpr double kThickness = 0.4;
const Vec3 kFibre = Vec3(std::cos(0.4), std::sin(0.4), 0);

constexpr auto bilinear = laws::Bilinear::law;
constexpr auto neo_hookean = laws::NeoHookean::law;
constexpr auto exponential = laws::Exponential::law;
constexpr auto soft_exponential = laws::SoftExponential::law;
constexpr auto orthotropic = laws::Orthotropic::law;
constexpr auto may_newman_yin = laws::MayNewmanYin::law;
constexpr auto crimped_fibre = laws::Crimped::law;

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
                             law_of(stress), kThickness * frame.length, relaxes));
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

template <typename Law, typename Density>
std::string against_oracle(const std::string& label, Law (*law_of)(double), const Density& density,
                           double tolerance = 1e-10) {
  const TriangleMesh mesh = patch();
  const oracle::Tissue<Density> energy{mesh.triangles, mesh.vertices, kFibre, kThickness, density};
  std::string defects;
  for (const auto& f :
       {deformation(1.3, 0.05, 1.2), deformation(1.1, 0.3, 1.05), deformation(0.9, 0.1, 0.95)})
    defects += compare_with_autodiff(patch_case(label, law_of, f, false), energy, tolerance);
  return defects;
}

TEST(Tissue, AgreesWithAutomaticDifferentiationOfTheLaws) {
  EXPECT_EQ(against_oracle("bilinear", bilinear, oracle::Bilinear{0.1, 6, 0.25, 0.05, 0.4}), "");
  EXPECT_EQ(against_oracle("neo-Hookean", neo_hookean, oracle::Exponential{0.3, 0, 0}), "");
  EXPECT_EQ(against_oracle("exponential", exponential, oracle::Exponential{0.05, 0.02, 3}), "");
  EXPECT_EQ(against_oracle("compressible exponential", soft_exponential,
                           oracle::CompressibleExponential{{0.05, 0.02, 3}, 0.6}, 1e-7),
            "");
  EXPECT_EQ(against_oracle("orthotropic", orthotropic,
                           oracle::Orthotropic{0.2, 4.2, 0.15, 0.08, 1.08, 0.3, 0.04, 0.3, 0.05}),
            "");
  EXPECT_EQ(against_oracle("May-Newman-Yin", may_newman_yin, oracle::MayNewmanYin{0.02, 1.5, 20}), "");
}

// One triangle under a plane deformation F of its rest frame, whose first axis is the fibre.
template <typename Law>
struct Single {
  using K = KernelOf<Law>;
  typename K::Type::Rest rest;
  Points X = Points::Zero(3, 3);
  CstVector x, g;
  CstMatrix H;
  double energy = 0, volume = 0;

  Single(const Law& law, const Eigen::Matrix2d& F, double fibre_angle = 0, bool relaxes = true) {
    X << 0, 1.1, 0.3, 0, 0.1, 0.9, 0, 0, 0;
    const Vec3 fibre(std::cos(fibre_angle), std::sin(fibre_angle), 0);
    rest = K::rest(X.col(0), X.col(1), X.col(2), fibre, law, kThickness, relaxes);
    Points image = X;
    image.topRows<2>() = F * X.topRows<2>();
    x = Eigen::Map<const CstVector>(image.data());
    energy = K::Type::evaluate(rest, x, &g, &H);
    const Vec3 e1 = X.col(1) - X.col(0), e2 = X.col(2) - X.col(0);
    volume = 0.5 * e1.cross(e2).norm() * kThickness;
  }

  // First Piola-Kirchhoff stress from the nodal forces: V P = (g1 g2) (e1 e2)^T in the plane.
  Eigen::Matrix2d nominal() const {
    Eigen::Matrix2d forces, edges;
    forces << g[3], g[6], g[4], g[7];
    edges << X(0, 1) - X(0, 0), X(0, 2) - X(0, 0), X(1, 1) - X(1, 0), X(1, 2) - X(1, 0);
    return forces * edges.transpose() / volume;
  }
  double density() const { return energy / volume; }
};

Eigen::Matrix2d plane(double f11, double f12, double f22) {
  Eigen::Matrix2d F;
  F << f11, f12, 0, f22;
  return F;
}

// Uniaxial tension is a wrinkled state: whatever the width, the stress is that of a strip with free sides.
TEST(Tissue, UniaxialTensionFollowsTheClosedForms) {
  for (const double l : {1.01, 1.1, 1.2, 1.3, 1.4}) {
    const double e = l - 1, knee = 0.25, w = 0.05;
    const double past = e <= knee - w   ? 0
                        : e >= knee + w ? 5.9 * (e - knee)
                                        : 5.9 / (4 * w) * (e - knee + w) * (e - knee + w);
    EXPECT_NEAR(Single(bilinear(1), plane(l, 0, 0.3)).nominal()(0, 0), 0.1 * e + past, 1e-8 * l);
    EXPECT_NEAR(Single(neo_hookean(1), plane(l, 0, 0.3)).nominal()(0, 0), 0.3 * (l - 1 / (l * l)), 1e-8);
    const double j = l * l + 2 / l - 3;
    const double slope = 0.5 * 0.05 + 0.02 * 3 * j * std::exp(3 * j * j);
    EXPECT_NEAR(Single(exponential(1), plane(l, 0, 0.3)).nominal()(0, 0), slope * 2 * (l - 1 / (l * l)),
                1e-8);
    EXPECT_NEAR(Single(exponential(1), plane(l, 0, 0.3)).density(),
                0.5 * (0.05 * j + 0.02 * std::expm1(3 * j * j)), 1e-10);
    // Along the fibre and below the knee across.
    const double ofibre = 0.2 * e + (e <= 0.11   ? 0
                                     : e >= 0.19 ? 4 * (e - 0.15)
                                                 : 4 / 0.16 * (e - 0.11) * (e - 0.11));
    EXPECT_NEAR(Single(orthotropic(1), plane(l, 0, 0.3)).nominal()(0, 0), ofibre, 1e-8);
    const double mny = 0.02 * std::exp(1.5 * j * j + 20 * std::pow(e, 4)) *
                       (2 * 1.5 * j * 2 * (l - 1 / (l * l)) + 4 * 20 * std::pow(e, 3));
    EXPECT_NEAR(Single(may_newman_yin(1), plane(l, 0, 0.3)).nominal()(0, 0) / mny, 1, 1e-8);
    for (const double stress : {Single(bilinear(1), plane(l, 0, 0.3)).nominal()(1, 1),
                                Single(may_newman_yin(1), plane(l, 0, 0.3)).nominal()(1, 1)})
      EXPECT_NEAR(stress, 0, 1e-12);
  }
}

TEST(Tissue, EquibiaxialTensionAndShearFollowTheClosedForms) {
  for (const double l : {1.05, 1.2, 1.35}) {
    const double thin = 1 / (l * l * l * l * l), j = 2 * l * l + thin * l - 3;
    EXPECT_NEAR(Single(neo_hookean(1), plane(l, 0, l)).nominal()(0, 0), 0.3 * (l - thin), 1e-8);
    const double slope = 0.5 * 0.05 + 0.02 * 3 * j * std::exp(3 * j * j);
    EXPECT_NEAR(Single(exponential(1), plane(l, 0, l)).nominal()(1, 1) / (2 * slope * (l - thin)), 1, 1e-8);
    const double e = l - 1;
    EXPECT_NEAR(Single(orthotropic(1), plane(l, 0, l)).nominal()(0, 0),
                0.2 * e / 0.91 + 0.3 / 0.91 * std::sqrt(0.2 * 0.08) * e + (e <= 0.11 ? 0 : 4 * (e - 0.15)),
                1e-8);
  }
  // Simple shear by gamma of an incompressible law: P12 = 2 psi' gamma and P11 = P22-free in C: with
  // B = F F^T, P = 2 psi' (F - F^-T det(C)^-1), det F = 1.
  for (const double gamma : {0.05, 0.2, 0.4}) {
    const Eigen::Matrix2d F = plane(1, gamma, 1);
    const double j = gamma * gamma;  // I1 - 3
    const double slope = 0.5 * 0.05 + 0.02 * 3 * j * std::exp(3 * j * j);
    const Eigen::Matrix2d expected = 2 * slope * (F - F.inverse().transpose());
    EXPECT_LT((Single(exponential(1), F, 0, false).nominal() - expected).norm(), 1e-8);
  }
}

// The stress of a crimped fibre, by its definition in lengths; its energy, by many small steps.
TEST(Tissue, CrimpedFibreIsTheHelixThatIsPulledStraight) {
  const double ratio = 9, slenderness = 1.6, young = 8, R0 = 2.5, H0 = ratio * R0, r0 = R0 / slenderness;
  const double L0 = std::sqrt(std::pow(2 * std::numbers::pi * R0, 2) + H0 * H0), limit = L0 / H0;
  const CrimpedFibre fibre(young, ratio, slenderness, 0);
  EXPECT_NEAR(fibre.limit(), limit, 1e-14);
  double energy = 0, before = 0;
  constexpr int kSteps = 20000;
  const double most = 1.4 * (limit - 1);
  for (int k = 1; k <= kSteps; ++k) {
    const double l = 1 + most * k / kSteps, H = l * H0;
    const double secant = young * H0 * H0 /
                          (L0 * (H0 + (1 + 37 / (6 * std::pow(std::numbers::pi, 2)) +
                                       2 * L0 * L0 / std::pow(std::numbers::pi * r0, 2)) *
                                          (L0 - H0)));
    double stress = secant * (limit - 1) + young * (l / limit - 1);
    if (l < limit) {
      const double R2 = (L0 * L0 - H * H) / std::pow(2 * std::numbers::pi, 2);
      const double eta =
          (R2 + H * H) / (L0 * H * (1 + 4 * R2 / (r0 * r0) + 6 * (20.0 / 9 + R2 / (r0 * r0)) * R2 / (H * H)));
      stress = secant * eta * (l - 1);
    }
    energy += 0.5 * (stress + before) * most / kSteps;
    before = stress;
    if (k % 500 == 0) {
      EXPECT_NEAR(fibre.at(l - 1).stress / stress, 1, 1e-12);
      EXPECT_NEAR(fibre.at(l - 1).energy / energy, 1, 1e-5);
    }
  }
  EXPECT_EQ(fibre.at(-0.1).stress, 0);
  EXPECT_LT(fibre.at(0.5 * (limit - 1)).stiffness, 0.2 * young);
}

template <typename Law>
double density_at(const Law& law, const Eigen::Matrix2d& F, double fibre_angle) {
  return Single(law, F, fibre_angle, false).density();
}

TEST(Tissue, IsIsotropicWhereItShouldBeAndOnlyThere) {
  const Eigen::Matrix2d F = plane(1.25, 0.1, 1.05);
  for (const double angle : {0.3, 0.8, 1.4}) {
    EXPECT_NEAR(density_at(bilinear(1), F, angle) / density_at(bilinear(1), F, 0), 1, 1e-13);
    EXPECT_NEAR(density_at(exponential(1), F, angle) / density_at(exponential(1), F, 0), 1, 1e-13);
    EXPECT_GT(std::abs(density_at(may_newman_yin(1), F, angle) / density_at(may_newman_yin(1), F, 0) - 1),
              0.01);
    EXPECT_GT(std::abs(density_at(crimped_fibre(1), F, angle) / density_at(crimped_fibre(1), F, 0) - 1),
              0.01);
    // Rotating sheet and deformation together changes nothing.
    const Eigen::Matrix2d R = Eigen::Rotation2Dd(angle).toRotationMatrix();
    EXPECT_NEAR(density_at(orthotropic(1), R * F * R.transpose(), angle) / density_at(orthotropic(1), F, 0),
                1, 1e-12);
  }
  // Fibres in all directions alike are isotropic.
  CrimpedFibreLaw even = crimped_fibre(1);
  even.splay = 10;
  EXPECT_NEAR(density_at(even, F, 0.7) / density_at(even, F, 0), 1, 1e-12);
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
          least = std::min(least, density_at(law, Eigen::Matrix2d(C.llt().matrixU()), angle));
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
