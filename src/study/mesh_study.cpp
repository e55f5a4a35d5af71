#include "study/mesh_study.hpp"

#include "core/error.hpp"
#include "formats/mesh_io.hpp"
#include "results/reference/registered_reference.hpp"
#include "results/standing.hpp"
#include "results/study_files.hpp"
#include "scene/build/build.hpp"
#include "scene/build/refine_scene.hpp"
#include "scene/build/scene_geometry.hpp"
#include "solve/solve_scene.hpp"

#include <algorithm>
#include <cmath>
#include <list>

namespace coapt {
namespace {

MeshLevel solved_level(const Scene& scene, const SceneGeometry& geometry, const SolveSetup& setup,
                       const IntersectionChecker& checker) {
  Model model = build(scene, geometry);
  const Result result = solve_scene(scene, geometry, model, setup).result;
  const Fields fields = compute_fields(model, model.objective->positions(result.q));
  const Metrics metrics = measure(model, result.q, fields, checker);
  MeshLevel level;
  level.doubts = doubts(model, result, fields, metrics);
  level.triangles = model.mesh.triangle_count();
  level.vertices = model.mesh.vertex_count();
  level.status = result.status;
  level.residual = result.residual;
  level.iterations = result.iterations;
  level.wall_s = result.wall_s;
  level.cpu_s = result.cpu_s;
  level.intersections = metrics.intersections;
  level.orifice_area_mm2 = metrics.orifice_area_mm2;
  level.max_chord_force_n = metrics.max_chord_force_n;
  level.closed = surface_at(model, fields.x);
  if (const auto reference = placed_reference(model, level.closed))
    level.to_reference = distance_between(level.closed, *reference);
  return level;
}

void compare(MeshLevel& level, const MeshLevel& before) {
  if (level.status != Status::Converged || before.status != Status::Converged) return;
  level.to_previous = distance_between(level.closed, before.closed);
  if (before.to_previous && level.to_previous->mean > 0)
    level.order = std::log2(before.to_previous->mean / level.to_previous->mean);
}

std::string surface_file(const MeshLevel& level) {
  return "closed_" + std::to_string(level.triangles) + ".obj";
}

}  // namespace

bool MeshStudy::has_converged() const {
  return std::all_of(levels.begin(), levels.end(),
                     [](const MeshLevel& level) { return level.status == Status::Converged; });
}

MeshStudy study_mesh(const Scene& scene, const SolverTable& solvers, int levels, const RunOptions& options,
                     const std::function<void(const MeshLevel&)>& report) {
  if (levels < 1) throw InputError("--levels: the mesh must be cut at least once");
  const SolveSetup setup = solve_setup(scene, solvers, options);
  std::list<SceneGeometry> geometries;  // which refer to the first
  geometries.push_back(scene_geometry(scene));
  if (geometries.front().model.mesh.triangle_count() == 0)
    throw InputError(scene.file.string() + ": mesh: missing; there is nothing to refine");
  MeshStudy study{scene.file.filename().string(),
                  setup.solver,
                  setup.stop.tolerance,
                  geometries.front().model.origin,
                  {}};
  for (int k = 0; k < levels; ++k) geometries.push_back(refined(geometries.back()));
  build(scene,
        *std::next(geometries.begin()));  // what a finer mesh cannot have is said before the first solve
  for (const SceneGeometry& geometry : geometries) {
    MeshLevel level = solved_level(scene, geometry, setup, options.checker);
    if (!study.levels.empty()) compare(level, study.levels.back());
    study.levels.push_back(std::move(level));
    if (report) report(study.levels.back());
    if (study.levels.back().status == Status::Cancelled) break;
  }
  return study;
}

Table level_table(std::span<const MeshLevel> levels) {
  using Distance = DistanceFigures;
  return table_of<MeshLevel>(
      levels, {{{"triangles"}, &MeshLevel::triangles},
               {{"vertices"}, &MeshLevel::vertices},
               {text_column("status", "", 9), along(&MeshLevel::status, status_name)},
               {text_column("doubts"), along(&MeshLevel::doubts, joined_doubts)},
               {{"residual", "", "", 2}, &MeshLevel::residual},
               {{"iterations"}, &MeshLevel::iterations},
               {{"wall_s", "wall", "s", 4, 2}, &MeshLevel::wall_s},
               {{"cpu_s", "CPU", "s", 4, 2}, &MeshLevel::cpu_s},
               {{"intersections", "inter."}, &MeshLevel::intersections},
               {{"mean_to_previous_mm", "to level before", "mm", 4, 4},
                along(&MeshLevel::to_previous, &Distance::mean)},
               {{"p95_to_previous_mm", "95 %", "mm", 4, 4}, along(&MeshLevel::to_previous, &Distance::p95)},
               {{"max_to_previous_mm"}, along(&MeshLevel::to_previous, &Distance::max)},
               {{"order", "", "", 4, 2}, &MeshLevel::order},
               {{"orifice_area_mm2", "orifice", "mm2", 4, 2}, &MeshLevel::orifice_area_mm2},
               {{"max_chord_force_n"}, &MeshLevel::max_chord_force_n},
               {{"mean_to_reference_mm"}, along(&MeshLevel::to_reference, &Distance::mean)}});
}

void write_mesh_study(const std::filesystem::path& folder, const MeshStudy& study) {
  OrderedJson json = {{"scene", study.scene_file},
                      {"solver", study.solver},
                      {"tolerance", study.tolerance},
                      {"converged", study.has_converged()},
                      {"levels", OrderedJson::array()}};
  for (const MeshLevel& level : study.levels) {
    json["levels"].push_back({{"triangles", level.triangles},
                              {"vertices", level.vertices},
                              {"status", std::string(status_name(level.status))},
                              {"doubts", level.doubts},
                              {"residual", number_json(level.residual)},
                              {"iterations", level.iterations},
                              {"wall_s", level.wall_s},
                              {"cpu_s", level.cpu_s},
                              {"intersections", level.intersections},
                              {"distance_to_previous", distances_json(level.to_previous)},
                              {"order", number_json(level.order)},
                              {"orifice_area_mm2", number_json(level.orifice_area_mm2)},
                              {"max_chord_force_n", number_json(level.max_chord_force_n)},
                              {"distance_to_reference", distances_json(level.to_reference)},
                              {"file", surface_file(level)}});
    TriangleMesh closed = level.closed;
    closed.vertices.colwise() += study.origin;
    write_mesh(folder / surface_file(level), closed);
  }
  write_study(folder, "mesh_study", json, level_table(study.levels));
}

}  // namespace coapt
