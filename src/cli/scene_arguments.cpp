#include "cli/scene_arguments.hpp"

#include "cli/command_line.hpp"
#include "cli/written_document.hpp"

#include <cstdio>

namespace coapt::cli {

void add_scene_options(CLI::App& command, SceneArguments& arguments,
                       const std::vector<std::string>& pressures) {
  command.add_option("-o,--output", arguments.folder, "Folder to write into")->required();
  command
      .add_option("--contact", arguments.contact,
                  "Contact term of the scene (default: barrier for a valve, none for a shape)")
      ->check(CLI::IsMember({"none", "barrier", "facet"}));
  command
      .add_option("--membrane", arguments.membrane,
                  "Leaflets of a valve: a tension field with bending, or for comparison one that resists "
                  "compression, or springs along the mesh edges with bending")
      ->check(CLI::IsMember({"tension_field", "stvk", "spring"}))
      ->capture_default_str();
  command
      .add_option("--pressure", arguments.pressure, "Pressure model of the scene (default: what suits it)")
      ->check(CLI::IsMember(pressures));
}

ImportOptions import_options(const SceneArguments& arguments) {
  ImportOptions options;
  if (!arguments.contact.empty()) options.contact = arguments.contact;
  options.membrane = linear_leaflets(arguments.membrane).value();
  if (!arguments.pressure.empty()) options.pressure_model = arguments.pressure;
  return options;
}

std::string announce_scene(const std::string& folder, const std::vector<std::string>& warnings) {
  const std::string scene = (std::filesystem::path(folder) / "scene.json").string();
  std::printf("written: %s\nnext:    coapt solve %s\n", scene.c_str(), scene.c_str());
  return written_document({scene}, warnings);
}

}  // namespace coapt::cli
