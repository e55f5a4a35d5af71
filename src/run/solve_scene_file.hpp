// A scene file solved in one call, as `coapt solve` does it.
#pragma once

#include "run/run.hpp"

#include <filesystem>

namespace coapt {

// Reads the scene file and runs it with the solvers that need no adapter (scene_solvers()); other tables, and
// a scene that is changed before, take run(). Results go where `options` says, else the scene, else into
// `result` beside the file; with options.writes false nowhere. Throws InputError as load_scene() and run().
RunReport solve_scene(const std::filesystem::path& file, const RunOptions& options = {});

}  // namespace coapt
