// What a benchmark lets people look at. Private to this room.
#pragma once

#include "study/bench/detail/bench_pair.hpp"

namespace coapt {

// The reference method on `geometry`, the scene's own nodes, to the tightest tolerance that it reached there:
// the way through iterates to the shape, coloured first by its distance to `finer`, the equilibrium on the
// finest mesh that it is known on, where that is not null. A solve of its own, so that keeping the history
// costs no run that is timed any time. Nothing where the method cannot be run.
std::optional<ShownSolve> bench_shown(const BenchCourse& course, const SceneGeometry& geometry,
                                      const TriangleMesh* finer, Benchmark& found);

}  // namespace coapt
