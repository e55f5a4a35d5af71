#include "study/bench/benchmark_report.hpp"

#include "core/components.hpp"
#include "core/number_text.hpp"
#include "formats/json/json_text.hpp"
#include "formats/whole_file.hpp"
#include "results/branches_json.hpp"
#include "results/study_files.hpp"
#include "study/bench/benchmark_summary.hpp"
#include "study/detail/comparison_json.hpp"

namespace coapt {
namespace {

OrderedJson spread_json(const Spread& spread) {
  return {{"median", number_json(spread.median)}, {"best", number_json(spread.best)}};
}

// What names a run: its method and its mesh.
OrderedJson place_json(const Benchmark& bench, size_t method, size_t mesh) {
  return {
      {"method", bench.methods[method].name}, {"mesh", mesh}, {"triangles", bench.meshes[mesh].triangles}};
}

OrderedJson errors_json(const RunErrors& errors) {
  OrderedJson json;
  json["algebraic"] = nullptr;
  if (const auto& algebraic = errors.algebraic)
    json["algebraic"] = {{"max_mm", number_json(algebraic->max)}, {"rms_mm", number_json(algebraic->rms)}};
  json["discretisation_mm"] = number_json(errors.discretisation);
  json["method_mm"] = number_json(errors.method);
  json["model"] = distances_json(errors.model);
  json["total_mm"] = number_json(errors.total);
  return json;
}

OrderedJson run_json(const Benchmark& bench, const BenchRun& run) {
  OrderedJson json = place_json(bench, run.method, run.mesh);
  json["tolerance"] = run.tolerance;
  json["status"] = std::string(status_name(run.status));
  json["converged"] = run.status == Status::Converged;
  json["message"] = run.message;
  json["residual"] = number_json(run.residual);
  json["energy_mj"] = number_json(run.energy);
  json["iterations"] = run.iterations;
  json["rounds"] = run.outer_iterations;
  json["evaluations"] = {{"value", run.evaluations.value},
                         {"gradient", run.evaluations.gradient},
                         {"hessian", run.evaluations.hessian},
                         {"factorisations", run.factorisations}};
  json["repeats"] = run.repeats;
  json["wall_s"] = spread_json(run.wall);
  json["cpu_s"] = spread_json(run.cpu);
  json["cpu_in_factorisations"] = number_json(factorisations_worth(bench, run));
  json["time_by_phase_s"] = OrderedJson::object();
  for (const auto& [phase, seconds] : run.phase_s) json["time_by_phase_s"][phase] = number_json(seconds);
  json["peak_memory_mb"] = number_json(run.peak_memory_mb);
  json["errors"] = errors_json(run.errors);
  return json;
}

OrderedJson mesh_json(const BenchMesh& mesh) {
  OrderedJson json = {{"triangles", mesh.triangles},
                      {"vertices", mesh.vertices},
                      {"nodes", mesh.nodes},
                      {"benchmarked", mesh.is_benchmarked},
                      {"residual_of_equilibrium", number_json(mesh.residual)}};
  json["no_equilibrium"] = mesh.missing.empty() ? OrderedJson(nullptr) : OrderedJson(mesh.missing);
  json["distance_to_next"] = distances_json(mesh.to_next);
  json["order"] = number_json(mesh.order);
  json["discretisation_mm"] = number_json(mesh.error_mm);
  json["factorisation_s"] = number_json(mesh.factorisation_s);
  return json;
}

OrderedJson end_json(const Benchmark& bench, const BenchEnd& end) {
  OrderedJson json = place_json(bench, end.method, end.mesh);
  json["verdict"] = std::string(verdict_name(end.verdict));
  json["failure"] = end.failure;
  json["residual_of_equilibrium"] = number_json(end.residual);
  json["no_equilibrium"] = end.missing.empty() ? OrderedJson(nullptr) : OrderedJson(end.missing);
  json["distance_to_reference_method"] = end.gap ? gap_json(*end.gap) : OrderedJson(nullptr);
  return json;
}

// Times to an accuracy: of each method and mesh by the algebraic error, of each method by the total one.
OrderedJson times_json(const Benchmark& bench) {
  OrderedJson json = OrderedJson::array();
  const auto add = [&](const char* kind, double mm, OrderedJson place, const BenchRun* run) {
    place["error"] = kind;
    place["accuracy_mm"] = mm;
    place["wall_s"] = run ? number_json(run->wall.median) : OrderedJson(nullptr);
    place["cpu_s"] = run ? number_json(run->cpu.median) : OrderedJson(nullptr);
    place["tolerance"] = run ? OrderedJson(run->tolerance) : OrderedJson(nullptr);
    json.push_back(std::move(place));
  };
  for (size_t method = 0; method < bench.methods.size(); ++method) {
    for (size_t mesh = 0; mesh < bench.meshes.size(); ++mesh)
      for (const double mm : kAlgebraicAccuracies)
        if (bench.meshes[mesh].is_benchmarked)
          add("algebraic", mm, place_json(bench, method, mesh),
              fastest_run(bench, ErrorKind::Algebraic, mm, {method, mesh}));
    for (const double mm : kTotalAccuracies) {
      const BenchRun* run = fastest_run(bench, ErrorKind::Total, mm, {.method = method});
      OrderedJson place =
          run ? place_json(bench, method, run->mesh)
              : OrderedJson{
                    {"method", bench.methods[method].name}, {"mesh", nullptr}, {"triangles", nullptr}};
      add("total", mm, std::move(place), run);
    }
  }
  return json;
}

OrderedJson growth_json(const Benchmark& bench) {
  OrderedJson json = OrderedJson::array();
  for (size_t method = 0; method < bench.methods.size(); ++method)
    if (const auto found = growth(bench, method))
      json.push_back({{"method", bench.methods[method].name},
                      {"exponent", number_json(found->exponent)},
                      {"tolerance", found->tolerance},
                      {"meshes", found->meshes}});
  return json;
}

OrderedJson benchmark_as_json(const Benchmark& bench) {
  OrderedJson json = {{"version", version()},
                      {"scene", bench.scene_file},
                      {"reference", bench.methods.front().name},
                      {"tolerances", bench.tolerances},
                      {"equilibrium_tolerance", kEquilibrium},
                      {"equilibrium_residual", bench.equilibrium_residual()},
                      {"extent_mm", number_json(bench.extent_mm)},
                      {"same_shape_mm", number_json(kSameShape * bench.extent_mm)}};
  json["closed_surface"] =
      bench.closed_surface.empty() ? OrderedJson(nullptr) : OrderedJson(bench.closed_surface);
  json["converged"] = bench.has_converged();
  json["cancelled"] = bench.is_cancelled;
  json["assumed_order"] = bench.assumed_order;
  json["methods"] = OrderedJson::array();
  for (const BenchMethod& method : bench.methods)
    json["methods"].push_back(
        {{"name", method.name}, {"model", std::string(method_model_name(method.model))}});
  for (const char* list : {"meshes", "runs", "ends"}) json[list] = OrderedJson::array();
  for (const BenchMesh& mesh : bench.meshes) json["meshes"].push_back(mesh_json(mesh));
  for (const BenchRun& run : bench.runs) json["runs"].push_back(run_json(bench, run));
  for (const BenchEnd& end : bench.ends) json["ends"].push_back(end_json(bench, end));
  json["time_to"] = times_json(bench);
  json["growth"] = growth_json(bench);
  json["other_equilibria"] = other_equilibria(bench);
  json["branches"] = bench.branches ? branches_json(*bench.branches) : OrderedJson(nullptr);
  json["doubts"] = bench.shown ? bench.shown->standing.doubts : std::vector<std::string>();
  json["warnings"] = missing_equilibria(bench);
  json["recommendations"] = OrderedJson::array();
  for (const double mm : kTotalAccuracies) json["recommendations"].push_back(recommendation(bench, mm));
  return json;
}

// "factorise=0.12;gradient=0.03", wall time [s].
std::string phases_text(const BenchRun& run) {
  std::string text;
  for (const auto& [phase, seconds] : run.phase_s)
    text.append(text.empty() ? "" : ";").append(phase).append("=").append(number_text(seconds, 6));
  return text;
}

}  // namespace

std::string benchmark_json(const Benchmark& bench) { return json_text(benchmark_as_json(bench), 2) + "\n"; }

Table run_table(const Benchmark& bench, std::span<const BenchRun> runs) {
  using Counts = EvaluationCounts;
  using Distance = DistanceFigures;
  const auto method = [&](const BenchRun& run) { return bench.methods[run.method].name; };
  const auto model = [&](const BenchRun& run) { return method_model_name(bench.methods[run.method].model); };
  const auto mesh = [&](const BenchRun& run) { return mesh_text(bench.meshes[run.mesh]); };
  const auto triangles = [&](const BenchRun& run) { return bench.meshes[run.mesh].triangles; };
  const auto worth = [&](const BenchRun& run) { return factorisations_worth(bench, run); };
  return table_of<BenchRun>(
      runs,
      {{text_column("method", "", 12), method},
       {text_column("model"), model},
       {text_column("mesh", "", 18), mesh},
       {{"triangles"}, triangles},
       {{"tolerance", "", "", 2}, &BenchRun::tolerance},
       {text_column("status", "", 16), along(&BenchRun::status, status_name)},
       {{"residual", "", "", 2}, &BenchRun::residual},
       {{"energy_mj"}, &BenchRun::energy},
       {{"iterations"}, &BenchRun::iterations},
       {{"values"}, along(&BenchRun::evaluations, &Counts::value)},
       {{"gradients"}, along(&BenchRun::evaluations, &Counts::gradient)},
       {{"hessians", "Hessians"}, along(&BenchRun::evaluations, &Counts::hessian)},
       {{"factorisations", "factors"}, &BenchRun::factorisations},
       {{"repeats"}, &BenchRun::repeats},
       {{"wall_median_s", "wall", "s", 3, 4}, along(&BenchRun::wall, &Spread::median)},
       {{"wall_best_s", "best", "s", 3}, along(&BenchRun::wall, &Spread::best)},
       {{"cpu_median_s", "CPU", "s", 3, 4}, along(&BenchRun::cpu, &Spread::median)},
       {{"cpu_best_s"}, along(&BenchRun::cpu, &Spread::best)},
       {{"cpu_in_factorisations", "CPU", "units", 3}, worth},
       {{"peak_memory_mb", "memory", "MB", 3, 1}, &BenchRun::peak_memory_mb},
       {{"algebraic_max_mm", "algebraic", "mm", 3},
        along(&BenchRun::errors, &RunErrors::algebraic, &NodeError::max)},
       {{"algebraic_rms_mm", "rms", "mm", 3},
        along(&BenchRun::errors, &RunErrors::algebraic, &NodeError::rms)},
       {{"discretisation_mm", "of the mesh", "mm", 3}, along(&BenchRun::errors, &RunErrors::discretisation)},
       {{"method_mm", "of the method", "mm", 3}, along(&BenchRun::errors, &RunErrors::method)},
       {{"mean_to_closed_mm", "to closed", "mm", 3},
        along(&BenchRun::errors, &RunErrors::model, &Distance::mean)},
       {{"p95_to_closed_mm"}, along(&BenchRun::errors, &RunErrors::model, &Distance::p95)},
       {{"max_to_closed_mm"}, along(&BenchRun::errors, &RunErrors::model, &Distance::max)},
       {{"total_mm", "total", "mm", 3}, along(&BenchRun::errors, &RunErrors::total)},
       {text_column("phases_s"), phases_text},
       {text_column("message"), &BenchRun::message}});
}

Table times_table(const Benchmark& bench) {
  Table table{.columns = {text_column("method"), text_column("error")}};
  for (const double mm : kAlgebraicAccuracies)
    table.columns.push_back({number_text(mm) + " mm", number_text(mm) + " mm", "s", 3});
  for (size_t method = 0; method < bench.methods.size(); ++method) {
    const auto add = [&](const std::string& error, ErrorKind kind, const RunFilter& filter) {
      std::vector<TableCell>& row = table.rows.emplace_back();
      row = {bench.methods[method].name, error};
      for (const double mm : kAlgebraicAccuracies) {
        const BenchRun* run = fastest_run(bench, kind, mm, filter);
        row.emplace_back(run != nullptr ? TableCell(run->wall.median) : TableCell());
      }
    };
    add("total", ErrorKind::Total, {.method = method});
    for (size_t mesh = 0; mesh < bench.meshes.size(); ++mesh)
      if (bench.meshes[mesh].is_benchmarked)
        add("algebraic, " + mesh_text(bench.meshes[mesh]), ErrorKind::Algebraic, {method, mesh});
  }
  return table;
}

void write_benchmark(const std::filesystem::path& folder, const Benchmark& bench) {
  write_study(folder, "bench", benchmark_as_json(bench), without(run_table(bench, bench.runs), {"mesh"}));
  formats::write_whole(folder / "bench.html", benchmark_page(bench));
}

}  // namespace coapt
