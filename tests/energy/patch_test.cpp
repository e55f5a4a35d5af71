// Rows A1 and A2 of the verification table: states of uniform strain, exact on any mesh.
#include "energy/load_dead.hpp"
#include "support/equilibrium.hpp"
#include "support/meshes.hpp"
#include "support/tissue_laws.hpp"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <cmath>

namespace coapt {
namespace {

constexpr double kEh = 1000, kNu = 0.3;

TriangleMesh irregular_square() {
  TriangleMesh mesh = grid_mesh(5, 5);
  perturb_in_plane(mesh, 0.06, 31, [](const Vec3& X) {
    return X[0] > 1e-9 && X[0] < 1 - 1e-9 && X[1] > 1e-9 && X[1] < 1 - 1e-9;
  });
  // Nodes of the rim slide along it, so that its edges differ in length too.
  for (int v = 0; v < mesh.vertex_count(); ++v)
    for (int c = 0; c < 2; ++c)
      mesh.vertices(c, v) +=
          0.05 * std::sin(6 * mesh.vertices(c, v)) * mesh.vertices(c, v) * (1 - mesh.vertices(c, v));
  return mesh;
}

std::unique_ptr<EnergyTerm> stvk_sheet(const TriangleMesh& mesh) {
  return membrane_term(mesh.vertices, mesh.triangles, {kEh, kNu, 0});
}

// The law that is linear in the stretches (Biot): a bilinear one that never gets to its knee.
std::unique_ptr<EnergyTerm> biot_sheet(const TriangleMesh& mesh) {
  return tissue_term(mesh, BilinearLaw{kEh, kNu, {0, 10, 0}}, 1, Points::Zero(3, mesh.triangle_count()),
                     false);
}

using Sheet = std::unique_ptr<EnergyTerm> (*)(const TriangleMesh&);

// Solves with the mask given, from a shaken state, in the plane z = 0.
Equilibrium stretch(const TriangleMesh& mesh, const FixedMask& fixed, const Points& prescribed,
                    Sheet sheet = stvk_sheet) {
  const Points start = fixed.select(prescribed, shaken(prescribed, 0.02, 32).array()).matrix();
  return find_equilibrium(start, fixed, terms_of(sheet(mesh)), 1e-13, "bfgs");
}

FixedMask in_plane_mask(const TriangleMesh& mesh, bool all_edges) {
  FixedMask fixed = FixedMask::Constant(3, mesh.vertex_count(), false);
  fixed.row(2).setConstant(true);
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    const double x = mesh.vertices(0, v), y = mesh.vertices(1, v);
    const bool on_x = x < 1e-9 || x > 1 - 1e-9, on_y = y < 1e-9 || y > 1 - 1e-9;
    if (on_x) fixed(0, v) = true;
    if (all_edges && (on_x || on_y)) fixed.col(v).setConstant(true);
    if (!all_edges && x < 1e-9 && y < 1e-9) fixed(1, v) = true;  // against sliding as a whole
  }
  return fixed;
}

// Sum of the reactions in direction `component` on the edge x = 1 or y = 1.
double edge_force(const TriangleMesh& mesh, const Points& x, int edge, int component,
                  Sheet sheet = stvk_sheet) {
  Points g = Points::Zero(3, x.cols());
  Sink sink(g.data());
  sheet(mesh)->evaluate(x, sink);
  double sum = 0;
  for (int v = 0; v < mesh.vertex_count(); ++v)
    if (mesh.vertices(edge, v) > 1 - 1e-9) sum += g(component, v);
  return sum;
}

TEST(PatchTest, A1aUniaxialStretchWithFreeSides) {
  const TriangleMesh mesh = irregular_square();
  Points prescribed = mesh.vertices;
  prescribed.row(0) *= 1.1;
  const Equilibrium found = stretch(mesh, in_plane_mask(mesh, false), prescribed);
  // Plane stress without lateral stress: E_lateral = -nu E_axial, W = Eh E_axial^2 / 2, P = lambda Eh
  // E_axial.
  const double axial = 0.5 * (1.1 * 1.1 - 1), lateral = std::sqrt(1 - 2 * kNu * axial);
  EXPECT_NEAR(found.result.energy / (0.5 * kEh * axial * axial), 1, 1e-10);
  EXPECT_NEAR(found.result.energy, 5.5125, 5.5125e-10);
  EXPECT_NEAR(lateral, 0.967987603, 1e-9);
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    const Vec3 expected(1.1 * mesh.vertices(0, v), lateral * mesh.vertices(1, v), 0);
    EXPECT_LT((found.x.col(v) - expected).norm(), 1e-10);
  }
  EXPECT_NEAR(edge_force(mesh, found.x, 0, 0) / 115.5, 1, 1e-10);
}

