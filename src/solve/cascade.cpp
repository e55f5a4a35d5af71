#include "solve/cascade.hpp"

#include "core/error.hpp"
#include "mesh/distance/separate.hpp"
#include "mesh/remesh/prolong.hpp"
#include "mesh/remesh/relieve_slivers.hpp"
#include "scene/build/build.hpp"
#include "scene/build/coarsen_scene.hpp"
#include "scene/build/contact_pairs.hpp"

#include <algorithm>
#include <numeric>
#include <string_view>

namespace coapt {
namespace {

constexpr int kFewestTriangles = 500;  // of a coarse mesh
constexpr size_t kMostCoarseMeshes = 4;
constexpr double kLeastCoarsening = 0.67;  // a mesh with more than this share of the next is no help
constexpr double kCoarseTolerance = 1e-3;
constexpr double kDampedTolerance =
    1e-6;  // of coarse meshes along a damped path, as little decides where it leads
constexpr double kMostResidual = 1e5;  // of a start
constexpr double kGapPerEdge = 0.1;    // left between facets that are pushed apart, of the mean edge
constexpr double kFarthest = 1;        // mean edges that a node is pushed at most
constexpr double kFarthestJudged = 2;  // where the residual of the start is judged as well

// One step from a mesh of the cascade to the next coarser one.
struct Step {
  Coarsening coarsening;
  std::vector<int> kept;  // vertex of the scene's own mesh of each coarse vertex
  Points X;               // vertices of the finer mesh
};

// The options for a mesh whose vertices are `kept` of the finest.
CoarsenOptions narrowed(const CoarsenOptions& finest, const Step& last) {
  std::vector<int> number(finest.kinds.size(), -1);
  CoarsenOptions options;
  options.share = finest.share;
  options.lines = last.coarsening.lines;
  for (size_t k = 0; k < last.kept.size(); ++k) {
    const auto v = static_cast<size_t>(last.kept[k]);
    number[v] = static_cast<int>(k);
    options.kinds.push_back(finest.kinds[v]);
  }
  for (const int v : finest.keep) options.keep.push_back(number[static_cast<size_t>(v)]);
  return options;
}

// From fine to coarse.
std::vector<Step> coarser_meshes(const Scene& scene, const SceneGeometry& geometry) {
  std::vector<Step> steps;
  steps.reserve(kMostCoarseMeshes);
  const TriangleMesh* mesh = &geometry.model.mesh;
  const CoarsenOptions finest = coarsen_options(scene, geometry);
  while (steps.size() < kMostCoarseMeshes && finest.share * mesh->triangle_count() >= kFewestTriangles) {
    Step step{coarsen(*mesh, steps.empty() ? finest : narrowed(finest, steps.back())), {}, mesh->vertices};
    if (step.coarsening.mesh.triangle_count() > kLeastCoarsening * mesh->triangle_count()) break;
    step.kept = step.coarsening.kept;
    if (!steps.empty())
      for (int& v : step.kept) v = steps.back().kept[static_cast<size_t>(v)];
    steps.push_back(std::move(step));
    mesh = &steps.back().coarsening.mesh;
  }
  return steps;
}

// What the coarser meshes give a finer one to begin with.
struct Start {
  Points x;                                // of all nodes
  Status status = Status::Converged;       // why the coarser ones ended
  std::vector<char> is_new;                // of each vertex: the mesh before has it not
  std::vector<Eigen::Matrix3d> gradients;  // of the motion of each vertex
  Distortion distortion;                   // the greatest of the mesh before
};

// Positions of all nodes of the finer mesh; the points of the networks follow the vertices.
Start finer(const Step& step, const Start& coarse) {
  const TriangleMesh& mesh = step.coarsening.mesh;
  const Eigen::Index coarse_count = mesh.vertex_count(), fine_count = step.X.cols();
  const Points surface = coarse.x.leftCols(coarse_count);
  Start fine;
  fine.status = coarse.status;
  fine.x.resize(3, fine_count + coarse.x.cols() - coarse_count);
  fine.x.leftCols(fine_count) = prolonged(step.coarsening, step.X, surface);
  fine.x.rightCols(coarse.x.cols() - coarse_count) = coarse.x.rightCols(coarse.x.cols() - coarse_count);
  for (const int host : step.coarsening.host) fine.is_new.push_back(host >= 0);
  fine.gradients = prolonged_gradients(step.coarsening, surface);
  fine.distortion = greatest_distortion(mesh.triangles, mesh.vertices, surface);
  return fine;
}

// The prescribed nodes go where they belong, and the vertices that are new where the triangles between them
// fit best, if wanted; slivers that do not are relieved.
void fit_to_mesh(Start& start, Model& model, bool fits_gradients) {
  start.x = model.objective->positions(problem_at(start.x, model).q0);
  const Eigen::Index count = model.mesh.vertex_count();
  std::vector<char> may_move = start.is_new;
  for (Eigen::Index v = 0; v < count; ++v)
    if (model.objective->fixed().col(v).any()) may_move[static_cast<size_t>(v)] = 0;
  const Points X = model.X.leftCols(count);
  Points surface = start.x.leftCols(count);
  if (fits_gradients) fit_to_gradients(model.mesh.triangles, X, start.gradients, may_move, surface);
  relieve_slivers(model.mesh.triangles, X, may_move, start.distortion, surface);
  start.x.leftCols(count) = surface;
}

// Makes x a start for a barrier: facets that pass through each other, as curved sheets in contact do once
// their mesh is finer, are pushed apart. False where that does not help, or moves a node by more than
// `farthest` mean edges.
bool make_startable(Start& start, Model& model, bool fits_gradients, double farthest) {
  fit_to_mesh(start, model, fits_gradients);
  Points& x = start.x;
  if (model.objective->step_limiting_term() == nullptr) return true;
  const Triangles facets = all_facets(model);
  SeparationOptions options;
  options.membrane_count = model.mesh.triangle_count();
  if (pairs_to_separate(x, facets, options.membrane_count, {}).empty()) return true;
  const double edge = mean_edge_length(model.X, model.mesh.triangles);
  options.gap = kGapPerEdge * edge;
  for (const auto& node : model.objective->fixed().colwise()) options.is_held.push_back(node.any());
  Separation separation = separate(x, facets, options);
  if (!separation.pairs_left.empty() || separation.largest_displacement > farthest * edge) return false;
  x = std::move(separation.x);
  return true;
}

// Whether a solver gets anywhere from this start. On slivers a shape that was carried over may bend and
// stretch beyond measure: starts at up to 4e4 were seen to converge, those at 7e5 and 2e7 to stall.
bool is_bearable(const Problem& problem) {
  Vector g;
  problem.objective.limit_stress(problem.q0);
  problem.objective.gradient(problem.q0, g);
  const double residual = problem.objective.relative_residual(problem.q0, g);
  problem.objective.release_stress_limits();
  return residual < kMostResidual;
}

bool was_interrupted(Status status) { return status == Status::Cancelled || status == Status::TimeLimit; }

// Makes the carried-over shape a start; on some meshes of slivers one that is not fitted to the gradients
// serves better. Why it is none; empty where it is one. How far it is bent is asked of the scene's own mesh
// alone.
std::string start_defect(Start& start, Model& model, bool is_own_mesh) {
  const Start carried = start;
  std::string defect;
  for (const bool fits_gradients : {true, false}) {
    start = carried;
    defect = "";
    if (!make_startable(start, model, fits_gradients, is_own_mesh ? kFarthestJudged : kFarthest))
      defect = "passes through itself";
    else if (is_own_mesh && !was_interrupted(start.status) && !is_bearable(problem_at(start.x, model)))
      defect = "is bent or stretched beyond measure";
    if (defect.empty()) break;
  }
  return defect;
}

// From the shape that a coarser mesh gave; the dampers of a damped path keep it to the equilibrium next to
// it.
Problem problem_near(const Points& x, Model& model, const Continuation& continuation) {
  Problem problem = problem_at(x, model);
  problem.continuation.damped_steps = continuation.damped_steps;
  problem.continuation.is_loaded = continuation.damped_steps > 0;
  return problem;
}

class Cascade {
 public:
  Cascade(const SolverMaker& make_solver, const StopRule& stop, const Observer& observer,
          const std::function<void(const RunPhase&)>& phase)
      : make_solver_(make_solver), stop_(stop), observer_(observer), phase_(phase) {}

