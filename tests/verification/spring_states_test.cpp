// Sheets of edge springs: row H1 of the verification table, where they are a membrane (equilateral triangles)
// and where they are not (triangles with a right angle), and closed forms of their nonlinear curves.
#include "support/meshes.hpp"
#include "support/sheets.hpp"
#include "support/spring_sheet.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

namespace coapt {
namespace {

constexpr double kYoung = 2.5, kThickness = 0.4;  // E_2 = E h = 1
constexpr double kPoisson = 1.0 / 3;
constexpr double kStrain = 1e-3;

Points gradient_of(const EnergyTerm& term, const Points& x) {
  Points g = Points::Zero(3, x.cols());
  Sink sink(g.data());
  term.evaluate(x, sink);
  return g;
}

double energy_of(const EnergyTerm& term, const Points& x) {
  Sink sink;
  return term.evaluate(x, sink);
}

// Nodes of the zigzag sides of a lattice.
bool is_on_side(int node, int columns) {
  return node % (columns + 1) == 0 || node % (columns + 1) == columns;
}

// Sides moved apart along x, free to slide along y; in the plane.
FixedMask sliding_sides(const TriangleMesh& mesh, int columns) {
  FixedMask fixed = FixedMask::Constant(3, mesh.vertex_count(), false);
  fixed.row(2).setConstant(true);
  for (int v = 0; v < mesh.vertex_count(); ++v)
    if (is_on_side(v, columns)) fixed(0, v) = true;
  fixed(1, 0) = true;  // against sliding as a whole
  return fixed;
}

// Sum of the forces along x on the right side.
double pull(const EnergyTerm& term, const Points& x, int columns) {
  const Points g = gradient_of(term, x);
  double sum = 0;
  for (int v = columns; v < x.cols(); v += columns + 1) sum += g(0, v);
  return sum;
}

// k_c = E_2 sum(area)/|c|^2 inside and half of it on the boundary make an isotropic membrane of E_2 and nu =
// 1/3.
TEST(SpringStates, H1EquilateralLatticeIsTheIsotropicMembrane) {
  constexpr int kColumns = 12, kRows = 9;
  const TriangleMesh mesh = lattice_mesh(kColumns, kRows);
  const auto term = spring_term(mesh.vertices, mesh.triangles, linear_springs(kYoung, kThickness));

  // Parts of an edge, one for each of its triangles: one on the boundary, two inside.
  double inner = 0, boundary = 0;
  for (const Edge& edge : edges(mesh.triangles)) {
    double stiffness = 0;
    for (size_t k = 0; k < term->rest().size(); ++k) {
      const int a = term->stencils().nodes[2 * k], b = term->stencils().nodes[2 * k + 1];
      if (std::minmax(a, b) == std::minmax(edge.a, edge.b))
        stiffness += Spring::elastic(term->rest()[k], 0).stiffness;
    }
    (edge.triangles.size() == 2 ? inner : boundary) = stiffness;
  }
  EXPECT_NEAR(inner, 0.866025404, 1e-9);
  EXPECT_NEAR(boundary, inner / 2, 1e-12);

  Points start = mesh.vertices;
  for (int v = 0; v < mesh.vertex_count(); ++v)
    if (is_on_side(v, kColumns)) start(0, v) *= 1 + kStrain;
  const Equilibrium found = find_equilibrium(
      start, sliding_sides(mesh, kColumns),
      terms_of(spring_term(mesh.vertices, mesh.triangles, linear_springs(kYoung, kThickness))), 1e-11,
      "newton");
  ASSERT_EQ(found.result.status, Status::Converged) << found.result.message;
  const double height = kRows * std::sqrt(0.75);
  const double across = (found.x.row(1).maxCoeff() - found.x.row(1).minCoeff()) / height - 1;
  const double young = pull(*term, found.x, kColumns) / height / kStrain, poisson = -across / kStrain;
  std::printf("H1: k/E2 %.9f, E_eff/E2 %.6f, nu_eff %.6f\n", inner, young, poisson);
  EXPECT_NEAR(young, 1, 1e-3);
  EXPECT_NEAR(poisson, 1.0 / 3, 1e-3);
  // The state is uniform: inner nodes, rims and sides.
  for (int v = 0; v < mesh.vertex_count(); ++v)
    EXPECT_NEAR(found.x(1, v) - found.x(1, 0), (1 + across) * mesh.vertices(1, v), 1e-8) << v;
}

Eigen::Matrix3d strained(double e11, double e22, double e12) {
  Eigen::Matrix3d f = Eigen::Matrix3d::Identity();
  f(0, 0) += e11;
  f(1, 1) += e22;
  f(0, 1) = f(1, 0) = e12;
  return f;
}

// Energy and every nodal force of the two membranes under small uniform strains.
TEST(SpringStates, EqualsStVenantKirchhoffOnEquilateralTriangles) {
  const TriangleMesh mesh = lattice_mesh(6, 5);
  const auto springs = spring_term(mesh.vertices, mesh.triangles, linear_springs(kYoung, kThickness));
  const auto stvk = membrane_term(mesh.vertices, mesh.triangles, {kYoung * kThickness, kPoisson, 0});
  for (const Eigen::Matrix3d& f :
       {strained(kStrain, kStrain, 0), strained(-kStrain, -kStrain, 0), strained(0, 0, kStrain),
        strained(kStrain, -kStrain, 0), strained(kStrain, 0, -kStrain)}) {
    const Points x = f * mesh.vertices;
    EXPECT_NEAR(energy_of(*springs, x) / energy_of(*stvk, x), 1, 3e-3);
    const Points g = gradient_of(*springs, x), h = gradient_of(*stvk, x);
    EXPECT_LT((g - h).norm(), 3e-3 * h.norm());
  }
}

// A state that is not uniform: clamped sides that are moved apart.
TEST(SpringStates, AgreesWithStVenantKirchhoffBetweenClamps) {
  constexpr int kColumns = 14, kRows = 8;
  const TriangleMesh mesh = lattice_mesh(kColumns, kRows);
  FixedMask fixed = FixedMask::Constant(3, mesh.vertex_count(), false);
  fixed.row(2).setConstant(true);
  Points start = mesh.vertices;
  for (int v = 0; v < mesh.vertex_count(); ++v)
    if (is_on_side(v, kColumns)) {
      fixed.col(v).setConstant(true);
      start(0, v) *= 1 + kStrain;
    }
  const auto springs = [&] {
    return spring_term(mesh.vertices, mesh.triangles, linear_springs(kYoung, kThickness));
  };
  const auto stvk = [&] {
    return membrane_term(mesh.vertices, mesh.triangles, {kYoung * kThickness, kPoisson, 0});
  };
  const Equilibrium a = find_equilibrium(start, fixed, terms_of(springs()), 1e-10, "newton"),
                    b = find_equilibrium(start, fixed, terms_of(stvk()), 1e-10, "newton");
  ASSERT_EQ(a.result.status, Status::Converged) << a.result.message;
  ASSERT_EQ(b.result.status, Status::Converged) << b.result.message;
  EXPECT_NEAR(pull(*springs(), a.x, kColumns) / pull(*stvk(), b.x, kColumns), 1, 2e-3);
  EXPECT_LT((a.x - b.x).norm(), 2e-3 * (b.x - mesh.vertices).norm());
}

// Stiffness of a sheet of springs against small uniform strains (e11, e22, 2 e12), in units of E h, from
// second differences of its energy.
Eigen::Matrix3d stiffness_of(const TriangleMesh& mesh) {
  const auto term = spring_term(mesh.vertices, mesh.triangles, linear_springs(kYoung, kThickness));
  const double area = surface_area(mesh.vertices, mesh.triangles);
  const auto energy = [&](const Eigen::Vector3d& e) {
    return energy_of(*term, strained(e[0], e[1], 0.5 * e[2]) * mesh.vertices) / (area * kYoung * kThickness);
  };
  const auto bend = [&](const Eigen::Vector3d& e) { return (energy(e) + energy(-e)) / (kStrain * kStrain); };
  Eigen::Matrix3d stiffness;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const Eigen::Vector3d a = kStrain * Eigen::Vector3d::Unit(i), b = kStrain * Eigen::Vector3d::Unit(j);
      stiffness(i, j) = 0.25 * (bend(a + b) - bend(a - b));
    }
  return stiffness;
}

// Of a grid with parallel diagonals: from left to right.
Vec3 diagonal_of(const TriangleMesh& grid) {
  for (const Edge& edge : edges(grid.triangles)) {
    const Vec3 along = grid.vertices.col(edge.b) - grid.vertices.col(edge.a);
    if (std::abs(along[0]) > 1e-9 && std::abs(along[1]) > 1e-9) return along[0] > 0 ? along : Vec3(-along);
  }
  return Vec3::Zero();
}

struct Moduli {
  double young = 0, poisson = 0;
};

// Of a strip cut at an angle to x and pulled along it.
Moduli moduli_at(const Eigen::Matrix3d& stiffness, int degree) {
  const double angle = degree * std::numbers::pi / 180;
  const double c = std::cos(angle), s = std::sin(angle);
  const Eigen::Vector3d stress(c * c, s * s, c * s), strain = stiffness.inverse() * stress;
  const double along = c * c * strain[0] + s * s * strain[1] + c * s * strain[2],
               across = s * s * strain[0] + c * c * strain[1] - c * s * strain[2];
  return {1 / along, -across / along};
}

// The least and the greatest modulus over E_2 and Poisson's ratio over all directions of pulling.
struct Range {
  double young_from = kInfinity, young_to = 0, poisson_from = kInfinity, poisson_to = -kInfinity;
};

void expect_range(const char* name, const TriangleMesh& mesh, const Range& expected) {
  const Eigen::Matrix3d stiffness = stiffness_of(mesh);
  Range r;
  for (int degree = 0; degree < 180; ++degree) {
    const Moduli m = moduli_at(stiffness, degree);
    r = {std::min(r.young_from, m.young), std::max(r.young_to, m.young), std::min(r.poisson_from, m.poisson),
         std::max(r.poisson_to, m.poisson)};
  }
  std::printf("springs on %s: E/E2 %.4f to %.4f, nu %.4f to %.4f\n", name, r.young_from, r.young_to,
              r.poisson_from, r.poisson_to);
  EXPECT_NEAR(r.young_from, expected.young_from, 2e-3) << name;
  EXPECT_NEAR(r.young_to, expected.young_to, 2e-3) << name;
  EXPECT_NEAR(r.poisson_from, expected.poisson_from, 2e-3) << name;
  EXPECT_NEAR(r.poisson_to, expected.poisson_to, 2e-3) << name;
}

// The limit of the method, stated in docs/theory.md: on triangles with a right angle the modulus depends on
// the direction by a factor of four, 1/E = 1 - p + p^2 with p = sin 2 theta from the springs' forces, and
// Poisson's ratio is anything from 0 to 1. As a triangle's stiffness is that of its three directions,
// whatever its size, refinement does not help.
TEST(SpringStates, AreAnisotropicOnTrianglesWithARightAngle) {
  expect_range("equilateral triangles", lattice_mesh(8, 8), {1, 1, kPoisson, kPoisson});
  for (const int n : {6, 12})
    expect_range("squares, parallel diagonals", grid_mesh(n, n, 1, 1, Diagonal::Same),
                 {1.0 / 3, 4.0 / 3, 0, 1});
  expect_range("squares, crossed diagonals", crossed_grid_mesh(6), {0.75, 1.2, 0.2, 0.5});
  const TriangleMesh same = grid_mesh(6, 6, 1, 1, Diagonal::Same);
  const Eigen::Matrix3d stiffness = stiffness_of(same);
  const double sign = diagonal_of(same)[1] > 0 ? 1 : -1;
  for (const int degree : {0, 15, 45, 70, 100, 135}) {
    const double p = sign * std::sin(degree * std::numbers::pi / 90);
    EXPECT_NEAR(moduli_at(stiffness, degree).young * (1 - p + p * p), 1, 2e-3) << degree;
  }
}

// On squares with parallel diagonals the state in which the springs along x alone are strained is a uniaxial
// stress in equilibrium at any strain: the force per width is the thickness times the curve along or across
// the fibre, exactly, and no inner node is out of balance.
void expect_uniaxial(const SpringSheet& sheet, double strain, double stress) {
  constexpr int kCells = 5;
  const TriangleMesh mesh = grid_mesh(kCells, kCells, 1, 1, Diagonal::Same);
  const Vec3 diagonal = diagonal_of(mesh);
  // Upright springs turn until the diagonals have their rest length again.
  const double l = 1 + strain, sign = diagonal[1] > 0 ? 1 : -1;
  const double cosine = sign * (1 - l * l) / (2 * l);
  Eigen::Matrix3d f = Eigen::Matrix3d::Identity();
  f(0, 0) = l;
  f(0, 1) = cosine;
  f(1, 1) = std::sqrt(1 - cosine * cosine);
  const Points x = f * mesh.vertices;
  const auto term = spring_term(mesh.vertices, mesh.triangles, sheet);
  EXPECT_NEAR((f * diagonal).norm(), diagonal.norm(), 1e-12);
  const Points g = gradient_of(*term, x);
  double side = 0;
  for (int j = 0; j <= kCells; ++j) side += g(0, grid_node(kCells, kCells, j));
  EXPECT_NEAR(side, sheet.thickness * stress, 1e-12) << "strain " << strain;
  for (int j = 0; j <= kCells; ++j)
    for (int i = 1; i < kCells; ++i) EXPECT_LT(g.col(grid_node(kCells, i, j)).norm(), 1e-12);
}

TEST(SpringStates, UniaxialTensionFollowsTheCurves) {
  SpringSheet sheet;
  sheet.thickness = kThickness;
  for (const bool resists : {false, true}) {
    sheet.resists = resists;
    sheet.fibre = sheet.cross = {0.1, {5.9, 0.25, 0.005}};  // Hammer et al. 2008 [MPa]
    expect_uniaxial(sheet, 0.1, 0.1 * 0.1);
    expect_uniaxial(sheet, 0.25, 0.1 * 0.25 + 5.9 * 0.005 / 4);
    expect_uniaxial(sheet, 0.35, 0.1 * 0.35 + 5.9 * 0.1);
    sheet.cross = {0.05, {1.95, 0.4, 0.005}};
    expect_uniaxial(sheet, 0.35, 0.1 * 0.35 + 5.9 * 0.1);
    sheet.direction = Vec3::UnitY();
    expect_uniaxial(sheet, 0.35, 0.05 * 0.35);
    expect_uniaxial(sheet, 0.5, 0.05 * 0.5 + 1.95 * 0.1);
    sheet.direction = Vec3::UnitX();
  }
}

}  // namespace
}  // namespace coapt
