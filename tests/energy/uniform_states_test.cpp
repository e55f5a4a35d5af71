// One triangle of each membrane law in a uniform strain: uniaxial, biaxial and sheared, against the closed
// forms of its stress; isotropy and objectivity; the crimped fibre against its definition.
#include "support/single_triangle.hpp"
#include "support/tissue_answers.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace coapt {
namespace {

constexpr double kQuarter = std::numbers::pi / 2;

template <typename Entry>
class UniformState : public testing::Test {
 protected:
  using Law = decltype(Entry::law(1));
  static constexpr bool kIsIsotropic = requires { IsotropicName<Law>::kType; };

  static Single<Law> single(const Eigen::Matrix2d& F, double angle, bool relaxes) {
    return Single<Law>(Entry::law(1), F, angle, relaxes);
  }

  // The width at which a strip stretched by l is free of stress across.
  static double free_width(double l, double angle) {
    double narrow = 0.4, wide = 1.05;
    for (int k = 0; k < 100; ++k) {
      const double middle = 0.5 * (narrow + wide);
      (nominal_stress<Entry>(plane(l, 0, middle), angle)(1, 1) < 0 ? narrow : wide) = middle;
    }
    return wide;
  }

  static void expect_stress(const Single<Law>& found, const Eigen::Matrix2d& F, double angle) {
    const Eigen::Matrix2d expected = nominal_stress<Entry>(F, angle);
    EXPECT_GT(expected.norm(), 0);
    EXPECT_LT((found.nominal() - expected).norm(), 1e-8 * expected.norm())
        << "fibre at " << angle << ", F =\n"
        << F << "\nP =\n"
        << found.nominal() << "\nnot\n"
        << expected;
    EXPECT_NEAR(found.density() / energy_density<Entry>(F, angle), 1, 1e-8) << "fibre at " << angle << "\n"
                                                                            << F;
  }