TEST(PatchTest, A1bUniaxialStretchOfALawLinearInTheStretches) {
  const TriangleMesh mesh = irregular_square();
  Points prescribed = mesh.vertices;
  prescribed.row(0) *= 1.1;
  const Equilibrium found = stretch(mesh, in_plane_mask(mesh, false), prescribed, biot_sheet);
  EXPECT_NEAR(found.result.energy / 5, 1, 1e-10);  // Eh 0.1^2 / 2
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    const Vec3 expected(1.1 * mesh.vertices(0, v), 0.97 * mesh.vertices(1, v), 0);
    EXPECT_LT((found.x.col(v) - expected).norm(), 1e-10);
  }
  EXPECT_NEAR(edge_force(mesh, found.x, 0, 0, biot_sheet) / 100, 1, 1e-10);
}

TEST(PatchTest, A1cBiaxialStretch) {
  const TriangleMesh mesh = irregular_square();
  Points prescribed = mesh.vertices;
  prescribed.row(0) *= 1.2;
  prescribed.row(1) *= 1.1;
  const Equilibrium found = stretch(mesh, in_plane_mask(mesh, true), prescribed);
  EXPECT_LT((found.x - prescribed).norm(), 1e-10);
  const double e1 = 0.5 * (1.44 - 1), e2 = 0.5 * (1.21 - 1), k = kEh / (1 - kNu * kNu);
  EXPECT_NEAR(found.result.energy / (0.5 * k * (e1 * e1 + e2 * e2 + 2 * kNu * e1 * e2)), 1, 1e-10);
  EXPECT_NEAR(found.result.energy, 40.2664835, 1e-7);
  EXPECT_NEAR(edge_force(mesh, found.x, 0, 0) / (1.2 * k * (e1 + kNu * e2)), 1, 1e-10);
  EXPECT_NEAR(edge_force(mesh, found.x, 0, 0), 331.648352, 1e-6);
  EXPECT_NEAR(edge_force(mesh, found.x, 1, 1) / (1.1 * k * (e2 + kNu * e1)), 1, 1e-10);
  EXPECT_NEAR(edge_force(mesh, found.x, 1, 1), 206.703297, 1e-6);
}

TEST(PatchTest, A1dSimpleShear) {
  const TriangleMesh mesh = irregular_square();
  const double gamma = 0.2;
  Points prescribed = mesh.vertices;
  prescribed.row(0) += gamma * mesh.vertices.row(1);
  const Equilibrium found = stretch(mesh, in_plane_mask(mesh, true), prescribed);
  EXPECT_LT((found.x - prescribed).norm(), 1e-10);
  // E = [0, gamma/2; gamma/2, gamma^2/2]
  const double k = kEh / (1 - kNu * kNu), e22 = 0.5 * gamma * gamma, e12 = 0.5 * gamma;
  const double S11 = k * kNu * e22, S22 = k * e22, S12 = k * (1 - kNu) * e12;
  EXPECT_NEAR(S11, 6.59340659, 1e-8);
  EXPECT_NEAR(S22, 21.978022, 1e-6);
  EXPECT_NEAR(S12, 76.9230769, 1e-7);
  EXPECT_NEAR(found.result.energy / (0.5 * S22 * e22 + S12 * e12), 1, 1e-10);
  EXPECT_NEAR(found.result.energy, 7.91208791, 1e-8);
  // First Piola-Kirchhoff stress P = F S with F = [1 gamma; 0 1], read off as edge forces.
  EXPECT_NEAR(edge_force(mesh, found.x, 0, 0) / (S11 + gamma * S12), 1, 1e-10);
  EXPECT_NEAR(edge_force(mesh, found.x, 0, 1) / S12, 1, 1e-10);
  EXPECT_NEAR(edge_force(mesh, found.x, 1, 0) / (S12 + gamma * S22), 1, 1e-10);
  EXPECT_NEAR(edge_force(mesh, found.x, 1, 1) / S22, 1, 1e-10);
}

