// Junctions of chords that bear nothing: where they move, where not, and what that saves.
#include "optim/slack_junctions.hpp"

#include "energy/element_term.hpp"
#include "energy/kernels/cable.hpp"
#include "energy/load_dead.hpp"
#include "optim/solver.hpp"

#include <gtest/gtest.h>

namespace coapt {
namespace {

constexpr double kHalf = 0.5e-4;  // of a line's length, by which it is slack at least where it was slackened

// Cables from given nodes, the junctions among them free.
struct Net {
  Points x;
  FixedMask fixed;
  std::vector<int> nodes;
  std::vector<double> lengths;
  double tension = 0;

  Net(std::vector<Vec3> places, std::vector<int> junctions, std::vector<int> ends, std::vector<double> rest)
      : x(3, static_cast<Eigen::Index>(places.size())),
        fixed(FixedMask::Constant(3, x.cols(), true)),
        nodes(std::move(ends)),
        lengths(std::move(rest)) {
    for (size_t k = 0; k < places.size(); ++k) x.col(static_cast<Eigen::Index>(k)) = places[k];
    for (const int junction : junctions) fixed.col(junction) = false;
  }

  std::unique_ptr<EnergyTerm> cables() const {
    std::vector<Cable::Rest> rest;
    for (const double length : lengths)
      rest.push_back({.stiffness = 10, .length = length, .tension = tension});
    return std::make_unique<ElementTerm<Cable>>("chords", nodes, rest);
  }
  Objective objective(std::unique_ptr<EnergyTerm> more = nullptr) const {
    std::vector<std::unique_ptr<EnergyTerm>> terms;
    terms.push_back(cables());
    if (more) terms.push_back(std::move(more));
    return {x, fixed, std::move(terms)};
  }
  // Of the line that is least slack.
  double greatest_share(const Points& at) const {
    double share = 0;
    for (size_t e = 0; e < lengths.size(); ++e)
      share = std::max(share, (at.col(nodes[2 * e + 1]) - at.col(nodes[2 * e])).norm() / lengths[e]);
    return share;
  }
};

// Three lines of length 1 that meet off their middle, the first just taut.
Net three(double length = 1) {
  return {{{1.00001, 0, 0}, {-0.5, 0.7, 0}, {-0.5, -0.7, 0.1}, {0, 0, 0}},
          {3},
          {0, 3, 3, 1, 3, 2},
          {length, length, length}};
}

TEST(SlackJunctions, MoveToWhereAllLinesAreSlack) {
  const Net net = three();
  Objective objective = net.objective();
  SlackJunctions junctions(objective);
  Vector q = objective.unknowns();
  ASSERT_TRUE(junctions.slacken(q));
  EXPECT_LE(net.greatest_share(objective.positions(q)), 1 - kHalf);
  EXPECT_LT((q - objective.unknowns()).norm(), 2e-4);  // no farther than it has to
  EXPECT_EQ(objective.value(q), 0);
  EXPECT_FALSE(junctions.slacken(q));
}

TEST(SlackJunctions, OfATreeMoveTogether) {
  // Two branch points in a row between two ends, each line but the last taut: only both can make room.
  const Net net({{0, 0, 0}, {1.00002, 0, 0}, {2.00004, 0, 0}, {2.9, 0, 0}}, {1, 2}, {0, 1, 1, 2, 2, 3},
                {1, 1, 1});
  Objective objective = net.objective();
  SlackJunctions junctions(objective);
  Vector q = objective.unknowns();
  ASSERT_TRUE(junctions.slacken(q));
  EXPECT_LE(net.greatest_share(objective.positions(q)), 1 - kHalf);
}

TEST(SlackJunctions, StayWhereTheirLinesHaveToPull) {
  const Net net({{0, 0, 0}, {1.00001, 0, 0}, {2.00001, 0, 0}}, {1}, {0, 1, 1, 2}, {1, 1});
  Objective objective = net.objective();
  SlackJunctions junctions(objective);
  EXPECT_FALSE(junctions.is_empty());
  Vector q = objective.unknowns();
  EXPECT_FALSE(junctions.slacken(q));
  EXPECT_EQ(q, objective.unknowns());
}

TEST(SlackJunctions, AreNotWhereSomethingElseHolds) {
  Net net = three();
  Points weight = Points::Zero(3, 4);
  weight(2, 3) = -1e-6;
  Objective loaded = net.objective(std::make_unique<LoadDead>("weight", "load_field", weight, net.x));
  EXPECT_TRUE(SlackJunctions(loaded).is_empty());
  net.tension = 1e-9;
  Objective tight = net.objective();
  EXPECT_TRUE(SlackJunctions(tight).is_empty());
  net.tension = 0;
  net.fixed(2, 3) = true;
  Objective held = net.objective();
  EXPECT_TRUE(SlackJunctions(held).is_empty());
}

// A weight on one cable, and beside it three that can be slack, overstretched at the start.
TEST(SlackJunctions, DoNotHoldNewtonsMethodUp) {
  const Net net({{0, 0, 0}, {0, 0, -1}, {1, 0, 0}, {-0.5, 0.7, 0}, {-0.5, -0.7, 0.1}, {-0.3, 0, 0}}, {1, 5},
                {0, 1, 2, 5, 5, 3, 5, 4}, {1, 1, 1, 1});
  Points weight = Points::Zero(3, 6);
  weight(2, 1) = -0.5;
  Objective objective = net.objective(std::make_unique<LoadDead>("weight", "load_field", weight, net.x));
  const auto newton = built_in_solvers().at("newton")({});
  const Result result = solve(*newton, {objective, objective.unknowns()}, {.tolerance = 1e-10});
  ASSERT_EQ(result.status, Status::Converged);
  const Points at = objective.positions(result.q);
  for (const int end : {2, 3, 4}) EXPECT_LE((at.col(end) - at.col(5)).norm(), 1 - kHalf);
  EXPECT_NEAR(at(2, 1), -1.05, 1e-9);
  EXPECT_LE(result.iterations, 4);
}

}  // namespace
}  // namespace coapt
