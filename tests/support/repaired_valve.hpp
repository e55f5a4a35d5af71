// A small generated valve whose scene gets interventions.
#pragma once

#include "core/error.hpp"
#include "exchange/import.hpp"
#include "run/run.hpp"
#include "scene/build/build.hpp"
#include "scene/build/scene_geometry.hpp"
#include "scene/file/scene_text.hpp"
#include "solve/solve_scene.hpp"
#include "support/temporary_folder.hpp"
#include "valve/generators/mitral.hpp"

#include <gtest/gtest.h>

namespace coapt {

class RepairedValve : public testing::Test {
 protected:
  RepairedValve() {
    write_valve_scene(mitral_valve({.triangles = 300, .preset = MitralPreset::Benchmark}), folder_.path(),
                      {.contact = "none"});
    text_ = scene_text(file_);
  }

  // interventions: JSON text of one or a list.
  Scene scene(const std::string& interventions = "[]") const {
    return parse_scene(with_interventions(text_, {interventions}, file_.string()), file_);
  }

  static SceneGeometry geometry(const Scene& scene) { return scene_geometry(scene); }

  static const ChordNetwork& network(const SceneGeometry& geometry) {
    return geometry.networks.begin()->second.network;
  }

  // Why a scene is refused.
  std::string refusal(const std::string& interventions) const {
    try {
      build(scene(interventions));
      return "accepted";
    } catch (const InputError& error) {
      return error.what();
    }
  }

  RunReport solved(const Scene& scene) const {
    RunOptions options;
    options.writes = false;
    return run(scene, scene_solvers(), options);
  }

  TemporaryFolder folder_;
  std::filesystem::path file_ = folder_.path() / "scene.json";
  std::string text_;
};

}  // namespace coapt
