// Closed-form positive semidefinite Hessians against the eigenvalues that they stand for.
#include "energy/element_term.hpp"
#include "energy/kernels/bending.hpp"
#include "energy/kernels/cable.hpp"
#include "energy/kernels/cst_isotropic.hpp"
#include "energy/kernels/cst_tension_field.hpp"
#include "energy/kernels/link.hpp"
#include "energy/kernels/surface_tension.hpp"
#include "energy/kernels/tether_cubic.hpp"
#include "energy/project_element.hpp"
#include "membrane_patch.hpp"

#include <gtest/gtest.h>

namespace coapt {
namespace {

static_assert(ProjectsItself<CstStVK> && ProjectsItself<CstTensionField> && ProjectsItself<BendingHinge> &&
              ProjectsItself<Cable> && ProjectsItself<TetherCubic> && ProjectsItself<Link> &&
              ProjectsItself<SurfaceTension>);

template <typename Kernel>
struct Both {
  static constexpr int kSize = 3 * Kernel::kNodes;
  using Matrix = Eigen::Matrix<double, kSize, kSize>;
  Eigen::Vector<double, kSize> x, g, projected_g;
  Matrix exact, projected;
  double energy, projected_energy;

  Both(const typename Kernel::Rest& rest, const Points& at) : x(at.reshaped()) {
    energy = Kernel::evaluate(rest, x, &g, &exact);
    projected_energy = Kernel::evaluate_projected(rest, x, &projected_g, &projected);
  }

  static Vector eigenvalues(const Eigen::MatrixXd& m) {
    return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(m).eigenvalues();
  }

  // Positive semidefinite, the rest untouched, and the exact matrix where that is semidefinite already.
  void expect_sound(const std::string& what) const {
    EXPECT_EQ(energy, projected_energy) << what;
    EXPECT_EQ(g, projected_g) << what;
    EXPECT_GE(eigenvalues(projected)[0], -1e-13 * exact.norm()) << what;
    if (eigenvalues(exact)[0] > -1e-14 * exact.norm()) {
      EXPECT_LT((projected - exact).norm(), 1e-12 * exact.norm()) << what;
    }
  }
};

Points rest_triangle() {
  Points X(3, 3);
  X << 0, 1.1, 0.3, 0, 0.1, 0.9, 0, 0, 0;
  return X;
}

Points strained(double f11, double f12, double f22) {
  Points x = deformation(f11, f12, f22) * rest_triangle();
  x.row(2) = 0.3 * x.row(0) - 0.2 * x.row(1);  // the current triangle is tilted
  return x;
}

// d2W/dF2 (6x6) from the element's matrix: x = F D_X for nodes 1 and 2 beside a fixed node 0.
Eigen::MatrixXd by_gradient(const CstMatrix& H, const Eigen::Matrix2d& shape) {
  Eigen::MatrixXd to_edges(6, 6);
  const Eigen::Matrix2d edges = shape.inverse();
  for (int a = 0; a < 2; ++a)
    for (int b = 0; b < 2; ++b)
      to_edges.block(3 * a, 3 * b, 3, 3) = edges(b, a) * Eigen::MatrixXd::Identity(3, 3);
  const Eigen::MatrixXd by_edges = H.bottomRightCorner<6, 6>();
  return to_edges.transpose() * by_edges * to_edges;
}

Eigen::MatrixXd with_negative_eigenvalues_cut(const Eigen::MatrixXd& m) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(m);
  return eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0).asDiagonal() *
         eigen.eigenvectors().transpose();
}

const double kStretches[] = {0.3, 0.55, 0.8, 1.0, 1.3};

template <typename Kernel>
void expect_exact_clamp(const typename Kernel::Rest& rest, const Eigen::Matrix2d& shape) {
  int cut = 0;
  for (const double f11 : kStretches)
    for (const double f12 : {0.0, 0.2, -0.5})
      for (const double f22 : kStretches) {
        const std::string what = std::to_string(f11) + " " + std::to_string(f12) + " " + std::to_string(f22);
        const Both<Kernel> both(rest, strained(f11, f12, f22));
        both.expect_sound(what);
        const Eigen::MatrixXd expected = with_negative_eigenvalues_cut(by_gradient(both.exact, shape));
        EXPECT_LT((by_gradient(both.projected, shape) - expected).norm(), 1e-12 * both.exact.norm()) << what;
        cut += (both.projected - both.exact).norm() > 1e-3 * both.exact.norm();
      }
  EXPECT_GT(cut, 20);
}

TEST(ClosedFormProjection, IsTheEigenvalueClampOfTheMembraneByDeformationGradient) {
  const Points X = rest_triangle();
  for (const double poisson : {-0.4, 0.0, 0.35, 0.4999}) {
    const CstStVK::Rest stvk = CstStVK::rest(X.col(0), X.col(1), X.col(2), 2, poisson, 0.4, 0.01);
    expect_exact_clamp<CstStVK>(stvk, stvk.shape);
    const CstTensionField::Rest relaxed =
        CstTensionField::rest(X.col(0), X.col(1), X.col(2), 2, poisson, 0.4, 0.01, 0.3);
    expect_exact_clamp<CstTensionField>(relaxed, relaxed.stvk.shape);
  }
}

