// The generated valve closes with the command's own settings, and a valve that does not is said to stand
// open.
#include "exchange/import.hpp"
#include "results/result_warnings.hpp"
#include "run/run.hpp"
#include "support/temporary_folder.hpp"
#include "valve/generators/mitral.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <numeric>
#include <vector>

namespace coapt {
namespace {

struct ClosingValve : testing::Test {
  RunReport closed(const Valve& valve) {
    write_valve_scene(valve, folder_.path());
    RunOptions options;
    options.writes = false;
    return run(load_scene(folder_.path() / "scene.json"), scene_solvers(), options);
  }

  TemporaryFolder folder_;
};

// The strain that 95 % of the leaflets' area at rest do not exceed.
double strain_of_most(const RunReport& run) {
  const Model& model = run.model;
  std::vector<int> order(static_cast<size_t>(model.mesh.triangle_count()));
  std::iota(order.begin(), order.end(), 0);
  const auto strain = [&](int t) { return run.report.fields.principal_strain(0, t); };
  std::sort(order.begin(), order.end(), [&](int a, int b) { return strain(a) < strain(b); });
  double left = 0.95 * surface_area(model.X.leftCols(model.mesh.vertex_count()), model.mesh.triangles);
  for (const int t : order)
    if ((left -= area_vector(model.X, model.mesh.triangles.col(t)).norm()) <= 0) return strain(t);
  return strain(order.back());
}

void expect_healthy(const RunReport& run) {
  const Metrics& metrics = run.report.metrics;
  EXPECT_EQ(run.report.result.status, Status::Converged) << run.report.result.message;
  EXPECT_LT(metrics.regurgitant_area_mm2.value(), 1);
  EXPECT_GE(metrics.coaptation_height_mm.value(), 3);
  EXPECT_LE(metrics.coaptation_height_mm.value(), 8);
  EXPECT_LT(strain_of_most(run), 0.25);
  EXPECT_LT(metrics.prolapse_height_mm.value(), 2);
  EXPECT_EQ(metrics.intersections, 0);
  EXPECT_EQ(standing_open(metrics), "");
}

TEST_F(ClosingValve, ClosesOnCoarseMeshesOfSeveralSeeds) {
  for (unsigned seed = 0; seed < 6; ++seed) {
    SCOPED_TRACE(seed);
    expect_healthy(closed(mitral_valve({.triangles = 630, .seed = seed})));
  }
}

TEST_F(ClosingValve, ClosesOnTheDefaultMeshAndMeetsEveryCriterion) {
  const RunReport run = closed(mitral_valve({}));
  expect_healthy(run);
  ASSERT_FALSE(run.report.metrics.healthy_closure.empty());
  for (const HealthyCriterion& criterion : run.report.metrics.healthy_closure)
    EXPECT_TRUE(criterion.is_met()) << figure_in_words(criterion);
}

TEST_F(ClosingValve, LeaksAsTheBenchmarkDoesWithoutStandingOpen) {
  const RunReport run = closed(mitral_valve({.triangles = 630, .preset = MitralPreset::Benchmark}));
  EXPECT_GT(run.report.metrics.regurgitant_area_mm2.value(), 1);
  EXPECT_EQ(standing_open(run.report.metrics), "");
}

TEST_F(ClosingValve, StandsOpenOnADilatedAnnulus) {
  Valve valve = mitral_valve({.triangles = 400});
  valve.annulus_closed.topRows(2) *= 1.4;
  const RunReport run = closed(valve);
  ASSERT_EQ(run.report.result.status, Status::Converged) << run.report.result.message;
  EXPECT_NE(headline(run.report).text.find("the valve stands open"), std::string::npos);
  EXPECT_TRUE(headline(run.report).is_in_doubt);
  const auto json = nlohmann::json::parse(result_json(run.model, run.report));
  EXPECT_TRUE(json["converged"].get<bool>());
  EXPECT_EQ(json["stands_open"].get<std::string>(), standing_open(run.report.metrics));
}

TEST(StandingOpen, IsSaidOfSevereOrificesAndOfLeafletsThatMeetNowhere) {
  Metrics metrics;
  EXPECT_EQ(standing_open(metrics), "");  // no annulus
  metrics.regurgitant_area_mm2 = 39;
  metrics.coaptation_length_mm = 20;
  EXPECT_EQ(standing_open(metrics), "");
  metrics.regurgitant_area_mm2 = 41;
  EXPECT_EQ(standing_open(metrics),
            "the valve stands open: 41 mm2 of regurgitant orifice, as in severe regurgitation (40 and more)");
  metrics.regurgitant_area_mm2 = 5;
  metrics.coaptation_length_mm = 0;
  EXPECT_EQ(standing_open(metrics),
            "the valve stands open: 5 mm2 of regurgitant orifice; its leaflets meet nowhere");
  metrics.regurgitant_area_mm2 = 0;  // a membrane that covers its annulus
  EXPECT_EQ(standing_open(metrics), "");
}

}  // namespace
}  // namespace coapt
