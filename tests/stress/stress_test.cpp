// The stability matrix: what it says of answers that are wrong, of scenes of the user's own, and in its
// files.
#include "core/error.hpp"
#include "formats/csv_table.hpp"
#include "formats/mesh_io.hpp"
#include "mesh/shapes.hpp"
#include "optim/newton.hpp"
#include "report/shown_way.hpp"
#include "scene/build/build.hpp"
#include "stress/energy_checker.hpp"
#include "stress/scenes/slivers.hpp"
#include "stress/stress_report.hpp"
#include "support/temporary_folder.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <set>

namespace coapt {
namespace {

using Verdict = StressVerdict;

StressRow row_that(const std::string& name, std::function<StressOutcome()> run) {
  return {"S3", "a scene", name, "error", "mm", true, std::move(run)};
}

// Newton, but what it hands over is not a number.
class Breaking : public Solver {
 public:
  std::string_view name() const override { return "breaking"; }
  bool follows_path() const override { return true; }
  Status minimize(Objective&, Vector& q, Monitor&) override {
    q.setConstant(kNaN);
    return Status::Converged;
  }
};

// Gives up where it stands.
class Idle : public Solver {
 public:
  std::string_view name() const override { return "idle"; }
  bool follows_path() const override { return true; }
  Status minimize(Objective&, Vector&, Monitor&) override { return Status::Stalled; }
};

class StressedScene : public testing::Test {
 protected:
  StressedScene() {
    options_.folder = folder_.path();
    options_.row_seconds = 60;
  }

  // A quarter of a square sheet between two planes of symmetry: supports that hold single coordinates.
  Scene quarter() {
    write_mesh(folder_.path() / "quarter.obj", square(10, 200, CellPattern::Cross));
    return load_scene(folder_.write("quarter.json", R"({"mesh": {"file": "quarter.obj"},
      "boundary": [{"nodes": {"plane": {"axis": "x"}}, "fix": ["x"]}, {"nodes": {"plane": {"axis": "y"}}, "fix": ["y"]},
                   {"nodes": {"nearest": [0, 0, 0]}, "fix": ["x", "y"]},
                   {"nodes": {"plane": {"axis": "x", "at": "10 mm"}}, "fix": true},
                   {"nodes": {"plane": {"axis": "y", "at": "10 mm"}}, "fix": true}],
      "terms": [{"type": "cst_tension_field", "young": "1 MPa", "poisson": 0.3, "thickness": "0.1 mm"},
                {"type": "load_pressure", "value": "0.1 kPa"}],
      "solver": {"type": "newton", "tolerance": 1e-8}})"));
  }

  // A disc pressed on a floor.
  Scene pressed() {
    TriangleMesh sheet = disc(10, 150), floor = square(60, 2);
    sheet.vertices.row(2).array() += 2;
    sheet.triangles.row(1).swap(sheet.triangles.row(2));
    floor.vertices.colwise() -= Vec3(31, 29, 0);
    write_mesh(folder_.path() / "sheet.obj", sheet);
    write_mesh(folder_.path() / "floor.obj", floor);
    return load_scene(folder_.write("pressed.json", R"({"mesh": {"file": "sheet.obj"},
      "obstacles": [{"name": "floor", "file": "floor.obj"}],
      "boundary": [{"nodes": "boundary", "fix": true}],
      "terms": [{"type": "cst_tension_field", "young": "1 MPa", "poisson": 0.3, "thickness": "0.1 mm"},
                {"type": "bending"}, {"type": "load_pressure", "value": "2 kPa"}, {"type": "contact_barrier"}],
      "solver": {"type": "newton", "tolerance": 1e-8}})"));
  }

  // A clamped disc, whose pressure has a potential.
  Scene clamped(int triangles = 100) {
    write_mesh(folder_.path() / "disc.obj", disc(10, triangles));
    return load_scene(folder_.write("clamped.json", R"({"mesh": {"file": "disc.obj"},
      "boundary": [{"nodes": "boundary", "fix": true}],
      "terms": [{"type": "cst_tension_field", "young": "1 MPa", "poisson": 0.3, "thickness": "0.1 mm"},
                {"type": "load_pressure", "value": "0.1 kPa"}],
      "solver": {"type": "newton", "tolerance": 1e-8}})"));
  }

