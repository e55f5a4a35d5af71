// Methods x tolerances x meshes on one scene: each error against a truth that is known otherwise, and what is
// recommended against the table that it comes from.
#include "mesh/cut_in_four.hpp"
#include "scene/bench_fixture.hpp"
#include "scene/benchmark_report.hpp"
#include "scene/benchmark_summary.hpp"
#include "scene/mesh_study.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace coapt {
namespace {

class BenchmarkTest : public BenchFixture {
 protected:
  Benchmark bench(const Scene& scene, const BenchOptions& options) {
    run_.folder = folder_.path() / "result";
    return run_benchmark(scene, solvers(), options, run_);
  }
};

constexpr double kTolerances[] = {1e-2, 1e-4, 1e-7};

BenchOptions two_methods() {
  BenchOptions options;
  options.methods = {"lbfgs", "newton"};
  options.tolerances = {1e-4, 1e-7, 1e-2};  // in any order
  options.repeats = 2;
  return options;
}

TEST_F(BenchmarkTest, MeasuresEachErrorAgainstATruthOfItsOwn) {
  const Scene scene = disc_scene();
  const Benchmark found = bench(scene, two_methods());
  ASSERT_EQ(found.meshes.size(), 3u);
  ASSERT_EQ(found.runs.size(), 12u);
  EXPECT_EQ(found.methods.front().name, "newton");
  EXPECT_TRUE(found.has_converged());

  // Algebraic: to the same mesh solved to 1e-12, and it falls with the tolerance.
  run_.writes = false;
  run_.tolerance = 1e-12;
  const Points truth = run(scene, solvers(), run_).report.fields.x;
  for (size_t k = 0; k < found.runs.size(); ++k) {
    const BenchRun& timed = found.runs[k];
    SCOPED_TRACE(found.methods[timed.method].name + ", mesh " + std::to_string(timed.mesh) + ", tolerance " +
                 std::to_string(timed.tolerance));
    EXPECT_EQ(timed.tolerance, kTolerances[k % 3]);
    EXPECT_LE(timed.residual, timed.tolerance);
    ASSERT_TRUE(timed.errors.algebraic && timed.errors.discretisation && timed.errors.total);
    const NodeError& algebraic = *timed.errors.algebraic;
    EXPECT_LE(algebraic.rms, algebraic.max);
    EXPECT_EQ(timed.errors.method.has_value(), timed.method == 1);
    EXPECT_NEAR(*timed.errors.total,
                algebraic.max + *timed.errors.discretisation + timed.errors.method.value_or(0), 1e-15);
    if (k % 3 > 0) {
      EXPECT_LE(algebraic.max, found.runs[k - 1].errors.algebraic->max);
    }
    EXPECT_LT(algebraic.max, 100 * timed.tolerance);  // mm, of a rise of 1.4
    EXPECT_EQ(timed.repeats, 2);
    EXPECT_LE(timed.wall.best, timed.wall.median);
    EXPECT_GT(timed.cpu.best, 0);
    EXPECT_GT(timed.evaluations.gradient, 0);
    EXPECT_GT(timed.phase_s.at("gradient"), 0);
    EXPECT_GE(timed.peak_memory_mb.value_or(0), 0);
    if (timed.mesh > 0 || timed.method > 0) continue;
    run_.tolerance = timed.tolerance;
    const Points x = run(scene, solvers(), run_).report.fields.x;
    EXPECT_NEAR(algebraic.max, (x - truth).colwise().norm().maxCoeff(), 1e-9);
  }
  for (const BenchEnd& end : found.ends) {
    EXPECT_EQ(end.verdict, end.method == 0 ? Verdict::Reference : Verdict::SameEquilibrium);
    EXPECT_LE(end.residual.value(), 1e-12);
  }
}

TEST_F(BenchmarkTest, EstimatesTheErrorOfTheMesh) {
  const Scene scene = disc_scene();
  BenchOptions options;
  options.methods = {"newton"};
  options.tolerances = {1e-8};
  options.repeats = 1;
  const Benchmark found = bench(scene, options);
  ASSERT_EQ(found.meshes.size(), 3u);
  EXPECT_EQ(found.meshes[1].triangles, 4 * found.meshes[0].triangles);
  EXPECT_GT(found.meshes[0].factorisation_s.value_or(0), 0);
  EXPECT_NEAR(factorisations_worth(found, found.runs[0]).value_or(0) * *found.meshes[0].factorisation_s,
              found.runs[0].cpu.median, 1e-12);
  EXPECT_FALSE(found.meshes[2].factorisation_s);
  EXPECT_FALSE(found.meshes[2].is_benchmarked);
  ASSERT_TRUE(found.meshes[1].order);
  // Two for a smooth shape; the corners that the rim of a coarse disc has take a little of it.
  EXPECT_GT(*found.meshes[1].order, 1.6);
  EXPECT_LT(*found.meshes[1].order, 2.1);

  // The later truth: another mesh, four times finer than any that the benchmark saw.
  run_.tolerance = 1e-10;
  const MeshStudy study = study_mesh(scene, solvers(), 3, run_);
  std::vector<TriangleMesh> shapes;
  for (const MeshLevel& level : study.levels) shapes.push_back(level.closed);
  const MeshDistances later = distances_between_meshes(shapes);
  for (const size_t k : {size_t{0}, size_t{1}}) {
    std::printf("  mesh %zu: %.4f mm by estimate, %.4f mm later\n", k, *found.meshes[k].error_mm,
                later.to_finest[k].p95);
    EXPECT_NEAR(*found.meshes[k].error_mm / later.to_finest[k].p95, 1, 0.25) << "mesh " << k;
  }
}

TEST_F(BenchmarkTest, AMethodThatStopsEarlyIsNeverRecommended) {
  BenchOptions options;
  options.methods = {"idle", "newton", "broken"};
  options.tolerances = {1e-2, 1e-6};
  options.levels = 0;
  options.repeats = 1;
  const Benchmark found = bench(disc_scene(), options);
  EXPECT_FALSE(found.has_converged());
  ASSERT_EQ(found.runs.size(), 3u);  // a tighter tolerance is not tried
  const BenchRun& idle = found.runs.back();
  EXPECT_EQ(idle.status, Status::Stalled);
  // It stands where it started, flat: its vertices are as far from the equilibrium as that has risen.
  EXPECT_NEAR(idle.errors.algebraic->max, 1.35, 0.15);
  EXPECT_EQ(fastest_run(found, ErrorKind::Algebraic, 10, {.method = idle.method}), nullptr);
  EXPECT_EQ(found.ends[1].verdict, Verdict::SameEquilibrium);  // newton goes on from there
  EXPECT_EQ(found.ends[2].verdict, Verdict::Failed);
  EXPECT_NE(found.ends[2].failure.find("it is broken"), std::string::npos);
  const std::string page = benchmark_page(found);
  EXPECT_NE(page.find("stalled"), std::string::npos);
  EXPECT_EQ(page.find("<b>really"), std::string::npos);
  for (const double mm : kTotalAccuracies)
    EXPECT_EQ(recommendation(found, mm).find("idle"), std::string::npos);
}

TEST_F(BenchmarkTest, MeasuresAGivenClosedSurface) {
  const Scene scene = disc_scene();
  run_.tolerance = 1e-12;
  run_.folder = folder_.path() / "truth";
  run(scene, solvers(), run_);
  run_.tolerance.reset();
  BenchOptions options;
  options.methods = {"newton"};
  options.tolerances = {1e-1, 1e-9};
  options.levels = 0;
  options.repeats = 1;
  options.closed = folder_.path() / "truth" / "closed.obj";
  const Benchmark found = bench(scene, options);
  ASSERT_TRUE(found.runs.front().errors.model && found.runs.back().errors.model);
  EXPECT_LT(found.runs.back().errors.model->max, 1e-6);
  EXPECT_GT(found.runs.front().errors.model->max, 1e-3);
  EXPECT_LE(found.runs.front().errors.model->max, found.runs.front().errors.algebraic->max * (1 + 1e-6));
}

TEST_F(BenchmarkTest, AChainHasNoErrorOfAMesh) {
  const Scene scene = load_scene(std::filesystem::path(COAPT_SOURCE_DIR) / "examples/03_catenary/scene.json");
  BenchOptions options;
  options.methods = {"newton"};
  options.tolerances = {1e-3};
  EXPECT_NE(refusal([&] { bench(scene, options); }).find("use --levels 0"), std::string::npos);
  options.levels = 0;
  options.repeats = 1;
  const Benchmark found = bench(scene, options);
  ASSERT_EQ(found.runs.size(), 1u);
  EXPECT_FALSE(found.runs[0].errors.discretisation);
  EXPECT_EQ(found.runs[0].errors.total.value(), found.runs[0].errors.algebraic->max);
  EXPECT_NE(recommendation(found, 1).find("nodes"), std::string::npos);
}

TEST_F(BenchmarkTest, ACancelledOneKeepsWhatThereIs) {
  int solves = 0;
  run_.observer = [&](const Iteration& it, const Vector&) {
    if (it.iteration == 0) ++solves;
    return solves < 4;
  };
  const Benchmark found = bench(disc_scene(), two_methods());
  EXPECT_TRUE(found.is_cancelled);
  EXPECT_FALSE(found.has_converged());
  EXPECT_EQ(found.runs.size(), 1u);  // of two repeats; the next was in its second
  EXPECT_TRUE(nlohmann::json::parse(benchmark_json(found)).at("cancelled").get<bool>());
}

// The finest mesh is solved for its equilibrium alone: without time for that the two others judge each other.
TEST_F(BenchmarkTest, SaysWhichEquilibriumIsMissing) {
  const Scene scene = disc_scene();
  BenchOptions options = two_methods();
  options.repeats = 1;
  options.truth_seconds = 1e-9;
  const Benchmark found = bench(scene, options);
  EXPECT_FALSE(found.has_converged());
  ASSERT_EQ(found.runs.size(), 12u);
  for (const BenchRun& timed : found.runs) EXPECT_EQ(timed.status, Status::Converged);
  EXPECT_EQ(found.meshes[0].missing + found.meshes[1].missing, "");
  EXPECT_TRUE(found.meshes[0].error_mm && found.meshes[1].error_mm);
  EXPECT_FALSE(found.meshes[1].to_next || found.meshes[2].error_mm);
  const std::vector<std::string> missing = missing_equilibria(found);
  ASSERT_EQ(missing.size(), 1u);
  for (const char* piece : {"triangles was not found: stopped at the time limit", "--truth-seconds"})
    EXPECT_NE(missing[0].find(piece), std::string::npos) << missing[0];
  EXPECT_NE(benchmark_page(found).find("Warning: the equilibrium on "), std::string::npos);
  EXPECT_EQ(nlohmann::json::parse(benchmark_json(found)).at("meshes").at(2).at("no_equilibrium"),
            found.meshes[2].missing);

  options.levels = 0;
  const Benchmark coarse = bench(scene, options);
  EXPECT_FALSE(coarse.meshes[0].error_mm);
  EXPECT_NE(recommendation(coarse, 1).find("not known, as the equilibrium on "), std::string::npos);
}

TEST_F(BenchmarkTest, RefusesAllBadInputAtOnce) {
  const Scene scene = disc_scene();
  BenchOptions options;
  options.methods = {"newtn"};
  options.reference = "bfgs";
  options.tolerances = {1e-2, 2, std::nan(""), 1e-2};
  options.levels = 7;
  options.repeats = 0;
  options.truth_seconds = 0;
  options.closed = folder_.path() / "nowhere.obj";
  const std::string defects = refusal([&] { bench(scene, options); });
  for (const char* piece :
       {"did you mean \"newton\"", "\"bfgs\" is not among", "above 0 and at most 1", "one is named twice",
        "--levels: between 0 and 4", "--repeats", "--truth-seconds", "nowhere.obj not found"})
    EXPECT_NE(defects.find(piece), std::string::npos) << piece << " in " << defects;
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "result"));
}

