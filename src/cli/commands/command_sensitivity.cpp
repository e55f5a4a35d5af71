#include "cli/command_line.hpp"
#include "cli/commands.hpp"
#include "cli/output_folder.hpp"
#include "cli/progress.hpp"
#include "cli/row_printer.hpp"
#include "cli/session.hpp"
#include "cli/solvers.hpp"
#include "cli/study_options.hpp"
#include "core/error.hpp"
#include "formats/json/units.hpp"
#include "formats/whole_file.hpp"
#include "results/standing.hpp"
#include "tuning/sensitivity_study.hpp"

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

void print_caption(bool has_solves, bool starts_anew) {
  std::printf("mean distances, per 100 %% of each parameter; %s\n",
              !has_solves   ? "exact derivatives at the first solution"
              : starts_anew ? "solves start from the scene's own shape"
                            : "solves start from the first solution");
}

void print_parameter(const ParameterSensitivity& found, RowPrinter& print) {
  const auto iterations = [](size_t run) {
    return [run](const ParameterSensitivity& p) {
      return p.runs.size() == 2 ? TableCell(p.runs[run].iterations) : TableCell();
    };
  };
  print(table_of<ParameterSensitivity>({&found, 1},
                                       {{text_column("parameter", "", 32), &ParameterSensitivity::name},
                                        {{"value", "", "", 6, -1, 12}, &ParameterSensitivity::value},
                                        {text_column("unit", "", 7), &ParameterSensitivity::unit},
                                        {{"movement", "", "mm", 4, 3}, &ParameterSensitivity::movement},
                                        {{"error", "", "mm", 4, 3}, &ParameterSensitivity::error_change},
                                        {{"iterations smaller"}, iterations(0)},
                                        {{"larger"}, iterations(1)},
                                        {{"wall", "", "s", 4, 2}, &ParameterSensitivity::wall_s}}));
  for (const SensitivityRun& run : found.runs)
    if (run.status != Status::Converged)
      std::printf("    times %g: %s, residual %.1e\n", run.factor,
                  std::string(status_name(run.status)).c_str(), run.residual);
  if (!found.message.empty()) std::printf("    solved again: %s\n", found.message.c_str());
  std::fflush(stdout);
}

void study(const SensitivityArguments& arguments, Session& session) {
  listen_for_interrupts();
  const Scene scene = load_scene(arguments.scene);
  SensitivityOptions options;
  options.parameters = arguments.parameters;
  if (!arguments.perturbation.empty()) options.perturbation = share(arguments.perturbation);
  options.starts_anew = arguments.starts_anew;
  bool has_caption = false;
  RowPrinter print;
  options.report = [&](const ParameterSensitivity& found) {
    end_progress();
    if (!has_caption)
      print_caption(options.perturbation.has_value() || arguments.starts_anew, arguments.starts_anew);
    has_caption = true;
    print_parameter(found, print);
  };
  const OutputFolder output(arguments.folder_for(scene, {"sensitivity.json", "sensitivity.csv"}));
  const std::filesystem::path& folder = output.path();
  const SensitivityStudy found = study_sensitivity(scene, all_solvers(), options, arguments.options(session));
  end_progress();
  for (const std::string& reason : found.left_out) std::printf("left out: %s\n", reason.c_str());
  const SensitivityRun& base = found.base;
  std::printf("first solve: %s, residual %.1e, %d iterations, %.2f s",
              std::string(status_name(base.status)).c_str(), base.residual, base.iterations, base.wall_s);
  if (base.to_reference) std::printf(", mean distance to the reference %.3f mm", base.to_reference->mean);
  std::printf("\n");
  if (!found.doubts.empty())
    std::fputs(wrapped("in doubt: " + joined_doubts(found.doubts), 2).c_str(), stdout);
  if (base.status != Status::Converged) std::printf("without it there is nothing to compare with\n");
  if (found.is_cancelled)
    std::printf("cancelled: only %zu parameters were studied to the end\n", found.parameters.size());
  write_sensitivity(folder, found);
  session.document = formats::read_whole(folder / "sensitivity.json");
  std::printf("written to %s (sensitivity.json, sensitivity.csv)\n", folder.string().c_str());
  session.exit_code = exit_code_of(found.has_converged(), {found.doubts});
}

}  // namespace

void add_sensitivity_command(CLI::App& app, Session& session) {
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
  command->callback([arguments, &session] { study(*arguments, session); });
}

}  // namespace coapt::cli
