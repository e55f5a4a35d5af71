// Edge springs: every law in every mode through the term suite, against the law written anew, and against
// closed forms.
#include "energy/kernels/spring.hpp"

#include "energy/project_psd.hpp"
#include "membrane_patch.hpp"
#include "support/spring_sheet.hpp"
#include "support/term_suite.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <tuple>

namespace coapt {
namespace {

static_assert(ProjectsItself<Spring> && HasKink<Spring>);

constexpr double kSpringThickness = 0.4;

// A law, in units of `stress`.
struct SpringCurve {
  const char* name;
  SpringSheet (*sheet)(double stress);
};

SpringSheet linear(double stress) { return linear_springs(2 * stress, kSpringThickness); }

SpringSheet bilinear(double stress) {
  SpringSheet sheet = linear_springs(stress, kSpringThickness);
  sheet.fibre.knee = sheet.cross.knee = {9 * stress, 0.2, 0.05};
  return sheet;
}

SpringSheet orthotropic(double stress) {
  SpringSheet sheet = bilinear(stress);
  sheet.cross = {0.3 * stress, {1.7 * stress, 0.3, 0.04}};
  sheet.direction = Vec3(std::cos(0.4), std::sin(0.4), 0);
  return sheet;
}

// A state and how springs take it.
struct Mode {
  const char* name;
  double f11, f12, f22;
  double smoothing;
  bool resists;
};

class SpringLaw : public testing::TestWithParam<std::tuple<SpringCurve, Mode>> {
 protected:
  TermCase test_case() const {
    const auto& [law, mode] = GetParam();
    const TriangleMesh mesh = patch();
    TermCase c;
    c.label = std::string(law.name) + ", " + mode.name;
    c.rest = mesh.vertices;
    c.state = shaken(deformation(mode.f11, mode.f12, mode.f22) * mesh.vertices, 0.01, 4);
    c.reach = 2e-3;
    c.make = [this, mesh](const Frame& frame) -> std::unique_ptr<EnergyTerm> {
      SpringSheet sheet = this->sheet(frame.force / (frame.length * frame.length));
      sheet.thickness *= frame.length;
      sheet.direction = frame.rotation * sheet.direction;
      return spring_term(frame.points(mesh.vertices), frame.triangles(mesh.triangles), sheet);
    };
    return c;
  }

  SpringSheet sheet(double stress) const {
    const auto& [law, mode] = GetParam();
    SpringSheet sheet = law.sheet(stress);
    sheet.smoothing = mode.smoothing;
    sheet.resists = mode.resists;
    return sheet;
  }
};

// Each triangle's area times thickness times the energy per volume of its three edges, which comes to the
// same as cross-sections and lengths.
struct Oracle {
  TriangleMesh mesh;
  SpringSheet sheet;

  template <typename T>
  T operator()(const std::vector<AutoVec<T>>& x) const {
    T energy = T(0.0);
    for (const auto& t : mesh.triangles.colwise())
      for (int k = 0; k < 3; ++k) {
        const int a = t[k], b = t[(k + 1) % 3];
        const Vec3 rest = mesh.vertices.col(b) - mesh.vertices.col(a);
        const double along = rest.dot(sheet.direction);
        const double share = along * along / rest.squaredNorm();
        const T e = T(times(1 / rest.norm(), norm(AutoVec<T>(x[b] - x[a]))) - T(1.0));
        if (number(e) <= 0 && !sheet.resists) continue;
        const T rho = rounded(e);
        const T w = T(times(share, curve(sheet.fibre, rho)) + times(1 - share, curve(sheet.cross, rho)));
        energy = T(energy + times(sheet.thickness * area_vector(mesh.vertices, t).norm(), w));
      }
    return energy;
  }

  template <typename T>
  T rounded(const T& e) const {
    using std::sqrt;
    if (sheet.resists || number(e) >= sheet.smoothing) return e;
    const T u = times(1 / sheet.smoothing, e), root = T(sqrt(u));
    const T bracket = T(T(T(15.0) - times(10, u)) + times(3, T(u * u)));
    return times(sheet.smoothing / 8, T(T(u * root) * bracket));
  }

