#include "solve/cascade.hpp"

#include "exchange/import.hpp"
#include "formats/mesh_io.hpp"
#include "mesh/shapes.hpp"
#include "optim/lbfgs.hpp"
#include "run/run.hpp"
#include "scene/build/build.hpp"
#include "scene/build/coarsen_scene.hpp"
#include "solve/solve_scene.hpp"
#include "support/sanitized.hpp"
#include "support/temporary_folder.hpp"
#include "valve/generators/mitral.hpp"

#include <gtest/gtest.h>

namespace coapt {
namespace {

// A clamped disc of radius 10 mm under pressure, prestressed: it has one equilibrium.
class CascadeTest : public testing::Test {
 protected:
  CascadeTest() { write_mesh(folder_.path() / "disc.obj", disc(10, 9600)); }

  Scene scene(const std::string& load = R"({"type": "load_pressure", "value": "1 kPa"})",
              const std::string& boundary = R"([{"nodes": "boundary", "fix": true}])") {
    return load_scene(folder_.write("scene.json", R"({"mesh": {"file": "disc.obj"}, "boundary": )" +
                                                      boundary +
                                                      R"(, "terms": [{"type": "cst_stvk", "young": "1 MPa",
      "thickness": "0.1 mm", "prestress": "0.01 N/mm"}, )" +
                                                      load +
                                                      R"(], "solver": {"type": "lbfgs", "tolerance": 1e-8,
      "cascade": true}})"));
  }

  CascadeOutcome solve(const Scene& scene, const SolverMaker& maker, const Observer& observer = {}) {
    geometry_ = scene_geometry(scene);
    model_ = build(scene, geometry_);
    StopRule stop;
    stop.tolerance = scene.solver.tolerance;
    return solve_cascade(scene, geometry_, model_, maker, stop, scene.solver.continuation, observer);
  }

  static std::unique_ptr<Solver> lbfgs(const Model&) { return make_lbfgs(); }

  TemporaryFolder folder_;
  SceneGeometry geometry_;
  Model model_;
};

TEST_F(CascadeTest, FindsTheEquilibriumOfTheDirectSolve) {
  if (is_sanitized()) GTEST_SKIP() << "switched off under the sanitizers: time";
  Scene scene = this->scene();
  RunOptions options;
  options.writes = false;
  const RunReport cascade = run(scene, scene_solvers(), options);
  scene.solver.cascade = false;
  const RunReport direct = run(scene, scene_solvers(), options);
  const Result &a = cascade.report.result, &b = direct.report.result;
  ASSERT_EQ(a.status, Status::Converged) << a.message;
  ASSERT_EQ(b.status, Status::Converged) << b.message;
  EXPECT_LT((a.q - b.q).cwiseAbs().maxCoeff(), 1e-6);
  EXPECT_LT(a.iterations, b.iterations);

  const auto& levels = cascade.report.levels;
  ASSERT_EQ(levels.size(), 3u);
  EXPECT_NEAR(levels[0].triangles, 600, 20);
  EXPECT_NEAR(levels[1].triangles, 2400, 50);
  EXPECT_EQ(levels[2].triangles, direct.model.mesh.triangle_count());
  EXPECT_EQ(levels[2].iterations, a.iterations);
  EXPECT_TRUE(direct.report.levels.empty());
  // The time is that of all levels.
  EXPECT_NEAR(a.wall_s, levels[0].wall_s + levels[1].wall_s + levels[2].wall_s, 0.02);
  EXPECT_GE(a.trace.front().seconds, levels[0].wall_s + levels[1].wall_s);
}

TEST_F(CascadeTest, ItsMotionEndsWhereTheDirectOneEnds) {
  if (is_sanitized()) GTEST_SKIP() << "switched off under the sanitizers: time";
  const std::string lifted = R"([{"nodes": "boundary", "move_to": {"translate": [0, 1, 3]}}])";
  const Scene scene = this->scene(R"({"type": "load_pressure", "value": "1 kPa"})", lifted);
  const CascadeOutcome moved = solve(scene, lbfgs);
  ASSERT_EQ(moved.result.status, Status::Converged) << moved.result.message;
  const Points x = model_.objective->positions(moved.result.q);
  const Scene still = this->scene();
  const CascadeOutcome unmoved = solve(still, lbfgs);
  const Points expected = model_.objective->positions(unmoved.result.q).colwise() + Vec3(0, 1, 3);
  EXPECT_LT((x - expected).cwiseAbs().maxCoeff(), 1e-6);
}

