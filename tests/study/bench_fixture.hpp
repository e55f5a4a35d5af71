// A clamped disc under pressure, and solvers that give up, for tests of errors against time.
#pragma once

#include "core/error.hpp"
#include "formats/mesh_io.hpp"
#include "mesh/shapes.hpp"
#include "run/run.hpp"
#include "solve/solve_scene.hpp"
#include "support/temporary_folder.hpp"

#include <gtest/gtest.h>

namespace coapt {

// Gives up where it stands.
class IdleSolver : public Solver {
 public:
  std::string_view name() const override { return "idle"; }
  bool follows_path() const override { return true; }
  Status minimize(Objective&, Vector&, Monitor&) override { return Status::Stalled; }
};

class BenchFixture : public testing::Test {
 protected:
  // One smooth equilibrium; the centre rises by some 1.4 mm. A disc of radius 10 mm.
  Scene disc_scene(int triangles = 54) {
    write_mesh(folder_.path() / "disc.obj", disc(10, triangles));
    return load_scene(folder_.write("disc.json", R"({ "mesh": { "file": "disc.obj" },
      "boundary": [{ "nodes": "boundary", "fix": true }],
      "terms": [{ "type": "cst_stvk", "young": "1 MPa", "poisson": 0.3, "thickness": "0.1 mm" },
                { "type": "load_pressure", "value": "0.1 kPa", "model": "follower" }] })"));
  }

  static SolverTable solvers() {
    SolverTable table = scene_solvers();
    table["idle"] = [](const SolverOptions&) { return std::make_unique<IdleSolver>(); };
    table["broken"] = [](const SolverOptions&) -> std::unique_ptr<Solver> {
      throw InputError("it is broken, <b>really</b>");
    };
    return table;
  }

  template <typename Act>
  static std::string refusal(const Act& act) {
    try {
      act();
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }

  TemporaryFolder folder_;
  RunOptions run_;
};

}  // namespace coapt
