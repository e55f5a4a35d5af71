// Methods x tolerances x meshes on one scene: each error against a truth that is known otherwise, and what is
// told of runs and equilibria that are not there.
#include "exchange/mass_spring_scene.hpp"
#include "formats/csv_table.hpp"
#include "report/plot_data.hpp"
#include "report/report_page.hpp"
#include "report/shown_way.hpp"
#include "solve/peak_memory.hpp"
#include "study/bench/benchmark_report.hpp"
#include "study/bench/benchmark_summary.hpp"
#include "study/bench_fixture.hpp"
#include "study/mesh_study.hpp"

#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

namespace coapt {
namespace {

class BenchmarkTest : public BenchFixture {
 protected:
  Benchmark bench(const Scene& scene, const BenchOptions& options) {
    run_.folder = folder_.path() / "result";
    return run_benchmark(scene, solvers(), options, run_);
  }

  // `lbfgs` and a method that moves nothing on the disc, without newton, which would go on from where they
  // end.
  Benchmark bench_idle_against(const std::string& reference) {
    SolverTable table = solvers();
    table.erase("newton");
    Scene scene = disc_scene();
    scene.solver.type = "lbfgs";
    BenchOptions options;
    options.methods = {"lbfgs", "idle"};
    options.reference = reference;
    options.tolerances = {1e-2, 1e-6};
    options.levels = 0;
    options.repeats = 1;
    run_.folder = folder_.path() / "result";
    return run_benchmark(scene, table, options, run_);
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

double to_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const double at = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
  return (p - a - at * (b - a)).norm();
}

double to_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 normal = (b - a).cross(c - a);
  const auto is_inside = [&](const Vec3& from, const Vec3& to) {
    return (to - from).cross(p - from).dot(normal) >= 0;
  };
  if (is_inside(a, b) && is_inside(b, c) && is_inside(c, a))
    return std::abs((p - a).dot(normal)) / normal.norm();
  return std::min({to_segment(p, a, b), to_segment(p, b, c), to_segment(p, c, a)});
}

// How near 95 % of the area of a surface are to another: corners, middles of edges and centroid of each
// triangle, weighed as mesh/distance/surface_distance.hpp says, against every triangle of the other.
double distance_of_most(const TriangleMesh& from, const TriangleMesh& to) {
  std::vector<std::pair<double, double>> samples;  // distance and weight
  double total = 0;
  const auto add = [&](const Vec3& p, double weight) {
    double least = kInfinity;
    for (const auto& t : to.triangles.colwise())
      least = std::min(least,
                       to_triangle(p, to.vertices.col(t[0]), to.vertices.col(t[1]), to.vertices.col(t[2])));
    samples.emplace_back(least, weight);
    total += weight;
  };
  for (const auto& t : from.triangles.colwise()) {
    const Vec3 corners[] = {from.vertices.col(t[0]), from.vertices.col(t[1]), from.vertices.col(t[2])};
    const double area = 0.5 * (corners[1] - corners[0]).cross(corners[2] - corners[0]).norm();
    for (int k = 0; k < 3; ++k) {
      add(corners[k], area / 20);
      add((corners[k] + corners[(k + 1) % 3]) / 2, 2 * area / 15);
    }
    add((corners[0] + corners[1] + corners[2]) / 3, 9 * area / 20);
  }
  std::sort(samples.begin(), samples.end());
  double below = 0;
  for (const auto& [distance, weight] : samples)
    if ((below += weight) >= 0.95 * total) return distance;
  return samples.back().first;
}

// Springs in place of the membrane: another shape, whose distance is known without the benchmark.
TEST_F(BenchmarkTest, TheErrorOfTheMethodIsTheDistanceBetweenTheTwoShapes) {
  const Scene scene = disc_scene();
  BenchOptions options;
  options.methods = {"newton", "mass-spring"};
  options.tolerances = {1e-2, 1e-6};
  options.levels = 0;
  options.repeats = 1;
  const Benchmark found = bench(scene, options);
  ASSERT_EQ(found.runs.size(), 4u);
  run_.writes = false;
  run_.tolerance = 1e-11;
  const auto closed = [&](const Scene& solved) {
    const RunReport report = run(solved, solvers(), run_);
    EXPECT_EQ(report.report.result.status, Status::Converged);
    return surface_at(report.model, report.report.fields.x);
  };
  const TriangleMesh sheet = closed(scene), springs = closed(mass_spring_scene(scene));
  const double distance = std::max(distance_of_most(sheet, springs), distance_of_most(springs, sheet));
  std::printf("  %.6f mm between membrane and springs\n", distance);
  EXPECT_GT(distance, 0.01);
  for (const BenchRun& timed : found.runs) {
    EXPECT_EQ(timed.errors.method.has_value(), timed.method == 1);
    if (timed.method == 1) {
      EXPECT_NEAR(*timed.errors.method, distance, 1e-7);  // whatever its own tolerance
    }
  }
}

TEST_F(BenchmarkTest, TellsTheMemoryOfARun) {
  if (!PeakMemory().risen_mb()) GTEST_SKIP() << "this system does not tell the peak of resident memory";
  BenchOptions options;
  options.methods = {"newton"};
  options.tolerances = {1e-2};
  options.levels = 0;
  options.repeats = 1;
  options.truth_seconds = 1e-9;  // the finer mesh is not wanted
  const Benchmark found = bench(disc_scene(2400), options);
  ASSERT_EQ(found.runs.size(), 1u);
  ASSERT_TRUE(found.runs[0].peak_memory_mb);
  std::printf("  %.1f MB for 2,400 triangles\n", *found.runs[0].peak_memory_mb);
  EXPECT_GT(*found.runs[0].peak_memory_mb, 1);
  EXPECT_LT(*found.runs[0].peak_memory_mb, 500);
  EXPECT_EQ(nlohmann::json::parse(benchmark_json(found)).at("runs").at(0).at("peak_memory_mb").get<double>(),
            *found.runs[0].peak_memory_mb);
}

TEST(PeakMemory, IsThatOfWhatIsHeldMeanwhile) {
  const PeakMemory memory;
  if (!memory.risen_mb()) GTEST_SKIP() << "this system does not tell the peak of resident memory";
  EXPECT_LT(*memory.risen_mb(), 10);
  {
    std::vector<char> held(size_t{64} << 20);
    volatile char* bytes = held.data();
    for (size_t k = 0; k < held.size(); k += 1024) bytes[k] = 1;  // every page, or it is not resident
  }
  EXPECT_NEAR(*memory.risen_mb(), 64, 10);  // also after it was given back
  EXPECT_LT(*PeakMemory().risen_mb(), 10);  // which is no matter of what comes later
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

// A mark of a run that stopped early, in some plot of the page.
struct EarlyMark {
  std::string label;
  double y = 0, highest = 0;  // of the mark, of all in its plot
};

std::vector<EarlyMark> early_marks(const std::string& page, const std::string& method) {
  std::vector<EarlyMark> marks;
  for (const nlohmann::json& plot : plot_data(page)) {
    double highest = 0;
    for (const nlohmann::json& series : plot["series"])
      for (const double y : series["y"]) highest = std::max(highest, y);
    for (const nlohmann::json& series : plot["series"])
      if (std::string(series["name"]).starts_with(method + ", "))
        for (const size_t k : series["crossed"])
          marks.push_back({series["labels"][k], series["y"][k], highest});
  }
  return marks;
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
  const size_t plots = has_plots() ? 2 : 0;  // of its total and of its algebraic error
  EXPECT_EQ(early_marks(page, "idle").size(), plots);
  EXPECT_TRUE(early_marks(page, "newton").empty());
  EXPECT_EQ(page.find("<b>really"), std::string::npos);
  for (const double mm : kTotalAccuracies)
    EXPECT_EQ(recommendation(found, mm).find("idle"), std::string::npos);
}

// Without newton nobody goes on from where the idle method stands: its equilibrium stays unknown.
TEST_F(BenchmarkTest, DrawsAStopWhoseEquilibriumIsNotKnown) {
  const Benchmark found = bench_idle_against("lbfgs");
  ASSERT_EQ(found.runs.size(), 3u);
  const BenchRun& idle = found.runs.back();
  ASSERT_EQ(idle.status, Status::Stalled);
  EXPECT_FALSE(idle.errors.algebraic);
  // Flat as at rest, it is as far from the dome as that has risen.
  ASSERT_TRUE(idle.errors.method && idle.errors.discretisation && idle.errors.total);
  EXPECT_NEAR(*idle.errors.method, 1.34, 0.02);
  EXPECT_EQ(*idle.errors.total, *idle.errors.method + *idle.errors.discretisation);
  const std::vector<std::string> warnings = missing_equilibria(found);
  ASSERT_EQ(warnings.size(), 1u);
  for (const char* piece : {"the equilibrium of idle on 54 triangles was not found: stalled", "1e-08 wanted"})
    EXPECT_NE(warnings[0].find(piece), std::string::npos) << warnings[0];
  if (!has_plots()) GTEST_SKIP() << "this build has no uPlot";
  const std::vector<EarlyMark> marks = early_marks(benchmark_page(found), "idle");
  ASSERT_EQ(marks.size(), 2u);
  EXPECT_NE(marks[1].label.find("distance to the equilibrium of lbfgs"), std::string::npos) << marks[1].label;
}

// Nobody knows how far the reference itself is off: it stands at the upper edge, on the power of ten that
// no run is above.
TEST_F(BenchmarkTest, DrawsAStopWithoutAnyErrorAtTheUpperEdge) {
  const Benchmark found = bench_idle_against("idle");
  ASSERT_EQ(found.runs.size(), 3u);
  for (const BenchRun& timed : found.runs) EXPECT_FALSE(timed.errors.total);
  EXPECT_TRUE(found.runs[1].errors.algebraic && found.runs[2].errors.algebraic);
  if (!has_plots()) GTEST_SKIP() << "this build has no uPlot";
  const std::vector<EarlyMark> marks = early_marks(benchmark_page(found), "idle");
  ASSERT_EQ(marks.size(), 2u);
  for (const EarlyMark& mark : marks) {
    EXPECT_NE(mark.label.find("error not known, at the upper edge"), std::string::npos) << mark.label;
    EXPECT_EQ(mark.y, mark.highest);
    EXPECT_NEAR(std::log10(mark.y), std::round(std::log10(mark.y)), 1e-6);
  }
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
  options.tolerances = {1e-2, 1e-3, 2e-7};
  options.truth_seconds = 1e-9;
  const Benchmark found = bench(scene, options);
  EXPECT_FALSE(found.has_converged());
  ASSERT_EQ(found.runs.size(), 12u);
  for (const BenchRun& timed : found.runs) EXPECT_EQ(timed.status, Status::Converged);
  EXPECT_EQ(found.meshes[0].missing + found.meshes[1].missing, "");
  EXPECT_TRUE(found.meshes[0].error_mm && found.meshes[1].error_mm);
  EXPECT_FALSE(found.meshes[1].to_next || found.meshes[2].error_mm);
  // lbfgs ends just below its tolerance: that is no truth for a run to it. The last step of newton goes far
  // below.
  const std::vector<std::string> missing = missing_equilibria(found);
  ASSERT_EQ(missing.size(), 3u);
  EXPECT_EQ(missing[0].find("the equilibrium on 864 triangles"), 0u) << missing[0];
  EXPECT_EQ(missing[1].find("the equilibrium of lbfgs on 54 triangles"), 0u) << missing[1];
  EXPECT_EQ(missing[2].find("the equilibrium of lbfgs on 216 triangles"), 0u) << missing[2];
  const std::string page = benchmark_page(found);
  for (const std::string& text : missing) {
    for (const char* piece : {" was not found: stopped at the time limit", "its residual of ",
                              " is above the 2e-09 wanted", "--truth-seconds"})
      EXPECT_NE(text.find(piece), std::string::npos) << piece << " in " << text;
    EXPECT_NE(page.find("Warning: " + text), std::string::npos) << text;
  }
  for (const BenchRun& timed : found.runs) {
    EXPECT_EQ(timed.errors.algebraic.has_value(), timed.method == 0);
    EXPECT_TRUE(timed.errors.total);  // by the distance to the equilibrium of newton
  }
  const nlohmann::json json = nlohmann::json::parse(benchmark_json(found));
  EXPECT_EQ(json.at("warnings"), nlohmann::json(missing));
  EXPECT_EQ(json.at("meshes").at(2).at("no_equilibrium"), found.meshes[2].missing);
  EXPECT_TRUE(json.at("ends").at(0).at("no_equilibrium").is_null());
  EXPECT_EQ(json.at("ends").at(1).at("no_equilibrium"), found.ends[1].missing);

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
  std::istringstream csv(csv_table(run_table(found, found.runs)));
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
  EXPECT_TRUE(json.at("warnings").empty());
  EXPECT_NE(page.find("residual of the equilibrium"), std::string::npos);
  for (const BenchMesh& mesh : found.meshes)
    EXPECT_NE(page.find(">" + page_number(mesh.residual.value(), 3) + "<"), std::string::npos);

  // Where on the mesh its error is: what the figures of the mesh say of the same two surfaces.
  ASSERT_TRUE(found.shown.has_value());
  EXPECT_EQ(found.shown->view.fields.front().title,
            "Greater principal Cauchy stress");  // the page opens on it
  const ViewField& distance = found.shown->view.fields.back();
  EXPECT_EQ(distance.title, "Distance to the equilibrium on " + mesh_text(found.meshes.back()));
  ASSERT_EQ(distance.values.at(0).size(), found.meshes.front().vertices);
  EXPECT_GT(distance.values[0].maxCoeff(), 0);
  EXPECT_LE(distance.values[0].maxCoeff(), *found.meshes.front().error_mm * 2);
  for (const char* part : {"All figures of the result", "certificate", "Residual against iterates"})
    EXPECT_NE(page.find(part), std::string::npos) << part;
  if (!has_shape_view()) return;
  EXPECT_NE(page.find("id=\"shape-data\""), std::string::npos);
  expect_a_way(found.shown->view);
}

}  // namespace
}  // namespace coapt