// Vertices close to the middle of an edge, whose height a carried-over shape stretches twenty times and more:
// the tension of a law that stiffens exponentially is then out of all bounds.
TEST_F(CascadeTest, BeginsFromTheCoarserMeshWhereTheFinerHasSlivers) {
  if (is_sanitized()) GTEST_SKIP() << "switched off under the sanitizers: time";
  TriangleMesh mesh = disc(10, 2400);
  std::vector<Eigen::Vector3i> triangles;
  std::vector<Vec3> vertices;
  for (int k = 0; k < mesh.triangle_count(); ++k) {
    const Eigen::Vector3i t = mesh.triangles.col(k);
    const Vec3 middle = 0.5 * (mesh.vertices.col(t[0]) + mesh.vertices.col(t[1]));
    if (k % 40 != 7 || middle.norm() > 9) {
      triangles.push_back(t);
      continue;
    }
    const int apex = mesh.vertex_count() + static_cast<int>(vertices.size());
    vertices.push_back(0.998 * middle + 0.002 * mesh.vertices.col(t[2]));
    for (int c = 0; c < 3; ++c) triangles.emplace_back(t[c], t[(c + 1) % 3], apex);
  }
  ASSERT_GT(vertices.size(), 40u);
  const Eigen::Index count = mesh.vertex_count();
  mesh.vertices.conservativeResize(3, count + std::ssize(vertices));
  for (size_t k = 0; k < vertices.size(); ++k)
    mesh.vertices.col(count + static_cast<Eigen::Index>(k)) = vertices[k];
  mesh.triangles.resize(3, std::ssize(triangles));
  for (size_t k = 0; k < triangles.size(); ++k)
    mesh.triangles.col(static_cast<Eigen::Index>(k)) = triangles[k];
  write_mesh(folder_.path() / "slivers.obj", mesh);
  const Scene scene = load_scene(folder_.write("slivers.json", R"({"mesh": {"file": "slivers.obj"},
    "boundary": [{"nodes": "boundary", "fix": true}],
    "terms": [{"type": "cst_exponential", "c0": "0.01 MPa", "c1": "0.002 MPa", "c2": 40, "thickness": "0.5 mm"},
      {"type": "load_pressure", "value": "10 kPa"}],
    "solver": {"type": "newton", "tolerance": 1e-8, "cascade": true, "continuation": {"damped_steps": 20}}})"));
  RunOptions options;
  options.writes = false;
  const RunReport found = run(scene, scene_solvers(), options);
  const Result& result = found.report.result;
  ASSERT_EQ(result.status, Status::Converged) << result.message;
  for (const std::string& warning : found.report.warnings)
    EXPECT_EQ(warning.find("cascade"), std::string::npos) << warning;
  ASSERT_EQ(found.report.levels.size(), 2u);
  EXPECT_LT(result.iterations, 15);
}

TEST_F(CascadeTest, KeepsTheWholeOfForcesThatAreGivenByNode) {
  const Scene scene = this->scene(R"({"type": "load_field", "direction": [0, 0, -1], "force": "1 mN"})",
                                  R"([{"nodes": {"nearest": [0, 0, 0]}, "fix": true}])");
  const SceneGeometry geometry = scene_geometry(scene);
  const Coarsening coarsening = coarsen(geometry.model.mesh, coarsen_options(scene, geometry));
  const SceneGeometry thin = coarsened(geometry, coarsening.mesh, coarsening.kept);
  double total[2];
  int k = 0;
  for (const SceneGeometry* level : {&geometry, &thin}) {
    Model model = build(scene, *level);
    Points forces = Points::Zero(3, model.X.cols());
    Sink sink(forces.data());
    for (const auto& term : model.objective->terms())
      if (term->role() == TermRole::Load) term->evaluate(model.X, sink);
    total[k++] = forces.row(2).sum();
  }
  EXPECT_NEAR(total[0], total[1], 1e-12 * std::abs(total[0]));
}

