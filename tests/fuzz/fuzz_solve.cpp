// Row S21: the solver on random tiny scenes. The result is finite and its status true, and between accepted
// iterates the energy does not rise where it is one and the same.
#include "fuzz/fuzz_target.hpp"
#include "fuzz/small_scene.hpp"
#include "scene/run.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace coapt::fuzz {
namespace {

constexpr double kTolerance = 1e-8;  // of small_scene()
constexpr double kRunaway = 100;     // times its size at the start

void judge_energies(const Result& result, Objective& objective, double extent) {
  double greatest = 0;
  for (const Iteration& iteration : result.trace) greatest = std::max(greatest, std::abs(iteration.energy));
  // Ten times what the solvers themselves take for rounding.
  const double rounding = 1e-11 * greatest + 1e-13 * objective.largest_force() * extent;
  for (size_t k = 1; k < result.trace.size(); ++k) {
    const Iteration &before = result.trace[k - 1], &now = result.trace[k];
    if (now.round != before.round || now.energy <= before.energy + rounding) continue;
    std::ostringstream text;
    text << "the energy does not rise; in iteration " << now.iteration << " from " << before.energy << " by "
         << now.energy - before.energy << ", rounding " << rounding << " mJ";
    throw Defect(text.str());
  }
}

}  // namespace

void run_target(std::string_view bytes) {
  static const Scratch scratch;
  const SmallScene small = small_scene(bytes);
  const auto mesh = scratch.write("mesh.obj", small.mesh);
  const Scene scene = parse_scene(small.scene, mesh.parent_path() / "scene.json");
  RunOptions options;
  options.writes = false;
  options.max_seconds = 10;
  RunReport found = run(scene, built_in_solvers(), options);
  const Result& result = found.report.result;
  require(result.q.allFinite(), "positions are finite");
  require(!result.message.empty(), "the status has a sentence");
  require(result.status != Status::Converged || result.residual <= kTolerance,
          "converged means a residual below the tolerance");
  require(std::isfinite(result.energy) || result.status == Status::NonFinite, "the energy is finite");
  // Of a shape that runs away the areas are known to the rounding of squared coordinates: nothing is judged.
  Objective& objective = *found.model.objective;
  const double extent = objective.extent(objective.unknowns(found.model.X));
  if (small.has_one_potential && objective.extent(result.q) < kRunaway * extent)
    judge_energies(result, objective, extent);
}

}  // namespace coapt::fuzz
