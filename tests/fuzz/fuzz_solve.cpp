// Row S21: the solver on random tiny scenes. The result is finite and its status true, and between accepted
// iterates the energy does not rise where it is one and the same.
#include "fuzz/fuzz_target.hpp"
#include "run/run.hpp"
#include "solve/solve_scene.hpp"
#include "stress/energy_checker.hpp"
#include "stress/scenes/small_scene.hpp"

#include <cmath>

namespace coapt::fuzz {
namespace {

constexpr double kTolerance = 1e-8;  // of small_scene()

}  // namespace

void run_target(std::string_view bytes) {
  static const Scratch scratch;
  const SmallScene small = small_scene(bytes);
  const auto mesh = scratch.write("mesh.obj", small.mesh);
  const Scene scene = parse_scene(small.scene, mesh.parent_path() / "scene.json");
  RunOptions options;
  options.writes = false;
  options.max_seconds = 10;
  RunReport found = run(scene, scene_solvers(), options);
  const Result& result = found.report.result;
  require(result.q.allFinite(), "positions are finite");
  require(!result.message.empty(), "the status has a sentence");
  require(result.status != Status::Converged || result.residual <= kTolerance,
          "converged means a residual below the tolerance");
  require(std::isfinite(result.energy) || result.status == Status::NonFinite, "the energy is finite");
  if (!small.has_one_potential) return;
  const std::string rise = energy_rise(result, *found.model.objective, found.model.X);
  require(rise.empty(), "the energy does not rise; " + rise);
}

}  // namespace coapt::fuzz
