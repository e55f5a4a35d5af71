// sensitivity.json and sensitivity.csv.
#include "results/study_files.hpp"
#include "tuning/sensitivity_study.hpp"

namespace coapt {
namespace {

OrderedJson run_json(const SensitivityRun& run) {
  OrderedJson json = {{"factor", run.factor},
                      {"status", std::string(status_name(run.status))},
                      {"residual", number_json(run.residual)},
                      {"iterations", run.iterations},
                      {"wall_s", number_json(run.wall_s)},
                      {"distance_to_base", distances_json(run.to_base)}};
  json["distance_to_reference"] = distances_json(run.to_reference);
  return json;
}

// A line of sensitivity.csv: a solve, of a parameter but for the first, or the derivative by a parameter.
struct SensitivityRow {
  const SensitivityRun* run = nullptr;
  const ParameterSensitivity* parameter = nullptr;
};

Table sensitivity_table(const SensitivityStudy& study) {
  std::vector<SensitivityRow> rows = {{&study.base}};
  for (const ParameterSensitivity& parameter : study.parameters) {
    if (parameter.runs.empty()) rows.push_back({nullptr, &parameter});
    for (const SensitivityRun& run : parameter.runs) rows.push_back({&run, &parameter});
  }
  const auto status = [](const SensitivityRow& row) {
    return row.run != nullptr ? status_name(row.run->status) : "derivative";
  };
  const auto wall_s = [](const SensitivityRow& row) {
    return row.run != nullptr ? row.run->wall_s : row.parameter->wall_s;
  };
  const auto run = [](auto... figure) { return along(&SensitivityRow::run, figure...); };
  const auto parameter = [](auto figure) { return along(&SensitivityRow::parameter, figure); };
  using Run = SensitivityRun;
  using Distance = DistanceFigures;
  return table_of<SensitivityRow>(
      rows, {{text_column("parameter"), parameter(&ParameterSensitivity::name)},
             {{"factor"}, run(&Run::factor)},
             {text_column("status"), status},
             {{"residual"}, run(&Run::residual)},
             {{"iterations"}, run(&Run::iterations)},
             {{"wall_s"}, wall_s},
             {{"mean_to_base_mm"}, run(&Run::to_base, &Distance::mean)},
             {{"p95_to_base_mm"}, run(&Run::to_base, &Distance::p95)},
             {{"max_to_base_mm"}, run(&Run::to_base, &Distance::max)},
             {{"mean_to_reference_mm"}, run(&Run::to_reference, &Distance::mean)},
             {{"movement_mm_per_100_percent"}, parameter(&ParameterSensitivity::movement)},
             {{"error_change_mm_per_100_percent"}, parameter(&ParameterSensitivity::error_change)}});
}

}  // namespace

void write_sensitivity(const std::filesystem::path& folder, const SensitivityStudy& study) {
  OrderedJson json = {{"scene", study.scene_file},
                      {"solver", study.solver},
                      {"tolerance", study.tolerance},
                      {"perturbation", number_json(study.perturbation)},
                      {"start", study.starts_anew ? "own" : "first solution"},
                      {"converged", study.has_converged()},
                      {"cancelled", study.is_cancelled},
                      {"doubts", study.doubts},
                      {"left_out", study.left_out},
                      {"wall_s", number_json(study.wall_s)},
                      {"first", run_json(study.base)},
                      {"parameters", OrderedJson::array()}};
  for (const ParameterSensitivity& parameter : study.parameters) {
    OrderedJson runs = OrderedJson::array();
    for (const SensitivityRun& run : parameter.runs) runs.push_back(run_json(run));
    json["parameters"].push_back({{"name", parameter.name},
                                  {"value", number_json(parameter.value)},
                                  {"unit", parameter.unit},
                                  {"movement_mm_per_100_percent", number_json(parameter.movement)},
                                  {"error_change_mm_per_100_percent", number_json(parameter.error_change)},
                                  {"by", parameter.runs.empty() ? "derivative" : "solves"},
                                  {"message", parameter.message},
                                  {"wall_s", number_json(parameter.wall_s)},
                                  {"runs", std::move(runs)}});
  }
  write_study(folder, "sensitivity", json, sensitivity_table(study));
}

}  // namespace coapt
