// The page of a benchmark.
#include "report/report_page.hpp"
#include "study/bench/benchmark_report.hpp"
#include "study/bench/benchmark_summary.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

namespace coapt {
namespace {

PageCell number_cell(const std::optional<double>& value, int digits = 3) {
  return {value ? page_number(*value, digits) : ""};
}

std::string words(std::string_view name) {
  std::string text(name);
  std::replace(text.begin(), text.end(), '_', ' ');
  return text;
}

// How high a run is drawn, and what that height is where it is not the error. Without a height: at the upper
// edge.
struct Height {
  std::optional<double> mm;
  std::string remark = {};
};

// A run that stopped early is drawn also where its error is not known, or it would look as if it had never
// been made: by as much of the error as can be measured. Empty: it is not drawn.
std::optional<Height> height_of(const Benchmark& bench, const BenchRun& run, ErrorKind kind) {
  if (const auto error = error_of(run, kind)) return Height{error};
  if (run.status == Status::Converged) return std::nullopt;
  const RunErrors& errors = run.errors;
  const Height edge{std::nullopt, "error not known, at the upper edge"};
  if (kind == ErrorKind::Total) {
    if (!errors.algebraic && !errors.method) return edge;
    return Height{(errors.algebraic ? errors.algebraic->max : 0) + errors.method.value_or(0),
                  "the part of the error that is known"};
  }
  const MethodModel model = bench.methods[run.method].model;
  if (model == MethodModel::Constraints) return std::nullopt;  // has no such error
  if (!errors.method || model != bench.methods.front().model) return edge;
  return Height{errors.method, "distance to the equilibrium of " + bench.methods.front().name};
}

// Above all heights that are known. A hair below the power of ten where the axis then ends.
double upper_edge(const Benchmark& bench, ErrorKind kind) {
  double greatest = 0;
  for (const BenchRun& run : bench.runs)
    if (const auto height = height_of(bench, run, kind))
      greatest = std::max(greatest, height->mm.value_or(0));
  if (!(greatest > 0)) greatest = std::max(bench.extent_mm, 1.0);
  return std::pow(10, std::ceil(std::log10(greatest))) * (1 - 1e-6);
}

// Error over time: a line for every method and mesh, from the loosest tolerance to the tightest.
PagePlot error_plot(const Benchmark& bench, ErrorKind kind, const std::string& title, const std::string& axis,
                    const std::string& note) {
  PagePlot plot;
  plot.title = title;
  plot.x = {"wall time [s], median", Scale::ByRange};
  plot.y = {axis, Scale::ByRange};
  plot.note = note;
  const double edge = upper_edge(bench, kind);
  for (size_t method = 0; method < bench.methods.size(); ++method)
    for (size_t mesh = 0; mesh < bench.meshes.size(); ++mesh) {
      PageSeries series{.name = bench.methods[method].name + ", " + mesh_text(bench.meshes[mesh]),
                        .group = static_cast<int>(method)};
      for (const BenchRun& run : bench.runs) {
        if (run.method != method || run.mesh != mesh) continue;
        const std::optional<Height> height = height_of(bench, run, kind);
        if (!height) continue;
        series.points.push_back({.x = run.wall.median,
                                 .y = height->mm.value_or(edge),
                                 .is_crossed = run.status != Status::Converged,
                                 .label = "tolerance " + page_number(run.tolerance) + ", " +
                                          words(status_name(run.status)) +
                                          (height->remark.empty() ? "" : ", " + height->remark)});
      }
      if (!series.points.empty()) plot.series.push_back(std::move(series));
    }
  return plot;
}

PageSection recommendation_section(const Benchmark& bench) {
  PageList list;
  for (const double mm : kTotalAccuracies) {
    const bool is_reached = fastest_run(bench, ErrorKind::Total, mm) != nullptr;
    list.items.push_back({recommendation(bench, mm), is_reached ? Tone::Good : Tone::Caution});
  }
  for (const std::string& missing : missing_equilibria(bench))
    list.items.push_back({"Warning: " + missing, Tone::Caution});
  for (const std::string& other : other_equilibria(bench)) list.items.push_back({other, Tone::Caution});
  PageSection section{.title = "Which method on which mesh"};
  section.blocks.emplace_back(list);
  return section;
}

PageSection plots_section(const Benchmark& bench) {
  PageSection section{.title = "Error against time"};
  section.blocks.emplace_back(error_plot(
      bench, ErrorKind::Total, "Total error against wall time", "total error [mm]",
      "Greatest algebraic error, discretisation error of 95 % of the surface and method error together. "
      "Hollow and crossed: the run stopped before its tolerance; what is not known of its error is left out, "
      "and where nothing is known it stands at the upper edge. The numbers say which."));
  section.blocks.emplace_back(error_plot(
      bench, ErrorKind::Algebraic, "Algebraic error against wall time", "algebraic error [mm]",
      "Of the vertex farthest from the equilibrium on the same mesh. Without the error of the mesh."));
  return section;
}

PageTable times_table(const Benchmark& bench) {
  PageTable table{.caption = "Median wall time to an accuracy [s]"};
  table.columns = {{"method", true}, {"error", true}};
  for (const double mm : kAlgebraicAccuracies) table.columns.push_back({page_number(mm) + " mm"});
  for (size_t method = 0; method < bench.methods.size(); ++method) {
    std::vector<PageCell> total = {{bench.methods[method].name}, {"total"}};
    for (const double mm : kTotalAccuracies) {
      const BenchRun* run = fastest_run(bench, ErrorKind::Total, mm, {.method = method});
      PageCell cell = number_cell(run ? std::optional(run->wall.median) : std::nullopt);
      if (run != nullptr) cell.remark = mesh_text(bench.meshes[run->mesh]);
      total.push_back(std::move(cell));
    }
    table.rows.push_back(std::move(total));
    for (size_t mesh = 0; mesh < bench.meshes.size(); ++mesh) {
      if (!bench.meshes[mesh].is_benchmarked) continue;
      std::vector<PageCell> row = {{bench.methods[method].name},
                                   {"algebraic, " + mesh_text(bench.meshes[mesh])}};
      for (const double mm : kAlgebraicAccuracies) {
        const BenchRun* run = fastest_run(bench, ErrorKind::Algebraic, mm, {method, mesh});
        row.push_back(number_cell(run ? std::optional(run->wall.median) : std::nullopt));
      }
      table.rows.push_back(std::move(row));
    }
  }
  table.note = "Of the tolerances that were run the fastest that is good enough. Empty: none of them.";
  return table;
}

PageTable meshes_table(const Benchmark& bench) {
  PageTable table{.caption = "Equilibria from mesh to mesh"};
  table.columns = {{"mesh", true},
                   {"mean distance to the next [mm]"},
                   {"95 % [mm]"},
                   {"greatest [mm]"},
                   {"observed order"},
                   {"discretisation error [mm]"},
                   {"residual of the equilibrium"},
                   {"Hessian and factorisation [CPU s]"}};
  using Figures = std::optional<DistanceFigures>;
  const auto figure = [](const Figures& to_next, double DistanceFigures::*member) {
    return number_cell(to_next ? std::optional((*to_next).*member) : std::nullopt);
  };
  for (const BenchMesh& mesh : bench.meshes) {
    const Figures& to_next = mesh.to_next;
    table.rows.push_back({{mesh_text(mesh)},
                          figure(to_next, &DistanceFigures::mean),
                          figure(to_next, &DistanceFigures::p95),
                          figure(to_next, &DistanceFigures::max),
                          number_cell(mesh.order),
                          number_cell(mesh.error_mm),
                          number_cell(mesh.residual),
                          number_cell(mesh.factorisation_s)});
  }
  table.note = "Beyond the last mesh distances are taken to fall with order " +
               page_number(bench.assumed_order, 3) + ". An equilibrium is what has a residual of at most " +
               page_number(bench.equilibrium_residual()) + ".";
  return table;
}

PageTable growth_table(const Benchmark& bench) {
  PageTable table{.caption = "Growth of the CPU time with the number of triangles"};
  table.columns = {{"method", true}, {"exponent"}, {"tolerance"}, {"meshes"}};
  for (size_t method = 0; method < bench.methods.size(); ++method)
    if (const auto found = growth(bench, method))
      table.rows.push_back({{bench.methods[method].name},
                            number_cell(found->exponent),
                            number_cell(found->tolerance),
                            {std::to_string(found->meshes)}});
  return table;
}

PageTable ends_table(const Benchmark& bench) {
  PageTable table{.caption = "Where each method ends, beside " + bench.methods.front().name};
  table.columns = {{"method", true}, {"mesh", true}, {"verdict", true}, {"95 % [mm]"}, {"same vertex [mm]"}};
  for (const BenchEnd& end : bench.ends) {
    const bool has_surfaces = end.gap && end.gap->surfaces;
    const bool is_good = end.verdict == Verdict::Reference || end.verdict == Verdict::SameEquilibrium;
    PageCell verdict{std::string(verdict_name(end.verdict)), is_good ? Tone::Good : Tone::Caution,
                     end.failure};
    table.rows.push_back(
        {{bench.methods[end.method].name},
         {mesh_text(bench.meshes[end.mesh])},
         std::move(verdict),
         number_cell(has_surfaces ? std::optional(both_directions(*end.gap->surfaces).p95) : std::nullopt),
         number_cell(end.gap ? std::optional(end.gap->same_vertex.max) : std::nullopt)});
  }
  return table;
}

// The first cells of a row: which run it is.
std::vector<PageCell> run_cells(const Benchmark& bench, const BenchRun& run) {
  return {{bench.methods[run.method].name}, {mesh_text(bench.meshes[run.mesh])}, number_cell(run.tolerance)};
}

PageTable runs_table(const Benchmark& bench, const std::string& caption,
                     const std::vector<PageColumn>& columns,
                     const std::function<std::vector<PageCell>(const BenchRun&)>& cells) {
  PageTable table{.caption = caption, .columns = {{"method", true}, {"mesh"}, {"tolerance"}}};
  table.columns.insert(table.columns.end(), columns.begin(), columns.end());
  for (const BenchRun& run : bench.runs) {
    const std::vector<PageCell> more = cells(run);
    std::vector<PageCell>& row = table.rows.emplace_back(run_cells(bench, run));
    row.insert(row.end(), more.begin(), more.end());
  }
  return table;
}

PageTable work_table(const Benchmark& bench) {
  const auto cells = [&](const BenchRun& run) {
    return std::vector<PageCell>{number_cell(run.wall.median),
                                 number_cell(run.wall.best),
                                 number_cell(run.cpu.median),
                                 number_cell(factorisations_worth(bench, run)),
                                 {std::to_string(run.iterations)},
                                 {std::to_string(run.evaluations.gradient)},
                                 {std::to_string(run.evaluations.hessian)},
                                 {std::to_string(run.factorisations)},
                                 number_cell(run.peak_memory_mb)};
  };
  PageTable table = runs_table(bench, "Work of every run",
                               {{"wall [s]"},
                                {"best [s]"},
                                {"CPU [s]"},
                                {"CPU [units]"},
                                {"iterations"},
                                {"gradients"},
                                {"Hessians"},
                                {"factors"},
                                {"memory [MB]"}},
                               cells);
  table.note =
      "Wall and CPU time are medians over the repeats, best: the least wall time of one. A unit is the CPU "
      "time of a Hessian and its factorisation on the same mesh in the same run. Memory is what terms and "
      "solve add to the process.";
  return table;
}

PageTable errors_table(const Benchmark& bench) {
  const auto cells = [](const BenchRun& run) {
    const RunErrors& errors = run.errors;
    const bool is_good = run.status == Status::Converged;
    return std::vector<PageCell>{
        {words(status_name(run.status)), is_good ? Tone::Plain : Tone::Caution},
        number_cell(run.residual, 2),
        number_cell(error_of(run, ErrorKind::Algebraic), 2),
        number_cell(errors.algebraic ? std::optional(errors.algebraic->rms) : std::nullopt, 2),
        number_cell(errors.discretisation, 2),
        number_cell(errors.method, 2),
        number_cell(errors.total, 2),
        number_cell(errors.model ? std::optional(errors.model->mean) : std::nullopt)};
  };
  PageTable table = runs_table(bench, "Errors of every run [mm]",
                               {{"status", true},
                                {"residual"},
                                {"algebraic"},
                                {"root mean square"},
                                {"of the mesh"},
                                {"of the method"},
                                {"total"},
                                {"to the closed surface"}},
                               cells);
  table.note =
      "Algebraic: of the vertex farthest from the equilibrium on the same mesh, and the root of the mean "
      "square over all. Total: greatest algebraic, mesh and method together. Distances to a given closed "
      "surface are means of both directions.";
  return table;
}

PageTable phases_table(const Benchmark& bench) {
  PageTable table{.caption = "Wall time by phase, of the fastest repeat at the tightest tolerance run [s]"};
  std::vector<const BenchRun*> last;
  std::vector<std::string> phases;
  for (size_t k = 0; k < bench.runs.size(); ++k) {
    const BenchRun& run = bench.runs[k];
    if (k + 1 < bench.runs.size() && bench.runs[k + 1].method == run.method &&
        bench.runs[k + 1].mesh == run.mesh)
      continue;
    last.push_back(&run);
    for (const auto& [phase, seconds] : run.phase_s)
      if (std::find(phases.begin(), phases.end(), phase) == phases.end()) phases.push_back(phase);
  }
  table.columns = {{"method", true}, {"mesh"}};
  for (const std::string& phase : phases) table.columns.push_back({words(phase)});
  for (const BenchRun* run : last) {
    std::vector<PageCell> row = {{bench.methods[run->method].name}, {mesh_text(bench.meshes[run->mesh])}};
    for (const std::string& phase : phases) {
      const auto found = run->phase_s.find(phase);
      row.push_back(number_cell(found == run->phase_s.end() ? std::nullopt : std::optional(found->second)));
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

}  // namespace

std::string benchmark_page(const Benchmark& bench) {
  Page page{.title = "Benchmark of " + bench.scene_title};
  page.lead = recommendation(bench, kTotalAccuracies[1]);
  if (bench.is_cancelled) page.lead += " (cancelled before the end)";
  page.tone = bench.is_cancelled ? Tone::Caution : Tone::Plain;
  page.sections.push_back(recommendation_section(bench));
  page.sections.push_back(plots_section(bench));
  if (bench.shown) page.sections.push_back(shape_section("Shape", *bench.shown));
  page.sections.push_back({"Time to an accuracy", {times_table(bench)}});
  if (PageTable grown = growth_table(bench); !grown.rows.empty())
    page.sections.back().blocks.emplace_back(std::move(grown));
  page.sections.push_back({"What the mesh leaves", {meshes_table(bench)}});
  page.sections.push_back({"Methods", {ends_table(bench)}});
  page.sections.push_back({"Runs", {errors_table(bench), work_table(bench), phases_table(bench)}});
  if (bench.shown)
    page.sections.insert(page.sections.end(), bench.shown->account.begin(), bench.shown->account.end());
  return report_page(page);
}

}  // namespace coapt
