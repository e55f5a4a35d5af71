#include "stress/subject.hpp"

#include "core/number_text.hpp"
#include "run/run_parts.hpp"

#include <algorithm>

namespace coapt {
namespace {

constexpr double kFiner = 1e-3;            // of the tolerance, to tell two branches from a loose tolerance
constexpr double kLeastTolerance = 1e-11;  // that refining asks for

// Solved on from x, in the scene as it is; x where that does not get nearer.
Points refined(StressSubject& subject, const Points& x) {
  StressScene finer = copy_of(own_scene(subject));
  const double tolerance = tolerance_of(own_scene(subject));
  finer.scene.solver.tolerance = std::min(tolerance, std::max(kFiner * tolerance, kLeastTolerance));
  const StressRun solved =
      subject.bench.solve(finer, {.solver = subject.bench.has_solver("newton") ? "newton" : "", .start = &x});
  return solved.result.residual <= tolerance && solved.x.allFinite() ? solved.x : x;
}

// Nodes whose place the equilibrium decides: those of the mesh, and ends of lines that pull. A branch point
// of slack lines may lie anywhere.
std::vector<int> decided_nodes(const Model& model, const Points& x) {
  constexpr double kTaut = 1 + 1e-5;  // length over that at rest
  std::vector<bool> is_decided(static_cast<size_t>(x.cols()), false);
  for (const int node : model.mesh.triangles.reshaped()) is_decided[static_cast<size_t>(node)] = true;
  for (const Line& line : model.lines)
    if ((x.col(line.a) - x.col(line.b)).norm() > kTaut * line.rest_length)
      is_decided[static_cast<size_t>(line.a)] = is_decided[static_cast<size_t>(line.b)] = true;
  std::vector<int> nodes;
  for (int node = 0; node < x.cols(); ++node)
    if (is_decided[static_cast<size_t>(node)]) nodes.push_back(node);
  return nodes;
}

double greatest_distance(const StressRun& own, const Points& a, const Points& b) {
  const std::vector<int> nodes = decided_nodes(own.model, own.x);
  return nodes.empty() ? 0 : (a - b)(Eigen::all, nodes).colwise().norm().maxCoeff();
}

}  // namespace

const StressScene& own_scene(StressSubject& subject) {
  if (!subject.scene) subject.scene = subject.make();
  return *subject.scene;
}

StressRun& own_solution(StressSubject& subject) {
  if (!subject.solution) subject.solution = subject.bench.solve(own_scene(subject), {.keeps_history = true});
  return *subject.solution;
}

double extent_of(StressSubject& subject) {
  return bounding_box_diagonal(own_scene(subject).geometry.model.X);
}

std::optional<StressOutcome> no_yardstick(StressSubject& subject) {
  auto outcome = not_converged(own_solution(subject), tolerance_of(own_scene(subject)));
  if (outcome) outcome->message = "the scene as it is: " + outcome->message;
  return outcome;
}

std::optional<ShownSolve> own_solve(const StressSubject& subject) {
  if (!subject.solution || !subject.solution->x.allFinite()) return std::nullopt;
  const StressRun& own = *subject.solution;
  const Scene& scene = subject.scene->scene;
  SolveSetup setup;
  setup.solver = scene.solver.type;
  setup.stop.tolerance = scene.solver.tolerance;
  SolvedRun solved;
  solved.outcome.result = own.result;
  solved.shape_history = own.shape_history;
  Report report = measure_run(scene, setup, own.model, std::move(solved), {.has_page = true},
                              subject.bench.options().checker);
  report.scene_file = subject.name;
  if (report.shape_history.empty()) report.shape_history = {{{}, own.model.X}};
  ShownSolve shown = shown_solve(subject.name + ": what the rows are compared with.", own.model, report);
  shown.view.name = "stress";
  return shown;
}

StressOutcome same_shape_as_own(StressSubject& subject, const StressRun& solved, const Points& x,
                                double energy_unit) {
  const double tolerance = tolerance_of(own_scene(subject));
  if (auto outcome = not_converged(solved, tolerance)) return *outcome;
  if (auto outcome = no_yardstick(subject)) return *outcome;
  const StressRun& own = own_solution(subject);
  const double extent = extent_of(subject), limit = subject.same_shape;
  double figure = greatest_distance(own, x, own.x) / extent;
  std::string note = solved.result.message;
  if (!(figure <= limit)) {
    const double residual = fresh_residual(own_scene(subject), x);
    if (residual > kResidualSlack * tolerance)
      return measured(solved, figure, limit,
                      "called converged, but in the scene as it is the residual of that shape is " +
                          number_text(residual));
    const double raw = figure;
    figure = greatest_distance(own, refined(subject, x), refined(subject, own.x)) / extent;
    note =
        "solved on to a smaller residual, as at the tolerance the shapes are " + number_text(raw) + " apart";
  }
  StressOutcome outcome =
      outcome_of(solved, figure <= limit ? StressVerdict::Pass : StressVerdict::OtherBranch, note);
  if (outcome.verdict == StressVerdict::OtherBranch)
    outcome.message = "another equilibrium of the same scene: energy " +
                      number_text(solved.result.energy / energy_unit) + " mJ, of the scene's own solution " +
                      number_text(own.result.energy) + " mJ";
  outcome.figure = figure;
  outcome.limit = limit;
  return outcome;
}

}  // namespace coapt
