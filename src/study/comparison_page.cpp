// compare.html of a comparison.
#include "formats/json/suggestion.hpp"
#include "report/compared_view.hpp"
#include "report/page_table.hpp"
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

// Mean distance to the reference's shape: of the surfaces, or of the nodes where there are none [mm].
std::optional<double> mean_gap(const ComparedMethod& method) {
  if (method.gap && method.gap->surfaces) return both_directions(*method.gap->surfaces).mean;
  return method.gap ? std::optional(method.gap->same_vertex.mean) : std::nullopt;
}

PageTable distance_table(const Comparison& comparison) {
  std::vector<std::string> columns = {"method", "status", "verdict", "shares_with_newton"};
  columns.insert(columns.end(), {"mean_to_reference_mm", "p95_to_reference_mm", "max_to_reference_mm",
                                 "same_vertex_mean_mm", "same_vertex_max_mm"});
  const bool has_closed = !comparison.closed_surface.empty();
  if (has_closed)
    columns.insert(columns.end(), {"mean_to_closed_mm", "p95_to_closed_mm", "max_to_closed_mm"});
  PageTable table = page_table(chosen(comparison_table(comparison.methods), columns),
                               "Distance of the closed surfaces to that of " + comparison.reference().name);
  for (size_t k = 0; k < table.rows.size(); ++k)
    table.rows[k][1] = status_cell(standing(comparison.methods[k]));
  table.note =
      "In both directions: mean of the means, greater 95th percentile, greater maximum. Same vertex: of each "
      "vertex from itself. Shared with newton: the energy (or the loads alone), the contact, steps by "
      "factorised "
      "Hessians; the verdict of all is by the residual. " +
      (has_closed ? "Closed: to the given surface " + comparison.closed_surface + ". " : "") +
      "One equilibrium: no vertex farther than " + page_number(kSameShape * comparison.extent_mm, 3) +
      " mm from itself.";
  return table;
}

PageList messages(const Comparison& comparison) {
  PageList list;
  for (const ComparedMethod& method : comparison.methods)  // their doubts stand above, in the lead
    list.items.push_back(
        {method.name + ": " + method.message, has_converged(method) ? Tone::Plain : Tone::Bad});
  return list;
}

PageTable figure_table(const Comparison& comparison) {
  return page_table(chosen(comparison_table(comparison.methods),
                           {"method", "orifice_area_mm2", "coaptation_area_mm2", "coaptation_height_mm",
                            "intersections", "residual", "energy_mj", "iterations", "cpu_s", "wall_s"}),
                    "Figures of each result, and what it took");
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

// The history of every method, that of the reference last: it is shown first. None where nothing was
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
  for (ViewField& field : view->fields)  // its distance to itself, so that it is not grey
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
  std::vector<Standing> states;
  for (const ComparedMethod& method : comparison.methods) states.push_back(standing(method));
  lead_with(page, comparison.has_converged() ? "every method converged" : "not every method converged",
            states, comparison.has_converged());
  if (PageList said = warnings(comparison); !said.items.empty())
    page.sections.push_back({"Warnings", {std::move(said)}});
  if (const std::optional<ShapeView> view = shapes(comparison))
    page.sections.push_back({"Closed shapes", {shape_view_html(*view)}});
  page.sections.push_back({"Distances", {messages(comparison), distance_table(comparison)}});
  page.sections.push_back({"Figures", {figure_table(comparison)}});
  page.sections.push_back({"Error and run time", {work_plot(comparison)}});
  add_accounts(comparison, page);
  page.footer = "Residual wanted: " + page_number(comparison.tolerance) +
                (comparison.is_cancelled ? "; cancelled before the last method." : ".");
  return report_page(page);
}

}  // namespace coapt
