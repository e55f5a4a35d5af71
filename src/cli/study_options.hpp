// Options that every command with many solves has.
#pragma once

#include "cli/session.hpp"
#include "run/branches.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace coapt::cli {

struct StudyArguments {
  std::string scene, folder, solver;
  double tolerance = 0, max_seconds = 0;  // 0: not given
  std::optional<int> damped_steps;

  RunOptions options(const Session& session) const;
  // Where the files go: `-o`, or the scene's result folder. Throws InputError where that is not allowed, and
  // where a file of one of these names, see refuse_replaced_inputs(), would take the place of an input.
  std::filesystem::path folder_for(const Scene& read, const std::vector<std::string>& names,
                                   std::vector<std::filesystem::path> others = {}) const;
};

// For a number given as an option: empty, or what is wrong with it. CLI11's own checks let NaN pass.
std::string positive_defect(const std::string& text);

// "newton, lbfgs" as a list.
std::vector<std::string> comma_list(const std::string& text);

// --damped-steps.
void add_path_option(CLI::App& command, std::optional<int>& damped_steps);

// SCENE, -o, --tolerance, --max-seconds, --damped-steps.
void add_run_arguments(CLI::App& command, StudyArguments& arguments);

// The same and --solver.
void add_study_arguments(CLI::App& command, StudyArguments& arguments);

// --branches, --branch-kick, --branch-seed.
void add_branch_options(CLI::App& command, BranchSearch& search);

}  // namespace coapt::cli