TEST_F(BenchmarkTest, TellsTheSameInJsonRowsAndPage) {
  const Benchmark found = bench(disc_scene(), two_methods());
  write_benchmark(found.folder, found);
  for (const char* file : {"bench.json", "bench.csv", "bench.html"})
    EXPECT_TRUE(std::filesystem::exists(found.folder / file)) << file;
  const nlohmann::json json = nlohmann::json::parse(benchmark_json(found));
  ASSERT_EQ(json.at("runs").size(), found.runs.size());
  EXPECT_EQ(json.at("runs").at(3).at("errors").at("total_mm").get<double>(), *found.runs[3].errors.total);
  EXPECT_EQ(json.at("runs").at(3).at("wall_s").at("median").get<double>(), found.runs[3].wall.median);
  EXPECT_EQ(json.at("time_to").size(), 2u * (2 * 4 + 3));  // methods x (meshes x accuracies + accuracies)
  EXPECT_EQ(json.at("growth").size(), 2u);
  std::istringstream csv(benchmark_csv(found));
  std::string line;
  std::getline(csv, line);
  const auto columns = std::count(line.begin(), line.end(), ',');
  size_t rows = 0;
  for (; std::getline(csv, line); ++rows)
    EXPECT_EQ(std::count(line.begin(), line.end(), ','), columns) << line;
  EXPECT_EQ(rows, found.runs.size());
  const std::string page = benchmark_page(found);
  EXPECT_NE(page.find(json.at("recommendations").at(0).get<std::string>()), std::string::npos);
  EXPECT_EQ(page.find("<script src"), std::string::npos);

  // Where on the mesh its error is: what the figures of the mesh say of the same two surfaces.
  ASSERT_EQ(found.mesh_view.has_value(), has_shape_view());
  if (!found.mesh_view) return;
  const ViewField& distance = found.mesh_view->fields.front();
  EXPECT_EQ(distance.title, "Distance to the equilibrium on " + mesh_text(found.meshes.back()));
  ASSERT_EQ(distance.values.at(0).size(), found.meshes.front().vertices);
  EXPECT_GT(distance.values[0].maxCoeff(), 0);
  EXPECT_LE(distance.values[0].maxCoeff(), *found.meshes.front().error_mm * 2);
  EXPECT_NE(page.find("id=\"shape-data\""), std::string::npos);
}

// --- what follows from a table, without a solve

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
  TriangleMesh fine = cut_in_four(coarse).mesh;
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
