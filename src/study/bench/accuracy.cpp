#include "study/bench/accuracy.hpp"

#include "core/error.hpp"
#include "core/number_text.hpp"
#include "report/report_page.hpp"
#include "results/frames.hpp"
#include "run/run_parts.hpp"
#include "run/unwritten.hpp"
#include "scene/build/build.hpp"
#include "scene/build/refine_scene.hpp"
#include "study/bench/discretisation.hpp"
#include "study/detail/method_list.hpp"

#include <algorithm>
#include <cmath>
#include <list>

namespace coapt {
namespace {

constexpr double kFirstTolerance = 1e-3, kLeastTolerance = 1e-10;
constexpr double kAlgebraicShare = 0.1;  // of the wanted accuracy
constexpr double kGoingOn = 1e-4;        // of the residual, to see how far the shape still goes
constexpr double kRoundOff = 1e-12;      // residual below which nothing is gained
constexpr double kClearlySmaller = 0.5;  // a residual that tells how far the shape still goes
constexpr int kMostTightenings = 4;

struct SolvedMesh {
  size_t cuts = 0;
  Model model;
  SolvedRun solved;
  const Result& result() const { return solved.outcome.result; }
  bool has_converged() const { return result().status == Status::Converged; }
  TriangleMesh closed() const { return surface_at(model, model.objective->positions(result().q)); }
};

// The tolerance at which an error that goes with the residual is at most `wanted`: a power of ten below.
double tighter(double tolerance, double error_mm, double wanted_mm) {
  return std::max(kLeastTolerance,
                  tolerance * std::pow(10, std::floor(std::log10(0.5 * wanted_mm / error_mm))));
}

class Search {
 public:
  Search(const Scene& scene, const SolverTable& solvers, double wanted_mm, const RunOptions& options,
         const AccuracyObserver& observer, int most_triangles)
      : scene_(scene),
        setup_(solve_setup(scene, solvers, options)),
        going_on_(solve_setup(scene, solvers, refining(solvers, options))),
        options_(options),
        observer_(observer),
        most_triangles_(most_triangles),
        most_seconds_(setup_.stop.max_seconds) {
    going_on_.stability = {};  // it stays with the shape that it is given, be it a saddle
    estimate.wanted_mm = wanted_mm;
    estimate.tolerance = kFirstTolerance;
    geometries_.push_back(scene_geometry(scene));
    build(scene, geometries_.back());
    build(scene, geometry(1));  // what a finer mesh cannot have is said before the first solve
  }

  SolvedMesh solve() {
    SolvedMesh mesh = tightened(solved(0));
    std::vector<TriangleMesh> shapes = {mesh.closed()};
    tell();
    while (mesh.has_converged() && estimate.algebraic_mm) {
      if (4L * mesh.model.mesh.triangle_count() > most_triangles_) break;
      SolvedMesh finer = solved(mesh.cuts + 1);
      if (!finer.has_converged()) return mesh;  // out of time, say: this one is an equilibrium
      shapes.push_back(finer.closed());
      mesh = std::move(finer);
      const std::optional<size_t> fine_enough = compare(shapes);
      tell();
      if (fine_enough) return tightened(*fine_enough == mesh.cuts ? std::move(mesh) : solved(*fine_enough));
    }
    return mesh.cuts == 0 ? std::move(mesh) : tightened(std::move(mesh));
  }

  const SolveSetup& setup() const { return setup_; }

  AccuracyEstimate estimate;

 private:
  static RunOptions refining(const SolverTable& solvers, RunOptions options) {
    if (solvers.contains(kRefiningSolver)) options.solver = kRefiningSolver;
    options.modes = 0;
    return options;
  }

  const SceneGeometry& geometry(size_t cuts) {
    while (geometries_.size() <= cuts) geometries_.push_back(refined(geometries_.back()));
    return *std::next(geometries_.begin(), static_cast<std::ptrdiff_t>(cuts));
  }

  void tell() const {
    if (observer_) observer_(estimate);
  }

