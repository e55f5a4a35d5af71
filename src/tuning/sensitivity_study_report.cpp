// sensitivity.json and sensitivity.csv.
#include "formats/csv_table.hpp"
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
  json["distance_to_reference"] = run.to_reference ? distances_json(*run.to_reference) : OrderedJson(nullptr);
  return json;
}

// A solve; the columns of what follows from both signs are the parameter's.
void add_run(std::ostream& out, const std::string& name, const SensitivityRun& run) {
  out << csv_text(name) << ',' << run.factor << ',' << status_name(run.status) << ',' << run.residual << ','
      << run.iterations << ',' << run.wall_s << ',' << run.to_base.mean << ',' << run.to_base.p95 << ','
      << run.to_base.max << ',';
  if (run.to_reference) out << run.to_reference->mean;
}

void add_sensitivity(std::ostream& out, const ParameterSensitivity& found) {
  out << ',';
  if (found.movement) out << *found.movement;
  out << ',';
  if (found.error_change) out << *found.error_change;
  out << '\n';
}

void add_rows(std::ostream& out, const ParameterSensitivity& found) {
  if (found.runs.empty()) {
    out << csv_text(found.name) << ",,derivative,,," << found.wall_s << ",,,,";
    add_sensitivity(out, found);
  }
  for (const SensitivityRun& run : found.runs) {
    add_run(out, found.name, run);
    add_sensitivity(out, found);
  }
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
                      {"left_out", study.left_out},
                      {"wall_s", number_json(study.wall_s)},
                      {"first", run_json(study.base)},
                      {"parameters", OrderedJson::array()}};
  std::ostringstream csv = csv_with_header(
      "parameter,factor,status,residual,iterations,wall_s,mean_to_base_mm,p95_to_base_mm,max_to_base_mm,"
      "mean_to_reference_mm,movement_mm_per_100_percent,error_change_mm_per_100_percent");
  add_run(csv, "", study.base);
  csv << ",,\n";
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
    add_rows(csv, parameter);
  }
  write_study(folder, "sensitivity", json, csv.str());
}

}  // namespace coapt
