#include "results/results.hpp"

#include "core/components.hpp"
#include "core/error.hpp"
#include "energy/term_access.hpp"
#include "formats/csv_table.hpp"
#include "formats/json/json_text.hpp"
#include "formats/mesh_io.hpp"
#include "formats/whole_file.hpp"
#include "results/branches_json.hpp"
#include "results/reference/reference_results.hpp"
#include "results/result_surfaces.hpp"
#include "results/result_warnings.hpp"
#include "results/study_files.hpp"
#include "results/write_attempts.hpp"

#include <cmath>
#include <fstream>
#include <functional>
#include <map>
#include <system_error>

namespace coapt {

namespace {

namespace fs = std::filesystem;

OrderedJson terms_json(const Result& result) {
  OrderedJson terms = OrderedJson::array();
  for (const TermReport& term : result.terms)
    terms.push_back({{"name", term.name},
                     {"type", term.type},
                     {"energy_mj", number_json(term.energy)},
                     {"greatest_force_n", number_json(term.greatest_force)},
                     {"counters",
                      {{"elements", term.counters.elements},
                       {"candidates", term.counters.candidates},
                       {"searches", term.counters.searches}}}});
  return terms;
}

OrderedJson rows_json(const std::vector<MetricRow>& rows) {
  OrderedJson json = OrderedJson::object();
  for (const MetricRow& row : rows) {
    if (!row.value)
      json[row.name] = nullptr;
    else if (row.is_count)
      json[row.name] = std::lround(*row.value);
    else
      json[row.name] = number_json(*row.value);
  }
  return json;
}

bool has_leaflets(const Report& report) {
  return report.metrics.closure && !report.metrics.closure->leaflets.empty();
}

OrderedJson leaflets_json(const std::vector<LeafletMetrics>& leaflets) {
  OrderedJson json = OrderedJson::array();
  for (const LeafletMetrics& leaflet : leaflets) {
    OrderedJson entry = {{"name", leaflet.name}};
    entry.update(rows_json(leaflet_rows(leaflet)));
    json.push_back(entry);
  }
  return json;
}

OrderedJson criteria_json(const std::vector<HealthyCriterion>& criteria) {
  const auto bound = [](const std::optional<double>& limit) {
    return limit ? number_json(*limit) : OrderedJson(nullptr);
  };
  OrderedJson json = OrderedJson::array();
  for (const HealthyCriterion& criterion : criteria)
    json.push_back({{"name", criterion.name},
                    {"unit", criterion.unit},
                    {"value", number_json(criterion.value)},
                    {"lowest", bound(criterion.lowest)},
                    {"highest", bound(criterion.highest)},
                    {"met", criterion.is_met()},
                    {"meaning", criterion.meaning},
                    {"source", criterion.source}});
  return json;
}

OrderedJson counters_json(const Model& model, const Result& result) {
  std::map<TermKind, long> elements;
  for (const auto& term : model.objective->terms()) elements[kind_of(*term)] += term->counters().elements;
  long candidates = 0, searches = 0;
  for (const TermReport& term : result.terms) {
    candidates += term.counters.candidates;
    searches += term.counters.searches;
  }
  return {{"membrane_elements", elements[TermKind::Membrane]},
          {"film_elements", elements[TermKind::Film]},
          {"spring_elements", elements[TermKind::Spring]},
          {"cable_elements", elements[TermKind::Line]},
          {"link_elements", elements[TermKind::Link]},
          {"pressure_facets", elements[TermKind::Pressure]},
          {"contact_candidates", candidates},
          {"contact_searches", searches}};
}

OrderedJson counted(int count) { return count < 0 ? OrderedJson(nullptr) : OrderedJson(count); }

OrderedJson certificate_json(const Model& model, const Result& result) {
  const Certificate& certificate = result.certificate;
  const std::string doubt = result.status == Status::Converged ? stability_doubt(certificate) : "";
  const StabilityReport& stability = certificate.stability;
  const bool is_judged = stability.verdict != Stability::NotKnown;
  OrderedJson smallest = OrderedJson::array(), parts = OrderedJson::array();
  for (const double value : stability.smallest) smallest.push_back(number_json(value));
  for (const FreePart& part : certificate.free_parts)
    parts.push_back({{"node", part.node}, {"nodes", part.node_count}, {"free_motions", part.free_motions}});
  OrderedJson lowest = nullptr;
  if (stability.is_tangent_checked)
    lowest = {{"real", number_json(stability.lowest.real())},
              {"imaginary", number_json(stability.lowest.imag())}};
  OrderedJson json = {
      {"summary", summary(certificate)},
      {"stability", stability_name(stability.verdict)},
      {"conservative", certificate.is_conservative},
      {"smallest_pivot_ratio",
       stability.pivot_ratio > 0 ? number_json(stability.pivot_ratio) : OrderedJson(nullptr)},
      {"doubt", doubt.empty() ? OrderedJson(nullptr) : OrderedJson(doubt)},
      {"zero_modes", counted(is_judged ? stability.zero_modes : -1)},
      {"negative_modes", counted(is_judged ? stability.negative_modes : -1)},
      {"unstable_modes", counted(stability.is_tangent_checked ? stability.unstable_modes : -1)},
      {"lowest_eigenvalue", lowest},
      {"free_directions", counted(is_judged ? stability.free_directions : -1)},
      {"loose_nodes", counted(is_judged ? stability.loose_nodes : -1)},
      {"free_nodes", certificate.free_nodes},
      {"smallest_eigenvalues", smallest},
      {"free_parts", parts},
      {"force_balance", number_json(certificate.balance.force)},
      {"moment_balance", number_json(certificate.balance.moment)}};
  if (const auto& worst = certificate.imbalance) {
    const Vec3 at = worst->position + model.origin;
    json["imbalance"] = {{"node", worst->node},
                         {"position_mm", {number_json(at[0]), number_json(at[1]), number_json(at[2])}},
                         {"force_n", number_json(worst->force)},
                         {"term", worst->term},
                         {"share_n", number_json(worst->share)}};
  }
  return json;
}

OrderedJson levels_json(const std::vector<CascadeLevel>& levels) {
  OrderedJson json = OrderedJson::array();
  for (const CascadeLevel& level : levels)
    json.push_back({{"triangles", level.triangles},
                    {"iterations", level.iterations},
                    {"status", status_name(level.status)},
                    {"residual", number_json(level.residual)},
                    {"wall_s", number_json(level.wall_s)},
                    {"cpu_s", number_json(level.cpu_s)}});
  return json;
}

OrderedJson accuracy_json(const AccuracyEstimate& accuracy) {
  OrderedJson levels = OrderedJson::array();
  for (const AccuracyLevel& level : accuracy.levels)
    levels.push_back({{"triangles", level.triangles},
                      {"tolerance", number_json(level.tolerance)},
                      {"status", status_name(level.status)},
                      {"iterations", level.iterations},
                      {"wall_s", number_json(level.wall_s)},
                      {"cpu_s", number_json(level.cpu_s)},
                      {"distance_to_previous", distances_json(level.to_previous)}});
  return {{"wanted_mm", number_json(accuracy.wanted_mm)},
          {"reached", accuracy.is_reached},
          {"message", accuracy.message},
          {"total_mm", number_json(accuracy.total_mm())},
          {"greatest_mm", number_json(accuracy.greatest_mm())},
          {"discretisation_mm", number_json(accuracy.discretisation_mm)},
          {"algebraic_mm", number_json(accuracy.algebraic_mm)},
          {"order", number_json(accuracy.order)},
          {"cuts", accuracy.cuts},
          {"solves", levels}};
}

OrderedJson branch_changes_json(const std::vector<BranchChange>& changes) {
  OrderedJson json = OrderedJson::array();
  for (const BranchChange& change : changes)
    json.push_back(
        {{"step", change.step}, {"before", change.before}, {"distance_mm", number_json(change.distance)}});
  return json;
}

OrderedJson undetermined_json(const Certificate& certificate, const std::optional<Branches>& branches) {
  const UndeterminedNodes nodes = undetermined_nodes(certificate.free_nodes, branches);
  return {{"total", nodes.total()}, {"free", nodes.free}, {"differing", nodes.differing}};
}

// Iterates at which a round begins, but for the first.
OrderedJson potential_changes_json(const std::vector<Iteration>& trace) {
  OrderedJson json = OrderedJson::array();
  for (size_t k = 1; k < trace.size(); ++k)
    if (trace[k].outer_iteration != trace[k - 1].outer_iteration) json.push_back(trace[k].iteration);
  return json;
}

constexpr int kDigits = 10;  // in trace.csv and metrics.csv

std::string trace_csv(const Result& result) {
  return csv_table(table_of<Iteration>(result.trace, {{{"iteration"}, &Iteration::iteration},
                                                      {{"round"}, &Iteration::outer_iteration},
                                                      {{"energy_mj"}, &Iteration::energy},
                                                      {{"residual"}, &Iteration::residual},
                                                      {{"step_mm"}, &Iteration::step},
                                                      {{"seconds"}, &Iteration::seconds},
                                                      {{"gradient_evaluations"}, &Iteration::evaluations},
                                                      {{"time_s"}, &Iteration::time}}),
                   kDigits);
}

// The range over other equilibria stands in two more columns where there are such; leaflets have none.
std::string metrics_csv(const Report& report) {
  Table table{.columns = {text_column("metric"), {"value"}, text_column("unit")}};
  const bool has_others = report.branches && !report.branches->others.empty();
  if (has_others)
    for (const char* name : {"others_lowest", "others_highest"}) table.columns.push_back({name});
  const auto add = [&](const std::string& prefix, const std::vector<MetricRow>& rows) {
    for (const MetricRow& row : rows) {
      table.rows.push_back({prefix + row.name, row.value, row.unit});
      if (!has_others) continue;
      const BranchRange* others = prefix.empty() ? range_of(report.branches, row.name) : nullptr;
      table.rows.back().emplace_back(others ? TableCell(others->lowest) : TableCell());
      table.rows.back().emplace_back(others ? TableCell(others->highest) : TableCell());
    }
  };
  add("", metric_rows(report.metrics));
  if (has_leaflets(report))
    for (const LeafletMetrics& leaflet : report.metrics.closure->leaflets)
      add(leaflet.name + ".", leaflet_rows(leaflet));
  return csv_table(table, kDigits);
}

bool has_line(const Report& report) {
  return report.metrics.closure && !report.metrics.closure->line.empty();
}

bool has_orifice(const Report& report) {
  return report.metrics.closure && !report.metrics.closure->orifices.empty();
}

OrderedJson phases_json(const std::map<std::string, double>& phases) {
  OrderedJson json = OrderedJson::object();
  for (const auto& [phase, seconds] : phases) json[phase] = number_json(seconds);
  return json;
}

}  // namespace

std::string pressure_route(const Model& model, const Result& result) {
  if (!result.route.empty()) return "follower pressure on a rim that moves: " + result.route;
  for (const auto& term : model.objective->terms()) {
    if (kind_of(*term) != TermKind::Pressure) continue;
    if (!access_of(*term)->pressure()) return "frozen: dead forces of the pressure on the reference shape";
    return "follower pressure by its potential, minus pressure times volume (exact: no rim moves freely)";
  }
  return "no pressure";
}

std::string result_json(const Model& model, const Report& report) {
  const Result& result = report.result;
  OrderedJson json = {{"version", version()},
                      {"scene", report.scene_file},
                      {"status", status_name(result.status)},
                      {"message", result.message},
                      {"converged", result.status == Status::Converged},
                      {"residual", number_json(result.residual)},
                      {"energy_mj", number_json(result.energy)},
                      {"certificate", certificate_json(model, result)},
                      {"terms", terms_json(result)},
                      {"iterations", result.iterations},
                      {"rounds", result.outer_iterations},
                      {"damped_steps", result.damped_steps},
                      {"potential_changes", potential_changes_json(result.trace)},
                      {"branch_changes", branch_changes_json(result.branch_changes)},
                      {"evaluations",
                       {{"value", result.evaluations.value},
                        {"gradient", result.evaluations.gradient},
                        {"hessian", result.evaluations.hessian},
                        {"factorisations", result.factorisations}}},
                      {"time",
                       {{"wall_s", number_json(result.wall_s)},
                        {"cpu_s", number_json(result.cpu_s)},
                        {"by_phase", phases_json(result.phase_s)},
                        {"cpu_by_phase", phases_json(result.phase_cpu_s)}}},
                      {"peak_memory_mb", number_json(peak_memory_mb())},
                      {"mesh",
                       {{"vertices", model.mesh.vertex_count()},
                        {"triangles", model.mesh.triangle_count()},
                        {"nodes", model.X.cols()},
                        {"unknowns", model.objective->free_count()}}},
                      {"metrics", rows_json(metric_rows(report.metrics))},
                      {"judge", report.metrics.intersection_checker}};
  if (has_leaflets(report)) json["leaflets"] = leaflets_json(report.metrics.closure->leaflets);
  const std::string stands_open = standing_open(report.metrics);
  json["stands_open"] = stands_open.empty() ? OrderedJson(nullptr) : OrderedJson(stands_open);
  if (!report.metrics.healthy_closure.empty())
    json["healthy_closure"] = criteria_json(report.metrics.healthy_closure);
  if (report.reference) json["distance_to_reference"] = reference_json(*report.reference);
  if (report.accuracy) json["accuracy"] = accuracy_json(*report.accuracy);
  json["counters"] = counters_json(model, result);
  json["solver"] = {{"type", report.solver},
                    {"tolerance", number_json(report.tolerance)},
                    {"route", report.pressure_route}};
  if (!report.levels.empty()) json["levels"] = levels_json(report.levels);
  json["files"] = result_files(model, report);
  json["headline"] = headline(report).text;
  json["doubts"] = doubts(report);
  json["warnings"] = report.warnings;
  json["neighbours"] = {{"judged", report.neighbours.is_made},
                        {"suspected", report.neighbours.is_suspected},
                        {"iterates", report.neighbours.iterates},
                        {"unstable_steps", report.neighbours.unstable_steps}};
  json["undetermined_nodes"] = undetermined_json(result.certificate, report.branches);
  if (report.branches) json["branches"] = branches_json(*report.branches);
  // Names come from files and may hold bytes that are not UTF-8: replace those instead of failing.
  return json_text(json, 2) + "\n";
}

std::vector<std::string> result_files(const Model& model, const Report& report) {
  std::vector<std::string> files = {"result.json", "closed.vtp"};
  if (model.mesh.triangle_count() > 0) files.push_back("closed.obj");
  files.insert(files.end(), {"trace.csv", "metrics.csv"});
  if (has_line(report)) files.push_back("coaptation_line.vtp");
  if (has_orifice(report)) files.push_back("orifice.vtp");
  if (report.fields.registered_reference) files.push_back("reference.vtp");
  if (report.has_page) files.push_back("report.html");
  if (report.has_frames) files.push_back("frames.pvd");
  return files;
}

void prepare_result_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error || !fs::is_directory(folder))
    throw InputError(folder.string() + ": cannot be used as the result folder: " +
                     (error ? error.message() : "it is a file") + "; choose another with -o");
  const fs::path probe = folder / ".coapt.part";
  {
    std::ofstream out(probe);
    if (!out)
      throw InputError(folder.string() + ": no file can be written into this folder; choose another with -o");
  }
  fs::remove(probe, error);
}

