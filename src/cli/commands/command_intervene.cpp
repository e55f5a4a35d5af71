#include "cli/command_line.hpp"
#include "cli/commands.hpp"
#include "cli/output_folder.hpp"
#include "cli/progress.hpp"
#include "cli/row_printer.hpp"
#include "cli/session.hpp"
#include "cli/solvers.hpp"
#include "cli/study_options.hpp"
#include "results/result_warnings.hpp"
#include "results/standing.hpp"
#include "study/intervene.hpp"

#include <cstdio>
#include <memory>

namespace coapt::cli {
namespace {

struct InterveneArguments : StudyArguments {
  std::vector<std::string> edits, files;
};

void print_state(const char* name, const std::optional<RunReport>& run) {
  if (!run) return;
  const Result& result = run->report.result;
  const Standing state = standing(name, run->report);
  std::printf("%-6s  %s, residual %.1e, %d iterations, %.2f s\n", name, shown_status(state).c_str(),
              result.residual, result.iterations, result.wall_s);
  if (!state.doubts.empty()) std::printf("        in doubt: %s\n", joined_doubts(state.doubts).c_str());
  for (const std::string& warning : run->report.warnings) std::printf("        %s\n", warning.c_str());
}

void run_command(const InterveneArguments& arguments, Session& session) {
  listen_for_interrupts();
  InterveneOptions options;
  options.files.assign(arguments.files.begin(), arguments.files.end());
  options.edits = arguments.edits;
  options.report = [](const RunReport&) { end_progress(); };
  RunOptions run = arguments.options(session);
  const OutputFolder output(arguments.folder_for(
      load_scene(arguments.scene), {"intervene.json", "intervene.csv", "intervene.html"}, options.files));
  run.folder = output.path();
  const BeforeAfter found = intervene(arguments.scene, all_solvers(), options, run);
  write_intervene(found);
  session.document = intervene_json(found);
  print_state("before", found.before);
  print_state("after", found.after);
  print_table(change_table(defined_figures(changed_figures(found))));
  if (!found.after) std::printf("cancelled before the second solve\n");
  std::printf(
      "written to %s (intervene.json, intervene.csv, intervene.html and the folders before and after)\n",
      found.folder.string().c_str());
  std::vector<std::vector<std::string>> doubted;
  for (const auto* state : {&found.before, &found.after})
    if (*state) doubted.push_back(doubts((*state)->report));
  session.exit_code = exit_code_of(found.has_converged(), doubted);
}

}  // namespace

void add_intervene_command(CLI::App& app, Session& session) {
  const auto arguments = std::make_shared<InterveneArguments>();
  CLI::App* command = app.add_subcommand(
      "intervene", "A valve before and after its repair: both solved, with every figure of both");
  add_study_arguments(*command, *arguments);
  command
      ->add_option(
          "--edit", arguments->edits,
          "An intervention as JSON, such as '{\"type\": \"ring\", \"size\": \"30 mm\"}', behind those of "
          "the scene; may be given again")
      ->allow_extra_args(false);
  command->add_option("--edits", arguments->files, "File with an intervention or a list of them, as JSON");
  command->callback([arguments, &session] { run_command(*arguments, session); });
}

}  // namespace coapt::cli