  // A state without compression is the same with and without relaxation.
  static void expect_follows(const Eigen::Matrix2d& F, double angle) {
    expect_stress(single(F, angle, false), F, angle);
    const Eigen::Matrix2d S = F.inverse() * nominal_stress<Entry>(F, angle);
    if (S.trace() > 0 && S.determinant() > 0) expect_stress(single(F, angle, true), F, angle);
  }
};
TYPED_TEST_SUITE(UniformState, MembraneLaws, LawNames);

// Uniaxial tension: a strip with free sides, and whatever narrower width its wrinkles leave it.
TYPED_TEST(UniformState, AStripPulledAlongOrAcrossTheFibre) {
  for (const double angle : {0.0, kQuarter})
    for (const double l : {1.01, 1.1, 1.2, 1.3, 1.4}) {
      const Eigen::Matrix2d F = plane(l, 0, this->free_width(l, angle));
      this->expect_stress(this->single(F, angle, false), F, angle);
      for (const double width : {0.99 * F(1, 1), 0.3}) {
        const auto wrinkled = this->single(plane(l, 0, width), angle, true);
        const double expected = nominal_stress<TypeParam>(F, angle)(0, 0);
        EXPECT_NEAR(wrinkled.nominal()(0, 0) / expected, 1, 1e-8) << l << " by " << width;
        EXPECT_LT((wrinkled.nominal() - plane(wrinkled.nominal()(0, 0), 0, 0)).norm(), 1e-8 * expected);
        EXPECT_NEAR(wrinkled.density() / energy_density<TypeParam>(F, angle), 1, 1e-8);
      }
    }
}

TYPED_TEST(UniformState, ASheetPulledOneWayAtItsWidthBothWaysAlikeAndUnlike) {
  for (const double angle : {0.0, 0.5, kQuarter})
    for (const double l : {1.05, 1.2, 1.35}) {
      this->expect_follows(plane(l, 0, 1), angle);
      this->expect_follows(plane(l, 0, l), angle);
      this->expect_follows(plane(l, 0, 1.1), angle);
    }
}

TYPED_TEST(UniformState, ASheetInSimpleShearAtRestAndStretched) {
  for (const double angle : {0.0, 0.5, kQuarter})
    for (const double shear : {0.05, 0.2, 0.4}) {
      this->expect_follows(plane(1, shear, 1), angle);
      this->expect_follows(plane(1.2, shear, 1.1), angle);
    }
}

// Turning the sheet at rest under the same deformation: nothing to an isotropic law, and to the others only
// where the fibre does not turn with it. Turning the deformed sheet: nothing to any.
TYPED_TEST(UniformState, IsIsotropicWhereItShouldBeAndObjective) {
  for (const Eigen::Matrix2d& F : {plane(1.25, 0.1, 1.05), plane(1.1, -0.2, 0.95)}) {
    const auto reference = this->single(F, 0, false);
    for (const double angle : {0.3, 0.8, 1.4}) {
      const Eigen::Matrix2d R = Eigen::Rotation2Dd(angle).toRotationMatrix();
      const auto turned = this->single(F * R, 0, false), together = this->single(F * R, -angle, false),
                 moved = this->single(R * F, 0, false);
      if (this->kIsIsotropic) {
        EXPECT_NEAR(turned.density() / reference.density(), 1, 1e-12);
        EXPECT_LT((turned.nominal() - reference.nominal() * R).norm(), 1e-12 * reference.nominal().norm());
      } else {
        EXPECT_GT(std::abs(turned.density() / reference.density() - 1), 0.01);
      }
      EXPECT_NEAR(together.density() / reference.density(), 1, 1e-12);
      EXPECT_LT((together.nominal() - reference.nominal() * R).norm(), 1e-12 * reference.nominal().norm());
      EXPECT_NEAR(moved.density() / reference.density(), 1, 1e-12);
      EXPECT_LT((moved.nominal() - R * reference.nominal()).norm(), 1e-12 * reference.nominal().norm());
    }
  }
}

// The laws' own words, without a width that must be found: uniaxial tension whatever the width held.
TEST(Strip, FollowsTheCurveThatNamesItsLaw) {
  const auto pulled = [](const auto& law, double l, double fibre_angle = 0) {
    return Single(law, plane(l, 0, 0.3), fibre_angle).nominal()(0, 0);
  };
  for (const double l : {1.01, 1.1, 1.2, 1.3, 1.4}) {
    const double e = l - 1, j = l * l + 2 / l - 3, slope = 2 * (l - 1 / (l * l));
    EXPECT_NEAR(pulled(laws::Bilinear::law(1), l), 0.1 * e + answers::past_knee(e, 5.9, 0.25, 0.05), 1e-8);
    EXPECT_NEAR(pulled(laws::NeoHookean::law(1), l), 0.15 * slope, 1e-8);
    EXPECT_NEAR(pulled(laws::Exponential::law(1), l), (0.025 + 0.06 * j * std::exp(3 * j * j)) * slope, 1e-8);
    EXPECT_NEAR(pulled(laws::Orthotropic::law(1), l), 0.2 * e + answers::past_knee(e, 4, 0.15, 0.04), 1e-8);
    EXPECT_NEAR(pulled(laws::Orthotropic::law(1), l, kQuarter),
                0.08 * e + answers::past_knee(e, 1, 0.3, 0.04), 1e-8);
    const double grown = 0.02 * std::exp(1.5 * j * j + 20 * std::pow(e, 4));
    EXPECT_NEAR(pulled(laws::MayNewmanYin::law(1), l) / (grown * (3 * j * slope + 80 * std::pow(e, 3))), 1,
                1e-8);
  }
}

TEST(CrimpedFibre, IsTheHelixThatIsPulledStraight) {
  for (const double window : {0.0, 0.02}) {
    const CrimpedFibre fibre(8, 9, 1.6, window);
    const oracle::CrimpedCurve helix{8, 9, 1.6, window};
    EXPECT_NEAR(fibre.limit(), helix.limit, 1e-14);
    for (double l = 1.002; l < 1.4 * helix.limit; l += 0.007) {
      AutoInner stretch(l);
      stretch.derivatives()[0] = 1;
      const AutoInner stress = helix.stress(stretch);
      EXPECT_NEAR(fibre.at(l - 1).stress / stress.value(), 1, 1e-11) << l;
      EXPECT_NEAR(fibre.at(l - 1).stiffness / stress.derivatives()[0], 1, 1e-10) << l;
      EXPECT_NEAR(fibre.at(l - 1).energy / helix.energy(l), 1, 1e-10) << l;
    }
    EXPECT_EQ(fibre.at(-0.1).stress, 0);
    EXPECT_LT(fibre.at(0.5 * (fibre.limit() - 1)).stiffness, 0.2 * 8);
  }
}

// The strut chord of Toma et al. 2016: H0/r0 1.35, R0/r0 5, fibres of 48 MPa in a matrix of 10 kPa. Its
// fibres are straight at a stretch of 23 only; before, the matrix bears all but a thousandth of the stress.
TEST(CrimpedFibre, InAMatrixHasTheStiffnessOfTheMatrixBeforeItIsStraight) {
  const CrimpedLine strut{CrimpedFibre(48, 1.35 / 5, 5, 0.005), 0.01};
  EXPECT_NEAR(strut.fibre.limit(), 23.3, 0.05);
  for (const double l : {1.001, 1.1, 1.5, 2.0}) {
    const double matrix = 0.01 * (l - 1 / (l * l));
    EXPECT_NEAR(strut.at(l - 1).stress - strut.fibre.at(l - 1).stress, matrix, 1e-15) << l;
    EXPECT_NEAR(strut.at(l - 1).energy - strut.fibre.at(l - 1).energy, 0.005 * (l * l + 2 / l - 3), 1e-15)
        << l;
    EXPECT_LT(strut.fibre.at(l - 1).stress, 0.05 * matrix) << l;
  }
}

TEST(CrimpedFibre, KeepsAShareOfItsStiffnessBeyondItsYield) {
  const CrimpedFibre whole(8, 9, 1.6, 0.02), yielding = whole.yielding(0.1, 0.75);
  EXPECT_TRUE(std::isinf(whole.yield_elongation()));
  const double yield = yielding.yield_elongation();
  EXPECT_NEAR(yield, whole.limit() * 1.1 - 1, 1e-14);
  for (const double e : {0.01, 0.1, 0.9 * yield}) EXPECT_EQ(yielding.at(e).stress, whole.at(e).stress) << e;
  const double far = yield + 0.05, slope = 8 / whole.limit();
  EXPECT_NEAR(yielding.at(far).stiffness, 0.25 * slope, 1e-12);
  EXPECT_NEAR(yielding.at(far).stress, whole.at(far).stress - 0.75 * slope * 0.05, 1e-12);
  EXPECT_EQ(whole.yielding(0.1, 0).at(far).stress, whole.at(far).stress);  // told of, and no more
}

// K of a mean over directions, for a direction in the plane; what fibres out of the plane pull.
TEST(CrimpedFibre, DispersionIsTheMeanOverDirectionsInSpace) {
  for (const double angle : {0.0, 0.6, kQuarter})
    for (const double out : {0.0, 0.3, 1.2}) {
      const FibreDispersion k = fibre_dispersion(0.4, out, angle);
      const Eigen::Matrix3d K = oracle::mean_of_directions(0.4, out, angle);
      EXPECT_NEAR(k.k11, K(0, 0), 1e-12);
      EXPECT_NEAR(k.k22, K(1, 1), 1e-12);
      EXPECT_NEAR(k.k12, K(0, 1), 1e-12);
      EXPECT_NEAR(k.k33, K(2, 2), 1e-12);
    }
  CrimpedFibreLaw flat = laws::Crimped::law(1), deep = flat;
  deep.splay_out_of_plane = 0.5;
  const Eigen::Matrix2d pulled = plane(1.2, 0, 1.2);  // thinner: the fibres through it grow shorter
  EXPECT_LT(Single(deep, pulled).density(), 0.9 * Single(flat, pulled).density());
}

// Elongation over that at yield, of the greater of both populations, behind wrinkles too.
TEST(CrimpedFibre, TellsHowNearItIsToItsYield) {
  using Kernel = CstCrimpedFibre;
  CrimpedFibreLaw law = laws::Crimped::law(1);
  law.splay = 0;
  law.fibre = law.fibre.yielding(0.1, 0);
  const double yield = law.fibre.yield_elongation();
  const auto ratio = [](const CrimpedFibreLaw& of, const Eigen::Matrix2d& F) {
    const Single<CrimpedFibreLaw> s(of, F);
    return Kernel::yield_ratio(s.rest, s.x, nullptr);
  };
  EXPECT_NEAR(ratio(law, plane(1 + yield, 0, 1)), 1, 1e-12);
  EXPECT_NEAR(ratio(law, plane(1 + yield, 0, 0.3)), 1, 1e-9);
  EXPECT_EQ(ratio(law, plane(0.9, 0, 1 + yield)), 0);
  EXPECT_EQ(ratio(law, plane(0.9, 0, 0.9)), 0);
  law.second_population = 0.1;
  EXPECT_NEAR(ratio(law, plane(1, 0, 1 + 0.5 * yield)), 0.5, 1e-12);
}

TEST(CrimpedFibre, ItsNearnessToYieldHasExactDerivativesTautAndWrinkled) {
  for (const auto& F : {plane(1.2, 0.1, 1.1), plane(1.3, 0.1, 0.6), plane(0.7, -0.1, 1.3)}) {
    const CrimpedFibreLaw law = laws::CrimpedPopulations::oblique(1, 1.1);
    const Single<CrimpedFibreLaw> s(law, F, 0.4);
    CstVector g;
    CstCrimpedFibre::yield_ratio(s.rest, s.x, &g);
    EXPECT_GT(g.norm(), 0.1);
    for (int k = 0; k < 9; ++k) {
      constexpr double kStep = 1e-5;
      const auto at = [&](double by) {
        CstVector x = s.x;
        x[k] += by * kStep;
        return CstCrimpedFibre::yield_ratio(s.rest, x, nullptr);
      };
      EXPECT_NEAR(g[k], (8 * (at(1) - at(-1)) - (at(2) - at(-2))) / (12 * kStep), 1e-7) << F << "\n" << k;
    }
  }
}

// A tissue that had shrunk by a tenth along its fibres when its shape was taken is at rest when it is that
// much longer, and has then the energy of its greater volume.
TEST(RestShape, IsTheReferenceShapeScaledAlongTheFibreAndAcross) {
  const Points X = (Points(3, 3) << 0, 1.1, 0.3, 0, 0.1, 0.9, 0, 0, 0).finished();
  const Vec3 fibre(std::cos(0.7), std::sin(0.7), 0);
  const Eigen::Matrix2d Q = Eigen::Rotation2Dd(0.7).toRotationMatrix();
  const CrimpedFibreLaw law = laws::Crimped::law(1);
  const auto deformed = [&](const Eigen::Matrix2d& F) {
    Points x = X;
    x.topRows<2>() = F * X.topRows<2>();
    return CstVector(Eigen::Map<const CstVector>(x.data()));
  };
  const auto grown = CstCrimpedFibre::rest(X.col(0), X.col(1), X.col(2), fibre, law, 0.4, true, {1.1, 0.95});
  const auto plain = CstCrimpedFibre::rest(X.col(0), X.col(1), X.col(2), fibre, law, 0.4);
  const Eigen::Matrix2d scale = Q * Eigen::Vector2d(1.1, 0.95).asDiagonal() * Q.transpose();
  CstVector g;
  EXPECT_NEAR(CstCrimpedFibre::evaluate(grown, deformed(scale), &g, nullptr), 0, 1e-15);
  EXPECT_LT(g.norm(), 1e-14);
  const Eigen::Matrix2d F = Q * plane(1.2, 0.1, 1.05) * Q.transpose();
  EXPECT_NEAR(CstCrimpedFibre::evaluate(grown, deformed(F * scale), nullptr, nullptr) /
                  CstCrimpedFibre::evaluate(plain, deformed(F), nullptr, nullptr),
              1.1 * 0.95, 1e-12);
  // With other corners in reference it keeps its scales.
  const Corners from{X.col(0), X.col(1), X.col(2)}, to{2 * X.col(0), 2 * X.col(1), 2 * X.col(2)};
  const auto twice = CstCrimpedFibre::reshaped(grown, from, to);
  EXPECT_NEAR(twice.volume / grown.volume, 4, 1e-12);
  EXPECT_NEAR(CstCrimpedFibre::evaluate(twice, 2 * deformed(scale), nullptr, nullptr), 0, 1e-14);
}

// Fibres in all directions alike are isotropic.
TEST(CrimpedFibre, SplayedEvenlyIsIsotropic) {
  CrimpedFibreLaw even = laws::Crimped::law(1);
  even.splay = 10;
  const Eigen::Matrix2d F = plane(1.25, 0.1, 1.05);
  EXPECT_NEAR(Single(even, F, 0.7, false).density() / Single(even, F, 0, false).density(), 1, 1e-12);
}

}  // namespace
}  // namespace coapt
