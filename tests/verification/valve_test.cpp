// The generated valve: one equilibrium from perturbed starts, one closed shape in the limit of fine meshes.
#include "mesh/distance/surface_distance.hpp"
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

// Solves on meshes that nest, with the same chords. The distance of the closed shapes must fall from each
// pair of neighbours to the next, and to the finest one.
void expect_the_closed_shape_to_converge(int refinements) {
  std::vector<TriangleMesh> shapes;
  for (int level = 0; level <= refinements; ++level) {
    ValveOptions options;
    options.refinements = level;
    const ValveScene scene(options);
    const Equilibrium found = find_equilibrium(scene.X, scene.fixed, scene.terms(), scene.method());
    EXPECT_EQ(found.result.status, Status::Converged) << level << ": " << found.result.message;
    EXPECT_LE(found.result.iterations, 40) << level;
    std::printf("valve %td triangles: %d iterations, %.2f s, energy %.8g mJ\n", scene.triangles.cols(),
                found.result.iterations, found.result.wall_s, found.result.energy);
    shapes.push_back(scene.leaflets(found.x));
  }
  double last = kInfinity, last_to_next = kInfinity;
  for (size_t k = 0; k + 1 < shapes.size(); ++k) {
    const SurfaceDistance next = surface_distance(shapes[k], shapes[k + 1]),
                          finest = surface_distance(shapes[k], shapes.back());
    std::printf(
        "valve refined %zu times: from the next level %.4f mm (p95 %.4f, max %.4f), from the finest %.4f mm",
        k, next.mean, next.p95, next.max, finest.mean);
    if (last < kInfinity) std::printf(", order %.2f", observed_order(last_to_next, next.mean));
    std::printf("\n");
    EXPECT_LT(finest.mean, last) << k;
    EXPECT_LT(next.mean, last_to_next) << k;
    last = finest.mean;
    last_to_next = next.mean;
  }
}

TEST(Valve, ClosesToOneShapeInTheLimitOfFineMeshes) {
  if (is_sanitized()) return;
  expect_the_closed_shape_to_converge(2);
}

TEST(Nightly, ValveClosesToOneShapeUpTo160000Triangles) {
  if (is_sanitized()) return;
  expect_the_closed_shape_to_converge(4);
}

}  // namespace
}  // namespace coapt
