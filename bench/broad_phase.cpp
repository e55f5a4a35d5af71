// Time of the search for facets whose boxes come within reach of each other, on one core: the hierarchy of
// boxes that contact uses, its shape kept and its bounds fitted anew, against a k-d tree of centroids
// (nanoflann) and a uniform hash grid, both built anew. All three find the same pairs. `pairs` counts them,
// neighbours on the surface included.
//
// valve: the generated mitral valve, open. sheets: two sheets one above the other at 0.3 edges, as when
// closed. floor: a sheet over two triangles as large as itself.
#include "mesh/distance/box_hierarchy.hpp"
#include "mesh/triangle_mesh.hpp"
#include "support/meshes.hpp"
#include "valve/generators/mitral.hpp"

#include <benchmark/benchmark.h>
#include <nanoflann.hpp>

#include <cmath>
#include <cstdint>
#include <stdexcept>

namespace {

using namespace coapt;

constexpr double kReachPerEdge = 0.45;  // gap and skin of a contact_barrier

enum class Scene { Valve, Sheets, Floor };

// A unit square; height and shift along both sides in cells.
TriangleMesh sheet(int cells, double height, double shift) {
  return moved(grid_mesh(cells, cells, 1, 1, Diagonal::Same), Vec3(shift, shift, height) / cells);
}

TriangleMesh mesh_of(Scene scene, int triangles) {
  if (scene == Scene::Valve) {
    MitralOptions options;
    options.preset = MitralPreset::Benchmark;
    options.triangles = triangles;
    return mitral_valve(options).leaflets;
  }
  if (scene == Scene::Sheets) {
    const int cells = static_cast<int>(std::sqrt(triangles / 4.0));
    return joined(sheet(cells, 0, 0), sheet(cells, 0.3, 0.2));
  }
  TriangleMesh floor = sheet(1, 0, 0);
  const int cells = static_cast<int>(std::sqrt(triangles / 2.0));
  floor.vertices.row(2).setConstant(-0.2 / cells);
  return joined(sheet(cells, 0, 0), floor);
}

struct Case {
  TriangleMesh mesh;
  double reach;

  std::vector<Bounds> bounds() const {
    std::vector<Bounds> all(static_cast<size_t>(mesh.triangle_count()));
    for (int t = 0; t < mesh.triangle_count(); ++t)
      for (int k = 0; k < 3; ++k)
        all[static_cast<size_t>(t)].include(Vec3(mesh.vertices.col(mesh.triangles(k, t))));
    return all;
  }
};

bool are_near(const Bounds& a, const Bounds& b, double reach) {
  return (a.low <= b.high + reach).all() && (b.low <= a.high + reach).all();
}

// Each is a function of the case that returns the number of pairs.
class Hierarchy {
 public:
  explicit Hierarchy(const Case& c) : hierarchy_(centroids(c.mesh.vertices, c.mesh.triangles)) {}
  long operator()(const Case& c) {
    const std::vector<Bounds> of_triangles = c.bounds();
    hierarchy_.fit(of_triangles, of_nodes_);
    long count = 0;
    hierarchy_.for_each_pair(
        of_triangles, of_nodes_, [&](const Bounds& a, const Bounds& b) { return are_near(a, b, c.reach); },
        [&](int, int) { ++count; });
    return count;
  }

