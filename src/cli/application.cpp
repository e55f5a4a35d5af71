#include "cli/application.hpp"

#include "cli/argument_errors.hpp"
#include "cli/command_line.hpp"
#include "cli/commands.hpp"
#include "cli/option_words.hpp"
#include "core/components.hpp"
#include "core/error.hpp"

#include <cstdio>
#include <vector>

namespace coapt::cli {
namespace {

std::string version_text() {
  std::string text = "coapt " + version() + "\n";
  for (const Component& component : components())
    text += "  " + std::string(component.present ? "with    " : "without ") + component.name + " (" +
            component.licence + "): " + component.gives + "\n";
  return text + "Licence: " + combined_licence();
}

void print_commands(const CLI::App& app) {
  for (const CLI::App* command : shown_commands(app))
    std::printf("  coapt %-13s %s\n", command->get_name().c_str(), command->get_description().c_str());
}

// The options that every command has, which are obeyed before it begins.
void add_session_options(CLI::App& command, Session& session, TextOutput& text) {
  CLI::Option* json =
      command.add_flag("--json", session.prints_json,
                       "Print one JSON document with what was found, or {\"error\": [...]}, instead of text");
  command
      .add_flag("-q,--quiet", session.is_quiet,
                "Print nothing but errors and warnings, on the standard error")
      ->excludes(json);
  command.add_flag("--verbose", session.is_verbose, "Show every iterate of a solve on the standard error");
  command.parse_complete_callback([&session, &text] {
    if (session.prints_json)
      text.turn_away(session.is_verbose ? TextPlace::StandardError : TextPlace::Nowhere);
    else if (session.is_quiet)
      text.turn_away(TextPlace::Nowhere);
  });
}

}  // namespace

std::unique_ptr<CLI::App, void (*)(CLI::App*)> application(Session& session, TextOutput& text) {
  std::unique_ptr<CLI::App, void (*)(CLI::App*)> app(
      new CLI::App("Closed, loaded equilibria of thin membranes by direct energy minimisation", "coapt"),
      [](CLI::App* owned) { delete owned; });
  app->require_subcommand(1);
  app->set_version_flag("--version", version_text, "Version, components and licence");
  for (const auto add :
       {add_solve_command,       add_check_command,   add_generate_command,     add_import_command,
        add_chords_command,      add_export_command,  add_schema_command,       add_mesh_study_command,
        add_sensitivity_command, add_tune_command,    add_tune_regions_command, add_intervene_command,
        add_study_command,       add_compare_command, add_register_command,     add_bench_command,
        add_stress_command,      add_image_command,   add_phantom_command,      add_segment_command,
        add_close_command,       add_pages_command})
    add(*app, session);
  const auto every = [](const CLI::App*) { return true; };
  for (CLI::App* command : app->get_subcommands(every)) {
    const std::vector<CLI::App*> parts = command->get_subcommands(every);  // as of `image`
    for (CLI::App* part : parts) add_session_options(*part, session, text);
    if (parts.empty()) add_session_options(*command, session, text);
  }
  app->footer(
      "Exit codes: 0 converged, or done what was asked; 1 not converged (result written), or a check did not "
      "hold; 2 bad input; 3 internal error or too little memory; 4 converged (result written) but the "
      "stability of a result is in doubt; 5 what was computed could not be written.");
  return app;
}

void run_application(const std::vector<std::string>& given, Session& session, TextOutput& text) {
  const auto app = application(session, text);
  if (given.empty()) print_commands(*app);
  const std::vector<std::string> arguments = with_help_option(given);
  try {
    app->parse(std::vector<std::string>(arguments.rbegin(),
                                        arguments.rend()));  // from the last on, as CLI11 wants them
  } catch (const CLI::Success& wanted) {                     // help or version
    if (const auto unknown = unknown_command(*app, arguments)) throw InputError(*unknown);
    session.exit_code = app->exit(wanted);
  } catch (const CLI::ParseError& error) {
    throw InputError(argument_error(*app, error, arguments));
  }
}

}  // namespace coapt::cli
