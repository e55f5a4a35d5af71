// Membranes of prescribed prestress: the term suite, and two shapes that are known in closed form.
#include "energy/element_term.hpp"
#include "energy/kernels/cst_prestress.hpp"
#include "energy/load_dead.hpp"
#include "membrane_patch.hpp"
#include "support/equilibrium.hpp"
#include "support/oracles.hpp"
#include "support/term_suite.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace coapt {
namespace {

constexpr double kWarp = 1.7, kWeft = 0.6;
const Vec3 kDirection(0.8, 0.5, 0.3);

std::unique_ptr<EnergyTerm> prestress_term(const Points& X, const Triangles& triangles, const Vec3& direction,
                                           double warp = kWarp, double weft = kWeft) {
  std::vector<CstPrestress::Rest> rest;
  for (int t = 0; t < triangles.cols(); ++t)
    rest.push_back(CstPrestress::rest(X.col(triangles(0, t)), X.col(triangles(1, t)), X.col(triangles(2, t)),
                                      direction, warp, weft));
  return std::make_unique<ElementTerm<CstPrestress>>("sail", triangle_nodes(triangles), rest);
}

TermCase prestress_case(const std::string& label, const Eigen::Matrix3d& deformation) {
  const TriangleMesh mesh = patch();
  TermCase c;
  c.label = label;
  c.rest = mesh.vertices;
  c.state = shaken(deformation * mesh.vertices, 0.1, 4);
  c.is_zero_at_rest = false;
  c.make = [mesh](const Frame& f) {
    const double resultant = f.force / f.length;
    return prestress_term(f.points(mesh.vertices), f.triangles(mesh.triangles), f.rotation * kDirection,
                          kWarp * resultant, kWeft * resultant);
  };
  return c;
}

// The energy of a cable net of force densities: sum of q l^2/2 over the edges of each triangle, with the q of
// A S = sum q E E^T at rest.
struct ForceDensities {
  Triangles triangles;
  Points X;

  template <typename T>
  T operator()(const std::vector<AutoVec<T>>& x) const {
    T energy = T(0.0);
    for (Eigen::Index t = 0; t < triangles.cols(); ++t) {
      const Eigen::Vector3i c = triangles.col(t);
      const Eigen::Vector3d q = densities(c);
      for (int k = 0; k < 3; ++k) {
        const AutoVec<T> edge = x[c[(k + 1) % 3]] - x[c[k]];
        energy = T(energy + times(0.5 * q[k], dot(edge, edge)));
      }
    }
    return energy;
  }

  Eigen::Vector3d densities(const Eigen::Vector3i& c) const {
    const Vec3 a = X.col(c[1]) - X.col(c[0]), b = X.col(c[2]) - X.col(c[0]);
    const Vec3 n = a.cross(b).normalized(), warp = (kDirection - n.dot(kDirection) * n).normalized(),
               weft = n.cross(warp);
    Eigen::Matrix3d system;
    for (int k = 0; k < 3; ++k) {
      const Vec3 edge = X.col(c[(k + 1) % 3]) - X.col(c[k]);
      const double along = edge.dot(warp), across = edge.dot(weft);
      system.col(k) << along * along, across * across, along * across;
    }
    return system.inverse() * (0.5 * a.cross(b).norm() * Eigen::Vector3d(kWarp, kWeft, 0));
  }
};

TEST(CstPrestress, PassesTheSuiteStretchedShearedAndCompressed) {
  EXPECT_EQ(examine_term(prestress_case("stretched", deformation(1.3, 0, 1.15))), "");
  EXPECT_EQ(examine_term(prestress_case("sheared", deformation(1.05, 0.4, 1.1))), "");
  EXPECT_EQ(examine_term(prestress_case("compressed", deformation(0.4, 0.1, 0.2))), "");
}

TEST(CstPrestress, IsANetOfForceDensities) {
  const TriangleMesh mesh = patch();
  EXPECT_EQ(compare_with_autodiff(prestress_case("net", deformation(1.2, 0.3, 0.7)),
                                  ForceDensities{mesh.triangles, mesh.vertices}),
            "");
}

TEST(CstPrestress, GivesItsStressOverTheThickness) {
  const Vec3 X0(0, 0, 0), X1(2, 0, 0), X2(0, 1, 0);
  CstVector x;
  x << X0, 1.3 * X1, X2;
  const MembraneState state =
      CstPrestress::state(CstPrestress::rest(X0, X1, X2, Vec3(0, 1, 0), kWeft, kWarp, 0.5), x);
  EXPECT_DOUBLE_EQ(state.stress[0], kWarp / 0.5);
  EXPECT_DOUBLE_EQ(state.stress[1], kWeft / 0.5);
  EXPECT_EQ(state.regime, MembraneRegime::Taut);
}

// Of a grid mesh.
std::vector<int> rim(const TriangleMesh& mesh, double width, double height) {
  std::vector<int> nodes;
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    const double x = mesh.vertices(0, v), y = mesh.vertices(1, v);
    if (x < 1e-9 || y < 1e-9 || x > width - 1e-9 || y > height - 1e-9) nodes.push_back(v);
  }
  return nodes;
}

