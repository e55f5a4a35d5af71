#include "study/bench/detail/bench_pair.hpp"

#include "report/report_page.hpp"
#include "scene/build/build.hpp"
#include "study/bench/detail/timed_run.hpp"
#include "study/detail/method_list.hpp"
#include "study/detail/method_verdict.hpp"

#include <algorithm>
#include <cmath>

namespace coapt {
namespace {

// Iterates of newton from a method's last shape; from one that takes more it is no near equilibrium.
constexpr int kMostRefinements = 200;

// Of all that errors are measured on: the mesh, or all nodes where there is none.
Points measured(const SceneGeometry& geometry, const Points& x) {
  const Model& model = geometry.model;
  return model.mesh.triangle_count() > 0 ? Points(x.leftCols(model.mesh.vertex_count())) : x;
}

NodeError node_error(const Points& a, const Points& b) {
  if (a.cols() == 0) return {};
  const Eigen::RowVectorXd squares = (a - b).colwise().squaredNorm();
  return {std::sqrt(squares.maxCoeff()), std::sqrt(squares.mean())};
}

MethodGap gap_between(const SceneGeometry& geometry, const Points& x, const Points& reference) {
  MethodGap gap;
  gap.same_vertex = apart(measured(geometry, x), measured(geometry, reference));
  Vector ignored;
  if (geometry.model.mesh.triangle_count() > 0)
    gap.surfaces =
        reference_distance(surface_at(geometry.model, x), surface_at(geometry.model, reference), ignored);
  return gap;
}

double gap_mm(const MethodGap& gap) {
  return gap.surfaces ? both_directions(*gap.surfaces).p95 : gap.same_vertex.max;
}

RunOptions run_options(const BenchCourse& course, const std::string& solver, double tolerance) {
  RunOptions options = course.run;
  options.solver = solver;
  options.tolerance = tolerance;
  return options;
}

// Of a solve for an equilibrium that errors are measured to.
RunOptions truth_options(const BenchCourse& course, const std::string& solver, double tolerance) {
  RunOptions options = run_options(course, solver, tolerance);
  if (course.options.truth_seconds) options.max_seconds = course.options.truth_seconds;
  return options;
}

// What keeps an equilibrium from being known, and what would help.
Equilibrium missing_equilibrium(const Benchmark& found, const Result& result, Points x = {}) {
  const bool lacks_time = result.status == Status::TimeLimit;
  return {.x = std::move(x),
          .residual = result.residual,
          .missing = result.message + "; its residual of " + page_number(result.residual, 3) +
                     " is above the " + page_number(found.equilibrium_residual(), 3) + " wanted" +
                     (lacks_time ? "; --truth-seconds gives it more time" : "")};
}

std::string refining_solver(const BenchCourse& course, const std::string& method) {
  return course.solvers.contains(kRefiningSolver) ? kRefiningSolver : method;
}

// Where newton, or where the build has none the method, goes on to from a shape; from a saddle it stays
// there.
Equilibrium equilibrium_near(const BenchCourse& course, const Scene& scene, const SceneGeometry& geometry,
                             const Points& x, const std::string& method, Benchmark& found) {
  const std::string solver = refining_solver(course, method);
  SolveSetup setup = solve_setup(scene, course.solvers, truth_options(course, solver, kEquilibrium));
  setup.stability = {};
  if (solver == kRefiningSolver)
    setup.stop.max_iterations = std::min(setup.stop.max_iterations, kMostRefinements);
  Model model = build(scene, geometry);
  const Result result = solve_again(x, model, setup);
  found.is_cancelled = result.status == Status::Cancelled;
  const bool is_found = !found.is_cancelled && result.residual <= found.equilibrium_residual();
  const Points end = model.objective->positions(result.q);
  return is_found ? Equilibrium{true, end, result.residual} : missing_equilibrium(found, result, end);
}

BenchRun bench_run(const TimedRun& timed, size_t method, size_t mesh, double tolerance) {
  const Result& result = timed.result;
  BenchRun run{.method = method, .mesh = mesh, .tolerance = tolerance};
  run.status = result.status;
  run.message = result.message;
  run.residual = result.residual;
  run.energy = result.energy;
  run.iterations = result.iterations;
  run.outer_iterations = result.outer_iterations;
  run.evaluations = result.evaluations;
  run.factorisations = result.factorisations;
  run.repeats = timed.repeats;
  run.wall = timed.wall;
  run.cpu = timed.cpu;
  run.phase_s = result.phase_s;
  run.peak_memory_mb = timed.peak_memory_mb;
  run.errors.model = timed.to_closed;
  return run;
}

// From the loosest tolerance to the tightest, or the first that is not reached. Returns the shapes.
std::vector<Points> run_tolerances(const BenchCourse& course, const Scene& scene,
                                   const SceneGeometry& geometry, size_t mesh, size_t method,
                                   Benchmark& found) {
  std::vector<Points> shapes;
  for (const double tolerance : found.tolerances) {
    const SolveSetup setup =
        solve_setup(scene, course.solvers, run_options(course, found.methods[method].name, tolerance));
    TimedRun timed = timed_run(scene, geometry, setup, course.options.repeats);
    found.is_cancelled = timed.result.status == Status::Cancelled;
    if (found.is_cancelled) break;
    found.runs.push_back(bench_run(timed, method, mesh, tolerance));
    shapes.push_back(std::move(timed.x));
    if (course.options.report) course.options.report(found, found.runs.back());
    if (timed.result.status != Status::Converged) break;
  }
  return shapes;
}

// How a method's end compares with that of the reference method.
Verdict verdict_of(const Benchmark& found, const BenchEnd& end, const Equilibrium& own,
                   const Equilibrium& reference) {
  if (end.method == 0) return own.is_found ? Verdict::Reference : Verdict::NotConverged;
  if (!reference.is_found) return Verdict::NoReference;
  if (found.methods[end.method].model != found.methods.front().model) return Verdict::ModelGap;
  if (!own.is_found) return Verdict::NotConverged;
  const bool is_same = end.gap->same_vertex.max <= kSameShape * found.extent_mm;
  return is_same ? Verdict::SameEquilibrium : Verdict::AnotherBranch;
}

// Errors of the runs, and the end of the method. shapes: of the last runs of the benchmark, in their order.
void measure_errors(const SceneGeometry& geometry, const std::vector<Points>& shapes, const Equilibrium& own,
                    const Equilibrium& reference, BenchEnd& end, Benchmark& found) {
  if (own.is_found) end.residual = own.residual;
  if (end.method > 0 && reference.is_found)
    end.gap = gap_between(geometry, own.is_found ? own.x : shapes.back(), reference.x);
  end.verdict = verdict_of(found, end, own, reference);
  for (size_t k = 0; k < shapes.size(); ++k) {
    RunErrors& errors = found.runs[found.runs.size() - shapes.size() + k].errors;
    if (own.is_found) {
      errors.algebraic = node_error(measured(geometry, shapes[k]), measured(geometry, own.x));
      if (end.gap) errors.method = gap_mm(*end.gap);
    } else if (end.gap) {
      errors.method = gap_mm(gap_between(geometry, shapes[k], reference.x));
    }
  }
}

}  // namespace

Equilibrium bench_pair(const BenchCourse& course, const SceneGeometry& geometry, size_t mesh, size_t method,
                       const Equilibrium& reference, Benchmark& found) {
  BenchEnd end{.method = method, .mesh = mesh};
  Equilibrium own;
  const size_t runs_before = found.runs.size();
  try {
    const std::string& name = found.methods[method].name;
    const Scene scene = scene_of(name, course.scene);
    const std::vector<Points> shapes = run_tolerances(course, scene, geometry, mesh, method, found);
    const bool has_energy = found.methods[method].model != MethodModel::Constraints;
    if (has_energy && !found.is_cancelled && !shapes.empty())
      own = equilibrium_near(course, scene, geometry, shapes.back(), name, found);
    if (!found.is_cancelled) end.missing = own.missing;
    if (!has_energy) own.missing = name + " solves constraints, which have no energy of the scene";
    if (!found.is_cancelled && !shapes.empty()) measure_errors(geometry, shapes, own, reference, end, found);
  } catch (const InputError& error) {
    end.failure = in_one_line(error);
  } catch (const std::exception& error) {
    end.failure = error.what();
  }
  if (!end.failure.empty()) {
    found.runs.resize(runs_before);
    end.missing.clear();
    own.missing = end.failure;
  }
  found.ends.push_back(std::move(end));
  return own;
}

Equilibrium equilibrium_from_start(const BenchCourse& course, const SceneGeometry& geometry,
                                   Benchmark& found) {
  try {
    const std::string& method = found.methods.front().name;
    const SolveSetup setup =
        solve_setup(course.scene, course.solvers,
                    truth_options(course, refining_solver(course, method), found.tolerances.back()));
    Model model = build(course.scene, geometry);
    const Result result = solve_scene(course.scene, geometry, model, setup).result;
    found.is_cancelled = result.status == Status::Cancelled;
    if (result.status != Status::Converged) return missing_equilibrium(found, result);
    return equilibrium_near(course, course.scene, geometry, model.objective->positions(result.q), method,
                            found);
  } catch (const InputError& error) {  // a finer mesh that cannot be solved leaves the others less well known
    Equilibrium none;
    none.missing = in_one_line(error);
    return none;
  }
}

}  // namespace coapt
