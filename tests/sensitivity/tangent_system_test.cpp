#include "sensitivity/tangent_system.hpp"

#include "energy/load_pressure.hpp"
#include "support/equilibrium.hpp"
#include "support/meshes.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <gtest/gtest.h>

namespace coapt {
namespace {

// A taut disc, held in its middle, under follower pressure, which has no potential as its rim is free.
Objective disc_with_a_free_rim(double pressure) {
  const TriangleMesh mesh = smooth_disc_mesh(5);
  Points start = 1.3 * mesh.vertices;
  std::vector<int> held;
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    const double r2 = mesh.vertices.col(v).squaredNorm();
    start(2, v) = 0.2 * r2;
    if (r2 < 0.5) held.push_back(v);
  }
  const FixedMask fixed = fixed_nodes(mesh.vertex_count(), held);
  return Objective(start, fixed,
                   terms_of(membrane_term(mesh.vertices, mesh.triangles, {1, 0.3, 0}),
                            make_follower_pressure("p", mesh.vertices, mesh.triangles, pressure, fixed)));
}

struct FactorisedDisc {
  explicit FactorisedDisc(double pressure) : objective(disc_with_a_free_rim(pressure)) {
    objective.set_path_anchor(q);
    if (system.assemble(objective, q, g)) system.factorise(objective, q);
  }

  Objective objective;
  Vector q = objective.unknowns(), g;
  TangentSystem system{make_multifrontal_factorisation};
};

TEST(TangentSystem, FactorisesATangentThatIsIndefiniteAtItsRimAlone) {
  int indefinite = 0;
  for (const double pressure : {0.1, 6.0, 10.0, 20.0}) {
    FactorisedDisc disc(pressure);
    auto& [objective, q, g, system] = disc;
    ASSERT_TRUE(objective.has_skew_tangent());
    ASSERT_TRUE(system.is_fresh());

    SparseMatrix lower;
    objective.hessian(q, g, lower, Projection::None);
    const Eigen::MatrixXd h = Eigen::MatrixXd(lower).selfadjointView<Eigen::Lower>();
    Eigen::MatrixXd k = h;
    for (Eigen::Index column = 0; column < k.cols(); ++column) {
      Vector product = Vector::Zero(k.rows());
      objective.add_skew_product(Vector::Unit(k.cols(), column), product);
      k.col(column) += product;
    }
    const Vector values =
        Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(h, Eigen::EigenvaluesOnly).eigenvalues();
    EXPECT_EQ(system.negative_modes(), (values.array() < 0).count()) << pressure;
    if (system.negative_modes() > 0) ++indefinite;

    const Vector b = Vector::LinSpaced(q.size(), -1, 2);
    Vector x;
    EXPECT_LT(system.solve(b, x, 1e-9), 1e-9);
    EXPECT_LE(system.applications(), 3) << pressure;
    EXPECT_LT((k * x - b).norm(), 1e-8 * b.norm());
    EXPECT_LT(system.solve_transposed(b, x, 1e-9), 1e-9);
    EXPECT_LE(system.applications(), 3) << pressure;
    EXPECT_LT((k.transpose() * x - b).norm(), 1e-8 * b.norm());
  }
  EXPECT_EQ(indefinite, 3);
}

TEST(TangentSystem, KeepsItsFactorForAStateNearby) {
  FactorisedDisc disc(0.1);
  auto& [objective, q, g, system] = disc;
  ASSERT_TRUE(system.is_fresh() && system.is_of_all());

  const Vector nearby = 1.0001 * q;
  objective.set_path_anchor(nearby);
  ASSERT_TRUE(system.assemble(objective, nearby, g));
  ASSERT_TRUE(system.has_factor());
  EXPECT_FALSE(system.is_fresh());
  const Vector b = Vector::LinSpaced(q.size(), -1, 2);
  Vector x;
  EXPECT_LT(system.solve(b, x, 1e-9), 1e-9);
  EXPECT_GT(system.applications(), 2);
  EXPECT_LE(system.applications(), 8);
  EXPECT_GT(system.solve(b, x, 1e-9, 2), 1e-9);
  EXPECT_EQ(system.applications(), 2);
  ASSERT_TRUE(system.factorise(objective, nearby));
  EXPECT_TRUE(system.is_fresh());
  EXPECT_LT(system.solve_transposed(b, x, 1e-9, 2), 1e-9);
}

}  // namespace
}  // namespace coapt
