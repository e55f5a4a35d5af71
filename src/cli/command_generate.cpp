#include "cli/commands.hpp"
#include "cli/shape_scenes.hpp"
#include "mesh/generators/mitral.hpp"
#include "scene/import.hpp"

#include <CLI/CLI.hpp>

#include <cstdio>
#include <memory>
#include <string>

namespace coapt::cli {
namespace {

struct Arguments {
  std::string what, folder, contact, pressure, membrane = "tension_field";
  int triangles = 2500;
  unsigned seed = 0;
};

void add_common_options(CLI::App& command, Arguments& arguments) {
  command.add_option("-o,--output", arguments.folder, "Folder to write into")->required();
  command
      .add_option("--contact", arguments.contact,
                  "Contact term of the scene (default: barrier for a valve, none for a shape)")
      ->check(CLI::IsMember({"none", "barrier", "facet"}));
  command
      .add_option("--membrane", arguments.membrane,
                  "Leaflets of a valve: a tension field with bending, or for comparison one that resists "
                  "compression")
      ->check(CLI::IsMember({"tension_field", "stvk"}))
      ->capture_default_str();
  command
      .add_option("--pressure", arguments.pressure, "Pressure model of the scene (default: what suits it)")
      ->check(CLI::IsMember({"follower", "frozen", "volume", "field"}));
}

ImportOptions import_options(const Arguments& arguments) {
  ImportOptions options;
  if (!arguments.contact.empty()) options.contact = arguments.contact;
  options.membrane = arguments.membrane;
  if (!arguments.pressure.empty()) options.pressure_model = arguments.pressure;
  return options;
}

void announce(const Arguments& arguments) {
  const std::string scene = (std::filesystem::path(arguments.folder) / "scene.json").string();
  std::printf("written: %s\nnext:    coapt solve %s\n", scene.c_str(), scene.c_str());
}

void generate(const Arguments& arguments) {
  if (arguments.what == "mitral") {
    MitralOptions options;
    options.triangles = arguments.triangles;
    options.seed = arguments.seed;
    write_valve_scene(mitral_valve(options), arguments.folder, import_options(arguments));
  } else {
    write_shape_scene(arguments.what, {arguments.triangles, arguments.contact, arguments.pressure},
                      arguments.folder);
  }
  announce(arguments);
}

}  // namespace

void add_generate_command(CLI::App& app, int& /*exit_code*/) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* command =
      app.add_subcommand("generate", "Write a valve or a simple shape with a scene that is ready to solve");
  std::string shapes = "mitral";
  for (const std::string& name : shape_names()) shapes += ", " + name;
  command->add_option("SHAPE", arguments->what, shapes)->required();
  command->add_option("--triangles", arguments->triangles, "Wanted number of triangles")
      ->check(CLI::Range(1, 10'000'000))
      ->capture_default_str();
  command
      ->add_option("--seed", arguments->seed, "Mitral: 0 is the mean valve, any other draws its dimensions")
      ->capture_default_str();
  add_common_options(*command, *arguments);
  command->callback([arguments] { generate(*arguments); });
}

void add_import_command(CLI::App& app, int& /*exit_code*/) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* command =
      app.add_subcommand("import", "Write a scene from a valve JSON with its meshes beside it");
  command->add_option("VALVE", arguments->what, "Valve JSON")->required();
  add_common_options(*command, *arguments);
  command->callback([arguments] {
    for (const std::string& warning :
         import_valve(arguments->what, arguments->folder, import_options(*arguments)))
      std::printf("warning: %s\n", warning.c_str());
    announce(*arguments);
  });
}

}  // namespace coapt::cli
