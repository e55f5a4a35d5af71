// The files of the studies: JSON and CSV.
#include "scene/detail/study_files.hpp"

#include "mesh/formats/whole_file.hpp"
#include "scene/detail/csv_text.hpp"
#include "scene/detail/json_text.hpp"

#include <cmath>
#include <sstream>

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

OrderedJson number_json(const std::optional<double>& value) {
  return value && std::isfinite(*value) ? OrderedJson(*value) : OrderedJson(nullptr);
}

OrderedJson distances_json(const DistanceFigures& distance) {
  return {{"mean_mm", number_json(distance.mean)},
          {"p95_mm", number_json(distance.p95)},
          {"max_mm", number_json(distance.max)}};
}

void write_study(const std::filesystem::path& folder, const std::string& name, const OrderedJson& json,
                 const std::string& csv) {
  formats::write_whole(folder / (name + ".json"), json_text(json, 2) + "\n");
  formats::write_whole(folder / (name + ".csv"), csv);
}

std::ostringstream csv_begun(const std::string& header) {
  std::ostringstream out;
  out.precision(12);
  out << header << '\n';
  return out;
}

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

void write_region_tuning(const std::filesystem::path& folder, const RegionTuning& tuning) {
  const auto state = [](const TuningState& s) -> OrderedJson {
    return {{"max_chord_strain", number_json(s.max_chord_strain)},
            {"strained_chords", s.strained_chords},
            {"orifice_area_mm2", number_json(s.orifice_area_mm2)}};
  };
  OrderedJson json = {{"scene", tuning.scene_file},
                      {"reached", tuning.is_reached},
                      {"message", tuning.message},
                      {"yield_strain", tuning.yield_strain},
                      {"orifice_limit_mm2", number_json(tuning.orifice_limit_mm2)},
                      {"before", state(tuning.before)},
                      {"after", state(tuning.after)},
                      {"rounds", tuning.rounds},
                      {"solves", tuning.solves},
                      {"failed_solves", tuning.failed_solves},
                      {"wall_s", tuning.wall_s},
                      {"regions", OrderedJson::array()},
                      {"chords", OrderedJson::array()}};
  std::ostringstream csv = csv_begun("name,triangles,factor"),
                     triangles = csv_begun("triangle,region,factor");
  for (const TunedFactor& region : tuning.regions) {
    json["regions"].push_back({{"name", region.name},
                               {"triangles", region.triangles},
                               {"tuned", region.is_tuned},
                               {"factor", region.factor}});
    csv << csv_text(region.name) << ',' << region.triangles << ',' << region.factor << '\n';
  }
  for (const TunedFactor& chord : tuning.chords) {
    json["chords"].push_back({{"name", chord.name}, {"area_scale", chord.factor}});
    csv << csv_text(chord.name) << ",," << chord.factor << '\n';
  }
  for (size_t t = 0; t < tuning.region_of_triangle.size(); ++t) {
    const TunedFactor& region = tuning.regions[static_cast<size_t>(tuning.region_of_triangle[t])];
    triangles << t << ',' << csv_text(region.name) << ',' << region.factor << '\n';
  }
  write_study(folder, "region_tuning", json, csv.str());
  formats::write_whole(folder / "triangle_factors.csv", triangles.str());
}

}  // namespace coapt
