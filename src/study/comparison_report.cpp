#include "study/comparison_report.hpp"

#include "core/components.hpp"
#include "formats/json/json_text.hpp"
#include "formats/whole_file.hpp"
#include "results/branches_json.hpp"
#include "results/result_warnings.hpp"
#include "results/study_files.hpp"
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
  json["doubts"] = doubts(report);
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
  json["judge"] = report.metrics.intersection_checker;
  json["warnings"] = report.warnings;
  json["branches"] = report.branches ? branches_json(*report.branches) : OrderedJson(nullptr);
}

OrderedJson method_json(const ComparedMethod& method) {
  OrderedJson json = {{"name", method.name},
                      {"model", std::string(method_model_name(method.model))},
                      {"verdict", std::string(verdict_name(method.verdict))},
                      {"message", method.message},
                      {"shares_with_newton", method.shares}};
  json["distance_to_reference_method"] = method.gap ? gap_json(*method.gap) : OrderedJson(nullptr);
  json["refined"] = method.refined ? refined_json(*method.refined) : OrderedJson(nullptr);
  json["energy_above_reference_mj"] = number_json(method.energy_above);
  const bool has_closed = method.run && method.run->report.reference;
  json["distance_to_closed_surface"] =
      has_closed ? reference_json(*method.run->report.reference) : OrderedJson(nullptr);
  if (method.run) add_result(*method.run, json);
  return json;
}

std::optional<double> area_change(const Metrics& metrics) {
  if (!(metrics.leaflet_area_open_mm2 > 0)) return std::nullopt;  // there is no membrane
  return metrics.leaflet_area_change_mm2;
}

DistanceFigures distance_of(const ReferenceDistance& distance) { return both_directions(distance); }

}  // namespace

Standing standing(const ComparedMethod& method) {
  if (method.run) return standing(method.name, method.run->report);
  return {method.name, "failed", method.message, {}};
}

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

Table comparison_table(std::span<const ComparedMethod> methods) {
  using Distance = DistanceFigures;
  const auto result = [](auto... figure) {
    return along(&ComparedMethod::run, &RunReport::report, &Report::result, figure...);
  };
  const auto metric = [](auto figure) {
    return along(&ComparedMethod::run, &RunReport::report, &Report::metrics, figure);
  };
  const auto gap = [](auto figure) {
    return along(&ComparedMethod::gap, &MethodGap::surfaces, distance_of, figure);
  };
  const auto vertex = [](auto figure) {
    return along(&ComparedMethod::gap, &MethodGap::same_vertex, figure);
  };
  const auto closed = [](auto figure) {
    return along(&ComparedMethod::run, &RunReport::report, &Report::reference, distance_of, figure);
  };
  return table_of<ComparedMethod>(
      methods, {{text_column("method", "", 16), &ComparedMethod::name},
                {text_column("model"), along(&ComparedMethod::model, method_model_name)},
                {text_column("verdict"), along(&ComparedMethod::verdict, verdict_name)},
                {text_column("shares_with_newton", "shares with newton"), &ComparedMethod::shares},
                {text_column("status", "", 16), result(&Result::status, status_name)},
                {text_column("doubts"),
                 [](const ComparedMethod& method) { return joined_doubts(standing(method).doubts); }},
                {{"residual", "", "", 3}, result(&Result::residual)},
                {{"energy_mj", "energy", "mJ", 8, -1, 12}, result(&Result::energy)},
                {{"iterations", "iterates"}, result(&Result::iterations)},
                {{"gradients"}, result(&Result::evaluations, &EvaluationCounts::gradient)},
                {{"factorisations"}, result(&Result::factorisations)},
                {{"simulated_s"}, result(simulated_s)},
                {{"wall_s", "wall", "s", 3, 2}, result(&Result::wall_s)},
                {{"cpu_s", "CPU", "s", 3, 2}, result(&Result::cpu_s)},
                {{"intersections"}, metric(&Metrics::intersections)},
                {{"mean_to_reference_mm", "mean", "mm", 3}, gap(&Distance::mean)},
                {{"p95_to_reference_mm", "95 %", "mm", 3}, gap(&Distance::p95)},
                {{"max_to_reference_mm", "max", "mm", 3}, gap(&Distance::max)},
                {{"same_vertex_mean_mm", "same vertex mean", "mm", 3}, vertex(&VertexDistance::mean)},
                {{"same_vertex_max_mm", "same vertex max", "mm", 3}, vertex(&VertexDistance::max)},
                {{"mean_to_closed_mm", "closed mean", "mm", 3}, closed(&Distance::mean)},
                {{"p95_to_closed_mm", "closed 95 %", "mm", 3}, closed(&Distance::p95)},
                {{"max_to_closed_mm", "closed max", "mm", 3}, closed(&Distance::max)},
                {{"orifice_area_mm2", "orifice", "mm2", 4, 2}, metric(&Metrics::orifice_area_mm2)},
                {{"leaflet_area_change_mm2", "area +-", "mm2", 4, 2}, metric(area_change)},
                {{"coaptation_area_mm2", "coaptation", "mm2", 4, 2}, metric(&Metrics::coaptation_area_mm2)},
                {{"coaptation_length_mm"}, metric(&Metrics::coaptation_length_mm)},
                {{"coaptation_height_mm", "coaptation height", "mm"}, metric(&Metrics::coaptation_height_mm)},
                {{"tenting_height_mm"}, metric(&Metrics::tenting_height_mm)},
                {{"max_chord_force_n"}, metric(&Metrics::max_chord_force_n)},
                {{"max_principal_strain"}, metric(&Metrics::max_principal_strain)},
                {text_column("message"), &ComparedMethod::message}});
}

void write_comparison(const std::filesystem::path& folder, const Comparison& comparison) {
  write_study(folder, "compare", comparison_as_json(comparison), comparison_table(comparison.methods));
  formats::write_whole(folder / "compare.html", comparison_page(comparison));
}

}  // namespace coapt
