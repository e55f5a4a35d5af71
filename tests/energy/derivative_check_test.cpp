#include "energy/derivative_check.hpp"

#include "energy/element_term.hpp"
#include "energy/kernels/cst_stvk.hpp"
#include "energy/load_dead.hpp"

#include <gtest/gtest.h>

namespace coapt {
namespace {

// x^4 spring between two nodes, with faults on request: a factor on the gradient and on the Hessian.
template <int gradient_permille, int hessian_permille>
struct Quartic {
  static constexpr int kNodes = 2;
  static constexpr std::string_view kType = "quartic";
  static constexpr TermRole kRole = TermRole::Internal;
  struct Rest {};
  static double evaluate(const Rest&, const Eigen::Vector<double, 6>& x, Eigen::Vector<double, 6>* g,
                         Eigen::Matrix<double, 6, 6>* H) {
    const Vec3 d = x.tail<3>() - x.head<3>();
    const double l2 = d.squaredNorm();
    if (g != nullptr) {
      g->tail<3>() = 4 * l2 * d * (gradient_permille / 1000.0);
      g->head<3>() = -g->tail<3>();
    }
    if (H != nullptr) {
      const Eigen::Matrix3d block =
          (4 * l2 * Eigen::Matrix3d::Identity() + 8 * d * d.transpose()) * (hessian_permille / 1000.0);
      *H << block, -block, -block, block;
    }
    return l2 * l2;
  }
};

Points three_points() {
  Points x(3, 3);
  x << 0, 1.1, 0.2, 0, 0.1, 0.9, 0, -0.2, 0.3;
  return x;
}

const FixedMask kAllFree = FixedMask::Constant(3, 3, false);

template <typename Kernel>
DerivativeReport check_quartic() {
  ElementTerm<Kernel> term("q", {0, 1, 1, 2}, std::vector<typename Kernel::Rest>(2));
  return check_derivatives(term, three_points(), random_directions(kAllFree, 20, 0.5, 1));
}

TEST(DerivativeCheck, PassesRightDerivatives) {
  const DerivativeReport report = check_quartic<Quartic<1000, 1000>>();
  EXPECT_TRUE(report.has_passed());
  EXPECT_TRUE(report.is_active());
  EXPECT_NEAR(report.gradient_slope, 2, 0.05);
  EXPECT_NEAR(report.hessian_slope, 3, 0.1);
  EXPECT_EQ(report.type, "quartic");
}

TEST(DerivativeCheck, CatchesAGradientThatIsOnePerMilleOff) {
  const DerivativeReport report = check_quartic<Quartic<1001, 1000>>();
  EXPECT_FALSE(report.has_passed());
  EXPECT_LT(report.gradient_slope, 1.5);
  EXPECT_GT(report.gradient_error, 1e-4);
}

TEST(DerivativeCheck, CatchesAHessianThatIsOnePerMilleOff) {
  const DerivativeReport report = check_quartic<Quartic<1000, 1001>>();
  EXPECT_FALSE(report.has_passed());
  EXPECT_LT(report.hessian_slope, 2.9);
  EXPECT_NEAR(report.hessian_error, 1e-3, 1e-4);
  EXPECT_GE(report.gradient_slope, 1.95);
}

// 0 up to `at`, then k/2 (x - at)^2 in the length of a line: the Hessian jumps. With a fault of the Hessian
// on request.
template <int hessian_permille>
struct Onset {
  static constexpr int kNodes = 2;
  static constexpr std::string_view kType = "onset";
  static constexpr TermRole kRole = TermRole::Internal;
  struct Rest {
    double at;
  };
  static double evaluate(const Rest& rest, const Eigen::Vector<double, 6>& x, Eigen::Vector<double, 6>* g,
                         Eigen::Matrix<double, 6, 6>* H) {
    const Vec3 d = x.tail<3>() - x.head<3>();
    const double l = d.norm(), e = l - rest.at;
    // Some stiffness before the onset, so that lines have a curvature of their own there.
    const double k = e > 0 ? 3 : 1;
    if (g != nullptr) {
      g->tail<3>() = k * e / l * d;
      g->head<3>() = -g->tail<3>();
    }
    if (H != nullptr) {
      const Eigen::Matrix3d along = d * d.transpose() / (l * l);
      const Eigen::Matrix3d block =
          (k * along + k * e / l * (Eigen::Matrix3d::Identity() - along)) * (hessian_permille / 1000.0);
      *H << block, -block, -block, block;
    }
    return 0.5 * k * e * e;
  }
};

// A chain of 100 lines, every tenth of them `off` away from its onset.
template <typename Kernel>
DerivativeReport check_chain(double off) {
  constexpr int kLines = 100;
  Points x(3, kLines + 1);
  for (int i = 0; i <= kLines; ++i) x.col(i) = Vec3(i, 0.3 * std::sin(i), 0.2 * std::cos(3 * i));
  std::vector<int> nodes;
  std::vector<typename Kernel::Rest> rest;
  for (int i = 0; i < kLines; ++i) {
    nodes.insert(nodes.end(), {i, i + 1});
    rest.push_back({(x.col(i + 1) - x.col(i)).norm() - (i % 50 == 0 ? off : 0.3)});
  }
  ElementTerm<Kernel> term("chain", nodes, rest);
  return check_derivatives(term, x, random_directions(FixedMask::Constant(3, kLines + 1, false), 6, 0.5, 1));
}

TEST(DerivativeCheck, TellsAKinkFromAWrongHessian) {
  for (const double off : {0.0, 1e-9, 1e-6, 1e-5, 1e-4}) {
    SCOPED_TRACE(off);
    const DerivativeReport right = check_chain<Onset<1000>>(off);
    EXPECT_TRUE(right.has_passed()) << right.hessian_slope << " " << right.hessian_error;
    EXPECT_GT(right.kinks, 0);
    for (const DerivativeReport& wrong :
         {check_chain<Onset<1001>>(off), check_chain<Onset<999>>(off), check_chain<Onset<500>>(off)}) {
      EXPECT_FALSE(wrong.has_passed());
      EXPECT_EQ(wrong.kinks, 0);
    }
  }
  EXPECT_EQ(check_chain<Onset<1000>>(0.2).kinks, 0);
}

TEST(DerivativeCheck, GivesALinearTermInfiniteSlopes) {
  Points forces = Points::Zero(3, 3);
  forces(2, 1) = 4;
  LoadDead term("weight", "load_field", forces, Points::Zero(3, 3));
  const DerivativeReport report =
      check_derivatives(term, three_points(), random_directions(kAllFree, 5, 0.5, 1));
  EXPECT_EQ(report.gradient_slope, kInfinity);
  EXPECT_EQ(report.hessian_slope, kInfinity);
  EXPECT_TRUE(report.has_passed());
}

TEST(DerivativeCheck, ChecksTheSumOverFreeUnknownsOnly) {
  FixedMask fixed = kAllFree;
  fixed.col(0).setConstant(true);
  fixed(1, 1) = true;
  const Points x = three_points();
  std::vector<std::unique_ptr<EnergyTerm>> terms;
  const Points X = 0.9 * x;
  terms.push_back(std::make_unique<ElementTerm<CstStVK>>(
      "membrane", std::vector<int>{0, 1, 2},
      std::vector<CstStVK::Rest>{CstStVK::rest(X.col(0), X.col(1), X.col(2), 3, 0.3, 0.5)}));
  Objective objective(x, fixed, std::move(terms));
  const Eigen::MatrixXd nodal = random_directions(fixed, 20, 0.3, 3);
  Eigen::MatrixXd directions(objective.unknown_count(), nodal.cols());
  for (int k = 0; k < nodal.cols(); ++k)
    directions.col(k) = objective.unknowns(Eigen::Map<const Points>(nodal.col(k).data(), 3, 3));
  const DerivativeReport report = check_derivatives(objective, objective.unknowns(x), directions);
  EXPECT_TRUE(report.has_passed()) << report.gradient_slope << " " << report.hessian_slope << " "
                                   << report.gradient_error << " " << report.hessian_error;
  EXPECT_TRUE(report.is_active());
}

}  // namespace
}  // namespace coapt