  template <typename T>
  static T curve(const BilinearLine& line, const T& e) {
    const auto& [modulus, transition, window] = line.knee;
    const T linear = times(0.5 * line.young, T(e * e)), past = T(e - T(transition));
    if (number(past) <= -window) return linear;
    if (number(past) >= window)
      return T(linear + times(0.5 * modulus, T(T(past * past) + T(window * window / 3))));
    const T in = T(past + T(window));
    return T(linear + times(modulus / (12 * window), T(T(in * in) * in)));
  }
};

TEST_P(SpringLaw, PassesTheSuite) {
  EXPECT_EQ(examine_term(test_case()), "");
  EXPECT_EQ(compare_with_autodiff(test_case(), Oracle{patch(), sheet(1)}), "");
}

// Eigenvalues by a decomposition, the negative ones cut off.
TEST_P(SpringLaw, ProjectsLikeAnEigenvalueDecomposition) {
  const TermCase c = test_case();
  const TriangleMesh mesh = patch();
  const auto term = spring_term(mesh.vertices, mesh.triangles, sheet(1));
  bool has_negative = false;
  for (size_t k = 0; k < term->rest().size(); ++k) {
    Eigen::Vector<double, 6> x, g, projected_g;
    x << c.state.col(term->stencils().nodes[2 * k]), c.state.col(term->stencils().nodes[2 * k + 1]);
    Eigen::Matrix<double, 6, 6> H, projected;
    EXPECT_EQ(Spring::evaluate(term->rest()[k], x, &g, &H),
              Spring::evaluate_projected(term->rest()[k], x, &projected_g, &projected));
    EXPECT_EQ(g, projected_g);
    const double scale = H.norm();
    const Eigen::Matrix<double, 6, 6> exact = H;
    project_psd(H);
    has_negative |= (H - exact).norm() > 1e-9 * scale;
    EXPECT_LE((H - projected).norm(), 1e-12 * scale);
  }
  EXPECT_EQ(has_negative, std::get<1>(GetParam()).resists && std::get<1>(GetParam()).f22 < 1);
}

constexpr SpringCurve kLaws[] = {{"linear", linear}, {"bilinear", bilinear}, {"orthotropic", orthotropic}};
constexpr Mode kModes[] = {{"stretched, resisting", 1.12, 0, 1.08, 0.002, true},
                           {"sheared beyond the knees, resisting", 1.6, 0.3, 1.5, 0.002, true},
                           {"compressed, resisting", 0.85, 0.1, 0.9, 0.002, true},
                           {"taut", 1.12, 0, 1.08, 0.002, false},
                           {"in the windows of the knees", 1.2, 0.05, 1.22, 0.002, false},
                           {"beyond the knees", 1.6, 0.3, 1.5, 0.002, false},
                           {"partly slack", 1.3, 0.1, 0.7, 0.002, false},
                           {"rounded", 1.12, 0, 1.08, 0.9, false}};

INSTANTIATE_TEST_SUITE_P(All, SpringLaw,
                         testing::Combine(testing::ValuesIn(kLaws), testing::ValuesIn(kModes)));

// One spring of the law under test: length 2, cross-section 0.3.
Spring::Rest one(const BlendedLine& law, bool resists = false) {
  return {2, 0.3, resists ? 0 : 0.002, resists, law};
}

TEST(Spring, FollowsTheClosedForms) {
  const BilinearLine along{1, {9, 0.2, 0.05}}, across{0.4, {1.6, 0.3, 0.02}};
  const auto curve = [](const BilinearLine& line, double e) {
    const auto& [modulus, transition, window] = line.knee;
    const double past = std::max(0.0, e - transition + window);
    return line.young * e +
           (e >= transition + window ? modulus * (e - transition) : modulus * past * past / (4 * window));
  };
  for (const double share : {0.0, 0.25, 1.0})
    for (const double e : {-0.3, 0.01, 0.1, 0.21, 0.29, 0.7}) {
      const double stress = share * curve(along, e) + (1 - share) * curve(across, e);
      const BlendedLine law = blended(along, across, share);
      EXPECT_NEAR(Spring::elastic(one(law, true), e).force, 0.3 * stress, 1e-14) << share << " at " << e;
      EXPECT_NEAR(Spring::elastic(one(law), e).force, e > 0 ? 0.3 * stress : 0, 1e-14)
          << share << " at " << e;
    }
  EXPECT_NEAR(Spring::elastic(one(blended(along, along, 1), true), -0.3).stiffness, 0.3 * 1 / 2.0, 1e-15);
}

// k = E h (A_1 + A_2)/r^2.
TEST(Spring, HasVanGeldersStiffness) {
  const double young = 3, thickness = 0.2, length = 1.7, first = 0.8, second = 1.1;
  const BlendedLine law = blended({young, {}}, {young, {}}, 1);
  Spring::Rest spring = Spring::rest(length, first, thickness, law, 0.002, true);
  EXPECT_NEAR(Spring::elastic(spring, 0).stiffness, young * thickness * first / (length * length), 1e-15);
  ASSERT_TRUE(join(spring, Spring::rest(length, second, thickness, law, 0.002, true)));
  EXPECT_NEAR(Spring::elastic(spring, 0).stiffness, young * thickness * (first + second) / (length * length),
              1e-15);
}

TEST(Spring, IsTheSumOfThePartsThatItJoins) {
  const BilinearLine soft{1, {9, 0.2, 0.05}}, stiff{4, {3, 0.2, 0.05}}, later{4, {3, 0.4, 0.05}};
  const auto part = [](double area, const BlendedLine& law) {
    return Spring::rest(2, area, 0.5, law, 0.1, false);
  };
  const Spring::Rest a = part(0.3, blended(soft, soft, 0.3)), b = part(0.9, blended(stiff, soft, 0.8));
  Spring::Rest sum = a;
  ASSERT_TRUE(join(sum, b));
  for (const double e : {-0.1, 0.05, 0.19, 0.5}) {
    const AxialLaw whole = Spring::elastic(sum, e), one = Spring::elastic(a, e),
                   other = Spring::elastic(b, e);
    EXPECT_NEAR(whole.energy, one.energy + other.energy, 1e-14);
    EXPECT_NEAR(whole.force, one.force + other.force, 1e-14);
    EXPECT_NEAR(whole.stiffness, one.stiffness + other.stiffness, 1e-14);
  }
  EXPECT_FALSE(join(sum, part(0.1, blended(later, later, 1))));
  EXPECT_EQ(sum.area, a.area + b.area);
}

TEST(Spring, IsFiniteWhereItsEndsMeet) {
  const Spring::Rest rest = one(blended({3, {}}, {3, {}}, 1), true);
  for (const double l : {0.0, 1e-300, 1e-14}) {
    const Eigen::Vector<double, 6> x{1, 1, 1, 1 + l, 1, 1};
    Eigen::Vector<double, 6> g;
    Eigen::Matrix<double, 6, 6> H;
    for (const auto evaluate : {&Spring::evaluate, &Spring::evaluate_projected}) {
      EXPECT_NEAR(evaluate(rest, x, &g, &H), 0.5 * 3 * 0.3 * 2, 1e-9);
      EXPECT_TRUE(g.allFinite() && H.allFinite());
    }
  }
}

TEST(Spring, CanBeRoundedMoreForAWhile) {
  ElementTerm<Spring> term("springs", {0, 1}, {one(blended({1, {9, 0.2, 0.01}}, {1, {9, 0.2, 0.01}}, 1))});
  Points x = Points::Zero(3, 2);
  x(0, 1) = 2.38;
  Sink value_only;
  const double sharp = term.evaluate(x, value_only);
  EXPECT_TRUE(term.round_kinks(0.5));
  EXPECT_NE(term.evaluate(x, value_only), sharp);
  EXPECT_EQ(term.rest()[0].law.first.window, 0.2);  // no further than the rest state
  term.round_kinks(0);
  EXPECT_EQ(term.evaluate(x, value_only), sharp);
}

}  // namespace
}  // namespace coapt
