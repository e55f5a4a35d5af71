#include "cli/commands.hpp"
#include "cli/exit_code.hpp"
#include "cli/progress.hpp"
#include "cli/solvers.hpp"
#include "cli/study_options.hpp"
#include "cli/table_cell.hpp"
#include "core/error.hpp"
#include "formats/json/units.hpp"
#include "tuning/sensitivity_study.hpp"

#include <CLI/CLI.hpp>

#include <cstdio>
#include <memory>

namespace coapt::cli {
namespace {

struct SensitivityArguments : StudyArguments {
  std::vector<std::string> parameters;
  std::string perturbation;
  bool starts_anew = false;
};

// "5%" or "0.05".
double share(const std::string& text) {
  const bool is_percent = !text.empty() && text.back() == '%';
  const std::string number = is_percent ? text.substr(0, text.size() - 1) : text;
  try {
    return quantity_value(number, kDimensionless) * (is_percent ? 0.01 : 1);
  } catch (const InputError&) {
    throw InputError("--perturb: \"" + text + "\" is no share; write 5% or 0.05");
  }
}

void print_parameter_header(bool has_solves, bool starts_anew) {
  std::printf("mean distances in mm, per 100 %% of each parameter; %s\n",
              !has_solves   ? "exact derivatives at the first solution"
              : starts_anew ? "solves start from the scene's own shape"
                            : "solves start from the first solution");
  std::printf("  %-32s %12s %-7s %10s %10s %11s %8s\n", "parameter", "value", "", "movement", "error",
              has_solves ? "iterations" : "", "s");
}

void print_row(const ParameterSensitivity& p) {
  std::printf("  %-32s %12.6g %-7s", p.name.c_str(), p.value, p.unit.c_str());
  print_cell(p.movement, " %10.3f");
  print_cell(p.error_change, " %10.3f");
  if (p.runs.size() == 2)
    std::printf("   %4d %4d", p.runs[0].iterations, p.runs[1].iterations);
  else
    std::printf("   %9s", "");
  std::printf(" %8.2f", p.wall_s);
  for (const SensitivityRun& run : p.runs)
    if (run.status != Status::Converged)
      std::printf("  times %g: %s, residual %.1e", run.factor, std::string(status_name(run.status)).c_str(),
                  run.residual);
  std::printf("\n");
  if (!p.message.empty()) std::printf("    solved again: %s\n", p.message.c_str());
  std::fflush(stdout);
}

void study(const SensitivityArguments& arguments, int& exit_code) {
  listen_for_interrupts();
  const Scene scene = load_scene(arguments.scene);
  SensitivityOptions options;
  options.parameters = arguments.parameters;
  if (!arguments.perturbation.empty()) options.perturbation = share(arguments.perturbation);
  options.starts_anew = arguments.starts_anew;
  bool has_header = false;
  options.report = [&](const ParameterSensitivity& found) {
    end_progress();
    if (!has_header)
      print_parameter_header(options.perturbation.has_value() || arguments.starts_anew,
                             arguments.starts_anew);
    has_header = true;
    print_row(found);
  };
  const std::filesystem::path folder = arguments.prepared_folder(scene);
  const SensitivityStudy found = study_sensitivity(scene, all_solvers(), options, arguments.options());
  end_progress();
  for (const std::string& reason : found.left_out) std::printf("left out: %s\n", reason.c_str());
  const SensitivityRun& base = found.base;
  std::printf("first solve: %s, residual %.1e, %d iterations, %.2f s",
              std::string(status_name(base.status)).c_str(), base.residual, base.iterations, base.wall_s);
  if (base.to_reference) std::printf(", mean distance to the reference %.3f mm", base.to_reference->mean);
  std::printf("\n");
  if (base.status != Status::Converged) std::printf("without it there is nothing to compare with\n");
  if (found.is_cancelled)
    std::printf("cancelled: only %zu parameters were studied to the end\n", found.parameters.size());
  write_sensitivity(folder, found);
  std::printf("written to %s (sensitivity.json, sensitivity.csv)\n", folder.string().c_str());
  exit_code = found.has_converged() ? kConverged : kNotConverged;
}

}  // namespace

void add_sensitivity_command(CLI::App& app, int& exit_code) {
  const auto arguments = std::make_shared<SensitivityArguments>();
  CLI::App* command = app.add_subcommand(
      "sensitivity",
      "How far the solution moves with each parameter, by exact derivatives or by finite changes");
  add_study_arguments(*command, *arguments);
  command->add_option(
      "--parameters", arguments->parameters,
      "TERM.KEY ..., such as chords.length_scale or chords.diameter (default: all numbers of all "
      "elastic terms that may be changed so far)");
  command->add_option("--perturb", arguments->perturbation,
                      "Make each smaller and larger by this share, such as 5%, and solve again");
  command->add_flag("--from-start", arguments->starts_anew,
                    "Solve each again, from the scene's own start instead of the first solution");
  command->callback([arguments, &exit_code] { study(*arguments, exit_code); });
}

}  // namespace coapt::cli
