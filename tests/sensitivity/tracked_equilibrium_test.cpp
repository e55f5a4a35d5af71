// Warm solves, kinks, lost branches, threads, and what is refused.
#include "core/components.hpp"
#include "energy/contact_facet.hpp"
#include "energy/kernels/spring.hpp"
#include "energy/load_dead.hpp"
#include "sensitivity/metrics/covariance.hpp"
#include "sensitivity/metrics/metrics_state.hpp"
#include "sensitivity/parameters/dead_load.hpp"
#include "sensitivity/refusal.hpp"
#include "sensitivity/tracked_valve.hpp"
#include "sensitivity/truss.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <thread>

namespace coapt {
namespace {

TEST(TrackedEquilibrium, ConvergesInFiveStepsAfterATenthOfAMillimetreOnAChord) {
  TrackedValve valve({.tolerance = 1e-8});
  EnergyTerm& chords = valve.term("chords");
  valve.equilibrium.add(make_line_lengths("lengths", chords, single_lines(chords), LengthMeasure::Length));
  ASSERT_EQ(valve.equilibrium.solve().status, Status::Converged);
  const Vector start = valve.equilibrium.value();
  double greatest_travel = 0;
  for (int chord = 0; chord < start.size(); chord += 5) {
    Vector changed = start;
    changed[chord] -= 0.1;
    for (const Vector& value : {changed, start}) {
      valve.equilibrium.set(value);
      const WarmSolve solved = valve.equilibrium.solve();
      ASSERT_EQ(solved.status, Status::Converged) << solved.message;
      EXPECT_TRUE(solved.is_quick) << "chord " << chord;
      EXPECT_LE(solved.iterations, 5) << "chord " << chord;
      EXPECT_FALSE(solved.lost_branch.has_value()) << "chord " << chord;
      greatest_travel = std::max(greatest_travel, solved.travel);
    }
  }
  EXPECT_GT(greatest_travel, 0.01);  // some of them pull
}

TEST(TrackedEquilibrium, ComesBackToTheShapeWhenAChangeIsUndone) {
  TrackedValve valve;
  valve.add_common();
  ASSERT_EQ(valve.equilibrium.solve().status, Status::Converged);
  const Points start = valve.equilibrium.positions();
  const Vector value = valve.equilibrium.value();
  Vector changed = value;
  for (size_t p = 0; p < valve.equilibrium.parameter_count(); ++p)
    changed += 0.01 * valve.direction(p, 5).cwiseMin(0.5 * value.cwiseAbs().cwiseMax(0.1));
  valve.equilibrium.set(changed);
  ASSERT_EQ(valve.equilibrium.solve().status, Status::Converged);
  EXPECT_GT((valve.equilibrium.positions() - start).cwiseAbs().maxCoeff(), 1e-3);
  valve.equilibrium.set(value);
  ASSERT_EQ(valve.equilibrium.solve().status, Status::Converged);
  std::vector<int> held = valve.scene.held_nodes(start);
  EXPECT_LT((valve.equilibrium.positions() - start)(Eigen::all, held).cwiseAbs().maxCoeff(), 1e-6);
}

// The same steps in several threads at once give the same bits as one after the other.
TEST(TrackedEquilibrium, SeveralAtOnceGiveTheSameBits) {
  closed_small_valve();
  const auto work = [](Vector& gradient) {
    TrackedValve valve;
    valve.add_common();
    valve.equilibrium.solve();
    Vector value = valve.equilibrium.value();
    value[0] *= 0.99;
    valve.equilibrium.set(value);
    valve.equilibrium.solve();
    gradient = valve.equilibrium.derivatives(*make_strain_energy("energy", valve.objective)).gradient;
  };
  Vector alone;
  work(alone);
  std::vector<Vector> together(3);
  {
    std::vector<std::jthread> threads;
    for (Vector& gradient : together) threads.emplace_back([&work, &gradient] { work(gradient); });
  }
  ASSERT_GT(alone.norm(), 0);
  for (const Vector& gradient : together) EXPECT_EQ(gradient, alone);
}

TEST(TrackedEquilibrium, ReportsTheBranchThatASnapLeaves) {
  Truss truss(0.0015);
  ASSERT_EQ(truss.equilibrium.solve().status, Status::Converged);
  EXPECT_GT(truss.equilibrium.positions()(2, 2), 0.1);
  truss.equilibrium.set(Vector::Constant(1, 1.0005));  // a little wider: still above
  const WarmSolve small = truss.equilibrium.solve();
  ASSERT_EQ(small.status, Status::Converged);
  EXPECT_FALSE(small.lost_branch.has_value()) << small.message;
  truss.equilibrium.set(Vector::Constant(1, 1.012));  // too flat to carry the load: it hangs below
  const WarmSolve snap = truss.equilibrium.solve();
  ASSERT_EQ(snap.status, Status::Converged) << snap.message;
  EXPECT_LT(truss.equilibrium.positions()(2, 2), 0);
  ASSERT_TRUE(snap.lost_branch.has_value());
  EXPECT_GT(snap.lost_branch->distance, 0.1);
  EXPECT_NE(snap.message.find("another branch"), std::string::npos);
  EXPECT_LT(truss.equilibrium.positions()(2, 2), 0) << "the check leaves the shape where it was";
}

// A weight on two cables, the second one slack as long as it is longer than its ends are apart.
struct TwoCables {
  static Points rest() {
    Points x(3, 3);
    x << 0, 0.5, 0, 0, 0, 0, 1, 1, 0;
    return x;
  }
  static Points forces() {
    Points f = Points::Zero(3, 3);
    f(2, 2) = -0.01;
    return f;
  }