  // Estimates the error of the last of the shapes, or of the first that is fine enough, which is returned.
  std::optional<size_t> compare(const std::vector<TriangleMesh>& shapes) {
    const MeshDistances distances = distances_between_meshes(shapes);
    estimate.levels.back().to_previous = distances.to_next.back();
    const DiscretisationEstimate found = estimate_discretisation(distances);
    estimate.order = found.order;
    estimate.discretisation_mm = estimate.farthest_mm = std::nullopt;
    if (!orders_agree(distances)) return std::nullopt;
    const auto fine_enough = std::find_if(found.error_mm.begin(), found.error_mm.end(), [&](double error) {
      return error <= (1 - kAlgebraicShare) * estimate.wanted_mm;
    });
    const bool is_enough = fine_enough != found.error_mm.end();
    const size_t finest = shapes.size() - 1,
                 chosen = is_enough ? static_cast<size_t>(fine_enough - found.error_mm.begin()) : finest;
    estimate.discretisation_mm = found.error_mm[chosen];
    // What the farthest point is beside the 95th percentile, as the distance to the finest mesh shows it.
    const DistanceFigures& seen = chosen < finest ? distances.to_finest[chosen] : distances.to_next.back();
    if (seen.p95 > 0) estimate.farthest_mm = found.error_mm[chosen] * seen.max / seen.p95;
    return is_enough ? std::optional(chosen) : std::nullopt;
  }

  double seconds_left() const { return std::max(0.0, most_seconds_ - (wall_seconds() - start_)); }

  SolvedMesh solved(size_t cuts) {
    setup_.stop.tolerance = estimate.tolerance;
    setup_.stop.max_seconds = seconds_left();
    SolvedMesh mesh{.cuts = cuts, .model = build(scene_, geometry(cuts)), .solved = {}};
    mesh.solved = solve_run(scene_, geometry(cuts), mesh.model, setup_, wants_page(scene_, options_));
    const Result& result = mesh.result();
    estimate.levels.push_back({mesh.model.mesh.triangle_count(), estimate.tolerance, result.status,
                               result.iterations, result.wall_s, result.cpu_s});
    return mesh;
  }

  // The mesh solved to the tolerance that its algebraic error needs, which is in the estimate afterwards.
  SolvedMesh tightened(SolvedMesh mesh) {
    for (int tightening = 0; mesh.has_converged(); ++tightening) {
      estimate.algebraic_mm = algebraic_error(mesh);
      const double wanted = kAlgebraicShare * estimate.wanted_mm;
      if (!estimate.algebraic_mm || *estimate.algebraic_mm <= wanted || tightening == kMostTightenings ||
          estimate.tolerance <= kLeastTolerance)
        break;
      estimate.tolerance = tighter(estimate.tolerance, *estimate.algebraic_mm, wanted);
      mesh = solved(mesh.cuts);
    }
    return mesh;
  }

  // How far the farthest vertex still goes. The error falls as the residual does, so the way to a smaller one
  // tells all of it. Empty where no smaller one was found.
  std::optional<double> algebraic_error(const SolvedMesh& mesh) {
    const double residual = mesh.result().residual;
    if (residual <= kRoundOff) return 0;
    going_on_.stop.tolerance = std::max(kRoundOff, kGoingOn * residual);
    going_on_.stop.max_seconds = seconds_left();
    Model model = build(scene_, geometry(mesh.cuts));
    const Points x = mesh.model.objective->positions(mesh.result().q);
    const Result result = solve_again(x, model, going_on_);
    const double ratio = result.residual / residual;
    if (!(ratio <= kClearlySmaller)) return std::nullopt;
    const TriangleMesh before = surface_at(model, x),
                       after = surface_at(model, model.objective->positions(result.q));
    return (after.vertices - before.vertices).colwise().norm().maxCoeff() / (1 - ratio);
  }

