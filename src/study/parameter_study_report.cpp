#include "core/components.hpp"
#include "formats/json/json_text.hpp"
#include "formats/text.hpp"
#include "formats/whole_file.hpp"
#include "report/metric_words.hpp"
#include "report/page_table.hpp"
#include "results/study_files.hpp"
#include "study/parameter_study.hpp"

#include <algorithm>
#include <cctype>
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
                         {"doubts", result.doubts},
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

std::vector<Standing> standings(const ParameterStudy& study) {
  std::vector<Standing> all;
  for (const PointResult& result : study.results) all.push_back(standing(result));
  return all;
}

std::vector<std::string> shown_metrics(const ParameterStudy& study) {
  std::vector<std::string> names{study.metric};
  for (const char* name : kShown)
    if (name != study.metric) names.emplace_back(name);
  return names;
}

MetricRow row_of(const std::string& metric) {
  for (const MetricRow& row : metric_rows(Metrics()))
    if (row.name == metric) return row;
  return {metric, "", "", false, std::nullopt};
}

PageTable page_points(const ParameterStudy& study) {
  std::vector<std::string> columns{"rank"};
  for (const Sweep& sweep : study.sweeps) columns.push_back(sweep.path);
  columns.emplace_back("status");
  const std::vector<std::string> metrics = shown_metrics(study);
  columns.insert(columns.end(), metrics.begin(), metrics.end());
  PageTable table =
      page_table(chosen(point_table(study), columns), "Points, the best first",
                 "Ranked by " + metric_in_words(row_of(study.metric)) + ", the " +
                     (study.is_greatest_best ? "greatest" : "least") +
                     " first. All figures stand in study.csv, and each point's own page in its folder.");
  for (size_t k = 0; k < metrics.size(); ++k)
    table.columns[columns.size() - metrics.size() + k].title = metric_title(row_of(metrics[k]));
  const std::vector<size_t> order = ranked(study);
  for (size_t k = 0; k < order.size(); ++k)
    table.rows[k][1 + study.sweeps.size()] = status_cell(standing(study.results[order[k]]));
  return table;
}

// Where the values of a sweep stand on an axis: numbers of one unit where they belong, others side by side.
struct SweptAxis {
  PageAxis axis;
  std::vector<double> places;  // of each value
};

SweptAxis swept_axis(const Sweep& sweep) {
  SweptAxis swept{{sweep.path, Scale::ByRange}, {}};
  std::string unit;
  bool is_even = true;
  for (const std::string& value : sweep.values) {
    char* end = nullptr;
    swept.places.push_back(std::strtod(value.c_str(), &end));
    const std::string rest(formats::trimmed(end));
    is_even = is_even && end != value.c_str() && (swept.places.size() == 1 || rest == unit);
    unit = rest;
  }
  if (is_even) {
    if (!unit.empty()) swept.axis.title += " [" + unit_sign(unit) + "]";
    return swept;
  }
  swept.axis.names = sweep.values;
  for (size_t k = 0; k < swept.places.size(); ++k) swept.places[k] = static_cast<double>(k + 1);
  return swept;
}

// The metric along the last sweep, one line for each combination of the others.
PagePlot metric_plot(const ParameterStudy& study, const std::string& metric) {
  const MetricRow row = row_of(metric);
  const Sweep& sweep = study.sweeps.back();
  const SweptAxis swept = swept_axis(sweep);
  PagePlot plot{
      .title = metric_in_words(row) + " against " + sweep.path, .x = swept.axis, .y = {metric_title(row)}};
  plot.title[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(plot.title[0])));
  for (const PointResult& result : study.results) {
    std::string name;
    for (size_t k = 0; k + 1 < study.sweeps.size(); ++k)
      name += (k == 0 ? "" : ", ") + study.sweeps[k].path + " = " + result.values[k];
    if (name.empty()) name = metric_in_words(row);
    if (plot.series.empty() || plot.series.back().name != name)
      plot.series.push_back({.name = name, .is_joined = swept.axis.names.empty()});
    const auto at = std::find(sweep.values.begin(), sweep.values.end(), result.values.back());
    if (const std::optional<double> value = result.metric(metric); value && at != sweep.values.end())
      plot.series.back().points.push_back(
          {swept.places[static_cast<size_t>(at - sweep.values.begin())], *value, !result.has_converged()});
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
  columns.push_back({text_column("doubts"),
                     of_result([](const PointResult& result) { return joined_doubts(result.doubts); })});
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
  lead_with(page,
            std::to_string(study.results.size()) + " of " + std::to_string(study.point_count) + " points" +
                (study.has_converged() ? ", all converged" : "; not every point converged"),
            standings(study), study.has_converged());
  if (study.shapes) page.sections.push_back({"Shapes", {shape_view_html(*study.shapes)}});
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
  formats::write_whole(folder / "study.html", parameter_study_page(study));
}

}  // namespace coapt
