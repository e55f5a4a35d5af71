#include "stress/bench.hpp"

#include "core/number_text.hpp"
#include "report/solve_page.hpp"
#include "scene/build/build.hpp"
#include "scene/terms/term_types.hpp"
#include "solve/solve_scene.hpp"

#include <algorithm>
#include <cmath>

namespace coapt {
namespace {

constexpr double kGrace = 1;  // after the time limit [s]

bool promises_contact(const Scene& scene) {
  return std::any_of(scene.terms.begin(), scene.terms.end(), [](const TermSpec& term) {
    return is_barrier(term) && !term.parameters.has("exclude");
  });
}

// The longest time from one accepted state to the next: within it nobody can be asked to stop.
double longest_pause(const Result& result) {
  double longest = 0, last = 0;
  for (const Iteration& iteration : result.trace) {
    longest = std::max(longest, iteration.seconds - last);
    last = iteration.seconds;
  }
  return std::max(longest, result.wall_s - last);
}

StressOutcome failure(const StressRun& solved, const std::string& message) {
  return outcome_of(solved, StressVerdict::Fail, message);
}

}  // namespace

StressScene stress_scene(const Scene& scene) { return {scene, scene_geometry(scene)}; }

StressScene copy_of(const StressScene& subject) {
  StressScene copy;
  copy.scene = subject.scene;
  const SceneGeometry& from = subject.geometry;
  SceneGeometry& to = copy.geometry;
  to.model.origin = from.model.origin;
  to.model.X = from.model.X;
  to.model.mesh = from.model.mesh;
  to.model.obstacles = from.model.obstacles;
  to.model.sets = from.model.sets;
  to.model.closed_reference = from.model.closed_reference;
  to.model.registration = from.model.registration;
  to.model.warnings = from.model.warnings;
  to.networks = from.networks;
  to.prescribed = from.prescribed;
  to.defects = from.defects;
  to.links = from.links;
  to.patches = from.patches;
  return copy;
}

void StressRunner::check(const StressScene& subject) const {
  RunOptions run;
  run.factorisations = options_.factorisations;
  solve_setup(subject.scene, options_.solvers, run);
  build(subject.scene, subject.geometry);
}

StressRun StressRunner::solve(const StressScene& subject, const StressSolve& how) const {
  StressRun solved;
  solved.seconds = how.seconds.value_or(options_.row_seconds);
  solved.promises_contact = promises_contact(subject.scene);
  RunOptions run;
  run.solver = how.solver;
  run.max_seconds = solved.seconds;
  run.factorisations = options_.factorisations;
  SolveSetup setup =
      solve_setup(subject.scene,
                  how.recorder == nullptr ? options_.solvers : how.recorder->recorded(options_.solvers), run);
  solved.model = build(subject.scene, subject.geometry);
  Model& model = solved.model;
  if (how.edit) how.edit(model);
  const auto checker = [&](const Points& x) {
    solved.intersections = std::max(solved.intersections, intersection_count(model, x, options_.checker));
    ++solved.judged;
  };
  std::optional<ShapeRecord> record;
  if (how.keeps_history && has_shape_view()) record.emplace(model, page_shapes(model));
  setup.observer = [&](const Iteration& iteration, const Vector& q) {
    if (record) record->see(iteration, q);
    // A coarser mesh of a cascade has other unknowns.
    if (how.judges_every_state && q.size() == model.objective->unknown_count())
      checker(model.objective->positions(q));
    if (options_.is_cancelled && options_.is_cancelled()) return false;
    return !how.observer || how.observer(iteration, q);
  };
  if (how.recorder != nullptr) setup.observer = how.recorder->recorded(setup.observer);
  const double start = wall_seconds();
  if (how.start != nullptr)
    solved.result = solve_again(*how.start, model, setup);
  else
    solved.result = solve_scene(subject.scene, subject.geometry, model, setup).result;
  solved.wall_s = wall_seconds() - start;
  solved.x = model.objective->positions(solved.result.q);
  if (record && solved.x.allFinite()) solved.shape_history = record->shapes(solved.x);
  if (solved.x.allFinite() && model.mesh.triangle_count() > 0) checker(solved.x);
  return solved;
}

StressOutcome outcome_of(const StressRun& solved, StressVerdict verdict, std::string message) {
  StressOutcome outcome{verdict, {}, {}, std::move(message)};
  outcome.status = status_name(solved.result.status);
  outcome.residual = solved.result.residual;
  outcome.iterations = solved.result.iterations;
  return outcome;
}

long intersection_count(const Model& model, const Points& x, const IntersectionChecker& checker) {
  const auto own = model.mesh.triangles.cols();
  Triangles facets(3, own + model.obstacles.cols());
  facets << model.mesh.triangles, model.obstacles;
  const auto pairs = checker.pairs(x, facets);
  return std::count_if(pairs.begin(), pairs.end(),
                       [&](const std::array<int, 2>& pair) { return std::min(pair[0], pair[1]) < own; });
}

std::optional<StressOutcome> untruth(const StressRun& solved, double tolerance) {
  const Result& result = solved.result;
  if (!solved.x.allFinite()) return failure(solved, "positions are not finite");
  if (!std::isfinite(result.energy) || !std::isfinite(result.residual))
    return failure(solved, "energy or residual is not finite");
  if (result.status == Status::Converged) {
    const double residual = solved.model.objective->true_residual(result.q);
    if (!(residual <= tolerance))
      return failure(solved, "called converged at residual " + number_text(residual) + ", wanted " +
                                 number_text(tolerance));
  }
  if (result.message.empty()) return failure(solved, "gives no reason for its end");
  const double late = solved.wall_s - solved.seconds;
  if (late > kGrace + longest_pause(result))
    return failure(solved, "ran on for " + number_text(late) + " s after its time limit");
  if (solved.promises_contact && solved.intersections > 0)
    return failure(solved, std::to_string(solved.intersections) +
                               " pairs of facets pass through each other in spite of the barrier");
  return std::nullopt;
}

std::optional<StressOutcome> not_converged(const StressRun& solved, double tolerance) {
  if (auto wrong = untruth(solved, tolerance)) return wrong;
  if (solved.result.status == Status::Converged) return std::nullopt;
  return outcome_of(solved, StressVerdict::Stall, solved.result.message);
}

double fresh_residual(const StressScene& subject, const Points& x) {
  Model model = build(subject.scene, subject.geometry);
  if (model.objective->step_limiting_term() != nullptr) return kNaN;
  Problem problem = problem_at(x, model);
  return model.objective->true_residual(problem.q0);
}

StressOutcome measured(const StressRun& solved, double figure, double limit, const std::string& message) {
  const bool holds = figure <= limit;  // false for what is not a number
  StressOutcome outcome = outcome_of(solved, holds ? StressVerdict::Pass : StressVerdict::Fail,
                                     holds ? solved.result.message : message);
  outcome.figure = figure;
  outcome.limit = limit;
  return outcome;
}

}  // namespace coapt