TEST(ClosedFormProjection, LeavesTheTensionFieldAsItIs) {
  const Points X = rest_triangle();
  const CstTensionField::Rest rest = CstTensionField::rest(X.col(0), X.col(1), X.col(2), 2, 0.35, 0.4);
  for (const double f11 : kStretches)
    for (const double f22 : kStretches) {
      const Both<CstTensionField> both(rest, strained(f11, 0.2, f22));
      EXPECT_EQ(both.projected, both.exact);
      EXPECT_GE(both.eigenvalues(both.exact)[0], -1e-13 * both.exact.norm());
    }
}

TEST(ClosedFormProjection, HoldsForACollapsedTriangle) {
  const Points X = rest_triangle();
  const CstStVK::Rest rest = CstStVK::rest(X.col(0), X.col(1), X.col(2), 2, 0.35, 0.4);
  Points on_line = X;
  on_line.row(1).setZero();
  for (const Points& x : {Points(Points::Zero(3, 3)), on_line}) {
    const Both<CstStVK> both(rest, x);
    EXPECT_TRUE(both.projected.allFinite());
    both.expect_sound("collapsed");
  }
}

TEST(ClosedFormProjection, KeepsAFilmStiffAgainstBendingAndDilation) {
  const Points x = strained(1.1, 0.3, 0.8);
  const Both<SurfaceTension> both({1.3}, x);
  both.expect_sound("film");
  EXPECT_LT(both.eigenvalues(both.exact)[0], -0.1);
  // Growing alike in all directions of its plane, and moving out of it, it is as stiff as before.
  const CstVector growth = x.reshaped();
  EXPECT_NEAR(growth.dot(both.projected * growth), growth.dot(both.exact * growth), 1e-13);
  const Vec3 normal = Vec3(x.col(1) - x.col(0)).cross(Vec3(x.col(2) - x.col(0))).normalized();
  CstVector lift;
  lift << 0.3 * normal, -0.4 * normal, 0.9 * normal;
  EXPECT_NEAR(lift.dot(both.projected * lift), lift.dot(both.exact * lift), 1e-13);
}

TEST(ClosedFormProjection, HoldsForHingesAndLines) {
  Points X(3, 4), x(3, 4);
  X << 0, 0.1, -0.8, 0.7, 0, 1.2, 0.3, 0.7, 0, 0.1, 0.2, -0.6;
  x << 0, 0.1, -0.7, -0.7, 0, 1.2, 0.3, 0.7, 0, 0.1, 0.2, 0.6;
  const auto curved = BendingHinge::rest(X.col(0), X.col(1), X.col(2), X.col(3), 0.7);
  const Both<BendingHinge> hinge(curved, x);
  EXPECT_LT(hinge.eigenvalues(hinge.exact)[0], -1e-2);
  hinge.expect_sound("curved hinge");
  X.row(2).setZero();
  const auto flat = BendingHinge::rest(X.col(0), X.col(1), X.col(2), X.col(3), 0.7);
  const Both<BendingHinge> constant(flat, x);
  EXPECT_EQ(constant.exact, constant.projected);
  for (const double stretch : {0.5, 0.99, 1.005, 1.5}) {
    Points ends(3, 2);
    ends << 0, stretch, 0, 0, 0, 0;
    Both<Cable>({3, 1, 0.02, 0.4}, ends).expect_sound("cable");
    Both<TetherCubic>({3, 1, 0.5}, ends).expect_sound("tether");
    Both<Link>({3, 1}, ends).expect_sound("link");
    Both<Link>({3, 0}, ends).expect_sound("suture");
  }
}

// A symmetric matrix of the eigenvalues.
template <int kSize>
Eigen::Matrix<double, kSize, kSize> with_eigenvalues(const Eigen::Vector<double, kSize>& values) {
  Eigen::Matrix<double, kSize, kSize> q = Eigen::Matrix<double, kSize, kSize>::Identity();
  for (int k = 0; k < kSize; ++k) {
    const Eigen::Vector<double, kSize> u = Eigen::Vector<double, kSize>::Random().normalized();
    q -= 2 * u * (u.transpose() * q).eval();
  }
  const Eigen::Matrix<double, kSize, kSize> m = q * values.asDiagonal() * q.transpose();
  return 0.5 * (m + m.transpose());
}

template <int kNodes>
void expect_projected_as_decomposed(const Eigen::Matrix<double, 3 * kNodes, 3 * kNodes>& h,
                                    const std::string& what) {
  const Eigen::Vector<double, 3 * kNodes> x = Eigen::Vector<double, 3 * kNodes>::Random();
  Eigen::Matrix<double, 3 * kNodes, 3 *kNodes> projected = h, decomposed = h;
  project_element<kNodes>(x, projected);
  project_psd(decomposed);
  EXPECT_LE((projected - decomposed).norm(), 1e-13 * h.norm()) << what;
}

