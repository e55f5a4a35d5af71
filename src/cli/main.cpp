// The command `coapt`: arguments in, exit code out.
#include "cli/argument_errors.hpp"
#include "cli/command_line.hpp"
#include "cli/commands.hpp"
#include "cli/exit_code.hpp"
#include "core/components.hpp"
#include "core/error.hpp"

#include <cstdio>
#include <iostream>
#include <string>
#include <vector>

namespace {

std::string version_text() {
  std::string text = "coapt " + coapt::version() + "\n";
  for (const coapt::Component& component : coapt::components())
    text += "  " + std::string(component.present ? "with    " : "without ") + component.name + " (" +
            component.licence + "): " + component.gives + "\n";
  return text + "Licence: " + coapt::combined_licence();
}

int run_command(int argc, char** argv) {
  using namespace coapt::cli;
  CLI::App app("Closed, loaded equilibria of thin membranes by direct energy minimisation", "coapt");
  app.require_subcommand(1);
  app.set_version_flag("--version", version_text, "Version, components and licence");
  int exit_code = kConverged;
  add_solve_command(app, exit_code);
  add_check_command(app, exit_code);
  add_generate_command(app, exit_code);
  add_import_command(app, exit_code);
  add_chords_command(app, exit_code);
  add_export_command(app, exit_code);
  add_schema_command(app, exit_code);
  add_mesh_study_command(app, exit_code);
  add_sensitivity_command(app, exit_code);
  add_tune_command(app, exit_code);
  add_tune_regions_command(app, exit_code);
  add_intervene_command(app, exit_code);
  add_study_command(app, exit_code);
  add_compare_command(app, exit_code);
  add_register_command(app, exit_code);
  add_bench_command(app, exit_code);
  add_stress_command(app, exit_code);
  add_segment_command(app, exit_code);
  add_close_command(app, exit_code);
  app.footer(
      "Exit codes: 0 converged, 1 not converged (result written), 2 bad input, 3 internal error, 4 converged "
      "(result written) but its stability is in doubt.");
  const std::vector<std::string> arguments = with_help_option({argv + 1, argv + argc});
  try {
    app.parse(std::vector<std::string>(arguments.rbegin(),
                                       arguments.rend()));  // from the last on, as CLI11 wants them
  } catch (const CLI::Success& wanted) {                    // help or version
    return app.exit(wanted);
  } catch (const CLI::ParseError& error) {
    std::cerr << "coapt: error: " << argument_error(app, error, arguments) << "\n";
    return kBadInput;
  }
  return exit_code;
}

// Whether all that was printed has arrived: a full disk shows only when the buffers are emptied.
bool is_printed() { return std::cout.flush().good() && std::fflush(stdout) == 0 && std::ferror(stdout) == 0; }

}  // namespace

int main(int argc, char** argv) {
  try {
    const int exit_code = run_command(argc, argv);
    if (is_printed()) return exit_code;
    std::cerr << "coapt: error: the standard output cannot be written; is the disk full?\n";
    return coapt::cli::kBadInput;
  } catch (const coapt::InputError& error) {
    for (const std::string& defect : error.defects()) std::cerr << "coapt: error: " << defect << "\n";
    return coapt::cli::kBadInput;
  } catch (const std::exception& error) {
    std::cerr << "coapt: internal error: " << error.what() << "\n";
    return coapt::cli::kInternal;
  }
}
