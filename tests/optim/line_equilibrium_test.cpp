// Rows C1, C1s, C3 and C5 of the verification table: tethers, chains and a wire.
#include "energy/element_term.hpp"
#include "energy/kernels/cable.hpp"
#include "energy/kernels/tether_cubic.hpp"
#include "energy/load_dead.hpp"
#include "support/equilibrium.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace coapt {
namespace {

// Root of a function that changes its sign between the two ends.
template <typename Function>
double root(const Function& f, double low, double high) {
  for (int k = 0; k < 200; ++k) {
    const double middle = 0.5 * (low + high);
    ((f(low) < 0) == (f(middle) < 0) ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

std::unique_ptr<EnergyTerm> tether(double length, double strength, double scale) {
  return std::make_unique<ElementTerm<TetherCubic>>(
      "tether", std::vector<int>{0, 1}, std::vector<TetherCubic::Rest>{{strength, length, scale}});
}

std::unique_ptr<LoadDead> weight_on(const Points& X, int node, const Vec3& force) {
  Points forces = Points::Zero(3, X.cols());
  forces.col(node) = force;
  return std::make_unique<LoadDead>("weight", "load_field", forces, X);
}

TEST(Tether, C1CarriesAWeightAtTheClosedFormLength) {
  const double t = 2, rho = 0.5, r = 1, weight = 3;
  Points X(3, 2);
  X << 0, 0.1, 0, -0.05, 0, -1.1;
  const Equilibrium found = find_equilibrium(
      X, fixed_nodes(2, {0}), terms_of(tether(r, t, rho), weight_on(X, 1, Vec3(0, 0, -weight))), 1e-11);
  ASSERT_EQ(found.result.status, Status::Converged) << found.result.message;
  const double d = r + std::pow(rho, 1.5) * std::sqrt(weight / (3 * t));
  EXPECT_NEAR(d, 1.25, 1e-15);
  EXPECT_NEAR((found.x.col(1) - found.x.col(0)).norm(), d, 1e-9);
  EXPECT_NEAR((found.x.col(1) - Vec3(0, 0, -d)).norm(), 0, 1e-9);
  double energy = 0;
  for (const TermReport& term : found.result.terms)
    if (term.name == "tether") energy = term.energy;
  EXPECT_NEAR(energy, 0.25, 1e-9);
}

TEST(Tether, C1sContributesExactlyNothingWhenSlack) {
  for (const double d : {0.999999, 0.5, 0.0}) {
    const double length = 1;
    Eigen::Vector<double, 6> x, g;
    x << 0.3, 0.2, 0.1, 0.3 + d * 0.6, 0.2, 0.1 + d * 0.8;
    Eigen::Matrix<double, 6, 6> H;
    EXPECT_EQ(TetherCubic::evaluate({2, length, 0.5}, x, &g, &H), 0);
    EXPECT_EQ(g.cwiseAbs().maxCoeff(), 0);
    EXPECT_EQ(H.cwiseAbs().maxCoeff(), 0);
    EXPECT_EQ(Cable::evaluate({2, length, 0, 0}, x, &g, &H), 0);
    EXPECT_EQ(g.cwiseAbs().maxCoeff(), 0);
    EXPECT_EQ(H.cwiseAbs().maxCoeff(), 0);
  }
}

TEST(Tether, IsTwiceContinuouslyDifferentiableAtItsLength) {
  Eigen::Vector<double, 6> x = Eigen::Vector<double, 6>::Zero(), g;
  Eigen::Matrix<double, 6, 6> H;
  x[3] = 1;
  EXPECT_EQ(TetherCubic::evaluate({2, 1, 0.5}, x, &g, &H), 0);
  EXPECT_EQ(H.norm(), 0);
  x[3] = 1 + 1e-9;
  TetherCubic::evaluate({2, 1, 0.5}, x, &g, &H);
  EXPECT_LT(H.norm(), 1e-6);  // 6 t e / rho^3: continuous, no jump
}

TEST(Lines, WithCoincidentEndsGiveNoNaN) {
  const Eigen::Vector<double, 6> x = Eigen::Vector<double, 6>::Constant(0.4);
  Eigen::Vector<double, 6> g;
  Eigen::Matrix<double, 6, 6> H;
  EXPECT_EQ(TetherCubic::evaluate({2, 0, 0.5}, x, &g, &H), 0);
  EXPECT_TRUE(g.allFinite() && H.allFinite());
  EXPECT_EQ(Cable::evaluate({2, 0.5, 0.1, 0.7}, x, &g, &H), 0);
  EXPECT_TRUE(g.allFinite() && H.allFinite());
}

// A chain of n links between two points at distance 1 on the level.
struct Chain {
  Points X;  // rest: a parabola a little above the answer, links then stretched to their length
  Segments links;
  FixedMask fixed;

  Chain(int n, double length) : X(3, n + 1), links(2, n), fixed(fixed_nodes(n + 1, {0, n})) {
    const double sag = std::sqrt(3.0 / 8 * (length - 1));  // of a shallow parabola of that length
    for (int k = 0; k <= n; ++k) {
      const double s = static_cast<double>(k) / n;
      X.col(k) = Vec3(s, 0, -4 * sag * s * (1 - s));
    }
    for (int k = 0; k < n; ++k) links.col(k) << k, k + 1;
  }
};

// Sag of a chain of total length 1.2 and weight 1 hung as n stiff links, EA = 1e6.
double hung_sag(int n) {
  const Chain chain(n, 1.2);
  Points weights = Points::Zero(3, n + 1);
  for (int k = 0; k < n; ++k)
    for (int end : {k, k + 1}) weights(2, end) -= 0.5 / n;
  const Equilibrium found = find_equilibrium(
      chain.X, chain.fixed,
      terms_of(cable_term(chain.links, 1e6, Vector::Constant(n, 1.2 / n)),
               std::make_unique<LoadDead>("weight", "load_field", weights, chain.X)),
      1e-7, "bfgs");  // EA epsilon / link length: forces of stiff links are known to some 1e-9
  EXPECT_EQ(found.result.status, Status::Converged) << found.result.message;
  return -found.x.row(2).minCoeff();
}

TEST(Chain, C3aHangsInACatenary) {
  const double c = root([](double p) { return 2 * p * std::sinh(1 / (2 * p)) - 1.2; }, 0.05, 10);
  const double sag = c * (std::cosh(1 / (2 * c)) - 1);
  EXPECT_NEAR(c, 0.469541523, 1e-9);
  EXPECT_NEAR(sag, 0.292343798, 1e-9);
  const double coarse = hung_sag(10) - sag, middle = hung_sag(20) - sag, fine = hung_sag(40) - sag;
  EXPECT_LT(std::abs(fine) / sag, 1e-3);
  EXPECT_GT(observed_order(coarse, middle), 1.9);
  EXPECT_GT(observed_order(middle, fine), 1.9);
}

TEST(Chain, C3bOfRigidLinksMatchesTheDiscreteSolution) {
  const int n = 20;
  const double length = 0.06;
  // With horizontal force H the k-th link carries the vertical force 9.5 - k; links are straight.
  const auto along = [&](double H, bool is_drop) {
    double sum = 0;
    for (int k = 0; k < (is_drop ? n / 2 : n); ++k) {
      const double V = 9.5 - k, T = std::hypot(H, V);
      sum += length * (is_drop ? V : H) / T;
    }
    return sum;
  };
  const double H = root([&](double h) { return along(h, false) - 1; }, 1, 50), sag = along(H, true);
  EXPECT_NEAR(H, 7.81995341, 1e-8);
  EXPECT_NEAR(sag, 0.292721475, 1e-9);
  EXPECT_NEAR(std::hypot(H, 9.5), 12.3045386, 1e-7);

  const Chain chain(n, n * length);
  Points weights = Points::Zero(3, n + 1);
  weights.row(2).segment(1, n - 1).setConstant(-1);
  const double stiffness = 1e9;  // EA/r of each link: its elongation T/k is 1e-8
  Terms terms = terms_of(cable_term(chain.links, stiffness * length, Vector::Constant(n, length)),
                         std::make_unique<LoadDead>("weight", "load_field", weights, chain.X));
  Objective objective(chain.X, chain.fixed, std::move(terms));
  StopRule stop;
  stop.tolerance = 1e-7;  // k epsilon is 2e-7 of a force of 12
  const Result result =
      solve(*built_in_solvers().at("bfgs")({}), {objective, objective.unknowns(chain.X), {}}, stop);
  ASSERT_EQ(result.status, Status::Converged) << result.message;
  const Points x = objective.positions(result.q), support = objective.reactions(result.q);
  EXPECT_NEAR(-x.row(2).minCoeff() / sag, 1, 1e-6);
  EXPECT_NEAR(std::abs(support(0, 0)) / H, 1, 1e-6);
  EXPECT_NEAR(support.col(n).norm() / std::hypot(H, 9.5), 1, 1e-6);
  EXPECT_LT(objective.balance(result.q).force, 1e-6);
}

TEST(Wire, C5DeflectsUnderACentralLoadFromASingularStart) {
  Points X(3, 3);
  X << -0.5, 0, 0.5, 0, 0, 0, 0, 0, 0;
  Segments bars(2, 2);
  bars << 0, 1, 1, 2;
  const Equilibrium found = find_equilibrium(
      X, fixed_nodes(3, {0, 2}),
      terms_of(cable_term(bars, 100, Vector::Constant(2, 0.5)), weight_on(X, 1, Vec3(0, 0, -0.1))), 1e-11);
  ASSERT_EQ(found.result.status, Status::Converged) << found.result.message;
  // 2 EA (l - r)/r sin(a) = P with l = sqrt(r^2 + d^2), sin(a) = d/l
  const double deflection = root(
      [](double d) {
        const double l = std::hypot(0.5, d);
        return 2 * 100 * (l - 0.5) / 0.5 * d / l - 0.1;
      },
      1e-6, 1);
  EXPECT_NEAR(deflection, 0.0501252083, 1e-10);
  EXPECT_NEAR(-found.x(2, 1), deflection, 1e-9);
}

}  // namespace
}  // namespace coapt
