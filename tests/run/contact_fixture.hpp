// A folder with meshes and scenes that are run as a user runs them.
#pragma once

#include "core/error.hpp"
#include "formats/mesh_io.hpp"
#include "run/run.hpp"
#include "solve/solve_scene.hpp"
#include "support/sheets.hpp"
#include "support/temporary_folder.hpp"

#include <gtest/gtest.h>

#include <string>

namespace coapt {

class ContactSceneTest : public testing::Test {
 protected:
  Scene scene_of(const std::string& text) const { return load_scene(folder_.write("scene.json", text)); }

  RunReport run_scene(const std::string& text) const {
    RunOptions options;
    options.writes = false;
    options.factorisations = built_in_factorisations();
    return run(scene_of(text), scene_solvers(), options);
  }

  // What a scene is refused for.
  std::string refusal(const std::string& text) const {
    try {
      run_scene(text);
      return "accepted";
    } catch (const InputError& error) {
      return error.what();
    }
  }

  void write(const std::string& name, const TriangleMesh& mesh) const {
    write_mesh(folder_.path() / name, mesh);
  }

  TemporaryFolder folder_;
};

}  // namespace coapt
