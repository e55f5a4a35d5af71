// Row A6 of the verification table: a manufactured solution. The exact map
//   x(X, Y) = (1.6 X + 0.05 sin 2piX sin piY, 1.6 Y + 0.05 sin piX sin 2piY, 0.3 sin piX sin piY)
// of the unit square (Eh = 1, nu = 0.3) is in equilibrium under the dead body force b = -DIV P(F), which
// automatic differentiation takes from the analytic F. The map is taut everywhere, so it is a minimum.
#include "energy/load_dead.hpp"
#include "support/equilibrium.hpp"
#include "support/meshes.hpp"
#include "support/sanitized.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <unsupported/Eigen/AutoDiff>

namespace coapt {
namespace {

constexpr double kPi = std::numbers::pi, kNu = 0.3;

using Dual = Eigen::AutoDiffScalar<Eigen::Vector2d>;

Vec3 exact_position(double X, double Y) {
  return {1.6 * X + 0.05 * std::sin(2 * kPi * X) * std::sin(kPi * Y),
          1.6 * Y + 0.05 * std::sin(kPi * X) * std::sin(2 * kPi * Y),
          0.3 * std::sin(kPi * X) * std::sin(kPi * Y)};
}

// First Piola-Kirchhoff stress P = F S, 3 x 2, row by row; the energy density on request.
template <typename T>
std::array<T, 6> stress(const T& X, const T& Y, T* energy = nullptr) {
  using std::cos, std::sin;
  const T sX = sin(T(kPi * X)), cX = cos(T(kPi * X)), sY = sin(T(kPi * Y)), cY = cos(T(kPi * Y));
  const T s2X = sin(T(2 * kPi * X)), c2X = cos(T(2 * kPi * X)), s2Y = sin(T(2 * kPi * Y)),
          c2Y = cos(T(2 * kPi * Y));
  const T F[3][2] = {{T(1.6 + 0.1 * kPi * T(c2X * sY)), T(0.05 * kPi * T(s2X * cY))},
                     {T(0.05 * kPi * T(cX * s2Y)), T(1.6 + 0.1 * kPi * T(sX * c2Y))},
                     {T(0.3 * kPi * T(cX * sY)), T(0.3 * kPi * T(sX * cY))}};
  T E[2][2];
  for (int a = 0; a < 2; ++a)
    for (int b = 0; b < 2; ++b) {
      T sum = T(a == b ? -1.0 : 0.0);
      for (int i = 0; i < 3; ++i) sum = T(sum + F[i][a] * F[i][b]);
      E[a][b] = T(0.5 * sum);
    }
  const double k = 1 / (1 - kNu * kNu);
  const T trace = T(E[0][0] + E[1][1]);
  std::array<T, 6> P;
  for (int i = 0; i < 3; ++i)
    for (int b = 0; b < 2; ++b) {
      P[2 * i + b] = T(0.0);
      for (int a = 0; a < 2; ++a) {
        T S = T((1 - kNu) * k * E[a][b]);
        if (a == b) S = T(S + kNu * k * trace);
        P[2 * i + b] = T(P[2 * i + b] + F[i][a] * S);
      }
    }
  if (energy != nullptr) {
    T square = T(0.0);
    for (int a = 0; a < 2; ++a)
      for (int b = 0; b < 2; ++b) square = T(square + E[a][b] * E[a][b]);
    *energy = T(0.5 * k * T((1 - kNu) * square + kNu * T(trace * trace)));
  }
  return P;
}

Vec3 body_force(double X, double Y) {
  const std::array<Dual, 6> P = stress(Dual(X, 2, 0), Dual(Y, 2, 1));
  Vec3 b;
  for (int i = 0; i < 3; ++i) b[i] = -(P[2 * i].derivatives()[0] + P[2 * i + 1].derivatives()[1]);
  return b;
}

// Six points a triangle, exact to degree four (Dunavant 1985): barycentric coordinates and weight.
template <typename Visit>
void quadrature(const Visit& visit) {
  for (const auto& [a, weight] :
       {std::pair{0.445948490915965, 0.223381589678011}, std::pair{0.091576213509771, 0.109951743655322}})
    for (int k = 0; k < 3; ++k) {
      Vec3 barycentric = Vec3::Constant(a);
      barycentric[k] = 1 - 2 * a;
      visit(barycentric, weight);
    }
}

Points nodal_body_forces(const TriangleMesh& mesh) {
  Points forces = Points::Zero(3, mesh.vertex_count());
  for (int t = 0; t < mesh.triangle_count(); ++t) {
    const Eigen::Vector3i c = mesh.triangles.col(t);
    const double area = area_vector(mesh.vertices, c).norm();
    quadrature([&](const Vec3& at, double weight) {
      Vec3 X = Vec3::Zero();
      for (int a = 0; a < 3; ++a) X += at[a] * mesh.vertices.col(c[a]);
      const Vec3 b = body_force(X[0], X[1]);
      for (int a = 0; a < 3; ++a) forces.col(c[a]) += weight * area * at[a] * b;
    });
  }
  return forces;
}

struct Errors {
  double displacement = 0, energy = 0, stress = 0;  // L2; of the strain energy; L2
};

// P of the constant-strain triangle.
Eigen::Matrix<double, 3, 2> triangle_stress(const TriangleMesh& mesh, const Points& x,
                                            const Eigen::Vector3i& c) {
  Eigen::Matrix2d rest;
  rest << (mesh.vertices.col(c[1]) - mesh.vertices.col(c[0])).head<2>(),
      (mesh.vertices.col(c[2]) - mesh.vertices.col(c[0])).head<2>();
  Eigen::Matrix<double, 3, 2> edges;
  edges << x.col(c[1]) - x.col(c[0]), x.col(c[2]) - x.col(c[0]);
  const Eigen::Matrix<double, 3, 2> F = edges * rest.inverse();
  const Eigen::Matrix2d E = 0.5 * (F.transpose() * F - Eigen::Matrix2d::Identity());
  return F / (1 - kNu * kNu) * ((1 - kNu) * E + kNu * E.trace() * Eigen::Matrix2d::Identity());
}

Errors solve_manufactured(int n) {
  TriangleMesh mesh = grid_mesh(n, n);
  Points start(3, mesh.vertex_count());
  FixedMask fixed = FixedMask::Constant(3, mesh.vertex_count(), false);
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    const double X = mesh.vertices(0, v), Y = mesh.vertices(1, v);
    const bool on_rim = X < 1e-9 || X > 1 - 1e-9 || Y < 1e-9 || Y > 1 - 1e-9;
    fixed.col(v).setConstant(on_rim);
    start.col(v) = on_rim ? exact_position(X, Y) : Vec3(1.6 * X, 1.6 * Y, 0.01);
  }
  auto load = std::make_unique<LoadDead>("body", "load_field", nodal_body_forces(mesh), mesh.vertices);
  const Equilibrium found = find_equilibrium(
      start, fixed, terms_of(membrane_term(mesh.vertices, mesh.triangles, {1, kNu, 0}), std::move(load)),
      1e-10);
  EXPECT_EQ(found.result.status, Status::Converged) << found.result.message;

