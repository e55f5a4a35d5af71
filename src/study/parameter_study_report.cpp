#include "core/components.hpp"
#include "formats/json/json_text.hpp"
#include "formats/whole_file.hpp"
#include "report/page_table.hpp"
#include "results/study_files.hpp"
#include "study/parameter_study.hpp"

#include <algorithm>
#include <cstdlib>

namespace coapt {
namespace {

constexpr const char* kShown[] = {"orifice_area_mm2",     "regurgitant_area_mm2", "coaptation_area_mm2",
                                  "coaptation_length_mm", "coaptation_height_mm", "tenting_height_mm",
                                  "prolapse_height_mm",   "max_chord_force_n",    "max_principal_strain"};

OrderedJson as_json(const ParameterStudy& study) {
  OrderedJson json = {{"version", version()},
                      {"scene", study.scene_file},
                      {"metric", study.metric},
                      {"best", study.is_greatest_best ? "greatest" : "least"},
                      {"point_count", study.point_count},
                      {"finished", study.results.size()},
                      {"converged", study.has_converged()},
                      {"sweeps", OrderedJson::array()},
                      {"points", OrderedJson::array()}};
  for (const Sweep& sweep : study.sweeps)
    json["sweeps"].push_back({{"key", sweep.path}, {"values", sweep.values}});
  int rank = 0;
  for (const size_t place : ranked(study)) {
    const PointResult& result = study.results[place];
    OrderedJson point = {{"rank", ++rank},
                         {"number", result.number},
                         {"folder", point_folder({}, result.number).string()},
                         {"values", OrderedJson::object()},
                         {"status", result.status},
                         {"message", result.message},
                         {"residual", number_json(result.residual)},
                         {"iterations", result.iterations},
                         {"wall_s", number_json(result.wall_s)},
                         {"metrics", OrderedJson::object()}};
    for (size_t k = 0; k < study.sweeps.size(); ++k) point["values"][study.sweeps[k].path] = result.values[k];
    for (const auto& [name, value] : result.metrics) point["metrics"][name] = number_json(value);
    json["points"].push_back(std::move(point));
  }
  return json;
}

std::vector<std::string> shown_metrics(const ParameterStudy& study) {
  std::vector<std::string> names{study.metric};
  for (const char* name : kShown)
    if (name != study.metric) names.emplace_back(name);
  return names;
}

PageTable page_points(const ParameterStudy& study) {
  std::vector<std::string> columns{"rank"};
  for (const Sweep& sweep : study.sweeps) columns.push_back(sweep.path);
  columns.emplace_back("status");
  for (const std::string& name : shown_metrics(study)) columns.push_back(name);
  PageTable table =
      page_table(chosen(point_table(study), columns), "Points, the best first",
                 "Ranked by " + study.metric + ", the " + (study.is_greatest_best ? "greatest" : "least") +
                     " first. All figures stand in study.csv, and each point's own page in its folder.");
  const std::vector<size_t> order = ranked(study);
  for (size_t k = 0; k < order.size(); ++k) {
    const PointResult& result = study.results[order[k]];
    PageCell& status = table.rows[k][1 + study.sweeps.size()];
    status.tone = result.has_converged() ? Tone::Good : Tone::Bad;
    if (!result.has_converged()) status.remark = result.message;
  }
  return table;
}

// The metric along the last sweep, one line for each combination of the others.
PagePlot metric_plot(const ParameterStudy& study, const std::string& metric) {
  PagePlot plot{.title = metric + " against " + study.sweeps.back().path,
                .x = {study.sweeps.back().path},
                .y = {metric}};
  for (const PointResult& result : study.results) {
    std::string name;
    for (size_t k = 0; k + 1 < study.sweeps.size(); ++k)
      name += (k == 0 ? "" : ", ") + study.sweeps[k].path + " = " + result.values[k];
    if (name.empty()) name = metric;
    if (plot.series.empty() || plot.series.back().name != name) plot.series.push_back({.name = name});
    if (const std::optional<double> value = result.metric(metric))
      plot.series.back().points.push_back(
          {std::strtod(result.values.back().c_str(), nullptr), *value, !result.has_converged()});
  }
  return plot;
}

}  // namespace

Table point_table(const ParameterStudy& study) {
  struct RankedPoint {
    size_t rank;
    const PointResult* result;
  };
  std::vector<RankedPoint> points;
  for (const size_t place : ranked(study)) points.push_back({points.size() + 1, &study.results[place]});
  const auto of_result = [](auto figure) { return along(&RankedPoint::result, figure); };
  std::vector<ColumnOf<RankedPoint>> columns{{{"rank"}, &RankedPoint::rank},
                                             {{"number"}, of_result(&PointResult::number)}};
  for (size_t k = 0; k < study.sweeps.size(); ++k)
    columns.push_back({text_column(study.sweeps[k].path),
                       of_result([k](const PointResult& result) { return result.values[k]; })});
  columns.push_back({text_column("status"), of_result(&PointResult::status)});
  columns.push_back({{"residual"}, of_result(&PointResult::residual)});
  columns.push_back({{"iterations"}, of_result(&PointResult::iterations)});
  columns.push_back({{"wall_s"}, of_result(&PointResult::wall_s)});
  for (const MetricRow& metric : metric_rows(Metrics()))
    columns.push_back({{metric.name}, of_result([name = metric.name](const PointResult& result) {
                         return result.metric(name);
                       })});
  return table_of<RankedPoint>(points, columns);
}

std::string parameter_study_json(const ParameterStudy& study) { return json_text(as_json(study), 2) + "\n"; }

std::string parameter_study_page(const ParameterStudy& study) {
  Page page{.title = "Study of " + study.scene_title};
  page.lead = std::to_string(study.results.size()) + " of " + std::to_string(study.point_count) + " points" +
              (study.has_converged() ? ", all converged" : "; not every point converged");
  page.tone = study.has_converged() ? Tone::Good : Tone::Bad;
  page.sections.push_back({"Points", {page_points(study)}});
  PageSection plots{"Figures", {}};
  for (const std::string& name : shown_metrics(study)) {
    const bool has_values = std::any_of(study.results.begin(), study.results.end(),
                                        [&](const PointResult& r) { return r.metric(name).has_value(); });
    if (has_values && plots.blocks.size() < 4) plots.blocks.emplace_back(metric_plot(study, name));
  }
  page.sections.push_back(std::move(plots));
  return report_page(page);
}

void write_parameter_study(const std::filesystem::path& folder, const ParameterStudy& study) {
  write_study(folder, "study", as_json(study), point_table(study));
  formats::write_whole(folder / "report.html", parameter_study_page(study));
}

}  // namespace coapt