// Eight-digit references, as printed in the table, bound the agreement to 5e-9; the exact value below, to
// 1e-12, comes from the invariants of the same triangle.
TEST(SingleTriangle, A2EnergyAndGradient) {
  Points X(3, 3), x(3, 3), expected(3, 3);
  X << 0.1, 1.3, 0.4, 0.2, 0.1, 1.1, 0.3, 0.5, -0.2;
  x << 0.0, 1.5, 0.2, 0.1, 0.3, 1.4, 0.2, 0.9, 0.3;
  expected << -427.182529, 351.255122, 75.9274074, -366.289277, 73.6144603, 292.674817, -200.971384,
      164.059268, 36.9121156;
  Triangles one(3, 1);
  one << 0, 1, 2;
  Points g = Points::Zero(3, 3);
  Sink sink(g.data());
  const double energy = membrane_term(X, one, {kEh, kNu, 0})->evaluate(x, sink);
  EXPECT_NEAR(energy / 112.182866, 1, 5e-9);
  EXPECT_LT((g - expected).cwiseAbs().maxCoeff(), 6e-7);

  // Independent of axes in the triangle: with metric tensors G (rest) and c (current) of the edges,
  // tr E = (tr(G^-1 c) - 2)/2, tr E^2 = tr((G^-1 c - I)^2)/4, area = sqrt(det G)/2.
  const auto metric = [](const Points& p) {
    Eigen::Matrix<double, 3, 2> edges;
    edges << p.col(1) - p.col(0), p.col(2) - p.col(0);
    return Eigen::Matrix2d(edges.transpose() * edges);
  };
  const Eigen::Matrix2d G = metric(X), M = G.inverse() * metric(x) - Eigen::Matrix2d::Identity();
  const double area = 0.5 * std::sqrt(G.determinant()), trace = 0.5 * M.trace(),
               square = 0.25 * (M * M).trace();
  const double exact = area * 0.5 * kEh / (1 - kNu * kNu) * ((1 - kNu) * square + kNu * trace * trace);
  EXPECT_NEAR(area, 0.648960708, 1e-9);
  EXPECT_NEAR(energy / exact, 1, 1e-12);
  // Gradient by the same invariants: dW/dx = 2 d(edges) . (dW/dc), dW/dc = area (..) G^-1 ...
  const Eigen::Matrix2d S =
      kEh / (1 - kNu * kNu) * (0.5 * (1 - kNu) * M + kNu * trace * Eigen::Matrix2d::Identity()) * G.inverse();
  Eigen::Matrix<double, 3, 2> edges;
  edges << x.col(1) - x.col(0), x.col(2) - x.col(0);
  const Eigen::Matrix<double, 3, 2> force = area * edges * S;
  EXPECT_LT((g.col(1) - force.col(0)).norm(), 1e-12 * g.norm());
  EXPECT_LT((g.col(2) - force.col(1)).norm(), 1e-12 * g.norm());
  EXPECT_LT((g.col(0) + force.rowwise().sum()).norm(), 1e-12 * g.norm());
}

// The shear trap: one engineering constant wrong and the law knows the axes of the element.
TEST(SingleTriangle, IsIsotropicUnderRotationOfTheElementAxes) {
  Points X(3, 3), x(3, 3);
  X << 0, 1, 0.2, 0, 0.1, 0.9, 0, 0, 0;
  Eigen::Matrix3d F = Eigen::Matrix3d::Identity();
  F(0, 0) = 1.2;
  F(0, 1) = 0.3;
  Triangles one(3, 1);
  one << 0, 1, 2;
  const double straight = membrane_energy(*membrane_term(X, one, {kEh, kNu, 0}), F * X);
  for (const double angle : {0.4, 1.1, 2.3}) {
    const Eigen::Matrix3d R = Eigen::AngleAxisd(angle, Vec3::UnitZ()).toRotationMatrix();
    // The rest triangle turned in its plane: other element axes, same material, same stretch.
    EXPECT_NEAR(membrane_energy(*membrane_term(R * X, one, {kEh, kNu, 0}), R * F * X) / straight, 1, 1e-13);
    // The stretch turned over the same rest triangle: E becomes R^T E R, of the same invariants.
    EXPECT_NEAR(membrane_energy(*membrane_term(X, one, {kEh, kNu, 0}), F * R * X) / straight, 1, 1e-13);
  }
}

}  // namespace
}  // namespace coapt
