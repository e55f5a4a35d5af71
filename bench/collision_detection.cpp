// Time of one query of continuous collision detection, on one core. The baseline in the same run is one
// distance. `near`: pairs as the broad phase hands them over, distances up to the edge length and small
// moves; `colliding`: pairs on their way to a collision.
#include "mesh/distance/collision_detection.hpp"

#include "mesh/distance/triangle_distance.hpp"

#include <benchmark/benchmark.h>

#include <random>

namespace {

using namespace coapt;

struct Pair {
  PairCorners x, d;
};

// Sides of unit size, `apart` from each other along z or some other direction, displacements of size `move`.
std::vector<Pair> pairs(int first, double nearest, double farthest, double move) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto any = [&] { return Vec3(uniform(random), uniform(random), uniform(random)); };
  std::vector<Pair> all(4096);
  for (Pair& pair : all) {
    const Vec3 shift = (nearest + (farthest - nearest) * std::abs(uniform(random))) * any().normalized();
    pair.x << any(), any(), any(), any();
    pair.d << any(), any(), any(), any();
    pair.d *= move;
    // Touching somewhere inside, then shifted.
    if (first == 1)
      pair.x.col(0) = 0.3 * pair.x.col(1) + 0.6 * pair.x.col(2) + 0.1 * pair.x.col(3);
    else
      pair.x.col(3) += 0.3 * pair.x.col(0) + 0.7 * pair.x.col(1) - 0.4 * pair.x.col(2) - 0.6 * pair.x.col(3);
    pair.x.leftCols(first).colwise() += shift;
  }
  return all;
}

template <class Query>
void run(benchmark::State& state, Query query, int first, double nearest, double farthest, double move) {
  const std::vector<Pair> all = pairs(first, nearest, farthest, move);
  size_t k = 0, limited = 0, count = 0;
  for (auto _ : state) {
    const double step = query(all[k]);
    benchmark::DoNotOptimize(step);
    limited += step < 1;
    ++count;
    k = (k + 1) % all.size();
  }
  state.counters["limited"] = static_cast<double>(limited) / static_cast<double>(count);
}

const auto triangle_step = [](const Pair& p) { return point_triangle_step(p.x, p.d, 1, 0.1); };
const auto edge_step = [](const Pair& p) { return edge_edge_step(p.x, p.d, 1, 0.1); };
const auto triangle_distance = [](const Pair& p) {
  return closest_on_triangle(p.x.col(0), p.x.col(1), p.x.col(2), p.x.col(3)).distance_squared;
};
const auto edge_distance = [](const Pair& p) {
  return closest_on_segments(p.x.col(0), p.x.col(1), p.x.col(2), p.x.col(3)).distance_squared;
};

BENCHMARK_CAPTURE(run, point_triangle_distance_as_baseline, triangle_distance, 1, 0.01, 1, 0.01);
BENCHMARK_CAPTURE(run, point_triangle_near, triangle_step, 1, 0.01, 1, 0.001);
BENCHMARK_CAPTURE(run, point_triangle_moving, triangle_step, 1, 0.01, 1, 0.1);
BENCHMARK_CAPTURE(run, point_triangle_colliding, triangle_step, 1, 0.01, 0.1, 1);
BENCHMARK_CAPTURE(run, edge_edge_distance_as_baseline, edge_distance, 2, 0.01, 1, 0.01);
BENCHMARK_CAPTURE(run, edge_edge_near, edge_step, 2, 0.01, 1, 0.001);
BENCHMARK_CAPTURE(run, edge_edge_moving, edge_step, 2, 0.01, 1, 0.1);
BENCHMARK_CAPTURE(run, edge_edge_colliding, edge_step, 2, 0.01, 0.1, 1);

}  // namespace

BENCHMARK_MAIN();
