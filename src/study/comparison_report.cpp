#include "study/comparison_report.hpp"

#include "core/components.hpp"
#include "formats/json/json_text.hpp"
#include "formats/whole_file.hpp"
#include "results/branches_json.hpp"
#include "results/csv_row.hpp"
#include "study/detail/comparison_json.hpp"

#include <cmath>

namespace coapt {
namespace {

OrderedJson refined_json(const RefinedPair& refined) {
  return {{"tolerance", refined.tolerance},
          {"residual", number_json(refined.residual)},
          {"residual_of_reference", number_json(refined.reference_residual)},
          {"energy_mj", number_json(refined.energy)},
          {"energy_of_reference_mj", number_json(refined.reference_energy)},
          {"same_vertex_max_mm", number_json(refined.largest_mm)}};
}

OrderedJson metrics_json(const Metrics& metrics) {
  OrderedJson json = OrderedJson::object();
  for (const MetricRow& row : metric_rows(metrics))
    json[row.name] =
        row.value && row.is_count ? OrderedJson(std::lround(*row.value)) : number_json(row.value);
  return json;
}

// Time that a method which follows the motion of masses has simulated.
std::optional<double> simulated_s(const Result& result) {
  if (result.trace.empty() || result.trace.back().time == 0) return std::nullopt;
  return result.trace.back().time;
}

void add_result(const RunReport& run, OrderedJson& json) {
  const Report& report = run.report;
  const Result& result = report.result;
  json["solver"] = report.solver;
  json["folder"] = run.folder.filename().string();
  json["status"] = std::string(status_name(result.status));
  json["converged"] = result.status == Status::Converged;
  json["status_message"] = result.message;
  json["residual"] = number_json(result.residual);
  json["energy_mj"] = number_json(result.energy);
  json["stability"] = std::string(stability_name(result.certificate.stability.verdict));
  json["iterations"] = result.iterations;
  json["rounds"] = result.outer_iterations;
  json["simulated_s"] = number_json(simulated_s(result));
  json["evaluations"] = {{"value", result.evaluations.value},
                         {"gradient", result.evaluations.gradient},
                         {"hessian", result.evaluations.hessian},
                         {"factorisations", result.factorisations}};
  json["time"] = {{"wall_s", number_json(result.wall_s)}, {"cpu_s", number_json(result.cpu_s)}};
  json["metrics"] = metrics_json(report.metrics);
  json["judge"] = report.metrics.intersection_judge;
  json["warnings"] = report.warnings;
  json["branches"] = report.branches ? branches_json(*report.branches) : OrderedJson(nullptr);
}

OrderedJson method_json(const ComparedMethod& method) {
  OrderedJson json = {{"name", method.name},
                      {"model", std::string(method_model_name(method.model))},
                      {"verdict", std::string(verdict_name(method.verdict))},
                      {"message", method.message}};
  json["distance_to_reference_method"] = method.gap ? gap_json(*method.gap) : OrderedJson(nullptr);
  json["refined"] = method.refined ? refined_json(*method.refined) : OrderedJson(nullptr);
  json["energy_above_reference_mj"] = number_json(method.energy_above);
  const bool has_closed = method.run && method.run->report.reference;
  json["distance_to_closed_surface"] =
      has_closed ? reference_json(*method.run->report.reference) : OrderedJson(nullptr);
  if (method.run) add_result(*method.run, json);
  return json;
}

constexpr const char* kHeader =
    "method,model,verdict,status,residual,energy_mj,iterations,gradients,factorisations,simulated_s,wall_s,"
    "cpu_s,intersections,mean_to_reference_mm,p95_to_reference_mm,max_to_reference_mm,same_vertex_mean_mm,"
    "same_vertex_max_mm,mean_to_closed_mm,p95_to_closed_mm,max_to_closed_mm,orifice_area_mm2,"
    "leaflet_area_change_mm2,coaptation_area_mm2,coaptation_length_mm,coaptation_height_mm,tenting_height_mm,"
    "max_chord_force_n,max_principal_strain,message";

// None where there is no membrane.
std::optional<double> area_change(const Metrics& m) {
  return m.leaflet_area_open_mm2 > 0 ? std::optional(m.leaflet_area_change_mm2) : std::nullopt;
}

void add_figures(const ComparedMethod& method, Row& row) {
  const Report& report = method.run->report;
  const Result& result = report.result;
  const Metrics& m = report.metrics;
  row.text(std::string(status_name(result.status)));
  for (const double value : {result.residual, result.energy}) row.number(value);
  for (const long count : {long{result.iterations}, result.evaluations.gradient, result.factorisations})
    row.count(count);
  row.number(simulated_s(result));
  for (const double value : {result.wall_s, result.cpu_s}) row.number(value);
  row.count(m.intersections);
  const bool has_surfaces = method.gap && method.gap->surfaces, has_closed = report.reference.has_value();
  const DistanceFigures to_reference =
                            has_surfaces ? both_directions(*method.gap->surfaces) : DistanceFigures{},
                        to_closed = has_closed ? both_directions(*report.reference) : DistanceFigures{};
  row.distance(has_surfaces ? &to_reference : nullptr);
  row.number(method.gap ? std::optional(method.gap->same_vertex.mean) : std::nullopt);
  row.number(method.gap ? std::optional(method.gap->same_vertex.max) : std::nullopt);
  row.distance(has_closed ? &to_closed : nullptr);
  for (const auto& value :
       {m.orifice_area_mm2, area_change(m), m.coaptation_area_mm2, m.coaptation_length_mm,
        m.coaptation_height_mm, m.tenting_height_mm, m.max_chord_force_n, m.max_principal_strain})
    row.number(value);
}

}  // namespace

OrderedJson gap_json(const MethodGap& gap) {
  OrderedJson json = gap.surfaces ? reference_json(*gap.surfaces) : OrderedJson::object();
  json["same_vertex"] = {{"mean_mm", number_json(gap.same_vertex.mean)},
                         {"max_mm", number_json(gap.same_vertex.max)}};
  json["left_out_nodes"] = gap.left_out;
  return json;
}

OrderedJson comparison_as_json(const Comparison& comparison) {
  OrderedJson json = {{"version", version()},
                      {"scene", comparison.scene_file},
                      {"reference", comparison.reference().name},
                      {"tolerance", comparison.tolerance},
                      {"extent_mm", number_json(comparison.extent_mm)},
                      {"same_shape_mm", number_json(kSameShape * comparison.extent_mm)}};
  json["closed_surface"] =
      comparison.closed_surface.empty() ? OrderedJson(nullptr) : OrderedJson(comparison.closed_surface);
  json["converged"] = comparison.has_converged();
  json["cancelled"] = comparison.is_cancelled;
  json["methods"] = OrderedJson::array();
  for (const ComparedMethod& method : comparison.methods) json["methods"].push_back(method_json(method));
  return json;
}

std::string comparison_json(const Comparison& comparison) {
  return json_text(comparison_as_json(comparison), 2) + "\n";
}

std::string comparison_csv(const Comparison& comparison) {
  std::ostringstream csv = csv_with_header(kHeader);
  constexpr int kFigures = 26;  // columns between the verdict and the message
  for (const ComparedMethod& method : comparison.methods) {
    Row row(csv);
    row.text(method.name);
    row.text(std::string(method_model_name(method.model)));
    row.text(std::string(verdict_name(method.verdict)));
    if (method.run)
      add_figures(method, row);
    else
      for (int column = 0; column < kFigures; ++column) row.text("");
    row.text(method.message);
    csv << '\n';
  }
  return csv.str();
}

void write_comparison(const std::filesystem::path& folder, const Comparison& comparison) {
  write_study(folder, "compare", comparison_as_json(comparison), comparison_csv(comparison));
  formats::write_whole(folder / "report.html", comparison_page(comparison));
}

}  // namespace coapt
