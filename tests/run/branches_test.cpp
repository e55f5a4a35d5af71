// Other equilibria near the one that a solve found, from perturbed starts.
#include "run/branches.hpp"

#include "formats/mesh_io.hpp"
#include "mesh/shapes.hpp"
#include "results/neighbour_check.hpp"
#include "results/result_warnings.hpp"
#include "scene/build/build.hpp"
#include "solve/solve_scene.hpp"
#include "support/temporary_folder.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

namespace coapt {
namespace {

class BranchesOfAScene : public testing::Test {
 protected:
  // A shallow pyramid, 10 mm wide and 1 mm high, of a membrane that resists compression: pushed at its apex
  // by less than it takes to snap it through, it is at rest above its base, and turned inside out below.
  Scene pyramid() {
    TriangleMesh mesh;
    mesh.vertices.resize(3, 5);
    mesh.vertices << -5, 5, 5, -5, 0, -5, -5, 5, 5, 0, 0, 0, 0, 0, 1;
    mesh.triangles.resize(3, 4);
    mesh.triangles << 0, 1, 2, 3, 1, 2, 3, 0, 4, 4, 4, 4;
    write_mesh(folder_.path() / "pyramid.obj", mesh);
    return load_scene(folder_.write("pyramid.json", R"({"mesh": {"file": "pyramid.obj"},
      "boundary": [{"nodes": "boundary", "fix": true}],
      "terms": [{"type": "cst_stvk", "young": "1 MPa", "poisson": 0.3, "thickness": "0.5 mm"},
                {"type": "load_field", "nodes": [4], "force": "0.001 N", "direction": [0, 0, -1]}]})"));
  }

  Scene blown_disc() {
    write_mesh(folder_.path() / "disc.obj", disc(10, 200));
    return load_scene(folder_.write("disc.json", R"({"mesh": {"file": "disc.obj"},
      "boundary": [{"nodes": "boundary", "fix": true}],
      "terms": [{"type": "cst_tension_field", "young": "1 MPa", "thickness": "0.5 mm"},
                {"type": "load_pressure", "value": "1 kPa"}]})"));
  }

  Branches found(const Scene& scene, const BranchSearch& search) {
    RunOptions options;
    options.writes = false;
    RunReport report = run(scene, scene_solvers(), options);
    EXPECT_EQ(report.report.result.status, Status::Converged) << report.report.result.message;
    return find_branches(scene, scene_solvers(), options, search, report.model, report.report);
  }

