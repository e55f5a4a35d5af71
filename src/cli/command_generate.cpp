#include "cli/commands.hpp"
#include "cli/scene_arguments.hpp"
#include "cli/shape_scenes.hpp"
#include "mesh/generators/mitral.hpp"
#include "scene/import.hpp"

#include <CLI/CLI.hpp>

#include <memory>
#include <string>

namespace coapt::cli {
namespace {

struct Arguments : SceneArguments {
  std::string what;
  int triangles = 2500;
  unsigned seed = 0;
};

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
  announce_scene(arguments.folder);
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
  add_scene_options(*command, *arguments);
  command->callback([arguments] { generate(*arguments); });
}

}  // namespace coapt::cli