  TwoCables() {
    equilibrium.add(make_line_lengths("lengths", cables(), single_lines(cables()), LengthMeasure::Length));
  }
  EnergyTerm& cables() { return *objective.terms().back(); }  // loads stand first

  Objective objective{
      rest(), fixed_nodes(3, {0, 1}),
      terms_of(cable_term((Segments(2, 2) << 0, 1, 2, 2).finished(), 1, Eigen::Vector2d(1, 1.3)),
               std::make_unique<LoadDead>("load", "load_field", forces(), rest()))};
  TrackedEquilibrium equilibrium{objective, objective.unknowns(rest()), {.tolerance = 1e-12}};
};

// The slack cable becomes taut when it is shortened to the distance of its ends.
TEST(TrackedEquilibrium, SaysThatItHasLeftTheBranchOfItsAnchor) {
  Truss truss(0.0015);
  ASSERT_EQ(truss.equilibrium.solve().status, Status::Converged);  // the anchor: above
  const Vector q = truss.equilibrium.unknowns(), start = truss.equilibrium.value();
  truss.equilibrium.set(Vector::Constant(1, 1.0005));
  ASSERT_EQ(truss.equilibrium.solve().status, Status::Converged);
  const AnchorCheck above = truss.equilibrium.check_anchor();
  EXPECT_TRUE(above.is_same_branch) << above.message;
  EXPECT_LT(above.back, 1e-6);
  EXPECT_LT(above.here, 1e-6);
  EXPECT_GT(above.travel, 0);

  truss.equilibrium.set(Vector::Constant(1, 1.012));  // it snaps, and stays below when the change is undone
  ASSERT_EQ(truss.equilibrium.solve().status, Status::Converged);
  truss.equilibrium.set(Vector::Constant(1, 1.0005));
  ASSERT_EQ(truss.equilibrium.solve().status, Status::Converged);
  const Points here = truss.equilibrium.positions();
  EXPECT_LT(here(2, 2), 0);
  const AnchorCheck below = truss.equilibrium.check_anchor();
  ASSERT_EQ(below.status, Status::Converged) << below.message;
  EXPECT_FALSE(below.is_same_branch) << below.message;
  EXPECT_GT(below.here, 0.1);  // the same number, reached from above
  EXPECT_NE(below.message.find("has left the branch"), std::string::npos);
  // The check leaves everything where it was.
  EXPECT_EQ(truss.equilibrium.positions(), here);
  EXPECT_EQ(truss.equilibrium.value()[0], 1.0005);
  truss.equilibrium.set(Vector::Constant(1, 1.0004));
  EXPECT_LE(truss.equilibrium.solve().iterations, 5);

  // From an anchor below it is on its own branch.
  truss.equilibrium.anchor_here();
  truss.equilibrium.set(Vector::Constant(1, 1.0005));
  ASSERT_EQ(truss.equilibrium.solve().status, Status::Converged);
  EXPECT_TRUE(truss.equilibrium.check_anchor().is_same_branch);
  truss.equilibrium.anchor_at(start, q);
  EXPECT_FALSE(truss.equilibrium.check_anchor().is_same_branch);
  EXPECT_THROW(truss.equilibrium.anchor_at(start, q.head(1)), InputError);
}

// What is added later had the same numbers at the anchor as it has now.
TEST(TrackedEquilibrium, ComparesWithItsAnchorAfterAParameterWasAdded) {
  Truss truss(0.0015);
  ASSERT_EQ(truss.equilibrium.solve().status, Status::Converged);
  truss.equilibrium.set(Vector::Constant(1, 1.0005));
  ASSERT_EQ(truss.equilibrium.solve().status, Status::Converged);
  truss.equilibrium.add(make_load_factor("load", *truss.objective.terms().front()));
  truss.equilibrium.set(Eigen::Vector2d(1.0005, 0.9));
  ASSERT_EQ(truss.equilibrium.solve().status, Status::Converged);
  const AnchorCheck check = truss.equilibrium.check_anchor();
  ASSERT_EQ(check.status, Status::Converged) << check.message;
  EXPECT_TRUE(check.is_same_branch) << check.message;
  EXPECT_GT(check.travel, 0);
  EXPECT_LT(std::max(check.back, check.here), 1e-6);
}

TEST(TrackedEquilibrium, GoesOnWhereAnotherOneWasLeft) {
  Truss left(0.0015), resumed(0.0015);
  const Vector start = left.equilibrium.value();
  ASSERT_EQ(left.equilibrium.solve().status, Status::Converged);
  for (const double width : {1.012, 1.0005}) {  // it snaps through, and stays below
    left.equilibrium.set(Vector::Constant(1, width));
    ASSERT_EQ(left.equilibrium.solve().status, Status::Converged);
  }
  const Points here = left.equilibrium.positions();
  ASSERT_LT(here(2, 2), 0);
  ASSERT_EQ(resumed.equilibrium.solve().status, Status::Converged);
  ASSERT_GT(resumed.equilibrium.positions()(2, 2), 0);
  resumed.equilibrium.resume_at(left.equilibrium.value(), left.equilibrium.unknowns());
  EXPECT_EQ(resumed.equilibrium.positions(), here);
  EXPECT_EQ(resumed.equilibrium.value(), left.equilibrium.value());
  EXPECT_THROW(resumed.equilibrium.pull_back(here), InputError);  // not solved yet
  const WarmSolve report = resumed.equilibrium.solve();
  EXPECT_EQ(report.status, Status::Converged);
  EXPECT_EQ(report.iterations, 0);
  EXPECT_FALSE(report.lost_branch);
  EXPECT_EQ(resumed.equilibrium.positions(), here);
  const Vector slope = resumed.equilibrium.pull_back(here);
  EXPECT_EQ(slope, left.equilibrium.pull_back(here));
  EXPECT_GT(slope.norm(), 0);
  EXPECT_THROW(resumed.equilibrium.resume_at(start, left.equilibrium.unknowns().head(1)), InputError);
  EXPECT_THROW(resumed.equilibrium.resume_at(start.head(0), left.equilibrium.unknowns()), InputError);
}

TEST(TrackedEquilibrium, ComparesWithItsAnchorEveryFewSteps) {
  Truss truss(0.0015, {.anchor_steps = 3});
  ASSERT_EQ(truss.equilibrium.solve().status, Status::Converged);
  const double widths[] = {1.012, 1.0110, 1.0100, 1.0005};
  std::vector<bool> compared;
  bool has_left = false;
  for (const double width : widths) {
    truss.equilibrium.set(Vector::Constant(1, width));
    const WarmSolve solved = truss.equilibrium.solve();
    ASSERT_EQ(solved.status, Status::Converged);
    compared.push_back(solved.anchor.has_value());
    if (solved.anchor) {
      has_left = !solved.anchor->is_same_branch;
      EXPECT_EQ(solved.message.find("has left") != std::string::npos, has_left);
    }
  }
  EXPECT_EQ(compared, (std::vector<bool>{false, false, true, false}));
  EXPECT_TRUE(has_left);
}

TEST(TrackedEquilibrium, ReportsAKink) {
  TwoCables two;
  TrackedEquilibrium& equilibrium = two.equilibrium;
  ASSERT_EQ(equilibrium.solve().status, Status::Converged);
  EXPECT_TRUE(equilibrium.switches(Eigen::Vector2d(0.01, 0)).empty());
  const double apart = (equilibrium.positions().col(2) - equilibrium.positions().col(1)).norm();
  const std::vector<Switch> found = equilibrium.switches(Eigen::Vector2d(1.4 * (1.3 - apart), 0));
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].term, two.cables().name());
  EXPECT_EQ(found[0].element, 1);
  EXPECT_EQ(found[0].before, "slack");
  EXPECT_EQ(found[0].after, "taut");

