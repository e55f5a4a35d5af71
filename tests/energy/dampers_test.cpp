// Dampers of a path: their force and stiffness, and what they must not change.
#include "support/meshes.hpp"
#include "support/valve_scene.hpp"

#include <gtest/gtest.h>

namespace coapt {
namespace {

// With the pressure's remainder on moving rims, contact and chords.
struct DampedValve {
  ValveScene scene{{.contact_gap = 0.5}};
  Objective objective{scene.X, scene.fixed, scene.terms()};
  Vector from = objective.unknowns(scene.X), q = objective.unknowns(shaken(scene.X, 0.02, 4));
  Vector coefficients = Vector::LinSpaced(q.size(), 0.1, 0.3);
};

TEST(Dampers, AddAForceAndAStiffnessToEveryEvaluation) {
  DampedValve valve;
  Objective& objective = valve.objective;
  objective.set_path_anchor(valve.from);
  Vector g, damped_g, unused;
  Eigen::SparseMatrix<double> h, damped_h;
  const double energy = objective.gradient(valve.q, g), value = objective.value(valve.q);
  objective.hessian(valve.q, unused, h);
  objective.damp(valve.coefficients, valve.from);
  EXPECT_TRUE(objective.is_damped());
  const Vector moved = valve.q - valve.from;
  const double stored = 0.5 * valve.coefficients.dot(moved.cwiseAbs2());
  ASSERT_GT(stored, 0);
  EXPECT_NEAR(objective.gradient(valve.q, damped_g) - energy, stored,
              1e-12 * stored + 1e-12 * std::abs(energy));
  EXPECT_NEAR(objective.value(valve.q) - value, stored, 1e-12 * stored + 1e-12 * std::abs(energy));
  EXPECT_LT((damped_g - g - valve.coefficients.cwiseProduct(moved)).norm(), 1e-12 * g.norm());
  objective.hessian(valve.q, unused, damped_h);
  const Eigen::SparseMatrix<double> change = damped_h - h;
  EXPECT_LT((Vector(change.diagonal()) - valve.coefficients).norm(), 1e-9 * valve.coefficients.norm());
  EXPECT_NEAR(change.norm(), valve.coefficients.norm(), 1e-9 * valve.coefficients.norm());
}

TEST(Dampers, LeaveTheForceScaleAloneAndGoWithoutATrace) {
  DampedValve valve;
  Objective& objective = valve.objective;
  objective.set_path_anchor(valve.from);
  const double scale = objective.reference_force(valve.q), residual = objective.true_residual(valve.q);
  objective.damp(1e3 * valve.coefficients, valve.from);
  EXPECT_EQ(objective.reference_force(valve.q), scale);
  EXPECT_GT(objective.true_residual(valve.q), 1.1 * residual);  // a step is judged with its dampers
  objective.damp({}, {});
  EXPECT_FALSE(objective.is_damped());
  EXPECT_EQ(objective.true_residual(valve.q), residual);
}

TEST(Dampers, HoldNoPrescribedCoordinate) {
  DampedValve valve;
  FixedMask fixed = valve.scene.fixed;
  int node = 0;
  while (fixed.col(node).any()) ++node;
  fixed(1, node) = true;  // a symmetry plane
  Objective objective(valve.scene.X, fixed, valve.scene.terms());
  const Vector q = objective.unknowns(shaken(valve.scene.X, 0.02, 4));
  objective.damp(Vector::Constant(q.size(), 0.5), objective.unknowns(valve.scene.X));
  Vector g;
  objective.gradient(q, g);
  EXPECT_EQ((g.array() == 0).count(), 1);
}

TEST(Dampers, ActInAPartAsInTheWhole) {
  DampedValve valve;
  Objective& objective = valve.objective;
  objective.set_path_anchor(valve.q);
  objective.damp(valve.coefficients, valve.from);
  Vector g, of_part;
  objective.gradient(valve.q, g);
  std::vector<int> blocks;
  for (int block = 0; 3 * block < valve.q.size(); block += 7) blocks.push_back(block);
  const auto part = objective.part(valve.q, blocks, 0.2);
  ASSERT_NE(part, nullptr);
  part->gradient(part->unknowns(), of_part);
  for (size_t k = 0; k < blocks.size(); ++k)
    EXPECT_LT((of_part.segment<3>(3 * k) - g.segment<3>(3 * blocks[k])).norm(), 1e-12 * g.norm());
}

TEST(Dampers, LeaveTheTotalLoadToTheLoadFactor) {
  DampedValve valve;
  Objective& objective = valve.objective;
  const double whole = objective.total_load(valve.q);
  EXPECT_GT(whole, 0);
  objective.scale(0.25, 1);
  EXPECT_NEAR(objective.total_load(valve.q), 0.25 * whole, 1e-12 * whole);
}

}  // namespace
}  // namespace coapt
