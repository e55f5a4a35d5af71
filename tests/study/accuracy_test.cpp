// A solve to a wanted accuracy: its estimate against a truth that is computed later.
#include "study/bench/accuracy.hpp"

#include "mesh/remesh/uniform_refinement.hpp"
#include "study/bench/discretisation.hpp"
#include "study/bench_fixture.hpp"
#include "study/mesh_study.hpp"

#include <nlohmann/json.hpp>

namespace coapt {
namespace {

using AccuracyTest = BenchFixture;

TEST_F(AccuracyTest, KeepsWhatItPromises) {
  const Scene scene = disc_scene();
  run_.writes = false;
  run_.tolerance = 1e-11;
  const MeshStudy study = study_mesh(scene, solvers(), 4, run_);
  run_.tolerance.reset();
  int last_triangles = 0;
  for (const double wanted : {0.3, 0.05, 0.015}) {
    SCOPED_TRACE(wanted);
    const RunReport found = run_to_accuracy(scene, solvers(), wanted, run_);
    const AccuracyEstimate& estimate = found.report.accuracy.value();
    ASSERT_TRUE(estimate.is_reached) << estimate.message;
    EXPECT_LE(estimate.total_mm().value(), wanted);
    EXPECT_EQ(found.report.result.status, Status::Converged);
    EXPECT_EQ(found.report.tolerance, estimate.tolerance);

    const auto& level = study.levels[static_cast<size_t>(estimate.cuts)];
    const TriangleMesh closed = surface_at(found.model, found.report.fields.x);
    ASSERT_EQ(closed.triangle_count(), level.triangles);
    TriangleMesh sampled = closed;
    for (auto k = static_cast<size_t>(estimate.cuts) + 1; k < study.levels.size(); ++k)
      sampled = refined_uniformly(sampled).mesh;
    const double later = distance_between(sampled, study.levels.back().closed).p95;
    std::printf("  wanted %g mm: %s; later %.4f mm, order %.2f\n", wanted, estimate.message.c_str(), later,
                estimate.order.value_or(-1));
    EXPECT_LE(later, wanted);
    EXPECT_NEAR(estimate.discretisation_mm.value() / later, 1, 0.25);
    EXPECT_GT(estimate.greatest_mm().value(), estimate.total_mm().value());
    const double algebraic = (closed.vertices - level.closed.vertices).colwise().norm().maxCoeff();
    EXPECT_NEAR(*estimate.algebraic_mm, algebraic, 0.05 * algebraic + 1e-9);
    EXPECT_LE(algebraic, 0.1 * wanted);
    EXPECT_GT(closed.triangle_count(), last_triangles);
    last_triangles = closed.triangle_count();
  }
}

TEST(OrdersAgree, NeedsTwoThatAreAlike) {
  const auto agree = [](const std::vector<double>& distances) {
    MeshDistances found;
    for (const double d : distances) found.to_next.push_back({d, d, d});
    return orders_agree(found);
  };
  EXPECT_TRUE(agree({16, 4, 1}));
  EXPECT_TRUE(agree({1, 16, 4.5, 1}));  // the last two count
  EXPECT_FALSE(agree({4, 1}));          // three meshes tell one order
  EXPECT_FALSE(agree({16, 4, 3}));      // 2 and 0.4
  EXPECT_FALSE(agree({3, 2.5, 2.1}));   // alike, but hardly falling
  EXPECT_FALSE(agree({4, 1, 0}));
}

TEST_F(AccuracyTest, IsASolveOfThatMeshToThatTolerance) {
  run_.folder = folder_.path() / "result";
  const RunReport found = run_to_accuracy(disc_scene(), solvers(), 0.3, run_);
  ASSERT_EQ(found.report.accuracy->cuts, 0);
  run_.tolerance = found.report.tolerance;
  run_.writes = false;
  EXPECT_EQ(run(disc_scene(), solvers(), run_).report.fields.x, found.report.fields.x);
  const auto json = nlohmann::json::parse(result_json(found.model, found.report)).at("accuracy");
  EXPECT_EQ(json.at("wanted_mm"), 0.3);
  EXPECT_TRUE(json.at("reached").get<bool>());
  EXPECT_EQ(json.at("total_mm").get<double>(), *found.report.accuracy->total_mm());
  EXPECT_EQ(json.at("greatest_mm").get<double>(), found.report.accuracy->greatest_mm().value());
  EXPECT_GE(json.at("solves").size(), 2u);
  EXPECT_TRUE(std::filesystem::exists(found.folder / "result.json"));
}

TEST_F(AccuracyTest, SaysWhatItDidNotReach) {
  run_.writes = false;
  const RunReport found = run_to_accuracy(disc_scene(), solvers(), 1e-3, run_, {}, 300);
  EXPECT_FALSE(found.report.accuracy->is_reached);
  EXPECT_EQ(found.report.accuracy->cuts, 1);
  EXPECT_FALSE(found.report.accuracy->total_mm());  // two meshes tell no order
  EXPECT_FALSE(found.report.accuracy->greatest_mm());
  EXPECT_NE(found.report.accuracy->message.find("the last moved 95 % of the surface"), std::string::npos);
  ASSERT_FALSE(found.report.warnings.empty());
  EXPECT_NE(found.report.warnings.back().find("not reached"), std::string::npos);

  run_.solver = "idle";
  const RunReport idle = run_to_accuracy(disc_scene(), solvers(), 0.1, run_);
  EXPECT_EQ(idle.report.result.status, Status::Stalled);
  EXPECT_FALSE(idle.report.accuracy->is_reached);
  EXPECT_FALSE(idle.report.accuracy->total_mm());
}

TEST_F(AccuracyTest, KeepsTheLastMeshThatConvergedWhereItIsInterrupted) {
  const Scene scene = disc_scene();
  run_.writes = false;
  Eigen::Index first = 0;
  run_.observer = [&first](const Iteration&, const Vector& q) {
    if (first == 0) first = q.size();
    return q.size() < 10 * first;  // the third mesh is solved no more
  };
  const RunReport found = run_to_accuracy(scene, solvers(), 1e-6, run_);
  const AccuracyEstimate& estimate = found.report.accuracy.value();
  ASSERT_EQ(estimate.levels.back().status, Status::Cancelled);
  EXPECT_FALSE(estimate.is_reached);
  EXPECT_EQ(estimate.cuts, 1);
  EXPECT_EQ(found.report.result.status, Status::Converged);
  EXPECT_NE(estimate.message.find("on " + std::to_string(found.model.mesh.triangle_count()) + " triangles"),
            std::string::npos)
      << estimate.message;
  EXPECT_NE(estimate.message.find("as the solve on " + std::to_string(estimate.levels.back().triangles) +
                                  " triangles did not converge"),
            std::string::npos)
      << estimate.message;
}

TEST_F(AccuracyTest, RefusesAllBadInputAtOnce) {
  const Scene chain = load_scene(std::filesystem::path(COAPT_SOURCE_DIR) / "examples/03_catenary/scene.json");
  run_.tolerance = 1e-3;
  run_.frame_interval = 1;
  run_.writes = false;
  const std::string defects = refusal([&] { run_to_accuracy(chain, solvers(), -1, run_); });
  for (const char* piece :
       {"a length above 0", "no mesh that could be refined", "leave --tolerance out", "leave --frames out"})
    EXPECT_NE(defects.find(piece), std::string::npos) << piece << " in " << defects;
}

}  // namespace
}  // namespace coapt
