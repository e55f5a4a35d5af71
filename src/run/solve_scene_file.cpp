#include "run/solve_scene_file.hpp"

#include "solve/solve_scene.hpp"

namespace coapt {

RunReport solve_scene(const std::filesystem::path& file, const RunOptions& options) {
  return run(load_scene(file), scene_solvers(), options);
}

}  // namespace coapt
