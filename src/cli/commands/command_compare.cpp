#include "cli/command_line.hpp"
#include "cli/commands.hpp"
#include "cli/output_folder.hpp"
#include "cli/progress.hpp"
#include "cli/row_printer.hpp"
#include "cli/session.hpp"
#include "cli/solvers.hpp"
#include "cli/study_options.hpp"
#include "study/comparison_report.hpp"

#include <algorithm>
#include <cstdio>
#include <memory>

namespace coapt::cli {
namespace {

struct CompareArguments : StudyArguments {
  std::string methods, reference, closed;
  BranchSearch branches = {.starts = 0};
};

// Of those that are usually compared what this build has.
std::vector<std::string> usual_methods(const std::vector<std::string>& known) {
  std::vector<std::string> methods;
  for (const char* name : {"newton", "lbfgs", "dynamic", "dynamic-explicit", "mass-spring", "xpbd"})
    if (std::find(known.begin(), known.end(), name) != known.end()) methods.emplace_back(name);
  return methods;
}

// Figures that fit beside each other on a terminal; compare.csv has all. The message says what became of it.
void print_method(const ComparedMethod& method, bool has_closed, RowPrinter& print) {
  std::vector<std::string> columns = {"method", "mean_to_reference_mm", "max_to_reference_mm"};
  if (has_closed) columns.emplace_back("mean_to_closed_mm");
  columns.insert(columns.end(), {"orifice_area_mm2", "intersections", "residual", "energy_mj"});
  if (!has_closed) columns.emplace_back("iterations");
  columns.emplace_back("cpu_s");
  print(chosen(comparison_table({&method, 1}), columns));
  std::fputs(
      wrapped((method.run ? "" : "failed: ") + method.message + "; shares with newton: " + method.shares, 6)
          .c_str(),
      stdout);
  const Standing state = standing(method);
  if (!state.doubts.empty())
    std::fputs(wrapped("in doubt: " + joined_doubts(state.doubts), 6).c_str(), stdout);
  std::fflush(stdout);
}

void compare(const CompareArguments& arguments, Session& session) {
  listen_for_interrupts();
  const Scene scene = load_scene(arguments.scene);
  const SolverTable solvers = all_solvers();
  RunOptions run = arguments.options(session);
  const OutputFolder output(arguments.folder_for(scene, {"compare.json", "compare.csv", "compare.html"}));
  run.folder = output.path();
  ComparisonOptions options;
  options.methods =
      arguments.methods.empty() ? usual_methods(known_methods(solvers)) : comma_list(arguments.methods);
  options.reference = arguments.reference;
  options.closed = arguments.closed;
  options.branches = arguments.branches;
  const bool has_closed = scene.closed_surface.has_value() || !arguments.closed.empty();
  RowPrinter print;
  options.report = [&](const ComparedMethod& method) {
    end_progress();
    print_method(method, has_closed, print);
  };
  const Comparison found = compare_methods(scene, solvers, options, run);
  write_comparison(found.folder, found);
  session.document = comparison_json(found);
  std::printf(
      "distances in mm to %s, of surfaces\n"
      "written: %s: compare.json, compare.csv, compare.html and a folder for each method\n",
      found.reference().name.c_str(), found.folder.string().c_str());
  std::vector<std::vector<std::string>> doubts;
  for (const ComparedMethod& method : found.methods) doubts.push_back(standing(method).doubts);
  session.exit_code = exit_code_of(found.has_converged(), doubts);
}

}  // namespace

void add_compare_command(CLI::App& app, Session& session) {
  const auto arguments = std::make_shared<CompareArguments>();
  CLI::App* command = app.add_subcommand(
      "compare", "One scene by several methods: distances between the results, figures, run times");
  add_run_arguments(*command, *arguments);
  command->add_option("--methods", arguments->methods,
                      "Names of solvers with commas between them; mass-spring puts springs in the place of "
                      "membranes (default: newton,lbfgs,dynamic,dynamic-explicit,mass-spring,xpbd)");
  command->add_option("--reference", arguments->reference,
                      "That of the methods which the others are compared with (default: newton, else the "
                      "first)");
  command->add_option("--closed", arguments->closed,
                      "Given closed surface, in the unit of the scene's mesh (default: the scene's)");
  add_branch_options(*command, arguments->branches);
  command->callback([arguments, &session] { compare(*arguments, session); });
}

}  // namespace coapt::cli
