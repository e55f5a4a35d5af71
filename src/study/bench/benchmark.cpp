#include "study/bench/benchmark.hpp"

#include "mesh/triangle_mesh.hpp"
#include "scene/build/build.hpp"
#include "scene/build/refine_scene.hpp"
#include "study/bench/detail/bench_shown.hpp"
#include "study/bench/detail/unit_cost.hpp"
#include "study/detail/method_list.hpp"

#include <algorithm>
#include <list>

namespace coapt {
namespace {

constexpr int kMostLevels = 4;

// What is wrong with the options, all in one pass. Throws InputError.
void check_options(const Scene& scene, const SolverTable& solvers, const BenchOptions& options) {
  std::vector<std::string> defects;
  check_methods(scene, solvers, {options.methods, options.reference, options.closed}, defects);
  const std::vector<double>& tolerances = options.tolerances;
  if (tolerances.empty()) defects.emplace_back("--tolerances: none is named");
  if (!std::all_of(tolerances.begin(), tolerances.end(), [](double t) { return t > 0 && t <= 1; }))
    defects.emplace_back(
        "--tolerances: each must be above 0 and at most 1, a residual relative to the largest force");
  if (std::any_of(tolerances.begin(), tolerances.end(),
                  [&](double t) { return std::count(tolerances.begin(), tolerances.end(), t) > 1; }))
    defects.emplace_back("--tolerances: one is named twice");
  if (options.truth_seconds && !(*options.truth_seconds > 0))
    defects.emplace_back("--truth-seconds: must be above 0");
  if (options.repeats < 1) defects.emplace_back("--repeats: each run is made at least once");
  if (options.levels < 0 || options.levels > kMostLevels)
    defects.push_back("--levels: between 0 and " + std::to_string(kMostLevels));
  if (options.levels > 0 && !scene.mesh)
    defects.push_back("--levels: " + scene.file.string() + " has no mesh that could be cut; use --levels 0");
  if (!defects.empty()) throw InputError(defects);
}

// The scene's own nodes first, then every mesh that is asked for and one more. Each refers to the first.
std::list<SceneGeometry> refined_geometries(const Scene& scene, int levels) {
  std::list<SceneGeometry> geometries;
  geometries.push_back(scene_geometry(scene));
  if (geometries.front().model.mesh.triangle_count() > 0)
    for (int k = 0; k <= levels; ++k) geometries.push_back(refined(geometries.back()));
  build(scene, geometries.front());  // what is refused is refused before the first solve
  if (geometries.size() > 1) build(scene, *std::next(geometries.begin()));
  return geometries;
}

BenchMesh described(const SceneGeometry& geometry, bool is_benchmarked) {
  const Model& model = geometry.model;
  BenchMesh mesh;
  mesh.triangles = model.mesh.triangle_count();
  mesh.vertices = model.mesh.vertex_count();
  mesh.nodes = static_cast<int>(model.X.cols());
  mesh.is_benchmarked = is_benchmarked;
  return mesh;
}

// Distances between the reference equilibria from mesh to mesh, and what they say of the error of each.
// Meshes from the first whose equilibrium is missing on are left out: two that are there say something.
void estimate_meshes(const std::list<SceneGeometry>& geometries, const std::vector<Equilibrium>& equilibria,
                     Benchmark& found) {
  if (found.meshes.size() < 2) return;
  std::vector<TriangleMesh> shapes;
  auto geometry = geometries.begin();
  for (const Equilibrium& equilibrium : equilibria) {
    if (!equilibrium.is_found) break;
    shapes.push_back(surface_at((geometry++)->model, equilibrium.x));
  }
  if (shapes.size() < 2) return;
  const MeshDistances distances = distances_between_meshes(shapes);
  const std::vector<DistanceFigures>& to_next = distances.to_next;
  const DiscretisationEstimate estimate = estimate_discretisation(distances);
  found.assumed_order = estimate.assumed_order;
  for (size_t k = 0; k < shapes.size(); ++k) {
    BenchMesh& mesh = found.meshes[k];
    mesh.error_mm = estimate.error_mm[k];
    if (k < to_next.size()) mesh.to_next = to_next[k];
    if (k > 0 && k < to_next.size()) mesh.order = observed_order(to_next[k - 1], to_next[k]);
  }
}

// The reference equilibrium on the finest mesh that it is known on, none where the scene's own is the finest.
std::optional<TriangleMesh> finest_shape(const std::list<SceneGeometry>& geometries,
                                         const std::vector<Equilibrium>& equilibria, const Benchmark& found) {
  size_t last = 0;
  while (last + 1 < found.meshes.size() && found.meshes[last + 1].error_mm) ++last;
  if (last == 0) return std::nullopt;
  return surface_at(std::next(geometries.begin(), static_cast<std::ptrdiff_t>(last))->model,
                    equilibria[last].x);
}

// What all errors of a run come to; needs the estimates of the meshes.
void add_totals(Benchmark& found) {
  for (BenchRun& run : found.runs) {
    const BenchMesh& mesh = found.meshes[run.mesh];
    RunErrors& errors = run.errors;
    // The distance of another method's run to the reference's equilibrium says enough without a truth of its
    // own.
    const bool is_known = run.method == 0 ? errors.algebraic.has_value() : errors.method.has_value();
    errors.discretisation = mesh.error_mm;
    if (!is_known || !mesh.residual || (mesh.triangles > 0 && !errors.discretisation)) continue;
    errors.total = (errors.algebraic ? errors.algebraic->max : 0) + errors.discretisation.value_or(0) +
                   errors.method.value_or(0);
  }
}

}  // namespace

bool Benchmark::has_converged() const {
  const bool have_all_run = std::all_of(ends.begin(), ends.end(), [](const BenchEnd& end) {
    return end.failure.empty() && end.missing.empty();
  });
  const bool are_known =
      std::all_of(meshes.begin(), meshes.end(), [](const BenchMesh& mesh) { return mesh.missing.empty(); });
  return !is_cancelled && have_all_run && are_known &&
         std::all_of(runs.begin(), runs.end(),
                     [](const BenchRun& run) { return run.status == Status::Converged; });
}

double Benchmark::equilibrium_residual() const {
  return std::max(kEquilibrium, kEquilibriumShare * tolerances.back());
}

Benchmark run_benchmark(const Scene& given, const SolverTable& solvers, const BenchOptions& options,
                        const RunOptions& wanted) {
  check_options(given, solvers, options);
  const Scene scene = with_closed_surface(given, options.closed);
  const std::list<SceneGeometry> geometries = refined_geometries(scene, options.levels);
  RunOptions run = wanted;
  run.modes = 0;  // eigenvalues are no part of a solve
  const SolveSetup setup = solve_setup(scene, solvers, run);
  if (run.folder.empty()) run.folder = result_folder(scene);

  Benchmark found;
  found.scene_file = scene.file.filename().string();
  found.scene_title = scene_title(scene);
  if (scene.closed_surface) found.closed_surface = scene.closed_surface->filename().string();
  const Model& first = geometries.front().model;
  found.extent_mm = bounding_box_diagonal(first.mesh.triangle_count() > 0 ? first.mesh.vertices : first.X);
  found.tolerances = options.tolerances;
  std::sort(found.tolerances.rbegin(), found.tolerances.rend());
  for (const std::string& name : reference_first(options.methods, options.reference))
    found.methods.push_back({name, model_of(name, scene)});
  if (run.writes) {
    prepare_result_folder(run.folder);
    found.folder = run.folder;
  }

  const BenchCourse course{scene, solvers, options, run};
  std::vector<Equilibrium> equilibria;
  for (const SceneGeometry& geometry : geometries) {
    const bool is_benchmarked = found.meshes.size() <= static_cast<size_t>(options.levels);
    found.meshes.push_back(described(geometry, is_benchmarked));
    const size_t mesh = found.meshes.size() - 1;
    equilibria.emplace_back();
    if (!is_benchmarked) equilibria.back() = equilibrium_from_start(course, geometry, found);
    for (size_t method = 0; is_benchmarked && method < found.methods.size() && !found.is_cancelled;
         ++method) {
      const Equilibrium end = bench_pair(course, geometry, mesh, method, equilibria.back(), found);
      if (method == 0) equilibria.back() = end;
    }
    found.meshes.back().missing = found.is_cancelled ? "cancelled" : equilibria.back().missing;
    if (const Equilibrium& reference = equilibria.back(); reference.is_found) {
      found.meshes.back().residual = reference.residual;
      if (is_benchmarked && !found.is_cancelled)
        found.meshes.back().factorisation_s = factorisation_seconds(scene, geometry, setup, reference.x);
    }
    if (found.is_cancelled) break;
  }
  estimate_meshes(geometries, equilibria, found);
  add_totals(found);
  if ((run.writes || options.branches.starts > 0) && !found.is_cancelled) {
    const std::optional<TriangleMesh> finest = finest_shape(geometries, equilibria, found);
    found.shown = bench_shown(course, geometries.front(), finest ? &*finest : nullptr, found);
  }
  return found;
}

}  // namespace coapt
