#include "cli/study_options.hpp"

#include "cli/command_line.hpp"
#include "cli/progress.hpp"
#include "cli/solvers.hpp"
#include "core/error.hpp"
#include "formats/text.hpp"
#include "run/replaced_inputs.hpp"
#include "tuning/first_order.hpp"

#include <charconv>
#include <utility>

namespace coapt::cli {
namespace {

constexpr int kMostSteps = 100000;  // as in a scene

// Of a number of steps; empty where it can be one.
std::string steps_defect(const std::string& text) {
  int steps = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), steps);
  if (error == std::errc() && end == text.data() + text.size() && steps >= 0 && steps <= kMostSteps)
    return "";
  return "expected a whole number from 0, which solves at once, to " + std::to_string(kMostSteps) +
         ", read " + text;
}

}  // namespace

RunOptions StudyArguments::options(const Session& session) const {
  RunOptions options;
  options.solver = solver;
  if (tolerance > 0) options.tolerance = tolerance;
  if (max_seconds > 0) options.max_seconds = max_seconds;
  options.damped_steps = damped_steps;
  options.factorisations = all_factorisations();
  options.checker = intersection_checker();
  show_progress(session, options);
  options.first_order = first_order_of_runs(all_solvers(), options);
  return options;
}

std::filesystem::path StudyArguments::folder_for(const Scene& read, const std::vector<std::string>& names,
                                                 std::vector<std::filesystem::path> others) const {
  std::filesystem::path path = folder.empty() ? result_folder(read) : std::filesystem::path(folder);
  refuse_replaced_inputs(read, path, names, std::move(others));
  return path;
}

std::string positive_defect(const std::string& text) {
  double number = 0;
  if (const auto reason = formats::read_number(text, number)) return *reason;
  return number > 0 ? "" : "expected a number above 0, read " + text;
}

std::vector<std::string> comma_list(const std::string& text) {
  std::vector<std::string> all;
  for (size_t from = 0; from != std::string::npos;) {
    const size_t comma = text.find(',', from);
    all.emplace_back(formats::trimmed(std::string_view(text).substr(from, comma - from)));
    from = comma == std::string::npos ? comma : comma + 1;
  }
  return all;
}

void add_path_option(CLI::App& command, std::optional<int>& damped_steps) {
  command
      .add_option("--damped-steps", damped_steps,
                  "Steps of all loads and of the prescribed motion along a damped path; 0 solves at once "
                  "(default: the scene's)")
      ->type_name("N")
      ->check(steps_defect);
}

void add_run_arguments(CLI::App& command, StudyArguments& arguments) {
  command.add_option("SCENE", arguments.scene, "Scene file (JSON)")->required();
  command.add_option("-o,--output", arguments.folder,
                     "Folder of the files (default: the scene's result folder)");
  command.add_option("--tolerance", arguments.tolerance, "On the residual (default: the scene's)")
      ->check(positive_defect);
  command.add_option("--max-seconds", arguments.max_seconds, "Of each solve (default: the scene's)")
      ->check(positive_defect);
  add_path_option(command, arguments.damped_steps);
}

void add_branch_options(CLI::App& command, BranchSearch& search) {
  auto* starts = command
                     .add_option("--branches", search.starts,
                                 "Look for other equilibria: solve again from N perturbed starts near the "
                                 "equilibrium, and N from the scene's own")
                     ->type_name("N")
                     ->check(CLI::Range(1, 1000));
  command
      .add_option("--branch-kick", search.kick,
                  "Greatest move of a node of these starts, over the mean edge length (default: 0.01)")
      ->check(positive_defect)
      ->needs(starts);
  command.add_option("--branch-seed", search.seed, "Of their random moves (default: 1)")->needs(starts);
}

void add_study_arguments(CLI::App& command, StudyArguments& arguments) {
  add_run_arguments(command, arguments);
  command.add_option("--solver", arguments.solver, "Solver (default: the scene's)");
}

}  // namespace coapt::cli