  StressMatrix stressed(const Scene& scene, std::vector<std::string> ids, bool is_quick = false) {
    options_.rows = std::move(ids);
    options_.is_quick = is_quick;
    return run_stress(stress_rows(scene, options_), options_);
  }

  static std::string told(const StressMatrix& matrix) { return csv_table(stress_table(matrix.results)); }

  TemporaryFolder folder_;
  StressOptions options_;
};

TEST_F(StressedScene, AWrongRowFailsTheMatrixAndStandsInEveryFile) {
  const std::vector<StressRow> rows = {
      row_that("right",
               [] {
                 return StressOutcome{Verdict::Pass, 1e-9, 1e-8, "converged"};
               }),
      row_that("wrong",
               [] {
                 return StressOutcome{Verdict::Fail, 0.5, 1e-8, "a lie, \"converged\""};
               }),
      row_that("broken", []() -> StressOutcome { throw std::runtime_error("broke <here>"); }),
      row_that("refused", []() -> StressOutcome { throw InputError("no such thing"); })};
  const StressMatrix matrix = run_stress(rows, options_);
  EXPECT_TRUE(matrix.has_failed());
  EXPECT_FALSE(matrix.holds());
  EXPECT_EQ(matrix.count(Verdict::Fail), 2);
  EXPECT_EQ(matrix.results[2].outcome.message, "exception: broke <here>");
  EXPECT_EQ(matrix.results[3].outcome.verdict, Verdict::NotApplicable);
  EXPECT_NE(stress_summary(matrix).find("4 rows: 1 pass, 1 do not apply, 2 FAIL"), std::string::npos);

  write_stress(folder_.path(), matrix);
  const auto json = nlohmann::json::parse(stress_json(matrix));
  EXPECT_FALSE(json["holds"]);
  EXPECT_EQ(json["counts"]["fail"], 2);
  EXPECT_EQ(json["rows"][1]["figure"], 0.5);
  EXPECT_EQ(json["rows"][1]["unit"], "mm");
  EXPECT_TRUE(json["rows"][2]["figure"].is_null());
  EXPECT_NE(told(matrix).find("\"a lie, \"\"converged\"\"\""), std::string::npos);
  const std::string page = stress_page(matrix);
  EXPECT_NE(page.find("Rows that fail"), std::string::npos);
  EXPECT_EQ(page.find("broke <here>"), std::string::npos);
  for (const char* file : {"stress.json", "stress.csv", "stress.html"})
    EXPECT_TRUE(std::filesystem::exists(folder_.path() / file)) << file;
  EXPECT_EQ(page.find("shape-data"), std::string::npos);  // none of these has a solution to show
  EXPECT_TRUE(run_stress({rows[0], rows[3]}, options_).holds());
  options_.is_cancelled = [] { return true; };
  EXPECT_FALSE(run_stress({rows[0], rows[3]}, options_).holds());
}

TEST_F(StressedScene, NumbersThatAreNoneAreAFailureAndGivingUpIsNot) {
  const Scene scene = quarter();
  options_.solvers = {{"newton", [](const SolverOptions&) { return std::make_unique<Breaking>(); }}};
  StressMatrix matrix = stressed(scene, {"S18", "S1"}, true);
  EXPECT_EQ(matrix.count(Verdict::Fail), static_cast<int>(matrix.results.size())) << told(matrix);
  options_.solvers = {{"newton", [](const SolverOptions&) { return std::make_unique<Idle>(); }}};
  matrix = stressed(scene, {"S1", "S4", "S9"}, true);
  EXPECT_EQ(matrix.count(Verdict::Pass), 0) << told(matrix);
  EXPECT_GT(matrix.count(Verdict::Stall), 2) << told(matrix);
  EXPECT_FALSE(matrix.has_failed()) << told(matrix);
}

TEST_F(StressedScene, FramesStartsAndNumbersDoNotMatter) {
  const StressMatrix matrix = stressed(quarter(), {"S1", "S2", "S3", "S4", "S6", "S7", "S9", "S22", "P"});
  EXPECT_GT(matrix.count(Verdict::Pass), 20) << told(matrix);
  EXPECT_EQ(matrix.count(Verdict::Fail) + matrix.count(Verdict::OtherBranch), 0) << told(matrix);
  const std::set<std::string> kRoundOff = {"slivers of aspect 1e+06", "membranes times 1e+08"};
  for (const StressResult& result : matrix.results)  // where round-off ends above the tolerance
    EXPECT_TRUE(result.outcome.verdict != Verdict::Stall || kRoundOff.contains(result.row.name))
        << result.row.id << " " << result.row.name << ": " << result.outcome.message;
  for (const StressResult& result : matrix.results) {
    const bool is_left_out = result.outcome.verdict == Verdict::NotApplicable;
    // It has no lines; and planes of symmetry cannot be turned obliquely.
    const std::string& name = result.row.name;
    EXPECT_EQ(is_left_out,
              name.starts_with("lines") || name.starts_with("chords") || name.starts_with("turned"))
        << result.row.id << " " << name << ": " << result.outcome.message;
  }
}

TEST_F(StressedScene, ContactKeepsItsPromiseAtEveryState) {
  const StressMatrix matrix = stressed(pressed(), {"S13", "S17", "S18"});
  EXPECT_FALSE(matrix.has_failed()) << told(matrix);
  EXPECT_GT(matrix.count(Verdict::Pass), 4) << told(matrix);
  for (const StressResult& result : matrix.results)
    if (result.row.id == "S13") {
      EXPECT_EQ(result.outcome.verdict, Verdict::Pass) << result.outcome.message;
      EXPECT_EQ(result.outcome.figure, 0);
      EXPECT_NE(result.outcome.message.find("states were judged"), std::string::npos);
    }
}

TEST_F(StressedScene, ARunThatIsStoppedOnItsWayIsTakenUpAgain) {
  write_mesh(folder_.path() / "disc.obj", disc(10, 100));
  const Scene scene = load_scene(folder_.write("moved.json", R"({"mesh": {"file": "disc.obj"},
      "boundary": [{"nodes": "boundary", "move_to": [{"translate": [0, 0, 4]}]}], "motion": {"steps": 8},
      "terms": [{"type": "cst_tension_field", "young": "1 MPa", "poisson": 0.3, "thickness": "0.1 mm"},
                {"type": "load_pressure", "value": "0.1 kPa"}],
      "solver": {"type": "newton", "tolerance": 1e-8}})"));
  const StressMatrix matrix = stressed(scene, {"S17"});
  int resumed = 0;
  for (const StressResult& result : matrix.results) {
    EXPECT_EQ(result.outcome.verdict, Verdict::Pass) << told(matrix);
    if (!result.row.name.ends_with("taken up again")) continue;
    ++resumed;
    ASSERT_TRUE(result.outcome.figure.has_value()) << result.row.name;
    EXPECT_LE(*result.outcome.figure, 1e-6) << result.row.name;
    EXPECT_NE(result.outcome.message.find("taken up again after"), std::string::npos)
        << result.row.name << ": " << result.outcome.message;
  }
  EXPECT_EQ(resumed, 6);
}

TEST_F(StressedScene, ThreadsAreComparedWhereTheyHaveWork) {
  StressMatrix matrix = stressed(quarter(), {"S19"});
  ASSERT_EQ(matrix.results.size(), 1u);
  EXPECT_EQ(matrix.results[0].outcome.verdict, Verdict::NotApplicable);
  EXPECT_NE(matrix.results[0].outcome.message.find("4000"), std::string::npos);

  matrix = stressed(clamped(5000), {"S19"});
  ASSERT_EQ(matrix.results.size(), 1u);
  const StressOutcome& outcome = matrix.results[0].outcome;
  EXPECT_EQ(outcome.verdict, Verdict::Pass) << outcome.message;
  EXPECT_EQ(outcome.figure, 0);
  ASSERT_TRUE(outcome.iterations.has_value());
  EXPECT_GT(*outcome.iterations, 2);
}

TEST_F(StressedScene, APageShowsTheSolutionThatRowsWereComparedWith) {
  EXPECT_FALSE(stressed(clamped(), {"S8"}).shown.has_value());  // it needs none
  const StressMatrix matrix = stressed(clamped(), {"S18"});
  ASSERT_TRUE(matrix.shown.has_value());
  const std::string page = stress_page(matrix);
  for (const char* part : {"clamped.json: what the rows are compared with", "All figures of the result",
                           "certificate", "Residual against iterates"})
    EXPECT_NE(page.find(part), std::string::npos) << part;
  if (!has_shape_view()) GTEST_SKIP() << "this build draws no shapes";
  EXPECT_NE(page.find("id=\"shape-data\""), std::string::npos);
  expect_a_way(matrix.shown->view);
  EXPECT_LT(matrix.shown->view.states.front().x.row(2).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_GT(matrix.shown->view.states.back().x.row(2).maxCoeff(), 1);
}

TEST_F(StressedScene, InputDescentAndStepsAreJudgedOnAnyScene) {
  for (const bool has_contact : {false, true}) {
    const StressMatrix matrix =
        stressed(has_contact ? pressed() : clamped(), {"S8", "S15", "S20", "S21", "S23", "S24"});
    EXPECT_FALSE(matrix.has_failed()) << told(matrix);
    for (const StressResult& result : matrix.results) {
      const std::string& id = result.row.id;
      const bool applies = id == "S8" || id == "S20" || id == (has_contact ? "S15" : "S21");
      EXPECT_EQ(result.outcome.verdict, applies ? Verdict::Pass : Verdict::NotApplicable)
          << id << ": " << result.outcome.message;
    }
  }
}

TEST_F(StressedScene, AnEnergyThatRisesIsToldUnlessAnotherRoundBegins) {
  Model model = build(clamped());
  Result result;
  result.q = model.q0;
  result.trace.resize(3);
  result.trace[0].energy = 1;
  result.trace[1].energy = 0.5;
  result.trace[2].energy = 0.6;
  result.trace[2].iteration = 2;
  const std::string rise = energy_rise(result, *model.objective, model.X);
  EXPECT_NE(rise.find("in iteration 2"), std::string::npos) << rise;
  result.trace[2].outer_iteration = 1;
  EXPECT_EQ(energy_rise(result, *model.objective, model.X), "");
}

TEST_F(StressedScene, RowsThatAreNotThereAreNamedWithThoseThatAre) {
  try {
    stressed(quarter(), {"S1", "S99", "s2"});
    FAIL() << "accepted";
  } catch (const InputError& error) {
    ASSERT_EQ(error.defects().size(), 2u);
    EXPECT_NE(error.defects()[0].find("\"S99\""), std::string::npos);
    EXPECT_NE(error.defects()[1].find("S22"), std::string::npos);
  }
}

TEST_F(StressedScene, SliversAreThinAndKeepTheirSides) {
  StressScene scene = stress_scene(quarter());
  const TriangleMesh before = scene.geometry.model.mesh;
  ASSERT_GT(add_slivers(scene, 1e-4, 10), 3);
  const TriangleMesh& after = scene.geometry.model.mesh;
  double thinnest = 1;
  for (const auto& t : after.triangles.colwise()) {
    const Vec3 area = area_vector(after.vertices, t);
    EXPECT_GT(area.dot(area_vector(before.vertices, t)), 0);
    double longest = 0;
    for (int k = 0; k < 3; ++k)
      longest = std::max(longest, (after.vertices.col(t[k]) - after.vertices.col(t[(k + 1) % 3])).norm());
    thinnest = std::min(thinnest, 2 * area.norm() / (longest * longest));
  }
  EXPECT_LT(thinnest, 2e-4);
  EXPECT_GT(thinnest, 1e-5);
  EXPECT_EQ(after.vertices, scene.geometry.model.X.leftCols(after.vertex_count()));
}

}  // namespace
}  // namespace coapt