  // Where the slack cable is just as long as its ends are apart, the smallest change has a kink.
  equilibrium.set(Eigen::Vector2d(1, apart));
  ASSERT_EQ(equilibrium.solve().status, Status::Converged);
  EXPECT_EQ(equilibrium.switches(Eigen::Vector2d(0, 1e-8)).size(), 1U);
  EXPECT_EQ(equilibrium.switches(Eigen::Vector2d(1e-8, 0)).size(), 1U);
}

// What is told without being asked for.
TEST(TrackedEquilibrium, TellsOfKinksThatItPassesAndStandsAt) {
  TwoCables two;
  TrackedEquilibrium& equilibrium = two.equilibrium;
  const UserMetric height("height", [](const Points& shape, Points* by_x) {
    if (by_x != nullptr) (*by_x)(2, 2) = 1;
    return shape(2, 2);
  });
  const auto solved = [&](double second) {
    equilibrium.set(Eigen::Vector2d(1, second));
    const WarmSolve warm = equilibrium.solve();
    EXPECT_EQ(warm.status, Status::Converged) << warm.message;
    return warm.switched;
  };
  EXPECT_TRUE(solved(1.3).empty());
  EXPECT_TRUE(solved(1.25).empty()) << "still slack";
  EXPECT_TRUE(equilibrium.derivatives(height).kinks.empty());
  const double apart = (equilibrium.positions().col(2) - equilibrium.positions().col(1)).norm();

  const std::vector<Switch> passed = solved(0.95 * apart);
  ASSERT_EQ(passed.size(), 1U);
  EXPECT_EQ(passed[0].term, two.cables().name());
  EXPECT_EQ(passed[0].element, 1);
  EXPECT_EQ(passed[0].before, "slack");
  EXPECT_EQ(passed[0].after, "taut");
  EXPECT_TRUE(passed[0].is_kink);
  EXPECT_TRUE(equilibrium.derivatives(height).kinks.empty());
  ASSERT_EQ(solved(1.25).size(), 1U) << "and back";

  solved(apart);  // just as long as its ends are apart
  const std::vector<Switch> kinks = equilibrium.derivatives(height).kinks;
  ASSERT_EQ(kinks.size(), 1U);
  EXPECT_EQ(kinks[0].element, 1);
  EXPECT_EQ(kinks[0].before, "slack");
  EXPECT_EQ(kinks[0].after, "taut");
  solved(0.999 * apart);
  EXPECT_TRUE(equilibrium.kinks().empty()) << "of this shape";
}

