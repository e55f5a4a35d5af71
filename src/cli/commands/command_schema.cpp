#include "cli/command_line.hpp"
#include "cli/commands.hpp"
#include "cli/session.hpp"
#include "results/result_schema.hpp"
#include "scene/file/schema.hpp"

#include <iostream>
#include <memory>
#include <string>

namespace coapt::cli {

void add_schema_command(CLI::App& app, Session& session) {
  const auto which = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand("schema", "Print the JSON Schema of scene files or results");
  command->add_option("WHICH", *which, "scene or result")
      ->required()
      ->check(CLI::IsMember({"scene", "result"}));
  command->callback([which, &session] {
    session.document = *which == "scene" ? json_schema() : result_schema();
    std::cout << session.document;
  });
}

}  // namespace coapt::cli