  void has_meshes(size_t count) { meshes_ = count; }  // coarser than the scene's own

  // Solves a mesh of the cascade and notes it as a level.
  Result level(const Problem& problem, const Model& model, double tolerance) {
    StopRule stop = stop_;
    stop.tolerance = std::max(tolerance, stop_.tolerance);
    stop.max_seconds = std::max(0.0, stop_.max_seconds - (wall_seconds() - wall_start_));
    const std::unique_ptr<Solver> solver = make_solver_(model);
    const size_t done = outcome.levels.size();
    if (phase_)
      phase_({meshes_ == 0     ? ""
              : done < meshes_ ? "mesh " + std::to_string(done + 1) + " of " + std::to_string(meshes_ + 1)
                               : "finest mesh",
              stop.tolerance});
    Result result = solve(*solver, problem, stop, observer_);
    outcome.levels.push_back({model.mesh.triangle_count(), result.iterations, result.status, result.residual,
                              wall_seconds() - level_wall_, cpu_seconds() - level_cpu_, result.damped_steps});
    level_wall_ = wall_seconds();
    level_cpu_ = cpu_seconds();
    return result;
  }

  // Makes the result that of the whole.
  void finish(Result result) {
    const double before = wall_seconds() - wall_start_ - result.wall_s;
    for (Iteration& iteration : result.trace) iteration.seconds += before;
    result.phase_s["coarse_levels"] = before;
    result.wall_s += before;
    const double cpu = cpu_seconds() - cpu_start_;
    result.phase_cpu_s["coarse_levels"] = cpu - result.cpu_s;
    result.cpu_s = cpu;
    outcome.result = std::move(result);
  }

