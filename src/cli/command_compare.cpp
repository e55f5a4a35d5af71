#include "cli/commands.hpp"
#include "cli/exit_code.hpp"
#include "cli/progress.hpp"
#include "cli/solvers.hpp"
#include "cli/study_options.hpp"
#include "cli/table_cell.hpp"
#include "study/comparison_report.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstdio>
#include <memory>

namespace coapt::cli {
namespace {

struct CompareArguments : StudyArguments {
  std::string methods, reference, closed;
  bool prints_json = false;
  BranchSearch branches = {.starts = 0};
};

// Of those that are usually compared what this build has.
std::vector<std::string> usual_methods(const std::vector<std::string>& known) {
  std::vector<std::string> methods;
  for (const char* name : {"newton", "lbfgs", "dynamic", "mass-spring", "xpbd"})
    if (std::find(known.begin(), known.end(), name) != known.end()) methods.emplace_back(name);
  return methods;
}

void print_header(bool has_closed) {
  std::printf("  %-12s %-16s %9s %9s %9s %9s", "method", "status", "mean", "95 %", "max", "vertex");
  if (has_closed) std::printf(" %9s %9s", "closed", "95 %");
  std::printf(" %9s %9s %9s %6s %9s %14s %7s %8s %8s\n", "orifice", "area +-", "coapt.", "inter.", "residual",
              "energy", "iter.", "CPU s", "wall s");
}

void print_distances(const ComparedMethod& method, bool has_closed) {
  using Figures = std::optional<DistanceFigures>;
  Figures to_reference, to_closed;
  if (method.gap && method.gap->surfaces) to_reference = both_directions(*method.gap->surfaces);
  if (method.run->report.reference) to_closed = both_directions(*method.run->report.reference);
  const auto print = [](const Figures& figures, double DistanceFigures::*figure) {
    print_cell(figures ? std::optional((*figures).*figure) : std::nullopt, " %9.3g");
  };
  for (const auto figure : {&DistanceFigures::mean, &DistanceFigures::p95, &DistanceFigures::max})
    print(to_reference, figure);
  print_cell(method.gap ? std::optional(method.gap->same_vertex.max) : std::nullopt, " %9.3g");
  if (!has_closed) return;
  for (const auto figure : {&DistanceFigures::mean, &DistanceFigures::p95}) print(to_closed, figure);
}

void print_row(const ComparedMethod& method, bool has_closed) {
  if (method.run) {
    const Result& result = method.run->report.result;
    const Metrics& metrics = method.run->report.metrics;
    std::printf("  %-12s %-16s", method.name.c_str(), std::string(status_name(result.status)).c_str());
    print_distances(method, has_closed);
    print_cell(metrics.orifice_area_mm2, " %9.2f");
    print_cell(
        metrics.leaflet_area_open_mm2 > 0 ? std::optional(metrics.leaflet_area_change_mm2) : std::nullopt,
        " %9.2f");
    print_cell(metrics.coaptation_area_mm2, " %9.2f");
    std::printf(" %6ld %9.1e %14.8g %7d %8.2f %8.2f\n", metrics.intersections, result.residual, result.energy,
                result.iterations, result.cpu_s, result.wall_s);
  } else {
    std::printf("  %-12s failed\n", method.name.c_str());
  }
  std::printf("      %s\n", method.message.c_str());
  std::fflush(stdout);
}

void compare(const CompareArguments& arguments, int& exit_code) {
  listen_for_interrupts();
  const Scene scene = load_scene(arguments.scene);
  const SolverTable solvers = all_solvers();
  RunOptions run = arguments.options();
  run.folder = arguments.folder;
  ComparisonOptions options;
  options.methods =
      arguments.methods.empty() ? usual_methods(known_methods(solvers)) : comma_list(arguments.methods);
  options.reference = arguments.reference;
  options.closed = arguments.closed;
  options.branches = arguments.branches;
  const bool has_closed = scene.closed_surface.has_value() || !arguments.closed.empty();
  bool has_header = false;
  options.report = [&](const ComparedMethod& method) {
    end_progress();
    if (arguments.prints_json) return;
    if (!has_header) print_header(has_closed);
    has_header = true;
    print_row(method, has_closed);
  };
  const Comparison found = compare_methods(scene, solvers, options, run);
  write_comparison(found.folder, found);
  if (arguments.prints_json)
    std::fputs(comparison_json(found).c_str(), stdout);
  else
    std::printf(
        "distances in mm to %s; written to %s (compare.json, compare.csv, report.html and a folder "
        "for each method)\n",
        found.reference().name.c_str(), found.folder.string().c_str());
  exit_code = found.has_converged() ? kConverged : kNotConverged;
}

}  // namespace

void add_compare_command(CLI::App& app, int& exit_code) {
  const auto arguments = std::make_shared<CompareArguments>();
  CLI::App* command = app.add_subcommand(
      "compare", "One scene by several methods: distances between the results, figures, run times");
  add_run_arguments(*command, *arguments);
  command->add_option("--methods", arguments->methods,
                      "Names of solvers, and mass-spring (springs for membranes, by dynamics), with commas "
                      "between them (default: newton,lbfgs,dynamic,mass-spring,xpbd as far as this build "
                      "has them)");
  command->add_option("--reference", arguments->reference,
                      "That of the methods which the others are compared with (default: newton, else the "
                      "first)");
  command->add_option("--closed", arguments->closed,
                      "Given closed surface, in the unit of the scene's mesh (default: the scene's)");
  add_branch_options(*command, arguments->branches);
  command->add_flag("--json", arguments->prints_json, "Print compare.json instead of the table");
  command->callback([arguments, &exit_code] { compare(*arguments, exit_code); });
}

}  // namespace coapt::cli
