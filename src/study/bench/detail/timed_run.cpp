#include "study/bench/detail/timed_run.hpp"

#include "results/reference/registered_reference.hpp"
#include "scene/build/build.hpp"
#include "solve/peak_memory.hpp"

#include <algorithm>

namespace coapt {
namespace {

// Pre: at least one.
Spread spread(std::vector<double> seconds) {
  std::sort(seconds.begin(), seconds.end());
  const size_t count = seconds.size();
  return {0.5 * (seconds[(count - 1) / 2] + seconds[count / 2]), seconds.front()};
}

}  // namespace

TimedRun timed_run(const Scene& scene, const SceneGeometry& geometry, const SolveSetup& setup, int repeats) {
  TimedRun run;
  std::vector<double> wall, cpu;
  for (double spent = 0; run.repeats == 0 || (run.repeats < repeats && spent < kEnough); ++run.repeats) {
    const PeakMemory memory;
    Model model = build(scene, geometry);
    Result result = solve_scene(scene, geometry, model, setup).result;
    if (run.repeats == 0) run.peak_memory_mb = memory.risen_mb();
    spent += result.wall_s;
    wall.push_back(result.wall_s);
    cpu.push_back(result.cpu_s);
    const bool is_cancelled = result.status == Status::Cancelled;
    if (run.repeats == 0) {
      run.x = model.objective->positions(result.q);
      const TriangleMesh closed = surface_at(model, run.x);
      if (const auto reference = placed_reference(model, closed))
        run.to_closed = distance_between(closed, *reference);
    }
    if (run.repeats == 0 || is_cancelled || result.wall_s < run.result.wall_s) run.result = std::move(result);
    if (is_cancelled) break;
  }
  run.wall = spread(wall);
  run.cpu = spread(cpu);
  return run;
}

}  // namespace coapt