// The element's matrix of what is given for the nodes but the first.
template <int kNodes>
Eigen::Matrix<double, 3 * kNodes, 3 * kNodes> invariant(
    const Eigen::Matrix<double, 3 * (kNodes - 1), 3 * (kNodes - 1)>& k) {
  Eigen::Matrix<double, 3 * (kNodes - 1), 3 * kNodes> difference;
  difference.setZero();
  for (int a = 1; a < kNodes; ++a) {
    difference.template block<3, 3>(3 * a - 3, 3 * a).setIdentity();
    difference.template block<3, 3>(3 * a - 3, 0) = -Eigen::Matrix3d::Identity();
  }
  return difference.transpose() * k * difference;
}

template <int kNodes>
void expect_any_matrix_projected() {
  constexpr int kSize = 3 * kNodes, kLeft = 3 * (kNodes - 1);
  for (int trial = 0; trial < 200; ++trial) {
    Eigen::Vector<double, kSize> values = Eigen::Vector<double, kSize>::Random();
    if (trial % 4 == 1) values.tail(3).setConstant(values[0]);                   // several alike
    if (trial % 4 == 2) values.head(kSize / 2).setZero();                        // singular
    if (trial % 4 == 3) values.array() *= std::pow(10.0, trial % 9 * 30 - 120);  // small and great
    const std::string what = std::to_string(kNodes) + " nodes, " + std::to_string(trial);
    expect_projected_as_decomposed<kNodes>(with_eigenvalues<kSize>(values), what);
    expect_projected_as_decomposed<kNodes>(
        invariant<kNodes>(with_eigenvalues<kLeft>(values.template head<kLeft>())), what + " invariant");
  }
}

TEST(ProjectElement, IsTheEigenvalueDecompositionOfAnyMatrix) {
  std::srand(11);
  expect_any_matrix_projected<2>();
  expect_any_matrix_projected<3>();
  expect_any_matrix_projected<4>();
}

// Minors tell without factors of a pair that it is definite, and must not where it is not quite.
TEST(ProjectElement, SeesTheLeastNegativeEigenvalueOfAPair) {
  std::srand(12);
  for (const double scale : {1e-100, 1e-6, 1.0, 1e100})
    for (const double least : {-1e-12, -1e-8, -1e-3, 1e-12, 1e-3})
      for (const double other : {1.0, 1e-6, -1e-6})
        for (int trial = 0; trial < 10; ++trial) {
          const auto k = with_eigenvalues<3>(scale * Vec3(1, other, least));
          expect_projected_as_decomposed<2>(invariant<2>(k),
                                            std::to_string(least) + ' ' + std::to_string(other));
        }
}

// With a direction of their own: the normal of a triangle, the line of two nodes.
TEST(ProjectElement, IsTheEigenvalueDecompositionOfMembranesAndLines) {
  const Points X = rest_triangle();
  const NeoHookeanLaw law{{0.33}, 0};
  int untouched = 0;
  for (const double along : {0.4, 0.9, 1.0, 1.3})
    for (const double shear : {0.0, 0.2})
      for (const double across : {0.4, 0.9, 1.0, 1.3}) {
        const Eigen::Vector<double, 9> x = strained(along, shear, across).reshaped();
        Eigen::Vector<double, 9> g;
        Eigen::Matrix<double, 9, 9> exact;
        CstNeoHookean::evaluate(CstNeoHookean::rest(X.col(0), X.col(1), X.col(2), law, 0.8, false), x, &g,
                                &exact);
        Eigen::Matrix<double, 9, 9> projected = exact, decomposed = exact;
        project_element<3>(x, projected);
        project_psd(decomposed);
        EXPECT_LE((projected - decomposed).norm(), 1e-13 * exact.norm()) << along << ' ' << across;
        untouched += projected == exact;
      }
  EXPECT_GE(untouched, 2);
  EXPECT_LE(untouched, 20);
  for (const double length : {0.5, 1.5}) {
    Eigen::Vector<double, 6> x = Eigen::Vector<double, 6>::Zero(), g;
    x.tail<3>() = length * Vec3(1, 2, -2) / 3;
    Eigen::Matrix<double, 6, 6> projected, decomposed;
    expand_axial({0, length - 1, 1}, x.tail<3>(), length, &g, &decomposed);  // a spring of the length 1
    projected = decomposed;
    project_element<2>(x, projected);
    project_psd(decomposed);
    EXPECT_LE((projected - decomposed).norm(), 1e-14);
  }
}

// Nothing to project, and nothing to project with.
TEST(ProjectElement, LeavesZeroAndWhatIsNotFinite) {
  const Eigen::Vector<double, 6> x = Eigen::Vector<double, 6>::Unit(3);
  Eigen::Matrix<double, 6, 6> h = Eigen::Matrix<double, 6, 6>::Zero();
  project_element<2>(x, h);
  EXPECT_TRUE(h.isZero(0));
  h(4, 4) = std::numeric_limits<double>::infinity();
  project_element<2>(x, h);
  EXPECT_FALSE(h.allFinite());
}

}  // namespace
}  // namespace coapt
