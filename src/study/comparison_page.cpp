// report.html of a comparison.
#include "formats/json/suggestion.hpp"
#include "report/compared_view.hpp"
#include "report/solve_page.hpp"
#include "results/result_warnings.hpp"
#include "study/comparison_report.hpp"

#include <algorithm>
#include <map>

namespace coapt {
namespace {

bool has_converged(const ComparedMethod& method) {
  return method.run && method.run->report.result.status == Status::Converged;
}

std::optional<DistanceFigures> to_reference(const ComparedMethod& method) {
  if (!method.gap || !method.gap->surfaces) return std::nullopt;
  return both_directions(*method.gap->surfaces);
}

std::optional<DistanceFigures> to_closed(const ComparedMethod& method) {
  if (!method.run || !method.run->report.reference) return std::nullopt;
  return both_directions(*method.run->report.reference);
}

// Mean distance to the reference's shape: of the surfaces, or of the nodes where there are none [mm].
std::optional<double> mean_gap(const ComparedMethod& method) {
  if (const auto surfaces = to_reference(method)) return surfaces->mean;
  return method.gap ? std::optional(method.gap->same_vertex.mean) : std::nullopt;
}

PageCell number_cell(const std::optional<double>& value, int digits = 3) {
  return {value ? page_number(*value, digits) : "–"};
}

void add_cells(const std::optional<DistanceFigures>& figures, std::vector<PageCell>& row) {
  for (const auto figure : {&DistanceFigures::mean, &DistanceFigures::p95, &DistanceFigures::max})
    row.push_back(number_cell(figures ? std::optional((*figures).*figure) : std::nullopt));
}

PageTable distance_table(const Comparison& comparison) {
  PageTable table{
      .caption = "Distance of the closed surfaces to that of " + comparison.reference().name + " [mm]",
      .columns = {{"method", true}, {"status", true}, {"verdict", true}, {"mean"}, {"95 %"}, {"greatest"}}};
  table.columns.insert(table.columns.end(), {{"same vertex, mean"}, {"same vertex, greatest"}});
  const bool has_closed = !comparison.closed_surface.empty();
  if (has_closed)
    for (const char* figure : {"mean", "95 %", "greatest"})
      table.columns.push_back({"to " + comparison.closed_surface + ", " + figure});
  for (const ComparedMethod& method : comparison.methods) {
    std::string status =
        method.run ? std::string(status_name(method.run->report.result.status)) : std::string("failed");
    std::replace(status.begin(), status.end(), '_', ' ');
    std::vector<PageCell> row = {{method.name},
                                 {status, has_converged(method) ? Tone::Good : Tone::Bad},
                                 {std::string(verdict_name(method.verdict))}};
    add_cells(to_reference(method), row);
    row.push_back(number_cell(method.gap ? std::optional(method.gap->same_vertex.mean) : std::nullopt));
    row.push_back(number_cell(method.gap ? std::optional(method.gap->same_vertex.max) : std::nullopt));
    if (has_closed) add_cells(to_closed(method), row);
    table.rows.push_back(row);
  }
  table.note =
      "In both directions: mean of the means, greater 95th percentile, greater maximum. Same vertex: of each "
      "vertex from itself. One equilibrium: no vertex farther than " +
      page_number(kSameShape * comparison.extent_mm, 3) + " mm from itself.";
  return table;
}

PageList messages(const Comparison& comparison) {
  PageList list;
  for (const ComparedMethod& method : comparison.methods)
    list.items.push_back(
        {method.name + ": " + method.message, has_converged(method) ? Tone::Plain : Tone::Bad});
  return list;
}

PageTable figure_table(const Comparison& comparison) {
  PageTable table{.caption = "Figures of each result, and what it took",
                  .columns = {{"method", true}, {"orifice [mm²]"}, {"coaptation area [mm²]"}}};
  for (const char* title : {"coaptation height [mm]", "intersections", "residual", "energy [mJ]", "iterates",
                            "CPU time [s]", "wall time [s]"})
    table.columns.push_back({title});
  for (const ComparedMethod& method : comparison.methods) {
    std::vector<PageCell> row = {{method.name}};
    if (method.run) {
      const Metrics& metrics = method.run->report.metrics;
      const Result& result = method.run->report.result;
      for (const auto& value :
           {metrics.orifice_area_mm2, metrics.coaptation_area_mm2, metrics.coaptation_height_mm})
        row.push_back(number_cell(value, 4));
      row.push_back({std::to_string(metrics.intersections)});
      row.push_back(number_cell(result.residual));
      row.push_back(number_cell(result.energy, 8));
      row.push_back({std::to_string(result.iterations)});
      row.push_back(number_cell(result.cpu_s));
      row.push_back(number_cell(result.wall_s));
    }
    table.rows.push_back(row);
  }
  return table;
}

PagePlot work_plot(const Comparison& comparison) {
  PagePlot plot{.title = "Distance to " + comparison.reference().name + " against run time",
                .x = {"CPU time of the solve [s]", Scale::ByRange},
                .y = {"mean distance [mm]", Scale::ByRange}};
  for (const ComparedMethod& method : comparison.methods)
    if (const auto gap = mean_gap(method))
      plot.series.push_back({.name = method.name,
                             .points = {{method.run->report.result.cpu_s, *gap, !has_converged(method)}},
                             .is_joined = false});
  plot.note =
      comparison.reference().name + " itself took " +
      (comparison.reference().run ? page_number(comparison.reference().run->report.result.cpu_s, 3) + " s."
                                  : "no time that means anything: it failed.");
  return plot;
}

// Each once, with the names of the methods where not all of them say it.
PageList warnings(const Comparison& comparison) {
  std::vector<std::string> texts;
  std::map<std::string, std::vector<std::string>> names;
  size_t solved = 0;
  for (const ComparedMethod& method : comparison.methods) {
    if (!method.run) continue;
    ++solved;
    for (const std::string& text : result_warnings(method.run->report)) {
      std::vector<std::string>& those = names[text];
      if (those.empty()) texts.push_back(text);
      if (those.empty() || those.back() != method.name) those.push_back(method.name);
    }
  }
  PageList list;
  for (const std::string& text : texts)
    list.items.push_back(
        {"Warning" + (names[text].size() < solved ? " (" + listed(names[text]) + ")" : "") + ": " + text,
         Tone::Caution});
  return list;
}

// The way of every method to its shape, that of the reference last: it is shown first. None where nothing was
// solved.
std::optional<ShapeView> shapes(const Comparison& comparison) {
  std::vector<ComparedShape> all;
  for (const ComparedMethod& method : comparison.methods)
    if (method.run)
      all.push_back({method.name + ": " + std::string(verdict_name(method.verdict)), &method.run->model,
                     &method.run->report, true});
  if (all.empty()) return std::nullopt;
  const std::optional<RunReport>& reference = comparison.reference().run;
  if (reference) std::rotate(all.begin(), all.begin() + 1, all.end());
  const Model& base = *all.back().model;
  std::optional<ShapeView> view =
      compared_view(all, all.size() - 1, "comparison", annulus_of(base) ? "Open ↔ closed" : "Start ↔ result");
  const auto is_distance = [](const ViewField& field) { return field.title.starts_with("Distance"); };
  std::stable_partition(view->fields.begin(), view->fields.end(), is_distance);
  for (ViewField& field : view->fields)  // its distance to itself, so that the view does not open in grey
    if (reference && field.title == kMethodDistance) field.values.back().setZero(base.mesh.vertex_count());
  return view;
}

// How each method went, and what was solved: the scene, by which version, and where every method ended.
void add_accounts(const Comparison& comparison, Page& page) {
  std::vector<NamedReport> reports;
  PageTable ends{.caption = "Certificates", .columns = {{"method", true}, {"certificate", true}}};
  for (const ComparedMethod& method : comparison.methods) {
    if (!method.run) continue;
    const Report& report = method.run->report;
    ends.rows.push_back({{method.name}, {summary(report.result.certificate)}});
    if (!report.result.trace.empty()) reports.push_back({method.name, &report});
  }
  if (!reports.empty())
    page.sections.push_back({"Convergence", {residual_plot(reports, false), residual_plot(reports, true)}});
  if (ends.rows.empty()) return;
  const auto solved = std::find_if(comparison.methods.begin(), comparison.methods.end(),
                                   [](const ComparedMethod& method) { return method.run.has_value(); });
  PageSection account = what_was_solved(solved->run->model, solved->run->report);
  account.title += ", by " + solved->name;
  account.blocks.emplace_back(std::move(ends));
  page.sections.push_back(std::move(account));
}

}  // namespace

std::string comparison_page(const Comparison& comparison) {
  Page page{.title = "Comparison of methods on " + comparison.scene_title};
  page.lead = comparison.has_converged() ? "every method converged" : "not every method converged";
  page.tone = comparison.has_converged() ? Tone::Good : Tone::Bad;
  if (PageList said = warnings(comparison); !said.items.empty())
    page.sections.push_back({"Warnings", {std::move(said)}});
  page.sections.push_back({"Distances", {messages(comparison), distance_table(comparison)}});
  if (const std::optional<ShapeView> view = shapes(comparison))
    page.sections.push_back({"Closed shapes", {shape_view_html(*view)}});
  page.sections.push_back({"Figures", {figure_table(comparison)}});
  page.sections.push_back({"Error and run time", {work_plot(comparison)}});
  add_accounts(comparison, page);
  page.footer = "Residual wanted: " + page_number(comparison.tolerance) +
                (comparison.is_cancelled ? "; cancelled before the last method." : ".");
  return report_page(page);
}

}  // namespace coapt
