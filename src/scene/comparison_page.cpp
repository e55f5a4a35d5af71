// report.html of a comparison.
#include "scene/comparison_report.hpp"
#include "scene/solve_view.hpp"

#include <algorithm>

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

PageCell cell(const std::optional<double>& value, int digits = 3) {
  return {value ? page_number(*value, digits) : "–"};
}

void add_cells(const std::optional<DistanceFigures>& figures, std::vector<PageCell>& row) {
  for (const auto figure : {&DistanceFigures::mean, &DistanceFigures::p95, &DistanceFigures::max})
    row.push_back(cell(figures ? std::optional((*figures).*figure) : std::nullopt));
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
    const std::string status =
        method.run ? std::string(status_name(method.run->report.result.status)) : std::string("failed");
    std::vector<PageCell> row = {{method.name},
                                 {status, has_converged(method) ? Tone::Good : Tone::Bad},
                                 {std::string(verdict_name(method.verdict))}};
    add_cells(to_reference(method), row);
    row.push_back(cell(method.gap ? std::optional(method.gap->same_vertex.mean) : std::nullopt));
    row.push_back(cell(method.gap ? std::optional(method.gap->same_vertex.max) : std::nullopt));
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
        row.push_back(cell(value, 4));
      row.push_back({std::to_string(metrics.intersections)});
      row.push_back(cell(result.residual));
      row.push_back(cell(result.energy, 8));
      row.push_back({std::to_string(result.iterations)});
      row.push_back(cell(result.cpu_s));
      row.push_back(cell(result.wall_s));
    }
    table.rows.push_back(row);
  }
  return table;
}

PagePlot work_plot(const Comparison& comparison) {
  PagePlot plot{.title = "Distance to " + comparison.reference().name + " against run time",
                .x = {"CPU time of the solve [s]", Scale::Logarithmic},
                .y = {"mean distance [mm]", Scale::Logarithmic}};
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

// The nodes that are drawn: obstacles, which come last, are not.
Eigen::Index drawn_nodes(const Model& model) {
  int last = model.mesh.vertex_count() - 1;
  for (const Line& line : model.lines) last = std::max({last, line.a, line.b});
  return last + 1;
}

// Puts the fields of a state, the last so far, to those of the same title; others have no values in it.
void add_fields(const std::vector<ViewField>& fields, size_t state_count, std::vector<ViewField>& all) {
  for (const ViewField& field : fields) {
    auto same =
        std::find_if(all.begin(), all.end(), [&](const ViewField& f) { return f.title == field.title; });
    if (same == all.end()) {
      same = all.insert(all.end(), field);
      same->values.clear();
    }
    same->values.resize(state_count - 1);
    same->values.push_back(field.values.front());
  }
  for (ViewField& field : all) field.values.resize(state_count);
}

// Every method's shape; null where there is none.
std::optional<ShapeView> shapes(const Comparison& comparison) {
  std::optional<ShapeView> view;
  Vec3 origin = Vec3::Zero();
  Eigen::Index nodes = 0;
  for (const ComparedMethod& method : comparison.methods) {
    if (!method.run) continue;
    const Model& model = method.run->model;
    const Report& report = method.run->report;
    if (!view) {
      view = bare_view(model, report.fields);
      view->name = "comparison";
      view->slider = "Method";
      view->obstacles.resize(3, 0);
      origin = model.origin;
      nodes = drawn_nodes(model);
      if (!model.lines.empty())
        view->line_force = {.title = "Force in chords and cables", .unit = "N", .place = ViewPlace::Line};
    }
    if (drawn_nodes(model) != nodes) continue;
    const Points x = report.fields.x.leftCols(nodes).colwise() + (model.origin - origin);
    view->states.push_back({method.name + ": " + std::string(verdict_name(method.verdict)), x});
    add_fields(view_fields(model, report.fields), view->states.size(), view->fields);
    if (view->line_force) view->line_force->values.push_back(report.fields.line_force);
  }
  if (!view) return view;
  const auto is_distance = [](const ViewField& field) { return field.title.starts_with("Distance"); };
  std::stable_partition(view->fields.begin(), view->fields.end(), is_distance);
  return view;
}

}  // namespace

std::string comparison_page(const Comparison& comparison) {
  Page page{.title = "Comparison of methods on " + comparison.scene_file};
  page.lead = comparison.has_converged() ? "every method converged" : "not every method converged";
  page.tone = comparison.has_converged() ? Tone::Good : Tone::Bad;
  page.sections.push_back({"Distances", {distance_table(comparison), messages(comparison)}});
  if (const std::optional<ShapeView> view = shapes(comparison))
    page.sections.push_back({"Closed shapes", {shape_view_html(*view)}});
  page.sections.push_back({"Figures", {figure_table(comparison)}});
  page.sections.push_back({"Error and run time", {work_plot(comparison)}});
  page.footer = "Residual wanted: " + page_number(comparison.tolerance) +
                (comparison.is_cancelled ? "; cancelled before the last method." : ".");
  return report_page(page);
}

}  // namespace coapt
