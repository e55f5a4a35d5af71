// The same state has the same residual, to the last bit, whatever was evaluated before; and a body that
// nothing loads and nothing holds is measured by its own stiffness.
#include "energy/force_scale.hpp"

#include "energy/contact_barrier.hpp"
#include "energy/element_term.hpp"
#include "energy/kernels/cst_stvk.hpp"
#include "energy/load_pressure.hpp"
#include "energy/objective.hpp"
#include "support/equilibrium.hpp"
#include "support/meshes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <map>
#include <string>

namespace coapt {
namespace {

enum class Held { Nothing, Rim, HalfOfTheRim };

// A disc, plane at rest, and its rim.
struct Sheet {
  Held held;
  double pressure;
  double stiffness = 1, prestress = 0;
  TriangleMesh mesh = disc_mesh(4);
  FixedMask fixed = held_nodes();

  FixedMask held_nodes() const {
    FixedMask mask = FixedMask::Constant(3, mesh.vertex_count(), false);
    for (int v = 0; v < mesh.vertex_count(); ++v) {
      const bool is_on_rim = mesh.vertices.col(v).norm() > 1 - 1e-9;
      if (held == Held::Rim || (held == Held::HalfOfTheRim && mesh.vertices(0, v) < 0.75))
        mask.col(v).setConstant(is_on_rim && held != Held::Nothing);
    }
    return mask;
  }

  Objective objective() const {
    Terms terms = terms_of(membrane_term(mesh.vertices, mesh.triangles, {stiffness, 0.3, prestress}));
    if (pressure != 0)
      terms.push_back(make_follower_pressure("p", mesh.vertices, mesh.triangles, pressure, fixed));
    return Objective(mesh.vertices, fixed, std::move(terms));
  }

