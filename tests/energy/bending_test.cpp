// Hinges: the term suite from flat to sharply folded, and the stiffness of a plate rolled to a cylinder.
#include "energy/kernels/bending.hpp"

#include "energy/element_term.hpp"
#include "membrane_patch.hpp"
#include "support/oracles.hpp"
#include "support/term_suite.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace coapt {
namespace {

constexpr double kStiffness = 0.7;

// The hinges of a manifold mesh: edge, then the corners opposite, the left one first.
Eigen::Matrix4Xi hinges(const Triangles& triangles) {
  std::vector<Eigen::Vector4i> found;
  for (const Edge& edge : edges(triangles)) {
    if (edge.triangles.size() != 2) continue;
    const auto opposite = [&](int t) { return triangles.col(t).sum() - edge.a - edge.b; };
    const Eigen::Vector3i first = triangles.col(edge.triangles[0]);
    bool is_left = false;
    for (int k = 0; k < 3; ++k) is_left |= first[k] == edge.a && first[(k + 1) % 3] == edge.b;
    const int left = edge.triangles[is_left ? 0 : 1], right = edge.triangles[is_left ? 1 : 0];
    found.emplace_back(edge.a, edge.b, opposite(left), opposite(right));
  }
  Eigen::Matrix4Xi nodes(4, found.size());
  for (size_t k = 0; k < found.size(); ++k) nodes.col(static_cast<Eigen::Index>(k)) = found[k];
  return nodes;
}

std::unique_ptr<EnergyTerm> bending_term(const Points& X, const Eigen::Matrix4Xi& nodes, double stiffness) {
  std::vector<BendingHinge::Rest> rest;
  for (Eigen::Index k = 0; k < nodes.cols(); ++k)
    rest.push_back(BendingHinge::rest(X.col(nodes(0, k)), X.col(nodes(1, k)), X.col(nodes(2, k)),
                                      X.col(nodes(3, k)), stiffness));
  return std::make_unique<ElementTerm<BendingHinge>>(
      "bending", std::vector<int>(nodes.data(), nodes.data() + nodes.size()), rest);
}

oracle::Hinges hinge_oracle(const Points& X, const Triangles& triangles) {
  const Eigen::Matrix4Xi nodes = hinges(triangles);
  Vector angle(nodes.cols());
  for (Eigen::Index k = 0; k < nodes.cols(); ++k)
    angle[k] =
        BendingHinge::angle(X.col(nodes(0, k)), X.col(nodes(1, k)), X.col(nodes(2, k)), X.col(nodes(3, k)));
  return {X, nodes, angle, kStiffness};
}

TermCase bending_case(const std::string& label, const Points& rest, const Points& state,
                      const Triangles& triangles) {
  TermCase c;
  c.label = label;
  c.rest = rest;
  c.state = state;
  c.reach = 0.05;
  c.make = [rest, triangles](const Frame& f) {
    return bending_term(f.points(rest), hinges(f.triangles(triangles)), kStiffness * f.force * f.length);
  };
  return c;
}

TEST(BendingHinge, PassesTheSuiteOnACrumpledPatch) {
  const TriangleMesh mesh = patch();
  const TermCase c = bending_case("crumpled", mesh.vertices, shaken(mesh.vertices, 0.15, 8), mesh.triangles);
  EXPECT_EQ(examine_term(c), "");
  EXPECT_EQ(compare_with_autodiff(c, hinge_oracle(mesh.vertices, mesh.triangles)), "");
}

// One hinge folded by an angle, with unequal facets.
Points folded(double angle) {
  Points x(3, 4);
  x.col(0) = Vec3(0, 0, 0);
  x.col(1) = Vec3(0, 1.2, 0);
  x.col(2) = Vec3(-0.8, 0.3, 0);
  x.col(3) = Vec3(0.9 * std::cos(angle), 0.7, -0.9 * std::sin(angle));
  return x;
}

const Triangles& hinge_triangles() {
  static const Triangles kTriangles = (Triangles(3, 2) << 0, 1, 1, 0, 2, 3).finished();
  return kTriangles;
}

TEST(BendingHinge, PassesTheSuiteFromNearlyFlatToASharpFold) {
  for (const double angle : {0.05, -0.8, 1.6, -2.4, 3.05, -3.1}) {
    const Points rest = shaken(folded(0.02), 0.01, 5);
    TermCase c = bending_case("fold " + std::to_string(angle), rest, shaken(folded(angle), 0.01, 6),
                              hinge_triangles());
    c.reach = 0.01;
    EXPECT_EQ(examine_term(c), "");
    EXPECT_EQ(compare_with_autodiff(c, hinge_oracle(rest, hinge_triangles())), "");
  }
}

double angle_of(const Points& x) { return BendingHinge::angle(x.col(0), x.col(1), x.col(2), x.col(3)); }

TEST(BendingHinge, MeasuresAnglesToTheirLastDigits) {
  for (const double angle : {1e-12, -1e-12, 3e-8, 0.3, -2.0, 3.1}) {
    EXPECT_NEAR(angle_of(folded(angle)) / angle, 1, 1e-14) << angle;
  }
  const double nearly = 1e-12;  // short of a full fold
  EXPECT_NEAR(std::numbers::pi - angle_of(folded(std::numbers::pi - nearly)), nearly, 1e-15);
}

// Derivatives where a quotient of small numbers would have no digits left.
TEST(BendingHinge, HasExactDerivativesWhereItIsFlat) {
  const TermCase c = bending_case("flat", folded(0), folded(1e-12), hinge_triangles());
  const TermValues flat = evaluate_term(*c.make({}), c.state);
  const double k = kStiffness * 1.44 / (0.5 * 1.2 * 1.7);
  EXPECT_NEAR(flat.energy / (0.5 * k * 1e-24), 1,
              1e-6);  // beside it the rounding in the plane, 1e-16, counts
  // Lifting a corner by z turns its facet by z over its height.
  EXPECT_NEAR(flat.gradient(2, 3) / (-k * 1e-12 / 0.9), 1, 1e-10);
  EXPECT_NEAR(flat.gradient(2, 2) / (-k * 1e-12 / 0.8), 1, 1e-10);
  EXPECT_NEAR(flat.hessian(11, 11) / (k / 0.81), 1, 1e-10);
  EXPECT_NEAR(flat.hessian(8, 11) / (k / 0.72), 1, 1e-10);
}

// The promise of the law: rigid facets that turn about their edge, from any angle at rest.
TEST(BendingHinge, MeasuresTwiceTheSineOfHalfTheChangeOfAngle) {
  const double k = kStiffness * 1.44 / (0.5 * 1.2 * 1.7);
  for (const double at_rest : {0.0, 0.4, -1.3, 3.0, std::numbers::pi})
    for (const double angle : {0.0, 1e-9, 0.7, -2.2, 3.1}) {
      const TermCase c = bending_case("fold", folded(at_rest), folded(angle), hinge_triangles());
      const double change = 2 * std::sin((angle - at_rest) / 2);
      EXPECT_NEAR(evaluate_term(*c.make({}), c.state).energy, 0.5 * k * change * change, 1e-15)
          << at_rest << " " << angle;
    }
}

// Where a facet collapses the angle has no limit; energy, force and stiffness have.
TEST(BendingHinge, IsSmoothWhereAFacetCollapses) {
  const TermCase c = bending_case("hinge", folded(0.4), folded(0), hinge_triangles());
  const auto term = c.make({});
  const auto at_height = [&](double height) {
    Points x = folded(0.3);
    x.col(3) = Vec3(height, 0.5, 0);
    return evaluate_term(*term, x);
  };
  const TermValues collapsed = at_height(0);
  EXPECT_GT(collapsed.energy, 0.01);
  for (const double height : {1e-9, -1e-9}) {
    const TermValues near = at_height(height);
    EXPECT_LT(std::abs(near.energy - collapsed.energy), 1e-8);
    EXPECT_LT((near.gradient - collapsed.gradient).norm(), 1e-7);
    EXPECT_LT((near.hessian - collapsed.hessian).norm(), 1e-7);
  }
  Points point = folded(0.3);
  point.col(1) = point.col(0);
  EXPECT_TRUE(std::isfinite(evaluate_term(*term, point).energy));
  EXPECT_TRUE(evaluate_term(*term, point).hessian.allFinite());
}

TEST(BendingHinge, CostsNothingWhereAFlatSheetStaysFlatAndStretchesEvenly) {
  const TriangleMesh mesh = grid_mesh(3, 3);
  const auto term = bending_term(mesh.vertices, hinges(mesh.triangles), 1.0);
  const TermValues flat = evaluate_term(*term, deformation(1.4, 0.3, 0.2) * mesh.vertices);
  EXPECT_LT(flat.energy, 1e-25);
  EXPECT_LT(flat.gradient.norm(), 1e-12);
}

// Energy of a sheet rolled to a cylinder, over that of plate theory, averaged over directions of rolling.
double plate_ratio(const TriangleMesh& flat) {
  const double curvature = 1e-3;
  const Eigen::Matrix4Xi nodes = hinges(flat.triangles);
  const auto term = bending_term(flat.vertices, nodes, 1.0);
  // Each hinge stands for a third of its two facets; those cut by the rim stand for none.
  double area = 0;
  for (Eigen::Index k = 0; k < nodes.cols(); ++k)
    for (const int corner : {2, 3})
      area += area_vector(flat.vertices, {nodes(0, k), nodes(1, k), nodes(corner, k)}).norm() / 3;
  double sum = 0;
  const int directions = 36;
  for (int k = 0; k < directions; ++k) {
    const double turn = std::numbers::pi * k / directions;
    Points x = flat.vertices;
    for (Eigen::Index v = 0; v < x.cols(); ++v) {
      const Vec3 along(std::cos(turn), std::sin(turn), 0);
      const double s = along.dot(flat.vertices.col(v));
      x.col(v) += (std::sin(curvature * s) / curvature - s) * along +
                  (1 - std::cos(curvature * s)) / curvature * Vec3::UnitZ();
    }
    Sink sink;
    sum += term->evaluate(x, sink) / (0.5 * curvature * curvature * area);
  }
  return sum / directions;
}

TEST(BendingHinge, GivesARolledPlateTheEnergyOfPlateTheory) {
  TriangleMesh equilateral = grid_mesh(24, 24, 24, 24 * std::sqrt(0.75), Diagonal::Same);
  for (int v = 0; v < equilateral.vertex_count(); ++v)
    equilateral.vertices(0, v) -= equilateral.vertices(1, v) * std::tan(std::numbers::pi / 6);
  const TriangleMesh square = grid_mesh(24, 24, 24, 24, Diagonal::Same);
  const TriangleMesh alternating = grid_mesh(24, 24, 24, 24, Diagonal::Alternating);
  const TriangleMesh disc = disc_mesh(20);
  TriangleMesh irregular = equilateral;
  perturb_in_plane(irregular, 0.2, 17, [](const Vec3&) { return true; });
  const struct {
    const char* name;
    const TriangleMesh& mesh;
    double expected, tolerance;
  } meshes[] = {{"equilateral", equilateral, 1, 0.005},
                {"irregular", irregular, 1.08, 0.02},
                {"disc", disc, 1.14, 0.02},
                {"squares, diagonals alternating", alternating, 1.25, 0.02},
                {"squares, diagonals parallel", square, 1.5, 0.005}};
  for (const auto& m : meshes) {
    const double ratio = plate_ratio(m.mesh);
    std::printf("rolled plate, energy over plate theory: %.4f %s\n", ratio, m.name);
    EXPECT_NEAR(ratio, m.expected, m.tolerance) << m.name;
  }
}

}  // namespace
}  // namespace coapt
