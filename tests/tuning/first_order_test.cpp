// The response of a result to its parameters, against scenes that are solved anew.
#include "tuning/first_order.hpp"

#include "scene/file/scene_parameter.hpp"
#include "study/bench_fixture.hpp"
#include "tuning/tracked_scene.hpp"

#include <algorithm>
#include <cmath>

namespace coapt {
namespace {

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
  const FirstOrder found = first_order(scene, scene_solvers(), run_, solved.model, solved.report);
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
      EXPECT_NEAR(error, end.error_mm, 1e-6) << key;
      EXPECT_LE(error, 0.1);
      const double moved = std::sqrt((end.change * response->motion).colwise().squaredNorm().maxCoeff());
      EXPECT_GT(moved, 5 * error) << "a first order that is worth something";
      for (const char* name : {"max_displacement_mm", "max_principal_strain", "max_cauchy_stress_kpa"})
        EXPECT_NEAR(value_of(end.figures, name), value_of(metric_rows(other.report.metrics), name),
                    1e-5 * value_of(end.figures, name))
            << key << " " << name;
    }
  }
}

TEST_F(FirstOrderTest, ShrinksTheRangeToItsTolerance) {
  const Scene scene = disc_scene(54);
  const RunReport solved = run(scene, scene_solvers(), run_);
  const FirstOrder wide = first_order(scene, scene_solvers(), run_, solved.model, solved.report),
                   narrow = first_order(scene, scene_solvers(), run_, solved.model, solved.report,
                                        {.most = 2, .tolerance_mm = 1e-5});
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
  other.has_page = true;
  other = with_first_order(scene, scene_solvers(), run_, solved.model, other, {});
  EXPECT_FALSE(other.first_order.has_value());
  EXPECT_EQ(other.warnings.back(), "No sliders of parameters: the solve did not converge.");
}

}  // namespace
}  // namespace coapt