void write_results(const fs::path& folder, const Model& model, const Report& report) {
  prepare_result_folder(folder);
  WriteAttempts attempt;
  attempt([&] { formats::write_whole(folder / "result.json", result_json(model, report)); });
  attempt([&] { formats::write_whole(folder / "metrics.csv", metrics_csv(report)); });
  attempt([&] { formats::write_whole(folder / "trace.csv", trace_csv(report.result)); });
  attempt([&] { write_vtp(folder / "closed.vtp", closed_surface(model, report.fields)); });
  const fs::path line = folder / "coaptation_line.vtp", orifice = folder / "orifice.vtp",
                 mesh = folder / "closed.obj", reference = folder / "reference.vtp";
  // One that an earlier solve left would be taken for this one's.
  const auto write_or_remove = [&](bool is_there, const fs::path& file, const std::function<void()>& write) {
    std::error_code ignored;
    if (is_there)
      attempt(write);
    else
      fs::remove(file, ignored);
  };
  write_or_remove(has_line(report), line,
                  [&] { write_vtp(line, coaptation_line(model, *report.metrics.closure)); });
  write_or_remove(has_orifice(report), orifice,
                  [&] { write_vtp(orifice, orifice_outlines(model, *report.metrics.closure)); });
  write_or_remove(report.fields.registered_reference.has_value(), reference,
                  [&] { write_vtp(reference, registered_surface(model, report.fields)); });
  write_or_remove(model.mesh.triangle_count() > 0, mesh, [&] {
    TriangleMesh closed = model.mesh;
    closed.vertices = report.fields.x.leftCols(model.mesh.vertex_count()).colwise() + model.origin;
    write_mesh(mesh, closed);
  });
  attempt.finish();
}

}  // namespace coapt