TEST_F(CascadeTest, SolvesDirectlyWithAWarningWhereACoarseMeshFails) {
  // Gives up on all meshes but the largest.
  class Choosy final : public Solver {
   public:
    std::string_view name() const override { return "choosy"; }
    bool follows_path() const override { return true; }
    Status minimize(Objective& objective, Vector& q, Monitor& monitor) override {
      if (objective.node_count() < 4000) return Status::LineSearchFailed;
      return make_lbfgs()->minimize(objective, q, monitor);
    }
  };
  const CascadeOutcome outcome = solve(scene(), [](const Model&) { return std::make_unique<Choosy>(); });
  EXPECT_EQ(outcome.result.status, Status::Converged) << outcome.result.message;
  ASSERT_EQ(outcome.warnings.size(), 1u);
  EXPECT_NE(outcome.warnings[0].find("was not solved (stalled"), std::string::npos) << outcome.warnings[0];
  ASSERT_EQ(outcome.levels.size(), 2u);
  EXPECT_EQ(outcome.levels[0].status, Status::Stalled);
}

TEST_F(CascadeTest, ARunThatIsCancelledOnACoarseMeshKeepsItsShapeOnTheFineOne) {
  const CascadeOutcome outcome =
      solve(scene(), lbfgs, [](const Iteration& it, const Vector&) { return it.iteration < 20; });
  EXPECT_EQ(outcome.result.status, Status::Cancelled);
  ASSERT_EQ(outcome.result.q.size(), model_.objective->unknown_count());
  EXPECT_GT(model_.objective->positions(outcome.result.q).row(2).cwiseAbs().maxCoeff(), 0.01);
}

TEST_F(CascadeTest, SaysThatASmallMeshIsSolvedDirectly) {
  write_mesh(folder_.path() / "disc.obj", disc(10, 600));
  const CascadeOutcome outcome = solve(scene(), lbfgs);
  EXPECT_EQ(outcome.result.status, Status::Converged);
  ASSERT_EQ(outcome.warnings.size(), 1u);
  EXPECT_EQ(outcome.levels.size(), 1u);
}

TEST(Thinning, CarriesChordsSetsAndMotionOfAValveOver) {
  TemporaryFolder folder;
  const Valve valve = mitral_valve({.triangles = 2500, .preset = MitralPreset::Benchmark});
  write_valve_scene(valve, folder.path(), {});
  const Scene scene = load_scene(folder.path() / "scene.json");
  const SceneGeometry fine = scene_geometry(scene);
  const Coarsening coarsening = coarsen(fine.model.mesh, coarsen_options(scene, fine));
  EXPECT_NEAR(coarsening.mesh.triangle_count(), 625, 20);
  const SceneGeometry thin = coarsened(fine, coarsening.mesh, coarsening.kept);
  const Model a = build(scene, fine), b = build(scene, thin);
  ASSERT_EQ(a.lines.size(), b.lines.size());
  for (size_t k = 0; k < a.lines.size(); ++k) {
    EXPECT_EQ(a.X.col(a.lines[k].a), b.X.col(b.lines[k].a));
    EXPECT_EQ(a.X.col(a.lines[k].b), b.X.col(b.lines[k].b));
    EXPECT_EQ(a.lines[k].rest_length, b.lines[k].rest_length);
  }
  EXPECT_EQ(b.sets.at("papillary").size(), a.sets.at("papillary").size());
  // The annulus is thinner, in the same order, and each of its nodes goes where it went.
  const std::vector<int>&annulus = a.sets.at("annulus"), &thinner = b.sets.at("annulus");
  EXPECT_LT(thinner.size(), 0.6 * static_cast<double>(annulus.size()));
  const Points end_a = a.motion.positions(1), end_b = b.motion.positions(1);
  size_t next = 0;
  for (const int node : annulus) {
    const int here = thin.number[static_cast<size_t>(node)];
    if (here < 0) continue;
    ASSERT_EQ(thinner[next++], here);
    EXPECT_EQ(end_a.col(node), end_b.col(here));
    EXPECT_TRUE(b.objective->fixed().col(here).all());
  }
  EXPECT_EQ(next, thinner.size());
}

}  // namespace
}  // namespace coapt
