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

// Solves on meshes each four times finer. What must fall is the distance of the closed shapes from the finest
// one. From one level to the next it need not: a chord inserts at the vertex nearest to its place, up to half
// an edge away, which adds an error of first order with a size of its own at each level.
void expect_the_closed_shape_to_converge(const std::vector<int>& sizes) {
  std::vector<TriangleMesh> shapes;
  for (const int size : sizes) {
    ValveOptions options;
    options.triangles = size;
    const ValveScene scene(options);
    const Equilibrium found = find_equilibrium(scene.X, scene.fixed, scene.terms(), scene.method());
    EXPECT_EQ(found.result.status, Status::Converged) << size << ": " << found.result.message;
    EXPECT_LE(found.result.iterations, 40) << size;
    std::printf("valve %td triangles: %d iterations, %.2f s, energy %.8g mJ\n", scene.triangles.cols(),
                found.result.iterations, found.result.wall_s, found.result.energy);
    shapes.push_back(scene.leaflets(found.x));
  }
  double last = kInfinity;
  for (size_t k = 0; k + 1 < shapes.size(); ++k) {
    const SurfaceDistance next = surface_distance(shapes[k], shapes[k + 1]),
                          finest = surface_distance(shapes[k], shapes.back());
    std::printf(
        "valve %d triangles: from the next level %.4f mm (p95 %.4f, max %.4f), from the finest %.4f mm",
        sizes[k], next.mean, next.p95, next.max, finest.mean);
    if (last < kInfinity) std::printf(", order %.2f", observed_order(last, finest.mean));
    std::printf("\n");
    EXPECT_LT(finest.mean, last) << sizes[k];
    last = finest.mean;
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
