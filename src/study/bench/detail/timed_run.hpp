// One solve, repeated for its time. Private to this room.
#pragma once

#include "scene/build/scene_geometry.hpp"
#include "solve/solve_scene.hpp"
#include "study/bench/benchmark.hpp"

namespace coapt {

struct TimedRun {
  Result result;  // of the fastest repeat; all end in the same shape
  Points x;       // 3 x node_count, relative to the model's origin [mm]
  int repeats = 0;
  Spread wall, cpu;
  std::optional<double> peak_memory_mb;      // of the first repeat
  std::optional<DistanceFigures> to_closed;  // where the scene has a closed surface
};

// repeats: wanted, at least one; no more are begun once they took kEnough seconds together.
inline constexpr double kEnough = 10;
TimedRun timed_run(const Scene& scene, const SceneGeometry& geometry, const SolveSetup& setup, int repeats);

}  // namespace coapt