 private:
  BoxHierarchy hierarchy_;
  std::vector<Bounds> of_nodes_;
};

// Half the diagonal of the largest box: nothing farther than twice that plus the reach can matter.
double largest_half_diagonal(const std::vector<Bounds>& bounds) {
  double most = 0;
  for (const Bounds& b : bounds) most = std::max(most, 0.5 * (b.high - b.low).matrix().norm());
  return most;
}

class KdTree {
 public:
  explicit KdTree(const Case&) {}
  long operator()(const Case& c) {
    const std::vector<Bounds> bounds = c.bounds();
    Eigen::Matrix<double, Eigen::Dynamic, 3> centres(c.mesh.triangle_count(), 3);
    for (int t = 0; t < centres.rows(); ++t) {
      const Bounds& b = bounds[static_cast<size_t>(t)];
      centres.row(t) = 0.5 * (b.low + b.high).matrix().transpose();
    }
    const nanoflann::KDTreeEigenMatrixAdaptor<decltype(centres), 3> tree(3, std::cref(centres), 10);
    const double radius = 2 * largest_half_diagonal(bounds) + std::sqrt(3) * c.reach;
    std::vector<std::pair<Eigen::Index, double>> found;
    nanoflann::SearchParams unsorted;
    unsorted.sorted = false;
    long count = 0;
    for (Eigen::Index s = 0; s < centres.rows(); ++s) {
      const Vec3 at = centres.row(s);
      tree.index->radiusSearch(at.data(), radius * radius, found, unsorted);
      for (const auto& [t, distance] : found)
        if (t > s && are_near(bounds[static_cast<size_t>(s)], bounds[static_cast<size_t>(t)], c.reach))
          ++count;
    }
    return count;
  }
};

// Cells as large as the largest box and the reach: a partner lies in one of the 27 cells around.
class HashGrid {
 public:
  explicit HashGrid(const Case&) {}
  long operator()(const Case& c) {
    const std::vector<Bounds> bounds = c.bounds();
    double cell = 0;
    for (const Bounds& b : bounds) cell = std::max(cell, (b.high - b.low).maxCoeff());
    cell += c.reach;
    size_t size = 1;
    while (size < 2 * bounds.size()) size *= 2;
    std::vector<int> head(size, -1), next(bounds.size(), -1);
    std::vector<Eigen::Array3i> cell_of(bounds.size());
    const auto slot = [&](const Eigen::Array3i& at) {
      const auto mixed = static_cast<std::uint64_t>(at[0]) * 73856093U ^
                         static_cast<std::uint64_t>(at[1]) * 19349663U ^
                         static_cast<std::uint64_t>(at[2]) * 83492791U;
      return static_cast<size_t>(mixed) & (size - 1);
    };
    for (size_t t = 0; t < bounds.size(); ++t) {
      cell_of[t] = (0.5 * (bounds[t].low + bounds[t].high) / cell).floor().cast<int>();
      int& first = head[slot(cell_of[t])];
      next[t] = first;
      first = static_cast<int>(t);
    }
    long count = 0;
    for (size_t s = 0; s < bounds.size(); ++s)
      for (int n = 0; n < 27; ++n) {
        const Eigen::Array3i at = cell_of[s] + Eigen::Array3i(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1);
        for (int t = head[slot(at)]; t >= 0; t = next[static_cast<size_t>(t)]) {
          const size_t other = static_cast<size_t>(t);
          if (other > s && (cell_of[other] == at).all() && are_near(bounds[s], bounds[other], c.reach))
            ++count;
        }
      }
    return count;
  }
};

template <class Search, Scene scene>
void search(benchmark::State& state) {
  Case c{mesh_of(scene, static_cast<int>(state.range(0))), 0};
  c.reach = kReachPerEdge * mean_edge_length(c.mesh.vertices, c.mesh.triangles);
  Search method(c);
  long count = 0;
  for (auto _ : state) {
    count = method(c);
    benchmark::DoNotOptimize(count);
  }
  if (state.range(0) <= 2500 && count != Hierarchy(c)(c)) throw std::logic_error("the methods disagree");
  state.counters["triangles"] = c.mesh.triangle_count();
  state.counters["pairs"] = static_cast<double>(count);
  state.counters["triangles/s"] =
      benchmark::Counter(c.mesh.triangle_count(), benchmark::Counter::kIsIterationInvariantRate);
}

void sizes(benchmark::internal::Benchmark* b) {
  for (const int triangles : {2500, 40000, 1000000}) b->Arg(triangles);
  b->Unit(benchmark::kMillisecond);
}
void small(benchmark::internal::Benchmark* b) {
  for (const int triangles : {2500, 10000}) b->Arg(triangles);
  b->Unit(benchmark::kMillisecond);
}

BENCHMARK(search<Hierarchy, Scene::Valve>)->Apply(sizes);
BENCHMARK(search<KdTree, Scene::Valve>)->Apply(sizes);
BENCHMARK(search<HashGrid, Scene::Valve>)->Apply(sizes);
BENCHMARK(search<Hierarchy, Scene::Sheets>)->Apply(sizes);
BENCHMARK(search<KdTree, Scene::Sheets>)->Apply(sizes);
BENCHMARK(search<HashGrid, Scene::Sheets>)->Apply(sizes);
BENCHMARK(search<Hierarchy, Scene::Floor>)->Apply(small);
BENCHMARK(search<KdTree, Scene::Floor>)->Apply(small);
BENCHMARK(search<HashGrid, Scene::Floor>)->Apply(small);

void build_hierarchy(benchmark::State& state) {
  const TriangleMesh mesh = mesh_of(Scene::Sheets, static_cast<int>(state.range(0)));
  for (auto _ : state) {
    const BoxHierarchy hierarchy(centroids(mesh.vertices, mesh.triangles));
    benchmark::DoNotOptimize(&hierarchy);
  }
}
BENCHMARK(build_hierarchy)->Apply(sizes);

}  // namespace

BENCHMARK_MAIN();