// Two triangles above one another come within range of their repulsion.
TEST(TrackedEquilibrium, FollowsTheRepulsionOfFacets) {
  const double range = 0.1;
  const auto at = [](double height) {
    Points x(3, 6);
    x << 0, 1, 0, 0, 1, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0, height, height, height;
    return x;
  };
  const Triangles facets = (Triangles(3, 2) << 0, 3, 1, 4, 2, 5).finished();
  const std::vector<Component> parts = components();
  if (std::ranges::none_of(parts, [](const Component& c) { return c.name == "nanoflann" && c.present; }))
    GTEST_SKIP() << "skipped: built without nanoflann";
  Objective objective(
      at(0.15), fixed_nodes(6, {0, 1, 2}),
      terms_of(make_contact_facet("contact", at(0.15), facets, {.range = range, .strength = 1})));
  objective.true_residual(objective.unknowns(at(0.15)));  // lets it look for pairs
  const ElementStates far = element_states(objective, at(0.11)), near = element_states(objective, at(0.09)),
                      nearer = element_states(objective, at(0.05));
  EXPECT_TRUE(far.empty());
  ASSERT_EQ(near.size(), 1U);
  EXPECT_EQ(near[0].detail, 3) << "each point and the one above it";
  const std::vector<Switch> found = switches_between(objective, far, near);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].term, "contact");
  EXPECT_EQ(found[0].before, "apart");
  EXPECT_EQ(found[0].after, "within range");
  EXPECT_FALSE(found[0].is_kink) << "its exponent is 3";
  EXPECT_TRUE(switches_between(objective, near, nearer).empty());
}

