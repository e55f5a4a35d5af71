// Parameters by themselves: dead loads, the rest shape of fibrous membranes and hinges, and which of them go
// together.
#include "energy/element_term.hpp"
#include "energy/kernels/bending.hpp"
#include "energy/kernels/cst_fibrous.hpp"
#include "energy/kernels/spring.hpp"
#include "energy/load_dead.hpp"
#include "sensitivity/metrics/metrics_state.hpp"
#include "sensitivity/parameters/dead_load.hpp"
#include "sensitivity/parameters/joint_parameter.hpp"
#include "sensitivity/parameters/line_lengths.hpp"
#include "sensitivity/parameters/prescribed_positions.hpp"
#include "sensitivity/parameters/reference_positions.hpp"
#include "sensitivity/parameters/stiffness_factor.hpp"
#include "sensitivity/parameters/term_number.hpp"
#include "sensitivity/refusal.hpp"
#include "sensitivity/tracked_equilibrium.hpp"
#include "support/equilibrium.hpp"

#include <gtest/gtest.h>

#include <functional>

namespace coapt {
namespace {

void expect_contains(const std::string& text, const std::string& part) {
  EXPECT_NE(text.find(part), std::string::npos) << text;
}

// Derivative of f at 0, by central differences of fourth order.
template <typename Function>
auto slope_of(const Function& f, double h) {
  return ((8 * (f(h) - f(-h)) - (f(2 * h) - f(-2 * h))) / (12 * h)).eval();
}

// A line of three cables between two supports, loaded at its two inner nodes and, to no effect, at a support.
struct LoadedLine {
  LoadedLine()
      : objective(
            positions(), fixed_nodes(4, {0, 1}),
            terms_of(cable_term((Segments(2, 3) << 0, 2, 3, 2, 3, 1).finished(), 5, Eigen::Vector3d(1, 1, 1)),
                     std::make_unique<LoadDead>("weight", "load_field", forces(), positions()))),
        equilibrium(objective, objective.unknowns(positions()), {.tolerance = 1e-12}) {}

  static Points positions() {
    return (Points(3, 4) << 0, 3, 0.9, 2, 0, 0, 0.1, 0.1, 0, 0, -0.6, -0.7).finished();
  }
  static Points forces() {
    return (Points(3, 4) << 1, 0, 0.01, 0.02, 1, 0, 0.03, 0.01, 1, 0, -0.2, -0.3).finished();
  }
  EnergyTerm& cables() const { return named("cables"); }
  EnergyTerm& weight() const { return named("weight"); }
  EnergyTerm& named(const std::string& name) const {
    for (const auto& term : objective.terms())
      if (term->name() == name) return *term;
    throw std::runtime_error("no term " + name);
  }

