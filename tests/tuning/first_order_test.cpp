// The response of a result to its parameters, against scenes that are solved anew.
#include "tuning/first_order.hpp"

#include "exchange/import.hpp"
#include "scene/file/scene_parameter.hpp"
#include "study/bench_fixture.hpp"
#include "tuning/tracked_scene.hpp"
#include "valve/generators/mitral.hpp"

#include <algorithm>
#include <cmath>

namespace coapt {
namespace {

const FirstOrderOptions kAll{.share = kInfinity};  // whatever the machine is busy with

class FirstOrderTest : public BenchFixture {
 protected:
  FirstOrderTest() {
    run_.writes = false;
    run_.tolerance = 1e-9;
  }

  const ParameterResponse* find(const FirstOrder& found, const std::string& key) {
    const auto at = std::find_if(found.parameters.begin(), found.parameters.end(),
                                 [&](const ParameterResponse& each) { return each.key == key; });
    return at == found.parameters.end() ? nullptr : &*at;
  }

  static double value_of(const std::vector<MetricRow>& rows, const std::string& name) {
    for (const MetricRow& row : rows)
      if (row.name == name) return row.value.value_or(kNaN);
    return kNaN;
  }
};

// The shape at both ends is that of a scene with the other number, to the error that is told; so are figures.
TEST_F(FirstOrderTest, HoldsOverItsRange) {
  const Scene scene = disc_scene(200);
  const RunReport solved = run(scene, scene_solvers(), run_);
  ASSERT_EQ(solved.report.result.status, Status::Converged);
  const FirstOrder found = first_order(scene, scene_solvers(), run_, solved.model, solved.report, kAll);
  EXPECT_EQ(found.message, "");
  EXPECT_EQ(found.tolerance_mm, 0.1);
  EXPECT_GE(found.candidates, 3);
  const std::string membrane = scene.terms[0].name, load = scene.terms[1].name;
  for (const auto& [key, number] : std::vector<std::pair<std::string, std::string>>{
           {membrane + ".stiffness", membrane + ".young"}, {load + ".pressure", load + ".value"}}) {
    const ParameterResponse* response = find(found, key);
    ASSERT_NE(response, nullptr) << key;
    EXPECT_EQ(response->unit, "%");
    for (const CheckedEnd& end : response->ends) {
      EXPECT_EQ(std::abs(end.change), 10) << "the usual range, which is smooth here";
      const RunReport other =
          run(scaled(scene, find_parameter(scene, number), 1 + end.change / 100), scene_solvers(), run_);
      ASSERT_EQ(other.report.result.status, Status::Converged);
      const Points apart = other.report.fields.x - solved.report.fields.x - end.change * response->motion;
      const double error = std::sqrt(apart.colwise().squaredNorm().maxCoeff());
      EXPECT_NEAR(error, end.error_mm, 0.002) << key;
      EXPECT_LE(error, 0.1);
      const double moved = std::sqrt((end.change * response->motion).colwise().squaredNorm().maxCoeff());
      EXPECT_GT(moved, 5 * error) << "a first order that is worth something";
      for (const char* name : {"max_displacement_mm", "max_principal_strain", "max_cauchy_stress_kpa"})
        EXPECT_NEAR(value_of(end.figures, name), value_of(metric_rows(other.report.metrics), name),
                    2e-3 * value_of(end.figures, name))
            << key << " " << name;
    }
  }
}

TEST_F(FirstOrderTest, ShrinksTheRangeToItsTolerance) {
  const Scene scene = disc_scene(54);
  const RunReport solved = run(scene, scene_solvers(), run_);
  const FirstOrder wide = first_order(scene, scene_solvers(), run_, solved.model, solved.report, kAll),
                   narrow = first_order(scene, scene_solvers(), run_, solved.model, solved.report,
                                        {.most = 2, .tolerance_mm = 1e-5, .share = kInfinity});
  ASSERT_EQ(narrow.parameters.size(), 2u);
  for (const ParameterResponse& response : narrow.parameters)
    for (const CheckedEnd& end : response.ends) {
      EXPECT_LE(end.error_mm, 1e-5);
      EXPECT_NE(end.change, 0);
      EXPECT_LT(std::abs(end.change), 5);
    }
  EXPECT_GE(wide.parameters.front().movement_mm, wide.parameters.back().movement_mm);
}

TEST_F(FirstOrderTest, LeavesTheResultAsItIsAndSaysWhyThereIsNone) {
  const Scene scene = disc_scene(54);
  const RunReport solved = run(scene, scene_solvers(), run_);
  const Vector q = solved.report.result.q;
  const double energy = solved.model.objective->value(q);
  first_order(scene, scene_solvers(), run_, solved.model, solved.report);
  EXPECT_EQ(solved.model.objective->value(q), energy);
  Report other = solved.report;
  other.result.status = Status::IterationLimit;
  EXPECT_EQ(first_order(scene, scene_solvers(), run_, solved.model, other).message,
            "the solve did not converge");
  other = solved.report;
  other.result.certificate.stability.verdict = Stability::Saddle;
  EXPECT_EQ(first_order(scene, scene_solvers(), run_, solved.model, other).message,
            "the stability of the equilibrium is in doubt");
  const FirstOrder hurried =
      first_order(scene, scene_solvers(), run_, solved.model, solved.report, {.share = 0});
  EXPECT_GE(hurried.parameters.size(), 1u);
  RunOptions ended = run_;
  ended.observer = [](const Iteration&, const Vector&) { return false; };
  EXPECT_NE(first_order(scene, scene_solvers(), ended, solved.model, solved.report).message,
            "no parameter moves the sheet over a range in which the first order holds");
  ended = run_;
  ended.max_seconds = 1e-9;
  EXPECT_EQ(first_order(scene, scene_solvers(), ended, solved.model, solved.report).message,
            "the solve left no time for them");
  Scene gone = scene;
  gone.mesh->file = folder_.path() / "gone.obj";
  EXPECT_NE(
      first_order_of_runs(scene_solvers(), run_)(gone, solved.model, solved.report).message.find("gone.obj"),
      std::string::npos)
      << "a result keeps its page";
}

// Contact, chords that fall slack and an annulus that moves, against warm solves, and figures of the closure
// at both ends.
TEST_F(FirstOrderTest, IsWhereAWarmSolveOfAValveEnds) {
  write_valve_scene(mitral_valve({.triangles = 400, .preset = MitralPreset::Benchmark}), folder_.path());
  Scene scene = load_scene(folder_.path() / "scene.json");
  scene.solver.threads = 1;
  run_.tolerance.reset();
  const RunReport solved = run(scene, scene_solvers(), run_);
  ASSERT_EQ(solved.report.result.status, Status::Converged);
  const FirstOrder found = first_order(scene, scene_solvers(), run_, solved.model, solved.report, kAll);
  ASSERT_EQ(found.parameters.size(), 8u) << found.message;
  const Points& x = solved.report.fields.x;
  std::vector<int> nodes;
  for (int node = 0; node < solved.model.mesh.vertex_count(); ++node)
    if (solved.report.fields.undetermined.empty() ||
        !solved.report.fields.undetermined[static_cast<size_t>(node)])
      nodes.push_back(node);
  int ends = 0, close = 0, alike = 0;
  for (const ParameterResponse& response : found.parameters)
    for (const CheckedEnd& end : response.ends) {
      if (end.change == 0) continue;
      ++ends;
      EXPECT_LE(end.error_mm, 0.1);
      TrackedScene tracked = track_shape(scene, x.colwise() + solved.model.origin, scene_solvers(), run_,
                                         {.tolerance = solved.report.tolerance});
      TrackedEquilibrium& equilibrium = *tracked.equilibrium;
      equilibrium.add(make_named_parameter(response.key, scene, tracked));
      ASSERT_EQ(equilibrium.solve().status, Status::Converged);
      equilibrium.set(equilibrium.value() + end.change * response.unit_change);
      ASSERT_EQ(equilibrium.solve().status, Status::Converged);
      const Points apart = (equilibrium.positions() - x - end.change * response.motion)(Eigen::all, nodes);
      const double error = std::sqrt(apart.colwise().squaredNorm().maxCoeff());
      EXPECT_LE(error, 0.1) << response.name << " " << end.change;
      close += std::abs(error - end.error_mm) <= 0.01 ? 1 : 0;
      const Fields fields = compute_fields(tracked.model, equilibrium.positions());
      const Metrics there = measure(tracked.model, equilibrium.unknowns(), fields, IntersectionChecker{});
      const double told = value_of(end.figures, "tenting_height_mm");
      alike += std::abs(told - value_of(metric_rows(there), "tenting_height_mm")) <= 0.02 ? 1 : 0;
    }
  EXPECT_GE(ends, 14);
  EXPECT_GE(close, ends - 2) << "what is told is what a solve finds";
  EXPECT_GE(alike, ends - 2) << "but where another facet closes the valve";
}

// The hook of a run: the page has the sliders, and a run without a page computes none.
TEST_F(FirstOrderTest, IsAskedForWhereAPageIsWritten) {
  const Scene scene = disc_scene(54);
  int asked = 0;
  run_.first_order = [&, made = first_order_of_runs(scene_solvers(), run_)](
                         const Scene& of, const Model& model, const Report& report) {
    ++asked;
    return made(of, model, report);
  };
  run(scene, scene_solvers(), run_);
  run_.writes = true;
  run_.folder = folder_.path() / "out";
  run_.writes_page = false;
  run(scene, scene_solvers(), run_);
  EXPECT_EQ(asked, 0);
  run_.writes_page = true;
  const RunReport solved = run(scene, scene_solvers(), run_);
  EXPECT_EQ(asked, 1);
  ASSERT_TRUE(solved.report.first_order.has_value());
  EXPECT_GE(solved.report.first_order->parameters.size(), 3u);
}

}  // namespace
}  // namespace coapt
