#include "report/solve_page.hpp"

#include "core/components.hpp"
#include "core/number_text.hpp"
#include "core/timing.hpp"
#include "formats/xml_escaped.hpp"
#include "report/metric_words.hpp"
#include "report/page_picture.hpp"
#include "report/page_table.hpp"
#include "report/solve_view.hpp"
#include "results/result_warnings.hpp"

#include <algorithm>

namespace coapt {
namespace {

constexpr size_t kMostShapes = 12;
constexpr size_t kShapeBytes = 2'000'000;  // of all shapes in the page; a node takes 16 in each

// The criterion of a healthy closure that judges a figure; null where none does.
const HealthyCriterion* criterion_of(const Report& report, const std::string& metric) {
  for (const HealthyCriterion& criterion : report.metrics.healthy_closure)
    if (criterion.name == metric) return &criterion;
  return nullptr;
}

// A figure that sliders may change, with its healthy range where it has one.
std::string tile(const std::string& name, double value, const std::string& unit,
                 const HealthyCriterion* healthy = nullptr) {
  std::string html = "<div data-figure=\"" + formats::xml_escaped(name) + "\" data-exact=\"" +
                     number_text(value, 9) + "\"><dt>" + formats::xml_escaped(name) +
                     "</dt><dd><span data-value>" + page_number(value) + "</span> <small>" + unit +
                     "</small></dd>";
  if (healthy != nullptr)
    html += std::string("<dd class=\"range ") + (healthy->is_met() ? "good" : "caution") + "\">" +
            (healthy->is_met() ? "healthy: " : "not in the healthy range: ") + range_in_words(*healthy) +
            "</dd>";
  return html + "</div>\n";
}

// The figures that a user looks at first.
PageMarkup tiles(const Report& report) {
  std::string html;
  const std::vector<MetricRow> rows = metric_rows(report.metrics);
  for (const MetricRow& row : rows)
    for (const char* name :
         {"orifice_area_mm2", "coaptation_area_mm2", "coaptation_height_mm", "tenting_height_mm",
          "max_principal_strain", "p95_principal_strain", "p99_principal_strain", "max_cauchy_stress_kpa",
          "max_chord_force_n", "max_chord_stress_kpa", "max_displacement_mm"})
      if (row.name == name && row.value)
        html += tile(metric_in_words(row), *row.value, unit_sign(row.unit), criterion_of(report, name));
  for (const HealthyCriterion& criterion : report.metrics.healthy_closure)  // those that are no metric
    if (std::none_of(rows.begin(), rows.end(),
                     [&](const MetricRow& row) { return row.name == criterion.name; }))
      html += tile(metric_in_words({criterion.name, criterion.unit, "", false, {}}), criterion.value,
                   unit_sign(criterion.unit), &criterion);
  if (report.reference)
    html += tile("mean distance to reference", both_directions(*report.reference).mean, "mm");
  return {"<dl class=\"tiles\">\n" + html + tile("residual", report.result.residual, "") + "</dl>\n"};
}

PageList warning_list(const Report& report) {
  PageList list;
  for (const std::string& warning : result_warnings(report))
    list.items.push_back({"Warning: " + warning, Tone::Caution});
  return list;
}

// A figure, with its range over other equilibria in small print.
PageCell value_cell(double value, const BranchRange* others) {
  PageCell cell{page_number(value, 6)};
  if (others != nullptr)
    cell.remark =
        "other equilibria: " + page_number(others->lowest, 6) + " to " + page_number(others->highest, 6);
  return cell;
}

PageTable metric_table(const Report& report) {
  PageTable table{.caption = "All figures of the result",
                  .columns = {{"figure", true}, {"value"}, {"unit", true}, {"meaning", true}}};
  const std::string coaptation = coaptation_remark(report.metrics);
  for (const MetricRow& row : metric_rows(report.metrics)) {
    const bool is_unresolved = row.name == "coaptation_area_mm2" && !coaptation.empty();
    if (!row.value && !is_unresolved) continue;
    PageCell cell = row.value ? value_cell(*row.value, range_of(report.branches, row.name)) : PageCell{"-"};
    if (is_unresolved) cell.remark = coaptation + (cell.remark.empty() ? "" : "; " + cell.remark);
    table.rows.push_back({{metric_in_words(row)}, cell, {unit_sign(row.unit)}, {row.meaning}});
  }
  table.note = "Intersections were counted by: " + report.metrics.intersection_checker +
               ". Figures that the scene does not define are left out.";
  return table;
}

PageTable criteria_table(const std::vector<HealthyCriterion>& criteria) {
  PageTable table{.caption = "A healthy closure of a mitral valve",
                  .columns = {{"figure", true},
                              {"value"},
                              {"unit", true},
                              {"healthy", true},
                              {"in range", true},
                              {"meaning", true},
                              {"source", true}}};
  for (const HealthyCriterion& criterion : criteria) {
    const bool is_met = criterion.is_met();
    table.rows.push_back({{metric_in_words({criterion.name, criterion.unit, "", false, {}})},
                          {page_number(criterion.value, 3)},
                          {criterion.unit},
                          {range_in_words(criterion)},
                          {is_met ? "yes" : "no", is_met ? Tone::Good : Tone::Caution},
                          {criterion.meaning},
                          {criterion.source}});
  }
  return table;
}

PageTable leaflet_table(const std::vector<LeafletMetrics>& leaflets) {
  Table table{.columns = {text_column("figure")}};
  for (const MetricRow& row : leaflet_rows(leaflets.front())) table.rows.push_back({metric_title(row)});
  for (const LeafletMetrics& leaflet : leaflets) {
    table.columns.push_back({leaflet.name, "", "", 5});
    const std::vector<MetricRow> rows = leaflet_rows(leaflet);
    for (size_t r = 0; r < rows.size(); ++r) table.rows[r].emplace_back(rows[r].value);
  }
  return page_table(table, "Leaflet by leaflet");
}

PageTable orifice_table(const std::vector<Orifice>& orifices) {
  Table table{.columns = {text_column("orifice"),
                          {"area", "", "mm2"},
                          {"regurgitant area", "", "mm2"},
                          {"perimeter", "", "mm"}}};
  for (const Orifice& orifice : orifices)
    table.rows.push_back({table.rows.size() + 1, orifice.outline.area, orifice.regurgitant_area_mm2,
                          orifice.outline.perimeter});
  return page_table(table, "Open places seen from the atrium; a negative area is a covered island in one");
}

PageTable distance_table(const ReferenceDistance& distance) {
  Table table{.columns = {text_column("direction"), {"mean"}, {"95 %"}, {"greatest"}}};
  std::string caption = "Distance to the given closed surface [mm]";
  const auto add = [&table](const char* name, const DistanceFigures& figures) {
    table.rows.push_back({name, figures.mean, figures.p95, figures.max});
  };
  add("from the result to it", distance.to_reference);
  add("from it to the result", distance.from_reference);
  if (const auto& vertex = distance.same_vertex)
    table.rows.push_back({"each vertex from itself", vertex->mean, "", vertex->max});
  if (const auto& lines = distance.lines) {
    add("from its coaptation line to that one's", lines->there);
    add("from that coaptation line to its own", lines->back);
  }
  if (const auto& registration = distance.registration) {
    add("before its registration, from the result", registration->to_reference_before);
    add("before its registration, from it", registration->from_reference_before);
    const Registration& found = registration->found;
    caption += std::string("; registered by ") + registration_method_name(found.method) + ": turned by " +
               page_number(found.motion.angle_deg()) + "°, moved by " +
               page_number(registration->translation_mm) + " mm, scale " + page_number(found.motion.scale) +
               ", overlap " + page_number(found.overlap);
  }
  if (distance.left_out > 0)
    caption += "; nodes that can move at no cost, left out: " + std::to_string(distance.left_out);
  return page_table(table, caption);
}

PageSection figures(const Report& report) {
  PageSection section{"Figures", {metric_table(report)}};
  if (!report.metrics.healthy_closure.empty())
    section.blocks.emplace_back(criteria_table(report.metrics.healthy_closure));
  if (report.metrics.closure && !report.metrics.closure->leaflets.empty())
    section.blocks.emplace_back(leaflet_table(report.metrics.closure->leaflets));
  if (report.metrics.closure && !report.metrics.closure->orifices.empty())
    section.blocks.emplace_back(orifice_table(report.metrics.closure->orifices));
  if (report.reference) section.blocks.emplace_back(distance_table(*report.reference));
  return section;
}

// Energies and the figures that differ, equilibrium by equilibrium.
PageTable branch_table(const Branches& branches) {
  Table table{.columns = {text_column("equilibrium"),
                          {"perturbed starts"},
                          {"energy", "", "mJ", 8},
                          text_column("stability"),
                          {"greatest distance", "", "mm"}}};
  std::vector<size_t> shown;
  const std::vector<MetricRow> own = metric_rows(branches.equilibria.front().metrics);
  for (size_t row = 0; row < own.size(); ++row)
    for (const char* name : {"orifice_area_mm2", "coaptation_area_mm2", "coaptation_height_mm",
                             "tenting_height_mm", "max_chord_force_n"})
      if (own[row].name == name && own[row].value) {
        shown.push_back(row);
        table.columns.push_back({metric_in_words(own[row]), "", own[row].unit, 5});
      }
  for (const NearbyEquilibrium& equilibrium : branches.equilibria) {
    const size_t number = table.rows.size() + 1;
    table.rows.push_back({number == 1 ? "this result" : std::to_string(number), equilibrium.found,
                          equilibrium.energy, stability_name(equilibrium.stability),
                          equilibrium.greatest_mm});
    const std::vector<MetricRow> rows = metric_rows(equilibrium.metrics);
    for (const size_t row : shown) table.rows.back().emplace_back(rows[row].value);
  }
  return page_table(table, "Equilibria, that of this result first");
}

PageSection other_equilibria(const Report& report) {
  const Branches& branches = *report.branches;
  return {"Other equilibria near by", {PageText{branches_message(branches) + "."}, branch_table(branches)}};
}

PageSection convergence(const Report& report) {
  PageSection section{"Convergence", {}};
  if (report.result.trace.empty()) return {"Convergence", {PageText{"No iterate was accepted."}}};
  const std::vector<NamedReport> named = {{report.solver, &report}};
  section.blocks = {residual_plot(named, false), residual_plot(named, true)};
  const auto& trace = report.result.trace;
  if (trace.front().outer_iteration != trace.back().outer_iteration)
    section.blocks.emplace_back(PageText{
        "Dotted upright lines: from there on another energy is minimised, because loads or supports "
        "went on, a barrier became stiffer, kinks became sharper, or the lagged pressure was updated."});
  if (report.result.outer_iterations > 0)
    section.blocks.emplace_back(
        PageText{"The residual of an iterate is that of the potential of its outer iteration; the "
                 "verdict is that of the exact loads."});
  return section;
}

// Name and value, one row each.
PageTable listed_pairs(const std::string& caption,
                       const std::vector<std::pair<std::string, std::string>>& pairs) {
  PageTable table{.caption = caption, .columns = {{"", true}, {"", true}}};
  for (const auto& [name, value] : pairs) table.rows.push_back({{name}, {value}});
  return table;
}

PageTable solve_table(const Model& model, const Report& report) {
  const Result& result = report.result;
  const auto count = [](auto number) { return std::to_string(number); };
  return listed_pairs(
      "What was solved, how, and at what cost",
      {{"scene", report.scene_file},
       {"version of coapt", version()},
       {"licence of this build", combined_licence()},
       {"mesh", count(model.mesh.vertex_count()) + " vertices, " + count(model.mesh.triangle_count()) +
                    " triangles, " + count(model.lines.size()) + " chords and cables, " +
                    count(model.objective->free_count()) + " unknowns"},
       {"solver", report.solver},
       {"tolerance on the residual", page_number(report.tolerance)},
       {"pressure", report.pressure_route},
       {"certificate", summary(result.certificate)},
       {"energy", page_number(result.energy, 10) + " mJ"},
       {"iterates", count(result.iterations)},
       {"evaluations", count(result.evaluations.gradient) + " gradients, " + count(result.evaluations.value) +
                           " values, " + count(result.evaluations.hessian) + " Hessians, " +
                           count(result.factorisations) + " factorisations"},
       {"time", page_number(result.wall_s, 3) + " s by the clock, " + page_number(result.cpu_s, 3) +
                    " s of CPU time"},
       {"peak memory", page_number(peak_memory_mb(), 3) + " MB"}});
}

PageTable term_table(const Result& result) {
  return page_table(
      table_of<TermReport>(result.terms, {{text_column("term"), &TermReport::name},
                                          {text_column("type"), &TermReport::type},
                                          {{"energy", "", "mJ", 6}, &TermReport::energy},
                                          {{"greatest nodal force", "", "N"}, &TermReport::greatest_force}}),
      "Energies and loads");
}

PageTable phase_table(const Result& result) {
  PageTable table{.caption = "Wall time by phase", .columns = {{"phase", true}, {"time [s]"}}};
  for (const auto& [phase, seconds] : result.phase_s)
    table.rows.push_back({{phase}, {page_number(seconds, 3)}});
  return table;
}

PageTable level_table(const std::vector<CascadeLevel>& levels) {
  using Level = CascadeLevel;
  return page_table(table_of<Level>(levels, {{text_column("triangles"), &Level::triangles},
                                             {{"iterates"}, &Level::iterations},
                                             {text_column("status"), along(&Level::status, status_name)},
                                             {{"residual", "", "", 3}, &Level::residual},
                                             {{"CPU time", "", "s", 3}, &Level::cpu_s}}),
                    "Meshes of the cascade; the shapes in the view are those of the last");
}

}  // namespace

size_t page_shapes(const Model& model) {
  const auto bytes = 16 * static_cast<size_t>(std::max<Eigen::Index>(1, model.X.cols()));
  return std::clamp<size_t>(kShapeBytes / bytes, 2, kMostShapes);
}

PagePlot residual_plot(const std::vector<NamedReport>& reports, bool against_time) {
  PagePlot plot{
      .title = against_time ? "Residual against wall time" : "Residual against iterates",
      .x = {against_time ? "wall time since the start [s]" : "accepted iterate"},
      .y = {"residual", Scale::ByRange},
      .note = "Residual: the largest out-of-balance nodal force over the largest applied or reaction force."};
  for (const NamedReport& each : reports) {
    PageSeries& series = plot.series.emplace_back();
    series.name = each.name;
    const std::vector<Iteration>& trace = each.report->result.trace;
    for (size_t k = 0; k < trace.size(); ++k)
      series.points.push_back(
          {.x = against_time ? trace[k].seconds : trace[k].iteration,
           .y = trace[k].residual,
           .label = "iterate " + std::to_string(trace[k].iteration),
           .begins_outer_iteration = k > 0 && trace[k].outer_iteration != trace[k - 1].outer_iteration});
  }
  plot.levels = {{reports.front().report->tolerance, "tolerance"}};
  return plot;
}

PageSection what_was_solved(const Model& model, const Report& report) {
  PageSection section{"What was solved", {solve_table(model, report), term_table(report.result)}};
  if (!report.result.phase_s.empty()) section.blocks.emplace_back(phase_table(report.result));
  if (!report.levels.empty()) section.blocks.emplace_back(level_table(report.levels));
  return section;
}

std::vector<PageSection> solve_account(const Model& model, const Report& report) {
  std::vector<PageSection> account = {figures(report), convergence(report), what_was_solved(model, report)};
  if (report.branches) account.insert(account.begin() + 1, other_equilibria(report));
  return account;
}

std::string solve_page_with(const Model& model, const Report& report, const std::vector<PageSection>& more) {
  Page page;
  page.title = "Result of " + (report.scene_title.empty() ? "a scene" : report.scene_title);
  page.lead = headline(report).text;
  page.tone = tone_of(standing("", report));
  if (PageList warnings = warning_list(report); !warnings.items.empty())
    page.sections.push_back({"Warnings", {std::move(warnings)}});
  page.sections.push_back({"Shape", {tiles(report), shape_view_html(solved_view(model, report))}});
  page.sections.insert(page.sections.end(), more.begin(), more.end());
  for (PageSection& section : solve_account(model, report)) page.sections.push_back(std::move(section));
  return report_page(page);
}

std::string solve_page(const Model& model, const Report& report) {
  return solve_page_with(model, report, {});
}

ShownSolve shown_solve(const std::string& what, const Model& model, const Report& report) {
  ShownSolve shown{what, standing("the valve as solved", report), warning_list(report),
                   solved_view(model, report), solve_account(model, report)};
  for (PageSection& section : shown.account) section.title += " of the shape above";
  return shown;
}

PageSection shape_section(const std::string& title, const ShownSolve& shown) {
  PageSection section{title, {PageText{shown.what}}};
  if (!shown.standing.doubts.empty())
    section.blocks.emplace_back(PageText{"In doubt: " + joined_doubts(shown.standing.doubts), Tone::Caution});
  if (!shown.warnings.items.empty()) section.blocks.emplace_back(shown.warnings);
  section.blocks.emplace_back(shape_view_html(shown.view));
  return section;
}

}  // namespace coapt