  Objective objective;
  TrackedEquilibrium equilibrium;
};

// Of the place of a node and of the elastic energy, by every number, against differences of solved shapes.
void expect_exact(LoadedLine& line) {
  TrackedEquilibrium& equilibrium = line.equilibrium;
  ASSERT_EQ(equilibrium.solve().status, Status::Converged);
  const Vector start = equilibrium.value();
  const auto place = make_node_position("place", {2}, Vec3(0.3, -0.5, 1));
  const auto energy = make_strain_energy("energy", line.objective);
  const Eigen::MatrixXd exact = equilibrium.jacobian({place.get(), energy.get()});
  for (Eigen::Index number = 0; number < start.size(); ++number) {
    const auto at = [&](double s) {
      equilibrium.set(start + s * Vector::Unit(start.size(), number));
      EXPECT_EQ(equilibrium.solve().status, Status::Converged);
      const Points x = equilibrium.positions();
      return Eigen::Vector2d(place->evaluate(x, nullptr), energy->evaluate(x, nullptr));
    };
    const Eigen::Vector2d slope = slope_of(at, 1e-4);
    EXPECT_LT((exact.col(number) - slope).norm(), 1e-6 * exact.norm()) << number;
    equilibrium.set(start);
    ASSERT_EQ(equilibrium.solve().status, Status::Converged);
  }
  EXPECT_GT(exact.norm(), 0.1);
}

TEST(DeadLoad, ItsFactorHasExactDerivatives) {
  LoadedLine line;
  line.equilibrium.add(make_load_factor("factor", line.weight()));
  EXPECT_EQ(line.equilibrium.value(), Vector::Ones(1));
  expect_exact(line);
  line.equilibrium.set(Vector::Constant(1, 0.5));
  ASSERT_EQ(line.equilibrium.solve().status, Status::Converged);
  const Points halved = dynamic_cast<LoadDead&>(line.weight()).forces();
  EXPECT_EQ(halved, Points(0.5 * LoadedLine::forces()(Eigen::all, {0, 2, 3})));
}

TEST(DeadLoad, EveryForceHasExactDerivatives) {
  LoadedLine line;
  line.equilibrium.add(make_nodal_forces("forces", line.weight()));
  EXPECT_EQ(line.equilibrium.value(), Vector(LoadedLine::forces()(Eigen::all, {0, 2, 3}).reshaped()));
  expect_exact(line);
  const Vector change = Vector::LinSpaced(9, -1, 2);
  const Points x = line.equilibrium.positions();
  const auto forces = make_nodal_forces("others", line.weight());
  const auto energy_at = [&](double s) {
    forces->set(line.equilibrium.value() + s * change);
    Sink sink;
    return Vector::Constant(1, line.weight().evaluate(x, sink));
  };
  EXPECT_NEAR(slope_of(energy_at, 1e-3)[0], forces->energy_derivative(x, line.weight()).dot(change), 1e-10);
}

TEST(DeadLoad, OtherTermsAndForcesAreRefused) {
  LoadedLine line;
  expect_contains(refusal([&] { make_load_factor("f", line.cables()); }), "keep their direction");
  expect_contains(refusal([&] { make_nodal_forces("f", line.cables()); }), "\"f\": term \"cables\"");
  line.equilibrium.add(make_load_factor("f", line.weight()));
  expect_contains(refusal([&] { line.equilibrium.set(Vector::Constant(1, kNaN)); }), "must be finite");
}

using Fibrous = CstFibrous<MayNewmanYinLaw>;

// Two triangles that share an edge, with a fibre across each, as a line that is drawn on it.
struct FibrousPatch {
  static constexpr int kCorners[2][3] = {{0, 1, 2}, {1, 3, 2}};
  Points X = (Points(3, 4) << 0, 2, 0.3, 2.2, 0, 0.1, 1.5, 1.8, 0, 0.2, -0.1, 0.3).finished();
  Points x = 1.25 * X + (Points(3, 4) << 0.1, 0, 0.05, 0, 0, -0.1, 0.1, 0.2, 0, 0.1, 0.3, -0.2).finished();

