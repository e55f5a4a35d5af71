// One method on one mesh of a benchmark. Private to this room.
#pragma once

#include "scene/build/scene_geometry.hpp"
#include "solve/solve_scene.hpp"
#include "study/bench/benchmark.hpp"

namespace coapt {

// What all parts of a benchmark are given.
struct BenchCourse {
  const Scene& scene;
  const SolverTable& solvers;
  const BenchOptions& options;
  const RunOptions& run;
};

struct Equilibrium {
  bool is_found = false;     // its residual is at most Benchmark::equilibrium_residual()
  Points x = {};             // 3 x node_count, relative to the model's origin [mm]
  double residual = 0;       // relative
  std::string missing = {};  // why it is not found
};

// Adds the runs of a method over the tolerances and where it ends, the errors of the runs but for that of the
// mesh, and returns its equilibrium. reference: that of the reference method on this mesh, not looked at for
// that method itself. A method that fails says so in its end.
Equilibrium bench_pair(const BenchCourse& course, const SceneGeometry& geometry, size_t mesh, size_t method,
                       const Equilibrium& reference, Benchmark& found);

// That to which newton, or where the build has none the reference method, comes from the scene's own start.
Equilibrium equilibrium_from_start(const BenchCourse& course, const SceneGeometry& geometry,
                                   Benchmark& found);

}  // namespace coapt