  void warn(std::string_view sentence) { outcome.warnings.emplace_back(sentence); }

  CascadeOutcome outcome;

 private:
  const SolverMaker& make_solver_;
  const StopRule& stop_;
  const Observer& observer_;
  const std::function<void(const RunPhase&)>& phase_;
  size_t meshes_ = 0;
  double wall_start_ = wall_seconds(), cpu_start_ = cpu_seconds();
  double level_wall_ = wall_start_, level_cpu_ = cpu_start_;
};

// The start of a problem as it stands, for a run that was interrupted before it came to it.
Result judged(const Problem& problem, Status reason, Solver& solver) {
  StopRule stop;
  stop.max_iterations = 0;
  Result result = solve(solver, problem, stop);
  result.status = reason;
  result.message = reason == Status::Cancelled ? "cancelled" : "stopped at the time limit";
  result.message += " on a coarse mesh of the cascade; the shape found there was kept";
  return result;
}

// Solves the coarser meshes. The shape on the scene's own mesh that the last of them gives; none where one of
// them failed.
std::optional<Start> coarse_start(const Scene& scene, const SceneGeometry& geometry,
                                  const Continuation& continuation, Cascade& cascade) {
  const std::vector<Step> steps = coarser_meshes(scene, geometry);
  if (steps.empty()) {
    cascade.warn("The mesh is too small for a cascade, or cannot be made coarser: it was solved directly.");
    return std::nullopt;
  }
  cascade.has_meshes(steps.size());
  Start start;
  for (size_t k = steps.size(); k-- > 0;) {
    const TriangleMesh& mesh = steps[k].coarsening.mesh;
    const std::string name =
        "The mesh of " + std::to_string(mesh.triangle_count()) + " triangles of the cascade ";
    std::string failure;
    try {
      Model model = build(scene, coarsened(geometry, mesh, steps[k].kept));
      const double tolerance = continuation.damped_steps > 0 ? kDampedTolerance : kCoarseTolerance;
      const auto solve_from_own_start = [&] {
        model.objective->prescribe(model.X);
        return cascade.level({*model.objective, model.q0, model.motion, continuation}, model, tolerance);
      };
      Result result;
      if (start.x.size() == 0) {
        result = solve_from_own_start();
      } else if (const std::string defect = start_defect(start, model, false); defect.empty()) {
        result = cascade.level(problem_near(start.x, model, continuation), model, tolerance);
      } else {
        cascade.warn(name + "was solved from its own start: the shape found on a coarser one " + defect +
                     " there.");
        result = solve_from_own_start();
      }
      start.x = model.objective->positions(result.q);
      start.status = result.status;
      if (result.status != Status::Converged) failure = result.message;
    } catch (const InputError& error) {
      failure = error.what();
      start.status = Status::NonFinite;
    }
    if (was_interrupted(start.status)) {
      for (size_t j = k + 1; j-- > 0;) start = finer(steps[j], start);
      return start;
    }
    if (!failure.empty()) {
      cascade.warn(name + "was not solved (" + failure + "); the scene's own was solved from its own start.");
      return std::nullopt;
    }
    start = finer(steps[k], start);
  }
  return start;
}

}  // namespace

CascadeOutcome solve_cascade(const Scene& scene, const SceneGeometry& geometry, Model& model,
                             const SolverMaker& make_solver, const StopRule& stop,
                             const Continuation& continuation, const Observer& observer,
                             const StabilityOptions& stability,
                             const std::function<void(const RunPhase&)>& phase) {
  Cascade cascade(make_solver, stop, observer, phase);
  std::optional<Start> start = coarse_start(scene, geometry, continuation, cascade);
  const auto give_up = [&](const std::string& reason) {
    cascade.warn("The start that the cascade gave " + reason + ": the mesh was solved from its own start.");
    model.objective->prescribe(model.X);
    start.reset();
  };
  if (start) {
    const std::string defect = start_defect(*start, model, true);
    if (!defect.empty()) give_up(defect);
  }
  if (start && was_interrupted(start->status)) {
    Problem problem = problem_at(start->x, model);
    problem.stability = stability;
    cascade.finish(judged(problem, start->status, *make_solver(model)));
    return std::move(cascade.outcome);
  }
  if (start) {
    Problem problem = problem_near(start->x, model, continuation);
    problem.stability = stability;
    Result result = cascade.level(problem, model, stop.tolerance);
    if (result.status == Status::Converged || result.status == Status::IterationLimit ||
        was_interrupted(result.status)) {
      cascade.finish(std::move(result));
      return std::move(cascade.outcome);
    }
    give_up("led nowhere (" + result.message + ")");
  }
  cascade.finish(cascade.level({*model.objective, model.q0, model.motion, continuation, stability}, model,
                               stop.tolerance));
  return std::move(cascade.outcome);
}

}  // namespace coapt
