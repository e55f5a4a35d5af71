// Where the laws with a fibre are convex in C (docs/theory.md, "Laws with a fibre").
#include "energy/laws/fibrous.hpp"

#include <gtest/gtest.h>

#include <random>

namespace coapt {
namespace {

struct PlaneState {
  double along, across, c12;  // stretches of the axes; sheared by less than the least that folds
};

std::vector<PlaneState> random_states(double greatest) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> stretch(0.7, greatest), shear(-0.8, 0.8);
  std::vector<PlaneState> states(4000);
  for (PlaneState& s : states) {
    s.along = stretch(random);
    s.across = stretch(random);
    s.c12 = shear(random) * s.along * s.across;
  }
  return states;
}

// The least eigenvalue of the tangent over its greatest.
template <typename Law>
double least_share(const Law& law, const PlaneState& s) {
  const auto tangent = law.evaluate(s.along * s.along, s.across * s.across, s.c12).tangent;
  const Eigen::Vector3d values = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(tangent).eigenvalues();
  return values[0] / values[2];
}

TEST(ConvexInC, MayNewmanYinIsEverywhere) {
  MayNewmanYinLaw law{0.4e-3, 4.3, 1446};
  law.limit_stress(10);
  for (const PlaneState& s : random_states(1.6)) EXPECT_GT(least_share(law, s), -1e-12);
}

TEST(ConvexInC, CrimpedFibresAreForEveryCrimp) {
  for (const double crimp : {1.0, 5.0, 27.5})
    for (const double slenderness : {0.3, 1.0, 5.0}) {
      const CrimpedFibreLaw law{0.01, CrimpedFibre(50, crimp, slenderness, 1e-4), 0.3};
      for (const PlaneState& s : random_states(1.6)) EXPECT_GT(least_share(law, s), -1e-12) << crimp;
    }
}

// Where its fibres yield, or their active stress has set in, sigma' < sigma/l: both are exact, neither
// convex.
TEST(ConvexInC, YieldingAndActiveFibresAreNotButPopulationsInSpaceAre) {
  CrimpedFibreLaw law{0.01, CrimpedFibre(50, 5, 1, 1e-4), 0.3};
  law.splay_out_of_plane = 0.3;
  law.second_population = 0.5;
  law.second_angle = 1;
  double least = 1, active_least = 1, yielding_least = 1;
  CrimpedFibreLaw active = law, yielding = law;
  active.fibre = CrimpedFibre(0.01, 5, 1, 1e-4);  // which outweigh it otherwise
  active.shear_modulus = 1e-3;
  active.active_stress = 0.2;
  yielding.fibre = law.fibre.yielding(0.02, 1);
  for (const PlaneState& s : random_states(1.9)) {
    least = std::min(least, least_share(law, s));
    active_least = std::min(active_least, least_share(active, s));
    yielding_least = std::min(yielding_least, least_share(yielding, s));
  }
  EXPECT_GT(least, -1e-12);
  EXPECT_LT(active_least, -1e-6);
  EXPECT_LT(yielding_least, -1e-6);
}

// Below the knees it is where (1 - nu r e_c)(1 - nu e_f/r) > nu^2 l_f l_c, r^2 = E_c/E_f, both factors being
// positive.
TEST(ConvexInC, OrthotropicIsWithinABoundAlone) {
  const double nu = 0.45;
  for (const double ratio : {1.0, 0.2}) {
    const OrthotropicLaw below{1, ratio, {}, {}, nu, 0.3};
    const OrthotropicLaw beyond{1, ratio, {5, 0.15, 0.05}, {4, 0.25, 0.05}, nu, 0.3};
    const double r = std::sqrt(ratio);
    int convex = 0, not_convex = 0;
    for (const PlaneState& s : random_states(2)) {
      const double first = 1 - nu * r * (s.across - 1), second = 1 - nu * (s.along - 1) / r;
      const double margin = first * second - nu * nu * s.along * s.across;
      if (first > 0 && second > 0 && margin > 1e-6) {
        EXPECT_GT(least_share(below, s), 0);
        EXPECT_GT(least_share(beyond, s), 0);  // knees take nothing away
        ++convex;
      } else if (margin < -1e-6) {
        EXPECT_LT(least_share(below, s), 0);
        ++not_convex;
      }
    }
    EXPECT_GT(convex, 500);
    EXPECT_GT(not_convex, 500);
  }
}

}  // namespace
}  // namespace coapt
