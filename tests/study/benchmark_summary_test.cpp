// What follows from a table of runs, without a solve: recommendations, growth, the estimate of the mesh
// error.
#include "study/bench/benchmark_summary.hpp"

#include "mesh/remesh/uniform_refinement.hpp"
#include "study/bench/discretisation.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace coapt {
namespace {

TEST(DiscretisationEstimate, IsExactForAGeometricSequence) {
  // Errors of 4^-k at mesh k, all on one side of the limit.
  const auto figures = [](double distance) { return DistanceFigures{distance, distance, distance}; };
  const DiscretisationEstimate found =
      estimate_discretisation({{figures(0.75), figures(0.1875)}, {figures(0.9375), figures(0.1875)}});
  EXPECT_NEAR(found.order.value(), 2, 1e-12);
  ASSERT_EQ(found.error_mm.size(), 3u);
  for (size_t k = 0; k < 3; ++k) EXPECT_NEAR(found.error_mm[k], std::pow(0.25, k), 1e-12);
}

// Vertices of the finer mesh lie where the coarser is farthest off: the distance between the two is 3/4 of
// the error in the middle of a facet and all of it in the middle of an edge. What a mesh before shows is
// kept.
TEST(DiscretisationEstimate, LearnsFromTheMeshBeforeWhatADistanceMeans) {
  const DiscretisationEstimate found =
      estimate_discretisation({{{0.8, 0.9, 1}, {0.2, 0.225, 0.25}}, {{0.9, 0.9375, 1}, {0.2, 0.225, 0.25}}});
  EXPECT_NEAR(found.error_mm[0], 1, 1e-12);
  EXPECT_NEAR(found.error_mm[1], 0.25, 1e-12);
  EXPECT_NEAR(found.error_mm[2], 0.0625, 1e-12);
}

TEST(DiscretisationEstimate, StaysWithinReasonWhereNoOrderIsSeen) {
  const DiscretisationEstimate one = estimate_discretisation({{{0.2, 0.5, 0.9}}, {{0.2, 0.5, 0.9}}});
  EXPECT_FALSE(one.order);
  EXPECT_GT(one.error_mm[0], 0.5);  // there is more beyond the next mesh
  EXPECT_LT(one.error_mm[0], 1);    // than with errors that halve
  EXPECT_NEAR(one.error_mm[0] - one.error_mm[1], 0.5, 1e-12);
  // The finest mesh found another branch: what the first two meshes have in common says nothing then.
  const DiscretisationEstimate rising =
      estimate_discretisation({{{0.01, 0.01, 0.01}, {1, 1, 1}}, {{1, 1, 1}, {1, 1, 1}}});
  EXPECT_LT(rising.order.value(), 0);
  EXPECT_EQ(rising.assumed_order, 0.5);
  EXPECT_GE(rising.error_mm[1], 1);
  EXPECT_LT(rising.error_mm[1], 4);
  const DistanceFigures none;
  EXPECT_EQ(estimate_discretisation({{none, none}, {none, none}}).error_mm[0], 0);
}

// A triangle over a shallow bowl: two facets of the finer mesh meet at the middle of its long edge.
TEST(DiscretisationEstimate, SamplesBothMeshesAsClosely) {
  TriangleMesh coarse;
  coarse.vertices.resize(3, 3);
  coarse.vertices << 0, 1, 0, 0, 0, 1, 0, 0, 0;
  coarse.triangles.resize(3, 1);
  coarse.triangles << 0, 1, 2;
  TriangleMesh fine = refined_uniformly(coarse).mesh;
  for (auto x : fine.vertices.colwise()) x[2] = 0.01 * (x[0] * (1 - x[0]) + x[1] * (1 - x[1]));
  const MeshDistances found = distances_between_meshes({coarse, fine});
  ASSERT_EQ(found.to_next.size(), 1u);
  // A quarter of the area each: three corners that rise from nothing to their middles, and the middle.
  const double middles = (0.0025 + 0.0025 + 0.005) / 3;
  EXPECT_NEAR(found.to_next[0].mean, (middles + 2 * middles) / 4, 0.02 * middles);
  EXPECT_LT(found.to_next[0].p95, 0.005);
}

// Two methods on two meshes: times grow with triangles^1.3, errors of the mesh fall by four.
Benchmark table() {
  Benchmark bench;
  bench.methods = {{"newton"}, {"hasty"}};
  bench.meshes = {{.triangles = 1000, .error_mm = 0.2}, {.triangles = 4000, .error_mm = 0.05}};
  bench.tolerances = {1e-2, 1e-6};
  for (const size_t method : {size_t{0}, size_t{1}})
    for (const size_t mesh : {size_t{0}, size_t{1}})
      for (const double tolerance : bench.tolerances) {
        BenchRun run{.method = method, .mesh = mesh, .tolerance = tolerance, .status = Status::Converged};
        const double seconds = std::pow(bench.meshes[mesh].triangles / 1000.0, 1.3) *
                               (tolerance < 1e-3 ? 2 : 1) * (method == 0 ? 1 : 0.1);
        run.wall = run.cpu = {seconds, 0.9 * seconds};
        run.errors.algebraic = NodeError{30 * tolerance, 10 * tolerance};
        run.errors.discretisation = bench.meshes[mesh].error_mm;
        run.errors.total = run.errors.algebraic->max + *bench.meshes[mesh].error_mm;
        if (method == 1) run.status = Status::Stalled;
        bench.runs.push_back(run);
      }
  return bench;
}

TEST(BenchmarkSummary, RecommendsTheFastestOfThoseThatAreGoodEnough) {
  const Benchmark bench = table();
  for (const double mm : {10.0, 1.0, 0.3, 0.1, 0.06}) {
    const BenchRun* found = fastest_run(bench, ErrorKind::Total, mm);
    ASSERT_NE(found, nullptr) << mm;
    EXPECT_LE(*found->errors.total, mm);
    for (const BenchRun& run : bench.runs)
      EXPECT_FALSE(run.status == Status::Converged && *run.errors.total <= mm &&
                   run.wall.median < found->wall.median)
          << mm;
  }
  EXPECT_EQ(recommendation(bench, 0.1),
            "for 0.1 mm on this scene: newton, 4,000 triangles, 12 s (tolerance 1e-06, error 0.05 mm)");
  const std::string none = recommendation(bench, 0.01);
  for (const char* piece : {"none of these runs", "newton, 4,000 triangles", "--levels"})
    EXPECT_NE(none.find(piece), std::string::npos) << none;
  EXPECT_EQ(fastest_run(bench, ErrorKind::Total, 1, {.method = 1}), nullptr);
  EXPECT_EQ(fastest_run(bench, ErrorKind::Algebraic, 1e-3, {0, 0})->tolerance, 1e-6);
}

TEST(BenchmarkSummary, AnEquilibriumIsFarBelowTheTightestTolerance) {
  Benchmark bench = table();
  EXPECT_EQ(bench.equilibrium_residual(), 1e-2 * 1e-6);
  bench.tolerances = {1e-6, 1e-11};
  EXPECT_EQ(bench.equilibrium_residual(), 1e-12);
}

TEST(BenchmarkSummary, AMissingEquilibriumIsNoSuccess) {
  Benchmark bench = table();
  for (BenchRun& run : bench.runs) run.status = Status::Converged;
  EXPECT_TRUE(bench.has_converged());
  bench.ends.push_back({.method = 1, .mesh = 0, .missing = "stalled"});
  EXPECT_FALSE(bench.has_converged());
  EXPECT_EQ(missing_equilibria(bench),
            std::vector<std::string>{"the equilibrium of hasty on 1,000 triangles was not found: stalled"});
}

TEST(BenchmarkSummary, SeesHowTimeGrows) {
  Benchmark bench = table();
  const auto found = growth(bench, 0);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->exponent, 1.3, 1e-12);
  EXPECT_EQ(found->tolerance, 1e-6);
  EXPECT_FALSE(growth(bench, 1));          // it never converged
  bench.runs[3].status = Status::Stalled;  // the tightest on the second mesh
  EXPECT_EQ(growth(bench, 0)->tolerance, 1e-2);
}

}  // namespace
}  // namespace coapt
