// The options that every command has which writes a valve's scene.
#pragma once

#include "exchange/import.hpp"

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace coapt::cli {

struct SceneArguments {
  std::string folder, contact, pressure, membrane = "tension_field";
};

// pressures: the models that the command can write.
void add_scene_options(CLI::App& command, SceneArguments& arguments,
                       const std::vector<std::string>& pressures);
ImportOptions import_options(const SceneArguments& arguments);

// Says where the scene is and how to solve it. Returns the document of the command.
std::string announce_scene(const std::string& folder, const std::vector<std::string>& warnings = {});

}  // namespace coapt::cli
