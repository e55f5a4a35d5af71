#include "study/bench/benchmark_report.hpp"

#include "core/components.hpp"
#include "formats/json/json_text.hpp"
#include "formats/whole_file.hpp"
#include "results/branches_json.hpp"
#include "results/csv_row.hpp"
#include "study/bench/benchmark_summary.hpp"
#include "study/detail/comparison_json.hpp"

#include <sstream>

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
  json["model"] = errors.model ? distances_json(*errors.model) : OrderedJson(nullptr);
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
  json["distance_to_next"] = mesh.to_next ? distances_json(*mesh.to_next) : OrderedJson(nullptr);
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
  json["warnings"] = missing_equilibria(bench);
  json["recommendations"] = OrderedJson::array();
  for (const double mm : kTotalAccuracies) json["recommendations"].push_back(recommendation(bench, mm));
  return json;
}

constexpr const char* kHeader =
    "method,model,triangles,tolerance,status,residual,energy_mj,iterations,values,gradients,hessians,"
    "factorisations,repeats,wall_median_s,wall_best_s,cpu_median_s,cpu_best_s,cpu_in_factorisations,"
    "peak_memory_mb,"
    "algebraic_max_mm,algebraic_rms_mm,discretisation_mm,method_mm,mean_to_closed_mm,p95_to_closed_mm,"
    "max_to_closed_mm,total_mm,phases_s,message";

// "factorise=0.12;gradient=0.03", wall time [s].
std::string phases_text(const BenchRun& run) {
  std::ostringstream text;
  for (const auto& [phase, seconds] : run.phase_s)
    text << (text.tellp() > 0 ? ";" : "") << phase << '=' << seconds;
  return text.str();
}

void add_row(const Benchmark& bench, const BenchRun& run, std::ostream& csv) {
  Row row(csv);
  row.text(bench.methods[run.method].name);
  row.text(std::string(method_model_name(bench.methods[run.method].model)));
  row.count(bench.meshes[run.mesh].triangles);
  row.number(run.tolerance);
  row.text(std::string(status_name(run.status)));
  for (const double value : {run.residual, run.energy}) row.number(value);
  for (const long count : {long{run.iterations}, run.evaluations.value, run.evaluations.gradient,
                           run.evaluations.hessian, run.factorisations, long{run.repeats}})
    row.count(count);
  for (const double seconds : {run.wall.median, run.wall.best, run.cpu.median, run.cpu.best})
    row.number(seconds);
  row.number(factorisations_worth(bench, run));
  row.number(run.peak_memory_mb);
  const RunErrors& errors = run.errors;
  row.number(errors.algebraic ? std::optional(errors.algebraic->max) : std::nullopt);
  row.number(errors.algebraic ? std::optional(errors.algebraic->rms) : std::nullopt);
  row.number(errors.discretisation);
  row.number(errors.method);
  row.distance(errors.model ? &*errors.model : nullptr);
  row.number(errors.total);
  row.text(phases_text(run));
  row.text(run.message);
  csv << '\n';
}

}  // namespace

std::string benchmark_json(const Benchmark& bench) { return json_text(benchmark_as_json(bench), 2) + "\n"; }

std::string benchmark_csv(const Benchmark& bench) {
  std::ostringstream csv = csv_with_header(kHeader);
  for (const BenchRun& run : bench.runs) add_row(bench, run, csv);
  return csv.str();
}

void write_benchmark(const std::filesystem::path& folder, const Benchmark& bench) {
  write_study(folder, "bench", benchmark_as_json(bench), benchmark_csv(bench));
  formats::write_whole(folder / "bench.html", benchmark_page(bench));
}

}  // namespace coapt