  static std::unique_ptr<ElementTerm<Fibrous>> term(const Points& X) {
    std::vector<Fibrous::Rest> rest;
    std::vector<int> nodes;
    for (const auto& n : kCorners) {
      const Vec3 fibre = 0.8 * (X.col(n[1]) - X.col(n[0])) + 0.7 * (X.col(n[2]) - X.col(n[0]));
      rest.push_back(Fibrous::rest(X.col(n[0]), X.col(n[1]), X.col(n[2]), fibre, {0.1, 0.5, 4}, 0.3));
      nodes.insert(nodes.end(), n, n + 3);
    }
    return std::make_unique<ElementTerm<Fibrous>>("tissue", nodes, rest);
  }
};

using MakeTerm = std::function<std::unique_ptr<EnergyTerm>(const Points& X)>;

// Gradient at x of four nodes, then the energy.
Vector derivatives_at(const EnergyTerm& term, const Points& x) {
  Points g = Points::Zero(3, 4);
  Sink sink(g.data());
  Vector all(13);
  all[12] = term.evaluate(x, sink);
  all.head<12>() = g.reshaped();
  return all;
}

// By the places of three of the nodes at rest: of gradient and energy at x, against differences of terms that
// are made anew.
void expect_derivatives_by_rest_shape(const Points& X, const Points& x, const MakeTerm& make) {
  Objective objective(X, fixed_nodes(4, {}), terms_of(make(X)));
  const EnergyTerm& term = *objective.terms().front();
  const auto rest = make_reference_positions("rest", objective, X, {1, 3, 0});
  Points motion = Points::Zero(3, 4);
  motion(Eigen::all, {1, 3, 0}) << 1, -2, 0.5, 0.3, 1, -1, -0.7, 0.4, 0.9;
  const Vector change = motion(Eigen::all, {1, 3, 0}).reshaped();
  const Vector slope = slope_of([&](double s) { return derivatives_at(*make(X + s * motion), x); }, 1e-3);
  Points forward = Points::Zero(3, 4);
  rest->push_forward(x, change, forward);
  EXPECT_LT((forward.reshaped() - slope.head<12>()).norm(), 1e-8 * slope.norm());
  EXPECT_NEAR(rest->energy_derivative(x, term).dot(change), slope[12], 1e-8 * slope.norm());
  const Points weights = (Points(3, 4) << 1, 2, -1, 0.5, 0.2, 1, -0.3, 0.7, 1, 1.5, -2, 0.1).finished();
  EXPECT_NEAR(rest->pull_back(x, weights).dot(change), forward.cwiseProduct(weights).sum(),
              1e-12 * slope.norm());
  EXPECT_GT(slope.head<12>().norm(), 0.01);

  rest->set(rest->value() + 0.2 * change);
  const Vector wanted = derivatives_at(*make(X + 0.2 * motion), x);
  EXPECT_LT((derivatives_at(term, x) - wanted).norm(), 1e-12 * wanted.norm());
}

TEST(ReferencePositions, OfFibrousMembranesHaveExactDerivatives) {
  const FibrousPatch patch;
  expect_derivatives_by_rest_shape(patch.X, patch.x, FibrousPatch::term);
}

// The two facets of a patch, flat at rest, folded to a ridge, to a valley, and nearly shut.
TEST(ReferencePositions, OfHingesHaveExactDerivatives) {
  const FibrousPatch patch;
  int folded = 0;
  for (const double height : {0.0, 0.9, -0.9, 5.0}) {
    Points X = patch.X;
    X.row(2).setZero();
    X(2, 0) = X(2, 3) = -height;
    const auto make = [&](const Points& at) -> std::unique_ptr<EnergyTerm> {
      std::vector<BendingHinge::Rest> rest = {
          BendingHinge::rest(at.col(1), at.col(2), at.col(0), at.col(3), 0.7)};
      return std::make_unique<ElementTerm<BendingHinge>>("fold", std::vector<int>{1, 2, 0, 3},
                                                         std::move(rest));
    };
    expect_derivatives_by_rest_shape(X, patch.x, make);
    if (std::abs(BendingHinge::angle(X.col(1), X.col(2), X.col(0), X.col(3))) > 2) ++folded;
  }
  EXPECT_EQ(folded, 1);
}

TEST(ReferencePositions, OfSpringsAreRefusedByNameOfWhatIsCovered) {
  const FibrousPatch patch;
  BlendedLine law;
  law.young = 1;
  Objective objective(
      patch.X, fixed_nodes(4, {}),
      terms_of(FibrousPatch::term(patch.X),
               std::make_unique<ElementTerm<Spring>>("net", std::vector<int>{0, 1},
                                                     std::vector<Spring::Rest>{{2, 1, 0, true, law}})));
  const std::string said = refusal([&] { make_reference_positions("rest", objective, patch.X, {0}); });
  expect_contains(said, "term \"net\" (spring)");
  expect_contains(said, "(cst_...) and bending");
}

// Two of them would undo each other, and whichever was set last would silently win.
TEST(Clashes, AreRefusedByTheEquilibrium) {
  LoadedLine line;
  TrackedEquilibrium& equilibrium = line.equilibrium;
  EnergyTerm& cables = line.cables();
  const auto add = [&](std::unique_ptr<Parameter> parameter) {
    return refusal([&] { equilibrium.add(std::move(parameter)); });
  };
  const auto places = [&](const std::string& name, const std::vector<int>& nodes) {
    const Points x = LoadedLine::positions()(Eigen::all, nodes);
    return make_prescribed_positions(name, line.objective, nodes, free_positions(), coordinates(x));
  };
  equilibrium.add(make_line_lengths("ends", cables, {{0}, {2}}, LengthMeasure::Length));
  expect_contains(add(make_line_lengths("all", cables, {{1, 2}}, LengthMeasure::Factor)),
                  "\"all\": changes the rest length of line 2 of term \"cables\", which \"ends\" changes");
  equilibrium.add(make_line_lengths("middle", cables, {{1}}, LengthMeasure::Factor));

  expect_contains(add(places("twice", {0, 0})), "changes the place of node 0 twice");
  equilibrium.add(places("left", {0}));
  expect_contains(add(places("both", {1, 0})), "changes the place of node 0, which \"left\" changes");
  equilibrium.add(places("right", {1}));

  equilibrium.add(make_load_factor("factor", line.weight()));
  expect_contains(add(make_nodal_forces("forces", line.weight())), "force 0 of term \"weight\"");

  // Factors on one stiffness multiply, and data that are made anew take none of them.
  equilibrium.add(make_stiffness_factor("stiff", {{.term = &cables}}, 1));
  equilibrium.add(make_stiffness_factor("stiffer", {{.term = &cables, .elements = {1}}}, 1));
  TermNumber number{.value = 1, .scale = 1, .terms = {&cables}, .terms_at = {}, .defect = {}, .keep = {}};
  const std::string said = add(make_term_number("young", number));
  expect_contains(said, "does not go with \"stiff\", one changes element 0 of term \"cables\"");
  expect_contains(said, "\"stiffer\"");  // all in one pass
  EXPECT_EQ(equilibrium.number_count(), 2 + 1 + 3 + 3 + 1 + 1 + 1);
}

TEST(Clashes, OfNumbersThatMakeTheSameTermsAreRefusedUnlessTheyKnowOfEachOther) {
  LoadedLine line;
  TermNumber number{
      .value = 1, .scale = 1, .terms = {&line.cables()}, .terms_at = {}, .defect = {}, .keep = {}};
  line.equilibrium.add(make_term_number("one", number));
  expect_contains(refusal([&] { line.equilibrium.add(make_term_number("other", number)); }),
                  "element 0 of term \"cables\", which \"one\" changes");
  LoadedLine reconciled;
  number.terms = {&reconciled.cables()};
  number.keep = [](double) {};
  reconciled.equilibrium.add(make_term_number("one", number));
  reconciled.equilibrium.add(make_term_number("other", number));
  EXPECT_EQ(reconciled.equilibrium.number_count(), 2);
}

// Neither knows of the changes of the other to the triangle that they share.
TEST(Clashes, OfRestShapesThatShareAnElementAreRefused) {
  const FibrousPatch patch;
  Objective objective(patch.X, fixed_nodes(4, {}), terms_of(FibrousPatch::term(patch.X)));
  TrackedEquilibrium equilibrium(objective, objective.unknowns(patch.X));
  equilibrium.add(make_reference_positions("left", objective, patch.X, {0}));
  expect_contains(
      refusal([&] { equilibrium.add(make_reference_positions("middle", objective, patch.X, {1})); }),
      "the rest shape of element 0 of term \"tissue\", which \"left\" changes");
  equilibrium.add(make_reference_positions("right", objective, patch.X, {3}));
}

TEST(Clashes, OfPartsOfOneParameterAreRefused) {
  LoadedLine line;
  std::vector<JointPart> parts;
  parts.push_back({make_line_lengths("a", line.cables(), {{0}}, LengthMeasure::Factor), {0}});
  parts.push_back({make_line_lengths("b", line.cables(), {{1, 0}}, LengthMeasure::Factor), {1}});
  const std::string said = refusal([&] { make_joint_parameter("both", 2, std::move(parts)); });
  expect_contains(said, "\"both\": of its parts, parameter \"b\": changes the rest length of line 0");
}

}  // namespace
}  // namespace coapt