  TemporaryFolder folder_;
};

TEST_F(BranchesOfAScene, FindsTheShallowPyramidTurnedInsideOut) {
  const Branches branches = found(pyramid(), {.starts = 12, .kick = 0.5, .seed = 1});
  EXPECT_EQ(branches.starts, 24);
  EXPECT_EQ(branches.starts_along_path, 12);
  EXPECT_EQ(branches.not_converged, 0);
  ASSERT_EQ(branches.equilibria.size(), 2u) << branches_message(branches);
  const NearbyEquilibrium &own = branches.equilibria[0], &other = branches.equilibria[1];
  EXPECT_EQ(own.greatest_mm, 0);
  EXPECT_GT(own.found, 0);
  EXPECT_GT(other.found, 0);
  EXPECT_EQ(own.found + other.found, 24);
  EXPECT_NEAR(other.greatest_mm, 2, 0.02);  // from one millimetre above to one below
  EXPECT_EQ(other.stability, Stability::StrictMinimum);
  EXPECT_NEAR(own.energy - other.energy, 0.002, 2e-5);  // what the load does on the way
  ASSERT_FALSE(branches.others.empty());
  for (const BranchRange& range : branches.others)
    if (range.name == "max_displacement_mm") {
      EXPECT_NEAR(range.lowest, 2, 0.02);
      EXPECT_EQ(range.lowest, range.highest);  // there is one other
    }
  EXPECT_EQ(branches_message(branches).find("1 other near by, from 24 perturbed starts"), 0u)
      << branches_message(branches);
}

TEST_F(BranchesOfAScene, TellsNodeByNodeWhatIsNotDetermined) {
  const Branches branches = found(pyramid(), {.starts = 12, .kick = 0.5, .seed = 1});
  ASSERT_EQ(branches.spread_mm.size(), 5);
  for (int corner = 0; corner < 4; ++corner) EXPECT_EQ(branches.spread_mm[corner], 0) << corner;
  EXPECT_NEAR(branches.spread_mm[4], branches.equilibria[1].greatest_mm, 1e-12);
  EXPECT_EQ(undetermined_flags({}, branches, 5), (std::vector<char>{0, 0, 0, 0, 2}));
  // What costs nothing is free, whatever the branches say of it.
  EXPECT_EQ(undetermined_flags({1, 4}, branches, 5), (std::vector<char>{0, 1, 0, 0, 1}));
  EXPECT_EQ(undetermined_nodes({1}, branches).total(), 2);
  EXPECT_EQ(undetermined_nodes({1}, branches).free, 1);
  EXPECT_EQ(undetermined_nodes({1}, std::nullopt).total(), 1);
  EXPECT_EQ(undetermined_nodes({}, std::nullopt).total(), 0);
}

TEST_F(BranchesOfAScene, WritesThemIntoEveryFileOfTheResult) {
  const Scene scene = pyramid();
  RunOptions options;
  options.folder = folder_.path() / "result";
  RunReport report = run(scene, scene_solvers(), options);
  EXPECT_EQ(text_of(options.folder / "metrics.csv").find("others_lowest"), std::string::npos);
  EXPECT_EQ(text_of(options.folder / "closed.vtp").find("branch_spread"), std::string::npos);
  report.report = with_branches(scene, scene_solvers(), options, {.starts = 12, .kick = 0.5, .seed = 1},
                                report.model, std::move(report.report), report.folder);
  ASSERT_TRUE(report.report.branches.has_value());
  const BranchRange* range = range_of(report.report.branches, "max_displacement_mm");
  ASSERT_NE(range, nullptr);
  EXPECT_EQ(range_of(report.report.branches, "no such metric"), nullptr);
  EXPECT_EQ(range_of(std::nullopt, "max_displacement_mm"), nullptr);

  const std::string table = text_of(options.folder / "metrics.csv");
  EXPECT_EQ(table.find("metric,value,unit,others_lowest,others_highest\n"), 0u) << table;
  std::ostringstream row;
  row.precision(10);
  row << ",mm," << range->lowest << ',' << range->highest << '\n';
  EXPECT_NE(table.find(row.str()), std::string::npos) << table;
  const std::string surface = text_of(options.folder / "closed.vtp");
  for (const char* name : {"branch_spread", "undetermined"})
    EXPECT_NE(surface.find(name), std::string::npos) << name;
  const std::string page = text_of(options.folder / "report.html");
  EXPECT_NE(page.find("Other equilibria near by"), std::string::npos);
  const size_t figures = page.find("<dl class=\"tiles\">");
  ASSERT_NE(figures, std::string::npos);
  for (const char* warning : {"one of several equilibria: 1 other near by",
                              "not determined: 1 (0 can be moved at no cost, 1 others differ"})
    EXPECT_LT(page.find(warning), figures) << warning;
  EXPECT_EQ(page.find("Warning: ", figures), std::string::npos);
  const nlohmann::json result = nlohmann::json::parse(text_of(options.folder / "result.json"));
  EXPECT_EQ(result["undetermined_nodes"]["differing"], 1);
  EXPECT_EQ(result["branches"]["equilibria"][1]["left_out_nodes"], 0);
  EXPECT_EQ(result["branches"]["equilibria"].size(), 2u);
}

TEST_F(BranchesOfAScene, SaysWhereTheyWereNotLookedFor) {
  const Scene scene = blown_disc();
  RunOptions options;
  options.writes = false;
  RunReport report = run(scene, scene_solvers(), options);
  report.report = with_branches(scene, scene_solvers(), options, {.starts = 0}, report.model,
                                std::move(report.report), report.folder);
  EXPECT_FALSE(report.report.branches.has_value());
  EXPECT_TRUE(report.report.warnings.empty());
  report.report.result.status = Status::Stalled;
  report.report = with_branches(scene, scene_solvers(), options, {.starts = 1}, report.model,
                                std::move(report.report), report.folder);
  EXPECT_FALSE(report.report.branches.has_value());
  ASSERT_EQ(report.report.warnings.size(), 1u);
  EXPECT_NE(report.report.warnings[0].find("No other equilibria"), std::string::npos);
}

TEST(Headline, SaysThatFacetsPassThroughEachOther) {
  Report report;
  report.result.status = Status::Converged;
  report.result.message = "converged";
  EXPECT_FALSE(headline(report).is_in_doubt);
  report.metrics.intersections = 151;
  EXPECT_EQ(headline(report).text, "converged; 151 pairs of facets pass through each other");
  EXPECT_TRUE(headline(report).is_in_doubt);
  withdraw_penetrated(report);
  EXPECT_EQ(report.result.status, Status::Converged) << "nothing was to keep them apart";
}

TEST(Headline, CallsNothingConvergedThatCollisionsLetThrough) {
  Report report;
  report.result.status = Status::Converged;
  report.result.residual = 2e-9;
  report.has_collisions = true;
  withdraw_penetrated(report);
  EXPECT_EQ(report.result.status, Status::Converged);
  report.metrics.intersections = 151;
  withdraw_penetrated(report);
  EXPECT_EQ(report.result.status, Status::Stalled);
  EXPECT_EQ(headline(report).text,
            "not converged: 151 pairs of facets pass through each other, which `solver.dynamics.collisions` "
            "were to "
            "keep apart; at rest with a residual of 2e-09");
}

TEST(Headline, DoubtsAnEquilibriumWhoseChordsHangSlack) {
  Report report;
  report.result.message = "converged";
  report.result.status = Status::Converged;
  report.fields.line_strain = Vector::Zero(4);
  report.metrics.slack_chords = 2;
  EXPECT_FALSE(headline(report).is_in_doubt);
  report.metrics.slack_chords = 3;
  EXPECT_TRUE(headline(report).is_in_doubt);
  EXPECT_EQ(headline(report).text, "converged; most chords are slack");
}

TEST(Headline, DoubtsASaddle) {
  Report report;
  report.result.message = "converged";
  report.result.status = Status::Converged;
  report.result.certificate.is_made = true;
  report.result.certificate.stability.verdict = Stability::Stable;
  EXPECT_FALSE(headline(report).is_in_doubt);
  report.result.certificate.stability.verdict = Stability::Saddle;
  report.result.certificate.stability.negative_modes = 2;
  EXPECT_TRUE(headline(report).is_in_doubt);
  EXPECT_EQ(doubts(report), std::vector<std::string>{"its stability is in doubt (a saddle of the energy, "
                                                     "with 2 negative modes)"});
}

// A square of two facets, with one more on their common edge, or one of them turned over.
TEST(Headline, DoubtsASurfaceOnWhichTheSideOfPressureIsNotDefined) {
  Report report;
  report.result.message = "converged";
  report.result.status = Status::Converged;
  TriangleMesh mesh;
  mesh.vertices = (Points(3, 5) << 0, 1, 1, 0, 0, 0, 0, 1, 1, 0, 0, 0, 0, 0, 1).finished();
  mesh.triangles = (Triangles(3, 2) << 0, 0, 1, 2, 2, 3).finished();
  report.surface_doubts = surface_doubts(mesh);
  EXPECT_FALSE(headline(report).is_in_doubt);
  mesh.triangles = (Triangles(3, 3) << 0, 0, 0, 1, 2, 2, 2, 3, 4).finished();
  report.surface_doubts = surface_doubts(mesh);
  EXPECT_EQ(headline(report).text, "converged; 1 edge has more than two facets");
  EXPECT_TRUE(headline(report).is_in_doubt);
  mesh.triangles = (Triangles(3, 2) << 0, 0, 1, 3, 2, 2).finished();
  report.surface_doubts = surface_doubts(mesh);
  EXPECT_EQ(headline(report).text, "converged; the normal of 1 facet points against the neighbours'");
  report.result.status = Status::Stalled;
  EXPECT_EQ(headline(report).text, "converged") << "doubts are those of an equilibrium";
}

TEST(Headline, SaysWhyNoPerturbedStartTellsAnything) {
  Report report;
  report.result.status = Status::Converged;
  report.branches.emplace();
  report.branches->equilibria.resize(1);
  report.branches->starts = report.branches->not_converged = 4;
  report.branches->first_failure = "stalled at residual 1e-3";
  const std::vector<std::string> warnings = result_warnings(report);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_EQ(
      warnings[0],
      "Nothing is known of other equilibria: none of 4 perturbed starts converged (the first: stalled at "
      "residual 1e-3).");
  report.branches->not_converged = 3;
  EXPECT_TRUE(result_warnings(report).empty());
}

TEST(Headline, SaysOfAnEquilibriumThatItMayNotBeTheOnlyOne) {
  Report report;
  report.result.message = "converged";
  report.result.status = Status::Stalled;
  report.neighbours.is_suspected = true;
  EXPECT_EQ(headline(report).text, "converged") << "no equilibrium, no doubt about others";
  report.result.status = Status::Converged;
  EXPECT_EQ(headline(report).text, "converged; there may be other equilibria near by");
  EXPECT_TRUE(headline(report).is_in_doubt);
  report.branches.emplace().equilibria.resize(1);
  EXPECT_EQ(headline(report).text, "converged; there may be other equilibria near by") << "before any start";
  report.branches->starts = kUsualStarts - 1;
  EXPECT_EQ(headline(report).text, "converged; there may be other equilibria near by")
      << "fewer than advised";
  report.branches->starts = kUsualStarts + 1;
  report.branches->not_converged = 2;
  EXPECT_EQ(headline(report).text, "converged; there may be other equilibria near by") << "too few converged";
  report.branches->starts = kUsualStarts + 2;
  EXPECT_EQ(headline(report).text, "converged") << "a search found none";
  report.branches->equilibria.resize(2);
  EXPECT_EQ(headline(report).text, "converged; one of several equilibria");
  EXPECT_TRUE(headline(report).is_in_doubt);
}

TEST(NeighbourCheck, SuspectsALongWayOfNewtonAlone) {
  Result result;
  result.status = Status::Converged;
  result.iterations = 39;
  EXPECT_TRUE(check_neighbours("newton", result, {}).is_made);
  EXPECT_FALSE(check_neighbours("newton", result, {}).is_suspected);
  EXPECT_EQ(neighbour_warning(check_neighbours("newton", result, {})), "");
  CascadeLevel coarse;
  coarse.iterations = 62;
  const NeighbourCheck by_level = check_neighbours("newton", result, {coarse});
  EXPECT_TRUE(by_level.is_suspected);
  EXPECT_NE(neighbour_warning(by_level).find("62 iterations"), std::string::npos);
  EXPECT_NE(neighbour_warning(by_level).find("--branches 5"), std::string::npos);
  result.iterations = 400;
  EXPECT_TRUE(check_neighbours("newton", result, {}).is_suspected);
  Result damped = result;
  damped.damped_steps = 24;
  EXPECT_FALSE(check_neighbours("newton", damped, {}).is_made) << "nobody looked at its steps";
  damped.unstable_steps = 0;
  EXPECT_TRUE(check_neighbours("newton", damped, {}).is_made);
  EXPECT_EQ(neighbour_warning(check_neighbours("newton", damped, {})), "");
  damped.unstable_steps = 1;
  EXPECT_EQ(neighbour_warning(check_neighbours("newton", damped, {})), "");
  damped.unstable_steps = 2;
  EXPECT_NE(neighbour_warning(check_neighbours("dynamic", damped, {})).find("unstable in 2 steps"),
            std::string::npos);
  EXPECT_FALSE(check_neighbours("lbfgs", result, {}).is_made);  // its iterates are many everywhere
  EXPECT_FALSE(check_neighbours("lbfgs", result, {}).is_suspected);
  result.status = Status::Stalled;
  EXPECT_FALSE(check_neighbours("newton", result, {}).is_suspected);
}

TEST_F(BranchesOfAScene, SeesOneStateWhereTheKickDoesNotReachAnother) {
  const Branches branches = found(pyramid(), {.starts = 4});
  EXPECT_EQ(branches.equilibria.size(), 1u);
  EXPECT_EQ(branches.equilibria[0].found, 8);
  EXPECT_TRUE(branches.others.empty());
}

TEST_F(BranchesOfAScene, ComesBackToTheOneStateOfABlownDisc) {
  const Branches branches = found(blown_disc(), {.starts = 3, .kick = 0.2, .seed = 7});
  ASSERT_EQ(branches.equilibria.size(), 1u) << branches_message(branches);
  EXPECT_EQ(branches.equilibria[0].found, 6);
  EXPECT_GT(branches.greatest_return_mm, 0);  // the starts were others
  EXPECT_LT(branches.greatest_return_mm, branches.tolerance_mm);
  EXPECT_NEAR(branches.least_moved_share, 1, 1e-12);  // no contact in the way
  EXPECT_EQ(branches_message(branches).find("6 perturbed starts came back to the same state"), 0u)
      << branches_message(branches);
}

TEST_F(BranchesOfAScene, DoesTheSameForTheSameSeed) {
  const Branches a = found(blown_disc(), {.starts = 1, .seed = 3}),
                 b = found(blown_disc(), {.starts = 1, .seed = 3}),
                 c = found(blown_disc(), {.starts = 1, .seed = 4});
  EXPECT_EQ(a.greatest_return_mm, b.greatest_return_mm);
  EXPECT_NE(a.greatest_return_mm, c.greatest_return_mm);
}

TEST_F(BranchesOfAScene, GoesTheWayAgainWhereItIsToldTo) {
  const Branches alone = found(pyramid(), {.starts = 3, .kick = 1e-3, .along_path = false});
  EXPECT_EQ(alone.starts, 3);
  EXPECT_EQ(alone.starts_along_path, 0);
  const Branches both = found(pyramid(), {.starts = 3, .kick = 1e-3});
  EXPECT_EQ(both.starts, 6);
  EXPECT_EQ(both.equilibria[0].found, 6);
}

TEST_F(BranchesOfAScene, StopsWhereTheUserInterrupts) {
  const Scene scene = blown_disc();
  RunOptions options;
  options.writes = false;
  RunReport report = run(scene, scene_solvers(), options);
  int iterates = 0;
  options.observer = [&iterates](const Iteration&, const Vector&) { return ++iterates < 2; };
  const Branches branches =
      find_branches(scene, scene_solvers(), options, {.starts = 5, .kick = 0.2}, report.model, report.report);
  EXPECT_LT(branches.starts, 5);
  EXPECT_EQ(branches.equilibria.size(), 1u);
}

TEST_F(BranchesOfAScene, ASearchOfFewerStartsThanAdvisedWithdrawsNoSuspicion) {
  const Scene scene = blown_disc();
  RunOptions options;
  options.writes = false;
  RunReport run = coapt::run(scene, scene_solvers(), options);
  run.report.neighbours = {.is_made = true, .is_suspected = true, .iterates = 400};
  const std::string warning = neighbour_warning(run.report.neighbours);
  run.report.warnings.push_back(warning);
  const auto is_suspected = [&](const Report& report) {
    const std::vector<std::string> said = doubts(report);
    const bool is_warned =
        std::find(report.warnings.begin(), report.warnings.end(), warning) != report.warnings.end();
    const bool is_doubted =
        std::find(said.begin(), said.end(), "there may be other equilibria near by") != said.end();
    EXPECT_EQ(is_warned, is_doubted);
    return is_warned;
  };
  ASSERT_TRUE(is_suspected(run.report));
  BranchSearch search = {.starts = 1, .kick = 0.2};
  RunOptions interrupted = options;
  interrupted.observer = [](const Iteration&, const Vector&) { return false; };
  const Report cut_short =
      with_branches(scene, scene_solvers(), interrupted, search, run.model, run.report, {});
  EXPECT_EQ(cut_short.branches->starts, 0);
  EXPECT_TRUE(is_suspected(cut_short));
  const auto searched = [&] {
    return with_branches(scene, scene_solvers(), options, search, run.model, run.report, {});
  };
  EXPECT_TRUE(is_suspected(searched()));
  search.starts = kUsualStarts;
  EXPECT_FALSE(is_suspected(searched()));
}

}  // namespace
}  // namespace coapt