TEST(TrackedEquilibrium, SaysWhichContactsAndMembranesSwitch) {
  TrackedValve valve;
  EnergyTerm& chords = valve.term("chords");
  valve.equilibrium.add(make_line_lengths("lengths", chords, single_lines(chords), LengthMeasure::Length));
  ASSERT_EQ(valve.equilibrium.solve().status, Status::Converged);
  const Vector change = Vector::Constant(valve.equilibrium.number_count(), 0.02);
  std::map<std::string, int> count;
  for (const Switch& each : valve.equilibrium.switches(change)) {
    EXPECT_NE(each.before, each.after);
    ++count[each.term];
  }
  EXPECT_GT(count[valve.term("contact").name()], 0);
  EXPECT_GT(count[valve.term("membrane").name()], 0);
  EXPECT_TRUE(valve.equilibrium.switches(1e-12 * change).empty());
}

TEST(TrackedEquilibrium, RefusesWhatMeansNothing) {
  TrackedValve valve;
  TrackedEquilibrium& equilibrium = valve.equilibrium;
  EnergyTerm& chords = valve.term("chords");
  EnergyTerm& membrane = valve.term("membrane");
  const auto contains = [](const std::string& text, const std::string& part) {
    EXPECT_NE(text.find(part), std::string::npos) << text;
  };
  contains(refusal([&] { equilibrium.derivatives(*make_strain_energy("energy", valve.objective)); }),
           "solve()");
  contains(refusal([&] { make_line_lengths("a", membrane, {{0}}, LengthMeasure::Length); }), "no lines");
  contains(refusal([&] {
             make_line_lengths("a", chords, {{0, 0}, {}, {99999}}, LengthMeasure::Change);
           }),
           "in a group already");
  contains(refusal([&] { make_pressure_value("p", chords); }), "no pressure");
  contains(refusal([&] { make_stiffness_factor("e", {{.term = &valve.term("contact")}}, 1); }),
           "no stiffness");
  int free_node = 0;
  while (valve.scene.fixed.col(free_node).all()) ++free_node;
  contains(refusal([&] {
             make_prescribed_positions("n", valve.objective, {free_node}, free_positions(), Vec3::Zero());
           }),
           "not prescribed");
  contains(refusal([&] { make_reference_positions("x", valve.objective, 1.1 * valve.scene.X, {free_node}); }),
           "is not that of term");
  equilibrium.add(make_line_lengths("lengths", chords, {{0}}, LengthMeasure::Length));
  contains(
      refusal([&] { equilibrium.add(make_line_lengths("lengths", chords, {{1}}, LengthMeasure::Length)); }),
      "of that name");
  contains(refusal([&] { equilibrium.set(Vector::Constant(1, -1)); }), "must stay positive");
  contains(refusal([&] { equilibrium.set(Vector::Constant(2, 1)); }), "2 numbers were given");
  EXPECT_GT(equilibrium.value()[0], 0);  // nothing has changed
  contains(
      refusal([] { first_order_covariance(Eigen::MatrixXd::Ones(1, 2), -Eigen::MatrixXd::Identity(2, 2)); }),
      "negative eigenvalue");
  contains(
      refusal([] { first_order_covariance(Eigen::MatrixXd::Ones(1, 2), Eigen::MatrixXd::Identity(3, 3)); }),
      "3 x 3");
}

}  // namespace
}  // namespace coapt
