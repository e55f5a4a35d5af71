// The page of a benchmark.
#include "report/page_table.hpp"
#include "study/bench/benchmark_report.hpp"
#include "study/bench/benchmark_summary.hpp"

#include <algorithm>
#include <cmath>
#include <set>

namespace coapt {
namespace {

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
                                          spaced(status_name(run.status)) +
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
    const bool is_good = is_reached && doubts_of_shown(bench).empty();
    list.items.push_back({recommendation(bench, mm), is_good ? Tone::Good : Tone::Caution});
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

PageTable page_times(const Benchmark& bench) {
  PageTable table =
      page_table(times_table(bench), "Median wall time to an accuracy",
                 "Of the tolerances that were run the fastest that is good enough. –: none of them.");
  size_t method = 0;
  for (std::vector<PageCell>& row : table.rows) {
    if (row[1].text != "total") continue;
    for (size_t k = 0; k < kAlgebraicAccuracies.size(); ++k)
      if (const BenchRun* run =
              fastest_run(bench, ErrorKind::Total, kAlgebraicAccuracies[k], {.method = method}))
        row[2 + k].remark = mesh_text(bench.meshes[run->mesh]);
    ++method;
  }
  return table;
}

PageTable meshes_table(const Benchmark& bench) {
  using Mesh = BenchMesh;
  using Distance = DistanceFigures;
  return page_table(
      table_of<Mesh>(bench.meshes,
                     {{text_column("mesh"), mesh_text},
                      {{"mean distance to the next", "", "mm", 3}, along(&Mesh::to_next, &Distance::mean)},
                      {{"95 %", "", "mm", 3}, along(&Mesh::to_next, &Distance::p95)},
                      {{"greatest", "", "mm", 3}, along(&Mesh::to_next, &Distance::max)},
                      {{"observed order", "", "", 3}, &Mesh::order},
                      {{"discretisation error", "", "mm", 3}, &Mesh::error_mm},
                      {{"residual of the equilibrium", "", "", 3}, &Mesh::residual},
                      {{"Hessian and factorisation", "", "CPU s", 3}, &Mesh::factorisation_s}}),
      "Equilibria from mesh to mesh",
      "Beyond the last mesh distances are taken to fall with order " + page_number(bench.assumed_order, 3) +
          ". An equilibrium is what has a residual of at most " + page_number(bench.equilibrium_residual()) +
          ".");
}

PageTable growth_table(const Benchmark& bench) {
  Table table{.columns = {text_column("method"), {"exponent", "", "", 3}, {"tolerance"}, {"meshes"}}};
  for (size_t method = 0; method < bench.methods.size(); ++method)
    if (const auto found = growth(bench, method))
      table.rows.push_back({bench.methods[method].name, found->exponent, found->tolerance, found->meshes});
  return page_table(table, "Growth of the CPU time with the number of triangles");
}

PageTable ends_table(const Benchmark& bench) {
  const auto method = [&](const BenchEnd& end) { return bench.methods[end.method].name; };
  const auto mesh = [&](const BenchEnd& end) { return mesh_text(bench.meshes[end.mesh]); };
  const auto p95 = [](const ReferenceDistance& distance) { return both_directions(distance).p95; };
  const auto vertex = along(&BenchEnd::gap, &MethodGap::same_vertex, &VertexDistance::max);
  PageTable table =
      page_table(table_of<BenchEnd>(
                     bench.ends, {{text_column("method"), method},
                                  {text_column("mesh"), mesh},
                                  {text_column("verdict"), along(&BenchEnd::verdict, verdict_name)},
                                  {{"95 %", "", "mm", 3}, along(&BenchEnd::gap, &MethodGap::surfaces, p95)},
                                  {{"same vertex", "", "mm", 3}, vertex}}),
                 "Where each method ends, beside " + bench.methods.front().name);
  for (size_t k = 0; k < bench.ends.size(); ++k) {
    const BenchEnd& end = bench.ends[k];
    const bool is_good = (end.verdict == Verdict::Reference || end.verdict == Verdict::SameEquilibrium) &&
                         doubts_of_shown(bench).empty();
    table.rows[k][2].tone = is_good ? Tone::Good : Tone::Caution;
    table.rows[k][2].remark = end.failure;
  }
  return table;
}

PageTable work_table(const Benchmark& bench) {
  return page_table(
      chosen(run_table(bench, bench.runs), {"method", "mesh", "tolerance", "wall_median_s", "wall_best_s",
                                            "cpu_median_s", "cpu_in_factorisations", "iterations",
                                            "gradients", "hessians", "factorisations", "peak_memory_mb"}),
      "Work of every run",
      "Wall and CPU time are medians over the repeats, best: the least wall time of one. A unit is the CPU "
      "time of a Hessian and its factorisation on the same mesh in the same run. Memory is what terms and "
      "solve add to the process.");
}

PageTable errors_table(const Benchmark& bench) {
  PageTable table = page_table(
      chosen(run_table(bench, bench.runs),
             {"method", "mesh", "tolerance", "status", "residual", "algebraic_max_mm", "algebraic_rms_mm",
              "discretisation_mm", "method_mm", "total_mm", "mean_to_closed_mm"}),
      "Errors of every run",
      "Algebraic: of the vertex farthest from the equilibrium on the same mesh, and the root of the mean "
      "square (rms) over all. Total: greatest algebraic, mesh and method together. Distances to a given "
      "closed "
      "surface are means of both directions.");
  for (size_t k = 0; k < table.rows.size(); ++k) {
    PageCell& status = table.rows[k][3];
    status = {spaced(status.text), bench.runs[k].status == Status::Converged ? Tone::Plain : Tone::Caution};
  }
  return table;
}

PageTable phases_table(const Benchmark& bench) {
  std::vector<BenchRun> last;
  std::set<std::string> phases;
  for (size_t k = 0; k < bench.runs.size(); ++k) {
    const BenchRun& run = bench.runs[k];
    if (k + 1 < bench.runs.size() && bench.runs[k + 1].method == run.method &&
        bench.runs[k + 1].mesh == run.mesh)
      continue;
    last.push_back(run);
    for (const auto& [phase, seconds] : run.phase_s) phases.insert(phase);
  }
  Table table = chosen(run_table(bench, last), {"method", "mesh"});
  for (const std::string& phase : phases) {
    table.columns.push_back({spaced(phase), "", "s", 3});
    for (size_t r = 0; r < last.size(); ++r) {
      const auto found = last[r].phase_s.find(phase);
      table.rows[r].emplace_back(found == last[r].phase_s.end() ? TableCell() : TableCell(found->second));
    }
  }
  return page_table(table, "Wall time by phase, of the fastest repeat at the tightest tolerance run");
}

}  // namespace

std::string benchmark_page(const Benchmark& bench) {
  Page page{.title = "Benchmark of " + bench.scene_title};
  page.lead = recommendation(bench, kTotalAccuracies[1]);
  if (bench.is_cancelled) page.lead += " (cancelled before the end)";
  const std::string doubted = doubts_of_shown(bench);
  if (!doubted.empty()) page.lead += "; " + doubted;
  page.tone = bench.is_cancelled || !doubted.empty() ? Tone::Caution : Tone::Plain;
  page.sections.push_back(recommendation_section(bench));
  if (bench.shown) page.sections.push_back(shape_section("Shape", *bench.shown));
  page.sections.push_back(plots_section(bench));
  page.sections.push_back({"Time to an accuracy", {page_times(bench)}});
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
