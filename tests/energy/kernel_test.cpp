// Every element law through the term suite and against automatic differentiation.
#include "energy/element_term.hpp"
#include "energy/kernels/cable.hpp"
#include "energy/kernels/cst_stvk.hpp"
#include "energy/kernels/facet_volume.hpp"
#include "energy/kernels/link.hpp"
#include "energy/kernels/surface_tension.hpp"
#include "energy/kernels/tether_cubic.hpp"
#include "membrane_patch.hpp"
#include "support/oracles.hpp"
#include "support/term_suite.hpp"

#include <gtest/gtest.h>

namespace coapt {
namespace {

constexpr double kYoung = 2.0, kPoisson = 0.35, kThickness = 0.4;

TermCase membrane_case(const std::string& label, const Eigen::Matrix3d& deformation, double prestress) {
  const TriangleMesh mesh = patch();
  TermCase c;
  c.label = label;
  c.rest = mesh.vertices;
  c.state = shaken(deformation * mesh.vertices, 0.03, 4);
  c.reach = 0.5;
  c.is_zero_at_rest = prestress == 0;
  c.make = [mesh, prestress](const Frame& f) -> std::unique_ptr<EnergyTerm> {
    const Points X = f.points(mesh.vertices);
    const Triangles triangles = f.triangles(mesh.triangles);
    const double stress = f.force / (f.length * f.length);
    std::vector<CstStVK::Rest> rest;
    for (int t = 0; t < triangles.cols(); ++t)
      rest.push_back(CstStVK::rest(X.col(triangles(0, t)), X.col(triangles(1, t)), X.col(triangles(2, t)),
                                   kYoung * stress, kPoisson, kThickness * f.length,
                                   prestress * f.force / f.length));
    return std::make_unique<ElementTerm<CstStVK>>("membrane", triangle_nodes(triangles), rest);
  };
  return c;
}

oracle::StVenantKirchhoff membrane_oracle(double prestress) {
  const TriangleMesh mesh = patch();
  return {mesh.triangles, mesh.vertices, kYoung, kPoisson, kThickness, prestress};
}

TEST(CstStVK, PassesTheSuiteStretched) {
  EXPECT_EQ(examine_term(membrane_case("stretched", deformation(1.3, 0, 1.15), 0)), "");
}
TEST(CstStVK, PassesTheSuiteSheared) {
  EXPECT_EQ(examine_term(membrane_case("sheared", deformation(1.05, 0.4, 1.1), 0)), "");
}
TEST(CstStVK, PassesTheSuiteCompressed) {
  EXPECT_EQ(examine_term(membrane_case("compressed", deformation(0.85, 0.1, 0.9), 0)), "");
}
TEST(CstStVK, PassesTheSuiteWithPrestress) {
  EXPECT_EQ(examine_term(membrane_case("prestressed", deformation(1.2, 0.2, 0.9), 0.6)), "");
}
TEST(CstStVK, AgreesWithAutomaticDifferentiation) {
  for (const double prestress : {0.0, 0.6})
    for (const auto& f :
         {deformation(1.3, 0, 1.15), deformation(1.05, 0.4, 1.1), deformation(0.85, 0.1, 0.9)})
      EXPECT_EQ(compare_with_autodiff(membrane_case("membrane", f, prestress), membrane_oracle(prestress)),
                "");
}

Segments chain() {
  Segments s(2, 4);
  s << 0, 1, 2, 0, 1, 2, 3, 2;
  return s;
}

Points chain_at_rest(double length) {  // all segments at or below `length`
  Points x(3, 4);
  x << 0, 0.9, 0.9, 0.1, 0, 0.1, 0.5, 0.7, 0, 0.2, -0.1, 0.1;
  return x * length;
}

template <typename Kernel>
TermCase line_case(const std::string& label,
                   const std::function<typename Kernel::Rest(const Frame&)>& rest_of, double rest_length,
                   double stretch) {
  TermCase c;
  c.label = label;
  c.rest = 0.7 * chain_at_rest(rest_length);
  c.state = stretch * chain_at_rest(rest_length);
  c.make = [rest_of](const Frame& f) -> std::unique_ptr<EnergyTerm> {
    const Segments s = chain();
    return std::make_unique<ElementTerm<Kernel>>(
        "lines", f.nodes({s.data(), s.data() + s.size()}),
        std::vector<typename Kernel::Rest>(static_cast<size_t>(s.cols()), rest_of(f)));
  };
  return c;
}

TermCase tether_case(double stretch) {
  return line_case<TetherCubic>(
      "tether",
      [](const Frame& f) {
        return TetherCubic::Rest{2.0 * f.force * f.length, 1.0 * f.length, 0.5 * f.length};
      },
      1.0, stretch);
}

TermCase link_case(double length, double stretch) {
  TermCase c = line_case<Link>(
      "link",
      [length](const Frame& f) {
        return Link::Rest{2.0 * f.force / f.length, length * f.length};
      },
      1.0, stretch);
  c.is_zero_at_rest = false;  // its length is its own
  c.reach = 0.05;
  return c;
}

TEST(Link, PassesTheSuitePulledPushedAndWithoutLength) {
  for (const double length : {0.0, 0.3, 1.4}) {
    const TermCase c = link_case(length, 1.1);
    EXPECT_EQ(examine_term(c), "") << length;
    EXPECT_EQ(compare_with_autodiff(c, oracle::Links{chain(), 2.0, length}), "") << length;
  }
}

TEST(Link, HoldsCoincidentEndsWithoutADirection) {
  const Eigen::Vector<double, 6> x = Eigen::Vector<double, 6>::Ones();
  Eigen::Vector<double, 6> g;
  Eigen::Matrix<double, 6, 6> H;
  EXPECT_EQ(Link::evaluate({3, 0}, x, &g, &H), 0);
  EXPECT_EQ(g.norm(), 0);
  EXPECT_EQ(H(0, 0), 3);
  EXPECT_EQ(H(1, 4), -3);
  EXPECT_DOUBLE_EQ(Link::evaluate({3, 2}, x, &g, &H), 6);  // 3/2 2^2
  EXPECT_EQ(g.norm(), 0);
  EXPECT_TRUE(H.allFinite());
}

TEST(TetherCubic, PassesTheSuiteWhenAllAreTaut) {
  TermCase c = tether_case(2.5);
  c.reach = 0.5;
  EXPECT_EQ(examine_term(c), "");
  EXPECT_EQ(compare_with_autodiff(c, oracle::CubicTethers{chain(), 2.0, 1.0, 0.5}), "");
}

TEST(TetherCubic, PassesTheSuiteWhenSomeAreSlack) {
  TermCase c = tether_case(1.4);
  c.reach = 0.05;
  EXPECT_EQ(examine_term(c), "");
  EXPECT_EQ(compare_with_autodiff(c, oracle::CubicTethers{chain(), 2.0, 1.0, 0.5}), "");
}

TermCase cable_case(const std::string& label, double axial_stiffness, double smoothing, double tension,
                    double stretch) {
  TermCase c = line_case<Cable>(
      label,
      [=](const Frame& f) {
        return Cable::Rest{axial_stiffness * f.force / f.length, 1.0 * f.length, smoothing * f.length,
                           tension * f.force};
      },
      1.0, stretch);
  c.is_zero_at_rest = tension == 0;
  return c;
}

TEST(Cable, PassesTheSuiteWithASharpKink) {
  TermCase c = cable_case("sharp cable", 3.0, 0, 0, 1.4);
  c.reach = 0.05;
  EXPECT_EQ(examine_term(c), "");
  EXPECT_EQ(compare_with_autodiff(c, oracle::Cables{chain(), 3.0, 1.0, 0, 0}), "");
}

TEST(Cable, PassesTheSuiteWithinTheRoundedKinkAndBeyond) {
  for (const double stretch : {1.2, 1.6}) {
    TermCase c = cable_case("rounded cable", 3.0, 0.6, 0, stretch);
    c.reach = 0.02;
    EXPECT_EQ(examine_term(c), "");
    EXPECT_EQ(compare_with_autodiff(c, oracle::Cables{chain(), 3.0, 1.0, 0.6, 0}), "");
  }
}

TEST(Cable, CanBeRoundedMoreForAWhile) {
  const auto cable = [](double smoothing) {
    return ElementTerm<Cable>("cable", {0, 1}, {Cable::Rest{3, 2, smoothing, 0}});
  };
  Points x = Points::Zero(3, 2);
  x(0, 1) = 2.3;  // within a rounding of 0.6, beyond one of 0.1
  Sink value_only;
  auto term = cable(0.1);
  const double sharp = term.evaluate(x, value_only);
  EXPECT_TRUE(term.round_kinks(0.3));  // of the length 2
  EXPECT_EQ(term.evaluate(x, value_only), cable(0.6).evaluate(x, value_only));
  EXPECT_LT(term.evaluate(x, value_only), 0.9 * sharp);
  term.round_kinks(0.01);  // less than its own
  EXPECT_EQ(term.evaluate(x, value_only), sharp);
  term.round_kinks(1);
  term.round_kinks(0);
  EXPECT_EQ(term.evaluate(x, value_only), sharp);
  EXPECT_FALSE(ElementTerm<TetherCubic>("tether", {0, 1}, {{1, 2, 1}}).round_kinks(0.3));
}

TEST(Cable, PassesTheSuiteWithConstantTension) {
  TermCase c = cable_case("constant tension", 0, 0, 1.7, 1.1);
  c.reach = 0.3;
  EXPECT_EQ(examine_term(c), "");
  EXPECT_EQ(compare_with_autodiff(c, oracle::Cables{chain(), 0, 1.0, 0, 1.7}), "");
}

TEST(SurfaceTension, PassesTheSuite) {
  const TriangleMesh mesh = patch();
  TermCase c;
  c.label = "film";
  c.rest = mesh.vertices;
  c.state = shaken(mesh.vertices, 0.1, 5);
  c.reach = 0.3;
  c.is_zero_at_rest = false;
  c.make = [mesh](const Frame& f) -> std::unique_ptr<EnergyTerm> {
    return std::make_unique<ElementTerm<SurfaceTension>>(
        "film", triangle_nodes(f.triangles(mesh.triangles)),
        std::vector<SurfaceTension::Rest>(static_cast<size_t>(mesh.triangle_count()),
                                          {1.3 * f.force / f.length}));
  };
  EXPECT_EQ(examine_term(c), "");
  EXPECT_EQ(compare_with_autodiff(c, oracle::SoapFilm{mesh.triangles, 1.3}), "");
}

TEST(FacetVolume, PassesTheSuiteOnAnOpenSurfaceWithItsOwnOrigin) {
  const TriangleMesh mesh = patch();
  const Vec3 origin(0.4, 0.7, -0.8);
  TermCase c;
  c.label = "cone";
  c.rest = mesh.vertices;
  c.state = shaken(mesh.vertices, 0.1, 6);
  c.reach = 0.5;
  c.is_zero_at_rest = false;
  c.ignores_rigid_motion = false;
  c.make = [mesh, origin](const Frame& f) -> std::unique_ptr<EnergyTerm> {
    const FacetVolume::Rest rest{0.9 * f.force / (f.length * f.length), f.point(origin)};
    return std::make_unique<ElementTerm<FacetVolume>>(
        "cone", triangle_nodes(f.triangles(mesh.triangles)),
        std::vector<FacetVolume::Rest>(static_cast<size_t>(mesh.triangle_count()), rest));
  };
  EXPECT_EQ(examine_term(c), "");
  EXPECT_EQ(compare_with_autodiff(c, oracle::Tetrahedra{mesh.triangles, 0.9, origin}), "");
}

// The element Hessian and the assembled one are the same numbers.
TEST(ElementTerm, AssemblesExactlyWhatTheKernelGives) {
  const Vec3 X0(0, 0, 0), X1(1, 0.1, 0), X2(0.2, 0.9, 0);
  const CstStVK::Rest rest = CstStVK::rest(X0, X1, X2, kYoung, kPoisson, kThickness);
  Points x(3, 3);
  x << 0, 1.2, 0.3, 0, 0.1, 1.0, 0.1, -0.2, 0.3;
  Eigen::Vector<double, 9> g;
  Eigen::Matrix<double, 9, 9> H;
  const double energy = CstStVK::evaluate(rest, Eigen::Map<const Eigen::Vector<double, 9>>(x.data()), &g, &H);
  std::vector<std::unique_ptr<EnergyTerm>> terms;
  terms.push_back(std::make_unique<ElementTerm<CstStVK>>("m", std::vector<int>{0, 1, 2}, std::vector{rest}));
  Objective objective(x, FixedMask::Constant(3, 3, false), std::move(terms));
  Vector q = objective.unknowns(x), gradient;
  Eigen::SparseMatrix<double> sparse;
  EXPECT_EQ(objective.hessian(q, gradient, sparse), energy);
  EXPECT_EQ(gradient, Vector(g));
  const Eigen::MatrixXd assembled = sparse;
  for (int column = 0; column < 9; ++column)
    for (int row = column; row < 9; ++row) EXPECT_EQ(assembled(row, column), H(row, column));
}

TEST(ElementTerm, ProjectsEachElementToANonNegativeHessianOnRequest) {
  const TermCase c = membrane_case("compressed", deformation(0.7, 0.2, 0.8), 0);
  std::vector<std::unique_ptr<EnergyTerm>> terms;
  terms.push_back(c.make({}));
  Objective objective(c.state, FixedMask::Constant(3, c.state.cols(), false), std::move(terms));
  const Vector q = objective.unknowns(c.state);
  Vector g;
  Eigen::SparseMatrix<double> h;
  const auto smallest = [&] {
    const Eigen::MatrixXd full = Eigen::MatrixXd(h).selfadjointView<Eigen::Lower>();
    return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(full).eigenvalues()[0];
  };
  objective.hessian(q, g, h, Projection::None);
  EXPECT_LT(smallest(), -1e-3);
  objective.hessian(q, g, h, Projection::PositiveSemidefinite);
  EXPECT_GT(smallest(), -1e-12);
}

}  // namespace
}  // namespace coapt