  Errors errors;
  double exact_energy = 0,
         energy = membrane_energy(*membrane_term(mesh.vertices, mesh.triangles, {1, kNu, 0}), found.x);
  for (int t = 0; t < mesh.triangle_count(); ++t) {
    const Eigen::Vector3i c = mesh.triangles.col(t);
    const double area = area_vector(mesh.vertices, c).norm();
    const Eigen::Matrix<double, 3, 2> P = triangle_stress(mesh, found.x, c);
    quadrature([&](const Vec3& at, double weight) {
      Vec3 X = Vec3::Zero(), x = Vec3::Zero();
      for (int a = 0; a < 3; ++a) {
        X += at[a] * mesh.vertices.col(c[a]);
        x += at[a] * found.x.col(c[a]);
      }
      double density = 0;
      const std::array<double, 6> exact = stress(X[0], X[1], &density);
      exact_energy += weight * area * density;
      errors.displacement += weight * area * (x - exact_position(X[0], X[1])).squaredNorm();
      for (int i = 0; i < 3; ++i)
        for (int b = 0; b < 2; ++b) errors.stress += weight * area * std::pow(P(i, b) - exact[2 * i + b], 2);
    });
  }
  errors.displacement = std::sqrt(errors.displacement);
  errors.stress = std::sqrt(errors.stress);
  errors.energy = std::abs(energy - exact_energy);
  if (n >= 32) {
    EXPECT_NEAR(exact_energy, 1.32871013, 1e-6);
  }
  return errors;
}

TEST(ManufacturedSolution, BodyForceIsThatOfTheReference) {
  EXPECT_LT((body_force(0.25, 0.35) - Vec3(11.3201195, 5.81542777, 7.83166955)).norm(), 1e-6);
  EXPECT_LT((body_force(0.5, 0.5) - Vec3(0, 0, 2.76371367)).norm(), 1e-7);
}

TEST(ManufacturedSolution, A6ConvergesAtTheOrdersOfLinearElements) {
  const Errors e8 = solve_manufactured(8), e16 = solve_manufactured(16), e32 = solve_manufactured(32);
  const auto expect_orders = [](const Errors& coarse, const Errors& fine) {
    EXPECT_GT(observed_order(coarse.displacement, fine.displacement), 1.9);
    EXPECT_GT(observed_order(coarse.energy, fine.energy), 1.9);
    EXPECT_GT(observed_order(coarse.stress, fine.stress), 0.9);
  };
  std::printf("A6 displacement %.2e %.2e %.2e energy %.2e %.2e %.2e stress %.2e %.2e %.2e\n", e8.displacement,
              e16.displacement, e32.displacement, e8.energy, e16.energy, e32.energy, e8.stress, e16.stress,
              e32.stress);
  expect_orders(e8, e16);
  expect_orders(e16, e32);
  if (is_sanitized()) return;
  expect_orders(e32, solve_manufactured(64));
}

}  // namespace
}  // namespace coapt