  // Stretched by a tenth, bulged and crumpled a little.
  Vector state(double amount, unsigned seed) const {
    Points x = (1 + amount) * mesh.vertices;
    for (int v = 0; v < mesh.vertex_count(); ++v)
      x(2, v) += amount * (1 - mesh.vertices.col(v).squaredNorm());
    return objective().unknowns(shaken(x, 0.1 * amount, seed));
  }
};

const std::map<std::string, Sheet>& sheets() {
  static const std::map<std::string, Sheet> table = {
      {"loaded", {Held::Rim, 0.02}},
      {"loaded_prestressed", {Held::Rim, 0.02, 1, 0.5}},
      {"loaded_without_potential", {Held::HalfOfTheRim, 0.02, 1, 0.05}},
      {"held", {Held::Rim, 0}},
      {"free", {Held::Nothing, 0}},
  };
  return table;
}

using History = std::function<void(Objective&, const Sheet&)>;

SolverOptions options_for(const Sheet& sheet) {
  SolverOptions options;
  options.masses = [count = sheet.mesh.vertex_count()] { return Vector(Vector::Constant(count, 0.01)); };
  options.dynamic = {.time_step = 0.05, .relaxation_time = 0.1};
  return options;
}

History run_of(const std::string& solver) {
  return [solver](Objective& objective, const Sheet& sheet) {
    StopRule stop;
    stop.max_iterations = 5;
    solve(*built_in_solvers().at(solver)(options_for(sheet)), {objective, sheet.state(0.2, 7)}, stop);
  };
}

const std::map<std::string, History>& histories() {
  static const std::map<std::string, History> table = {
      {"at_rest",
       [](Objective& objective, const Sheet&) {
         Vector g;
         objective.gradient(objective.unknowns(), g);
       }},
      {"far_away",
       [](Objective& objective, const Sheet& sheet) {
         Vector g;
         SparseMatrix h;
         objective.hessian(sheet.state(0.5, 1), g, h);
       }},
      {"held_dead_elsewhere",
       [](Objective& objective, const Sheet& sheet) {
         objective.lag_circulatory_force(sheet.state(0.3, 2));
       }},
      {"on_a_path",
       [](Objective& objective, const Sheet& sheet) {
         objective.lag_circulatory_force(sheet.state(0.3, 2));
         objective.set_path_anchor(sheet.state(0.4, 3));
         objective.advance(sheet.state(0.2, 3));
       }},
      {"lbfgs", run_of("lbfgs")},
      {"bfgs", run_of("bfgs")},
      {"newton", run_of("newton")},
      {"dynamic", run_of("dynamic")},
  };
  return table;
}

TEST(ForceScale, TheResidualOfAStateDoesNotDependOnWhatWasEvaluatedBefore) {
  for (const auto& [name, sheet] : sheets()) {
    const Vector q = sheet.state(0.1, 4);
    Objective fresh = sheet.objective();
    const double residual = fresh.true_residual(q);
    EXPECT_GT(residual, 1e-3) << name;
    EXPECT_TRUE(std::isfinite(residual)) << name;
    for (const auto& [history, live_through] : histories()) {
      Objective objective = sheet.objective();
      live_through(objective, sheet);
      EXPECT_EQ(objective.true_residual(q), residual) << name << " after " << history;
      EXPECT_EQ(objective.reactions(q), fresh.reactions(q)) << name << " after " << history;
    }
  }
}

// A gradient that was kept is judged by the scale of its own state, although another was evaluated since.
TEST(ForceScale, AKeptGradientIsJudgedByItsOwnState) {
  for (const auto& [name, sheet] : sheets()) {
    const Vector q = sheet.state(0.1, 4);
    Objective objective = sheet.objective();
    Vector g, other;
    objective.gradient(q, g);
    const double residual = objective.relative_residual(q, g), force = objective.reference_force(q);
    objective.gradient(sheet.state(0.5, 1), other);
    EXPECT_EQ(objective.relative_residual(q, g), residual) << name;
    EXPECT_EQ(objective.reference_force(q), force) << name;
    objective.scale(2, 3);
    objective.scale(1, 1);
    EXPECT_EQ(objective.relative_residual(q, g), residual) << name;
  }
}

// Where no load says what is little, the body's own stiffness does: the residual of a shape does not depend
// on how stiff the body is, on its size, or on the start of a run.
TEST(ForceScale, ABodyWithoutLoadsIsMeasuredByItsStiffness) {
  for (const Held held : {Held::Nothing, Held::Rim}) {
    const Sheet soft{held, 0}, stiff{held, 0, 1024};
    const Vector q = soft.state(1e-3, 4);
    Objective of_soft = soft.objective(), of_stiff = stiff.objective();
    EXPECT_EQ(of_soft.true_residual(q), of_stiff.true_residual(q));
    of_soft.scale(1, 8);
    EXPECT_EQ(of_soft.true_residual(q), of_stiff.true_residual(q));
  }
}

TEST(ForceScale, EverySolverBringsAFreeBodyToRest) {
  const Sheet sheet{Held::Nothing, 0};
  const std::map<std::string, double> tolerances = {
      {"lbfgs", 1e-8}, {"bfgs", 1e-8}, {"newton", 1e-8}, {"dynamic", 1e-6}};
  for (const auto& [solver, tolerance] : tolerances) {
    Objective objective = sheet.objective(), fresh = sheet.objective();
    StopRule stop;
    stop.tolerance = tolerance;
    stop.max_seconds = 60;
    const Result result =
        solve(*built_in_solvers().at(solver)(options_for(sheet)), {objective, sheet.state(0.1, 4)}, stop);
    EXPECT_EQ(result.status, Status::Converged) << solver << ": " << result.message;
    EXPECT_EQ(result.residual, fresh.true_residual(result.q)) << solver;
  }
}

// The one thing that a solve leaves with the problem: a barrier that it made stiffer, until it is given back.
TEST(ForceScale, ABarrierThatWasMadeStifferIsAnotherProblemUntilItIsGivenBack) {
  const TriangleMesh sheet = disc_mesh(4), floor = moved(sheet, {0, 0, -0.05}), both = joined(sheet, floor);
  FixedMask fixed = FixedMask::Constant(3, both.vertex_count(), false);
  fixed.rightCols(floor.vertex_count()).setConstant(true);
  for (int v = 0; v < sheet.vertex_count(); ++v)
    if (sheet.vertices.col(v).norm() > 1 - 1e-9) fixed.col(v).setConstant(true);
  ContactBarrierOptions options{.gap = 0.02, .pressure = 0.1};
  options.obstacles = both.triangles.rightCols(floor.triangle_count());
  Objective objective(both.vertices, fixed,
                      terms_of(membrane_term(both.vertices, sheet.triangles, {1, 0.3, 0}),
                               make_contact_barrier("contact", both.vertices, sheet.triangles, options)));
  Points x = both.vertices;
  for (int v = 0; v < sheet.vertex_count(); ++v)
    x(2, v) -= 0.04995 * (1 - sheet.vertices.col(v).squaredNorm());
  const Vector q = objective.unknowns(x);
  const double residual = objective.true_residual(q);
  ASSERT_TRUE(objective.escalate_stiffness(q));
  EXPECT_NE(objective.true_residual(q), residual);
  objective.restore_stiffness();
  EXPECT_EQ(objective.true_residual(q), residual);
}

// What the reference state says follows the data of the terms.
TEST(ForceScale, FollowsAChangeOfTheTerms) {
  const Sheet before{Held::Rim, 0.02, 1, 0.5}, after{Held::Rim, 0.02, 1, 0.75};
  const Vector q = before.state(0.01, 4);
  Objective changed = before.objective(), fresh = after.objective();
  const auto wanted = membrane_term(after.mesh.vertices, after.mesh.triangles, {1, 0.3, after.prestress});
  for (const auto& term : changed.terms())
    if (auto* membrane = dynamic_cast<ElementTerm<CstStVK>*>(term.get()))
      membrane->set_rest(dynamic_cast<const ElementTerm<CstStVK>&>(*wanted).rest());
  changed.remeasure_reference();
  EXPECT_EQ(changed.true_residual(q), fresh.true_residual(q));
  EXPECT_EQ(changed.reference_force(q), fresh.reference_force(q));
}

}  // namespace
}  // namespace coapt
