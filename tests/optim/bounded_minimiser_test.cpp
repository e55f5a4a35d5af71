// Minimisers within bounds against problems with known answers. Those of NLopt and Ceres where they are in
// the build.
#include "support/minimisers.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace coapt {
namespace {

// Rosenbrock's valley, which cannot be evaluated where z0 > 1.4.
class Valley final : public BoundedFunction {
 public:
  Valley(Vector low, Vector high) : low_(std::move(low)), high_(std::move(high)) {}
  const Vector& low() const override { return low_; }
  const Vector& high() const override { return high_; }

  double value(const Vector& z, Vector* gradient) override {
    Vector r;
    Eigen::MatrixXd J;
    if (!residuals(z, r, &J)) return kInfinity;
    if (gradient != nullptr) *gradient = 2 * J.transpose() * r;
    return r.squaredNorm();
  }
  bool has_residuals() const override { return true; }
  bool residuals(const Vector& z, Vector& r, Eigen::MatrixXd* jacobian) override {
    EXPECT_TRUE((z.array() >= low_.array()).all() && (z.array() <= high_.array()).all()) << z.transpose();
    ++evaluations;
    if (z[0] > 1.4) return false;
    r = Eigen::Vector2d(3 * (z[1] - z[0] * z[0]), 1 - z[0]);
    if (jacobian != nullptr) *jacobian = (Eigen::Matrix2d() << -6 * z[0], 3, -1, 0).finished();
    const double value = r.squaredNorm();
    if (value < least) {
      least = value;
      best = z;
    }
    return true;
  }
  bool is_over() const override { return evaluations >= limit; }

  int evaluations = 0, limit = 100000;
  double least = kInfinity;
  Vector best;

 private:
  Vector low_, high_;
};

const BoundedStop kTight = {1e-7, 1e-12};

TEST(BoundedMinimiser, EachReachesTheLeastWithinBounds) {
  const Vector wide_low = Eigen::Vector2d(-2, -2), wide_high = Eigen::Vector2d(2, 2);
  const Vector tight_high = Eigen::Vector2d(0.5, 2);  // the least is then at (0.5, 0.25), on the bound
  for (const auto& [name, make] : minimisers()) {
    SCOPED_TRACE(name);
    Valley free(wide_low, wide_high);
    make()->minimise(free, Eigen::Vector2d(-1.2, 1), kTight);
    EXPECT_NEAR((free.best - Eigen::Vector2d(1, 1)).norm(), 0, 1e-3) << free.evaluations;
    Valley bounded(wide_low, tight_high);
    make()->minimise(bounded, Eigen::Vector2d(-1.2, 1), kTight);
    // Ceres shortens its steps at a bound, and calls itself done before the least along it.
    EXPECT_NEAR((bounded.best - Eigen::Vector2d(0.5, 0.25)).norm(), 0, name == "ceres" ? 0.05 : 1e-3)
        << bounded.evaluations;
    EXPECT_EQ(make()->name(), name);
  }
}

TEST(BoundedMinimiser, EachEndsWhenItIsTold) {
  for (const auto& [name, make] : minimisers()) {
    SCOPED_TRACE(name);
    Valley valley(Eigen::Vector2d(-2, -2), Eigen::Vector2d(2, 2));
    valley.limit = 4;
    EXPECT_FALSE(make()->minimise(valley, Eigen::Vector2d(-1.2, 1), kTight).has_converged);
    EXPECT_LE(valley.evaluations, 6);
  }
}

// The conditions of Karush, Kuhn and Tucker, of random problems.
TEST(BoundedMinimiser, StepIsTheLeastOfItsBox) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  int bounds = 0;
  for (int trial = 0; trial < 50; ++trial) {
    const int n = 1 + trial % 12;
    const auto entries = [&] { return normal(random); };
    const Eigen::MatrixXd root = Eigen::MatrixXd::NullaryExpr(n, n, entries);
    const Eigen::MatrixXd A = root * root.transpose() + 0.01 * Eigen::MatrixXd::Identity(n, n);
    const Vector g = Vector::NullaryExpr(n, entries);
    const Vector low = -Vector::NullaryExpr(n, entries).cwiseAbs(),
                 high = Vector::NullaryExpr(n, entries).cwiseAbs();
    const Vector s = bounded_step(A, g, low, high), slope = g + A * s;
    for (int i = 0; i < n; ++i) {
      ASSERT_GE(s[i], low[i]);
      ASSERT_LE(s[i], high[i]);
      EXPECT_TRUE(s[i] == low[i] || slope[i] <= 1e-9) << slope[i];
      EXPECT_TRUE(s[i] == high[i] || slope[i] >= -1e-9) << slope[i];
      if (s[i] == low[i] || s[i] == high[i]) ++bounds;
    }
  }
  EXPECT_GT(bounds, 50);
}

}  // namespace
}  // namespace coapt
