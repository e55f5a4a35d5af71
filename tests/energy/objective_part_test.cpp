// A part of the unknowns by itself: the whole objective's derivatives, its scale and its contact.
#include "energy/objective.hpp"
#include "optim/worst_part.hpp"
#include "support/equilibrium.hpp"
#include "support/meshes.hpp"
#include "support/valve_scene.hpp"

#include <gtest/gtest.h>

namespace coapt {
namespace {

// With the pressure's remainder on moving rims, contact and chords.
struct WholeValve {
  ValveScene scene{{.contact_gap = 0.5}};
  Objective objective{scene.X, scene.fixed, scene.terms()};
  Vector q = objective.unknowns(shaken(scene.X, 0.02, 4));
  Vector g;

  // Every seventh node.
  std::vector<int> blocks() const {
    std::vector<int> chosen;
    for (int block = 0; 3 * block < q.size(); block += 7) chosen.push_back(block);
    return chosen;
  }
};

TEST(ObjectivePart, HasTheDerivativesOfTheWholeInItsUnknowns) {
  WholeValve valve;
  valve.objective.set_path_anchor(valve.q);
  valve.objective.scale(0.7, 1.3);
  valve.objective.gradient(valve.q, valve.g);
  const double reach = 0.2;
  const auto blocks = valve.blocks();
  const auto part = valve.objective.part(valve.q, blocks, reach);
  ASSERT_NE(part, nullptr);
  ASSERT_EQ(part->unknown_count(), 3 * static_cast<int>(blocks.size()));
  EXPECT_LT(part->node_count(), valve.objective.node_count());

  Vector of_part, start = part->unknowns();
  for (const double moved : {0.0, 0.3 * reach}) {
    Vector q = valve.q, q_part = start;
    for (size_t k = 0; k < blocks.size(); ++k) {
      const Vec3 d = moved * Vec3(std::sin(1.0 * k), std::cos(1.7 * k), std::sin(2.3 * k));
      q_part.segment<3>(3 * k) += d;
      q.segment<3>(3 * blocks[k]) += d;
    }
    part->gradient(q_part, of_part);
    valve.objective.gradient(q, valve.g);
    for (size_t k = 0; k < blocks.size(); ++k)
      EXPECT_LT((of_part.segment<3>(3 * k) - valve.g.segment<3>(3 * blocks[k])).norm(),
                1e-12 * valve.g.norm());
  }
}

TEST(ObjectivePart, IsMeasuredByTheWholesForce) {
  WholeValve valve;
  valve.objective.set_path_anchor(valve.q);
  valve.objective.gradient(valve.q, valve.g);
  const auto part = valve.objective.part(valve.q, valve.blocks(), 0.1);
  Vector g;
  part->gradient(part->unknowns(), g);
  EXPECT_EQ(part->reference_force(part->unknowns()), valve.objective.reference_force(valve.q));
}

TEST(ObjectivePart, KeepsItsNodesWithinReach) {
  WholeValve valve;
  valve.objective.set_path_anchor(valve.q);
  valve.objective.gradient(valve.q, valve.g);
  const auto part = valve.objective.part(valve.q, {3, 4}, 0.01);
  Vector along = Vector::Zero(6);
  along[1] = 5;
  const double limit = part->step_limit(part->unknowns(), along, 1);
  EXPECT_GT(limit, 0);
  EXPECT_LE(limit, 0.01 / 5 * (1 + 1e-12));
}

TEST(ObjectivePart, IsNotToBeHadWhereTheRemainderIsHeldDead) {
  WholeValve valve;
  valve.objective.lag_circulatory_force(valve.q);
  valve.objective.gradient(valve.q, valve.g);
  EXPECT_EQ(valve.objective.part(valve.q, {3, 4}, 0.1), nullptr);
}

// A chain of nodes, coupled each to the next.
SparseMatrix chain(int count) {
  std::vector<Eigen::Triplet<double>> entries;
  for (int column = 0; column < 3 * count; ++column)
    for (int row = 0; row < 3 * count; ++row)
      if (row / 3 == column / 3 || row / 3 == column / 3 + 1) entries.emplace_back(row, column, 1);
  SparseMatrix lower(3 * count, 3 * count);
  lower.setFromTriplets(entries.begin(), entries.end());
  return lower;
}

TEST(WorstPart, IsWhatBearsTheForceAndItsNeighbours) {
  Vector g = Vector::Zero(3 * 20);
  g[3 * 5 + 1] = -8;
  g[3 * 6] = 1;
  g[3 * 6 + 2] = 1;
  g[3 * 12] = 0.5;
  WorstPart worst(20);
  ASSERT_TRUE(worst.find(g, chain(20)));
  EXPECT_EQ(worst.blocks, (std::vector<int>{4, 5, 6, 7}));
  EXPECT_EQ(worst.outside, 0.5);
  EXPECT_EQ(worst.share(), 0.2);
}

TEST(WorstPart, IsNoneWhereAllIsOutOfBalanceOrNothing) {
  EXPECT_FALSE(WorstPart(100).find(Vector::Ones(3 * 100), chain(100)));
  EXPECT_FALSE(WorstPart(100).find(Vector::Zero(3 * 100), chain(100)));
}

// 40 nodes, each third of a chain, bear the force; with their neighbours they are the first 120 of it.
TEST(WorstPart, IsNoneWhereItIsAGreatShareOfAll) {
  const auto every_third = [](int count) {
    Vector g = Vector::Zero(3 * count);
    for (int node = 1; node < 120; node += 3) g[3 * node] = 1;
    return g;
  };
  EXPECT_FALSE(WorstPart(120).find(every_third(120), chain(120)));
  EXPECT_FALSE(WorstPart(380).find(every_third(380), chain(380)));
  WorstPart worst(420);
  ASSERT_TRUE(worst.find(every_third(420), chain(420)));
  EXPECT_EQ(worst.blocks.size(), 120u);
}

}  // namespace
}  // namespace coapt
