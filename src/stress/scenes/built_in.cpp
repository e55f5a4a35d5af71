#include "stress/scenes/built_in.hpp"

#include "core/number_text.hpp"
#include "formats/csv_table.hpp"
#include "formats/json/valve_json.hpp"
#include "formats/mesh_io.hpp"
#include "formats/whole_file.hpp"
#include "results/results.hpp"

namespace coapt {
namespace {

std::string csv_of(const Points& points) {
  Table table{.columns = {{"x"}, {"y"}, {"z"}}};
  for (const auto& x : points.colwise()) table.rows.push_back({x[0], x[1], x[2]});
  return csv_table(table, 17);
}

}  // namespace

StressScene written(const std::filesystem::path& folder, const BuiltScene& built) {
  const std::filesystem::path path = folder / built.name;
  prepare_result_folder(path);
  if (built.mesh.triangle_count() > 0) write_mesh(path / "mesh.obj", built.mesh);
  for (const auto& [name, mesh] : built.others) write_mesh(path / (name + ".obj"), mesh);
  for (const auto& [name, points] : built.points)
    formats::write_whole(path / (name + ".csv"), csv_of(points));
  if (!built.chords.chords.empty()) {
    Valve valve;
    valve.name = built.name;
    valve.chords = built.chords;
    write_valve(path / "chords.json", valve);
  }
  formats::write_whole(path / "scene.json", built.text);
  return stress_scene(load_scene(path / "scene.json"));
}

std::string filled(std::string_view text,
                   std::initializer_list<std::pair<std::string_view, double>> numbers) {
  std::string result(text);
  for (const auto& [name, value] : numbers) {
    const std::string key = "$" + std::string(name), digits = number_text(value, 17);
    for (size_t at = result.find(key); at != std::string::npos; at = result.find(key, at + digits.size()))
      result.replace(at, key.size(), digits);
  }
  return result;
}

Points boundary_points(const Points& x, const Triangles& triangles) {
  std::vector<int> nodes;
  for (const auto& loop : boundary_loops(triangles)) nodes.insert(nodes.end(), loop.begin(), loop.end());
  return x(Eigen::all, nodes);
}

StressRow row_of(const StressRunner& bench, const BuiltRow& row) {
  return {row.id, row.scene.name, row.name, row.measure, row.unit, row.is_quick, [bench, row] {
            const StressScene scene = written(bench.options().folder / "scenes", row.scene);
            const StressRun solved = bench.solve(scene, {.judges_every_state = row.judges_every_state});
            return row.checker(scene, solved);
          }};
}

StressOutcome converged_and(const StressRun& solved, const StressScene& scene, double figure, double limit,
                            const std::string& message) {
  if (auto outcome = not_converged(solved, scene.scene.solver.tolerance)) return *outcome;
  return measured(solved, figure, limit, message);
}

}  // namespace coapt