// With its rim on z = c x y the sheet is that surface whatever warp and weft are, as x y solves
// s1 z_xx + s2 z_yy = 0, and on a grid along both its differences too (row D1 of the verification).
TEST(CstPrestress, HangsAHyparInItsFrame) {
  const TriangleMesh mesh = grid_mesh(8, 8);
  Points hypar = mesh.vertices;
  hypar.row(2) = 0.7 * hypar.row(0).cwiseProduct(hypar.row(1));
  const FixedMask fixed = fixed_nodes(hypar.cols(), rim(mesh, 1, 1));
  const Points start = fixed.select(hypar, shaken(mesh.vertices, 0.2, 5).array()).matrix();
  for (const double weft : {kWeft, 5 * kWarp}) {
    const Equilibrium found = find_equilibrium(
        start, fixed, terms_of(prestress_term(mesh.vertices, mesh.triangles, Vec3::UnitX(), kWarp, weft)),
        1e-13, "newton");
    EXPECT_EQ(found.result.status, Status::Converged) << found.result.message;
    EXPECT_LT((found.x - hypar).cwiseAbs().maxCoeff(), 1e-12);
  }
}

// Greatest deflection of a flat sheet in a rectangular frame under a force p for each area at rest: the
// series of s1 z_xx + s2 z_yy = -p.
double deflection_of_frame(double width, double height, double p) {
  double sum = 0;
  const double pi = std::numbers::pi;
  for (int m = 1; m < 400; m += 2)
    for (int n = 1; n < 400; n += 2) {
      const double sign = (m + n) % 4 == 2 ? 1 : -1;
      sum += sign * 16 * p /
             (pi * pi * m * n * (kWarp * std::pow(m * pi / width, 2) + kWeft * std::pow(n * pi / height, 2)));
    }
  return sum;
}

double found_deflection(int n, double width, double height, double p) {
  const TriangleMesh mesh = grid_mesh(n, n, width, height);
  const Vector areas = nodal_areas(mesh.vertices, mesh.triangles);
  const Equilibrium found = find_equilibrium(
      mesh.vertices, fixed_nodes(mesh.vertex_count(), rim(mesh, width, height)),
      terms_of(
          prestress_term(mesh.vertices, mesh.triangles, Vec3::UnitX()),
          std::make_unique<LoadDead>("load", "load_field", area_forces(areas, Vec3(0, 0, p)), mesh.vertices)),
      1e-12, "newton");
  EXPECT_EQ(found.result.status, Status::Converged) << found.result.message;
  return found.x(2, grid_node(n, n / 2, n / 2));
}

TEST(CstPrestress, SagsInARectangularFrameAsTheSeriesSays) {
  const double width = 2, height = 1, p = 0.4, exact = deflection_of_frame(width, height, p);
  const double coarse = found_deflection(16, width, height, p) - exact,
               fine = found_deflection(32, width, height, p) - exact;
  EXPECT_LT(std::abs(fine), 0.002 * exact);
  EXPECT_NEAR(observed_order(coarse, fine), 2, 0.1);
  EXPECT_GT(std::abs(deflection_of_frame(height, width, p) - exact), 0.1 * exact);  // it does know its warp
}

}  // namespace
}  // namespace coapt
