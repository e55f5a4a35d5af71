// The generated valve: one equilibrium from perturbed starts, one closed shape in the limit of fine meshes.
#include "mesh/surface_distance.hpp"
#include "support/meshes.hpp"
#include "support/sanitized.hpp"
#include "support/valve_scene.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <vector>

namespace coapt {
namespace {

TEST(Valve, LandsOnOneEquilibriumFromPerturbedStarts) {
  const ValveScene scene({});
  Points first;
  std::vector<int> held;
  double spread = 0;
  int fewest = 1000, most = 0;
  const int seeds = is_sanitized() ? 1 : 10;
  for (int seed = 0; seed <= seeds; ++seed) {
    Points start = scene.X;  // the supports stay
    if (seed > 0) start = scene.fixed.select(scene.X.array(), shaken(scene.X, 1e-2, seed).array()).matrix();
    const Equilibrium found = find_equilibrium(start, scene.fixed, scene.terms(), scene.method(1e-10));
    ASSERT_EQ(found.result.status, Status::Converged) << seed << ": " << found.result.message;
    if (seed == 0) {
      first = found.x;
      held = scene.held_nodes(first);
    }
    const Vector distance = (found.x - first)(Eigen::all, held).colwise().norm();
    spread = std::max(spread, distance.maxCoeff());
    fewest = std::min(fewest, found.result.iterations);
    most = std::max(most, found.result.iterations);
  }
  std::printf("valve restarts: spread %.2e mm over %zu held of %td nodes, iterations %d to %d\n", spread,
              held.size(), scene.X.cols(), fewest, most);
  EXPECT_LT(spread, 1e-6);
  EXPECT_LE(most, 1.2 * fewest);
}

// Surface distance between the closed shapes of successive meshes, each four times finer: mean over the area.
void expect_the_closed_shape_to_converge(const std::vector<int>& sizes) {
  TriangleMesh last;
  double last_distance = kInfinity;
  for (const int size : sizes) {
    ValveOptions options;
    options.triangles = size;
    const ValveScene scene(options);
    const Equilibrium found = find_equilibrium(scene.X, scene.fixed, scene.terms(), scene.method());
    EXPECT_EQ(found.result.status, Status::Converged) << size << ": " << found.result.message;
    const TriangleMesh surface = scene.leaflets(found.x);
    std::printf("valve %td triangles: %d iterations, %.2f s, energy %.8g mJ", scene.triangles.cols(),
                found.result.iterations, found.result.wall_s, found.result.energy);
    if (last.triangle_count() > 0) {
      const SurfaceDistance distance = surface_distance(last, surface);
      std::printf(", distance of the coarser one mean %.4f p95 %.4f max %.4f mm", distance.mean, distance.p95,
                  distance.max);
      if (last_distance < kInfinity)
        std::printf(", order %.2f", observed_order(last_distance, distance.mean));
      EXPECT_LT(distance.mean, last_distance) << size;
      last_distance = distance.mean;
    }
    std::printf("\n");
    last = surface;
  }
}

TEST(Valve, ClosesToOneShapeInTheLimitOfFineMeshes) {
  if (is_sanitized()) return;
  expect_the_closed_shape_to_converge({625, 2500, 10000});
}

TEST(Nightly, ValveClosesToOneShapeUpTo160000Triangles) {
  if (is_sanitized()) return;
  expect_the_closed_shape_to_converge({625, 2500, 10000, 40000, 160000});
}

}  // namespace
}  // namespace coapt