  const Scene& scene_;
  SolveSetup setup_, going_on_;
  const RunOptions& options_;
  const AccuracyObserver& observer_;
  int most_triangles_;
  double most_seconds_, start_ = wall_seconds();
  std::list<SceneGeometry> geometries_;  // the scene's own first; the others refer to it
};

void check(const Scene& scene, double wanted_mm, const RunOptions& options) {
  std::vector<std::string> defects;
  if (!(wanted_mm > 0 && std::isfinite(wanted_mm)))
    defects.emplace_back("--accuracy: must be a length above 0, for example 0.1mm");
  if (!scene.mesh)
    defects.push_back("--accuracy: " + scene.file.string() +
                      " has no mesh that could be refined; use --tolerance");
  if (options.tolerance)
    defects.emplace_back("--accuracy: chooses the tolerance itself; leave --tolerance out");
  if (options.frame_interval)
    defects.emplace_back("--accuracy: solves several meshes and writes no frames; leave --frames out");
  if (!defects.empty()) throw InputError(defects);
}

// What is known where the error is not.
std::string last_change(const AccuracyEstimate& estimate) {
  const std::vector<AccuracyLevel>& levels = estimate.levels;
  const auto compared = std::find_if(levels.rbegin(), levels.rend(), [](const AccuracyLevel& level) {
    return level.to_previous.has_value();
  });
  std::string why = "there was no finer mesh to compare", refinement = "the last";
  if (levels.back().status != Status::Converged) {
    why = "the solve on " + std::to_string(levels.back().triangles) + " triangles did not converge";
    refinement = "the refinement before";
  } else if (compared != levels.rend()) {
    why = "no two refinements in a row agree in their order";
  }
  if (compared == levels.rend()) return ", as " + why;
  const DistanceFigures& moved = *compared->to_previous;
  return ", as " + why + "; " + refinement + " moved 95 % of the surface by up to " +
         page_number(moved.p95, 2) + " mm, its farthest point by " + page_number(moved.max, 2) + " mm";
}

std::string described(const AccuracyEstimate& estimate, const SolvedMesh& mesh) {
  const std::string where = " on " + std::to_string(mesh.model.mesh.triangle_count()) +
                            " triangles at tolerance " + page_number(estimate.tolerance);
  const std::string wanted = " (wanted: " + page_number(estimate.wanted_mm) + " mm)";
  if (!mesh.has_converged()) return "not known, as the solve" + where + " did not converge" + wanted;
  const std::optional<double> total = estimate.total_mm();
  if (!total) return "not known" + where + (estimate.discretisation_mm ? "" : last_change(estimate)) + wanted;
  const std::optional<double> greatest = estimate.greatest_mm();
  return page_number(*total, 2) + " mm by estimate for 95 % of the surface" +
         (greatest ? ", " + page_number(*greatest, 2) + " mm at its farthest point" : "") + where + wanted;
}

}  // namespace

std::string last_mesh(const AccuracyEstimate& estimate) {
  const AccuracyLevel& level = estimate.levels.back();
  std::string text = std::to_string(level.triangles) + " triangles in " + fixed_text(level.wall_s, 1) + " s";
  if (level.to_previous)
    text += ": 95 % of the surface moved by up to " + page_number(level.to_previous->p95, 2) +
            " mm, its farthest point by " + page_number(level.to_previous->max, 2) + " mm";
  if (estimate.discretisation_mm)
    text += "; error by estimate " + page_number(*estimate.discretisation_mm, 2) +
            " mm (wanted: " + page_number(estimate.wanted_mm) + " mm)";
  return text;
}

RunReport run_to_accuracy(const Scene& scene, const SolverTable& solvers, double wanted_mm,
                          const RunOptions& options, const AccuracyObserver& observer, int most_triangles) {
  check(scene, wanted_mm, options);
  Search search(scene, solvers, wanted_mm, options, observer, most_triangles);
  RunReport run;
  run.folder = open_result_folder(scene, options);
  SolvedMesh mesh = search.solve();
  AccuracyEstimate estimate = std::move(search.estimate);
  if (!mesh.has_converged())
    estimate.discretisation_mm = estimate.farthest_mm = estimate.algebraic_mm = std::nullopt;
  const std::optional<double> total = estimate.total_mm();
  estimate.cuts = static_cast<int>(mesh.cuts);
  estimate.is_reached = total && *total <= wanted_mm;
  estimate.message = described(estimate, mesh);

  SolveSetup setup = search.setup();
  setup.stop.tolerance = estimate.tolerance;
  RunNotes notes{.has_page = wants_page(scene, options)};
  if (!estimate.is_reached)
    notes.warnings.push_back("The wanted accuracy was not reached: " + estimate.message + ".");
  if (scene.frame_interval > 0)
    notes.warnings.emplace_back(
        "Frames are not written for a wanted accuracy, as several meshes are solved.");
  notes.accuracy = std::move(estimate);
  run.model = std::move(mesh.model);
  try {
    run.report =
        complete_run(scene, setup, run.model, std::move(mesh.solved), notes, options.checker, run.folder);
  } catch (const UnwrittenReport& error) {
    run.report = std::move(error.report());
    throw UnwrittenRun(error, std::move(run));
  }
  return run;
}

}  // namespace coapt
