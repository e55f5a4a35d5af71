// sensitivity.json and sensitivity.csv.
#include "formats/json/csv_text.hpp"
#include "results/study_files.hpp"
#include "study/sensitivity.hpp"

namespace coapt {
namespace {

OrderedJson run_json(const SensitivityRun& run) {
  OrderedJson json = {{"factor", run.factor},
                      {"status", std::string(status_name(run.status))},
                      {"residual", number_json(run.residual)},
                      {"iterations", run.iterations},
                      {"wall_s", number_json(run.wall_s)},
                      {"distance_to_base", distances_json(run.to_base)}};
  json["distance_to_reference"] = run.to_reference ? distances_json(*run.to_reference) : OrderedJson(nullptr);
  return json;
}

void add_row(std::ostream& out, const std::string& name, const SensitivityRun& run) {
  out << csv_text(name) << ',' << run.factor << ',' << status_name(run.status) << ',' << run.residual << ','
      << run.iterations << ',' << run.wall_s << ',' << run.to_base.mean << ',' << run.to_base.p95 << ','
      << run.to_base.max << ',';
  if (run.to_reference) out << run.to_reference->mean;
  out << '\n';
}

}  // namespace

void write_sensitivity(const std::filesystem::path& folder, const SensitivityStudy& study) {
  OrderedJson json = {{"scene", study.scene_file},
                      {"solver", study.solver},
                      {"tolerance", study.tolerance},
                      {"perturbation", study.perturbation},
                      {"start", study.starts_anew ? "own" : "first solution"},
                      {"converged", study.has_converged()},
                      {"cancelled", study.is_cancelled},
                      {"left_out", study.left_out},
                      {"wall_s", number_json(study.wall_s)},
                      {"first", run_json(study.base)},
                      {"parameters", OrderedJson::array()}};
  std::ostringstream csv = csv_begun(
      "parameter,factor,status,residual,iterations,wall_s,mean_to_base_mm,p95_to_base_mm,max_to_base_mm,"
      "mean_to_reference_mm");
  add_row(csv, "", study.base);
  for (const ParameterSensitivity& parameter : study.parameters) {
    json["parameters"].push_back({{"name", parameter.name},
                                  {"value", number_json(parameter.value)},
                                  {"unit", parameter.unit},
                                  {"movement_mm_per_100_percent", number_json(parameter.movement)},
                                  {"error_change_mm_per_100_percent", number_json(parameter.error_change)},
                                  {"runs", {run_json(parameter.smaller), run_json(parameter.larger)}}});
    add_row(csv, parameter.name, parameter.smaller);
    add_row(csv, parameter.name, parameter.larger);
  }
  write_study(folder, "sensitivity", json, csv.str());
}

}  // namespace coapt
