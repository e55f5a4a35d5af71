// Fibres and numbers given by triangle or vertex, on meshes other than the scene's own: the finer ones of a
// mesh study, the coarser ones of a cascade, and under the factors of a tuning or a sensitivity study.
#include "core/error.hpp"
#include "energy/element_term.hpp"
#include "energy/kernels/cst_fibrous.hpp"
#include "exchange/import.hpp"
#include "formats/mesh_io.hpp"
#include "mesh/shapes.hpp"
#include "run/run.hpp"
#include "scene/build/build.hpp"
#include "scene/build/coarsen_scene.hpp"
#include "scene/build/refine_scene.hpp"
#include "scene/file/scene_parameter.hpp"
#include "solve/cascade.hpp"
#include "solve/solve_scene.hpp"
#include "study/mesh_study.hpp"
#include "support/temporary_folder.hpp"
#include "tuning/tuned_scene.hpp"
#include "valve/generators/mitral.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <list>
#include <sstream>
#include <stdexcept>

namespace coapt {
namespace {

// Modulus along the fibre [kPa] and thickness [mm] at a place of the sheet.
double stiffness_at(const Vec3& x) { return 800 + 40 * x.x() + 20 * x.y(); }
double thickness_at(const Vec3& x) { return 0.1 + 0.004 * x.x(); }

// A clamped square of fibrous tissue under pressure, stiffer towards one corner and thicker towards one side.
class CarriedValues : public testing::Test {
 protected:
  Scene scene(int triangles, const std::string& fibres = R"({"directions":
      [{"nodes": {"plane": {"axis": "x"}}, "direction": [1, 0.5, 0]}]})",
              bool cascades = false) {
    mesh_ = square(10, triangles, CellPattern::Cross);
    write_mesh(folder_.path() / "sheet.obj", mesh_);
    std::ostringstream stiff, thick;
    stiff.precision(17);
    thick.precision(17);
    stiff << "fibre_young_pre [kPa]\n";
    for (int t = 0; t < mesh_.triangle_count(); ++t) stiff << stiffness_at(centre(mesh_, t)) << "\n";
    thick << "thickness [mm]\n";
    for (int v = 0; v < mesh_.vertex_count(); ++v) thick << thickness_at(mesh_.vertices.col(v)) << "\n";
    folder_.write("stiff.csv", stiff.str());
    folder_.write("thick.csv", thick.str());
    return load_scene(folder_.write("scene.json", R"({"mesh": {"file": "sheet.obj"}, "fibres": )" + fibres +
                                                      R"(,
      "boundary": [{"nodes": "boundary", "fix": true}],
      "terms": [{"type": "cst_orthotropic", "name": "tissue", "fibre_young_pre": "1 MPa", "fibre_young_post": "3 MPa",
                 "fibre_transition": 0.2, "cross_young_pre": "0.3 MPa", "cross_young_post": "0.5 MPa",
                 "cross_transition": 0.3, "thickness": "1 mm",
                 "triangle_values": "stiff.csv", "vertex_values": "thick.csv"},
                {"type": "load_pressure", "value": "1 kPa"}],
      "solver": {"type": "newton", "tolerance": 1e-8, "cascade": )" +
                                                      (cascades ? "true" : "false") + "}}"));
  }

  static Vec3 centre(const TriangleMesh& mesh, int t) {
    return mesh.vertices(Eigen::all, mesh.triangles.col(t)).rowwise().mean();
  }

  static const std::vector<CstOrthotropic::Rest>& elements(const Model& model) {
    for (const auto& term : model.objective->terms())
      if (const auto* found = dynamic_cast<const ElementTerm<CstOrthotropic>*>(term.get()))
        return found->rest();
    throw std::logic_error("no such term");
  }

  static SolveSetup setup(const Scene& scene) { return solve_setup(scene, scene_solvers(), {}); }

  TemporaryFolder folder_;
  TriangleMesh mesh_;
};

TEST_F(CarriedValues, AreThoseOfTheParentOnFinerMeshes) {
  const Scene scene = this->scene(200);
  const SceneGeometry own = scene_geometry(scene), fine = refined(own), finer = refined(fine);
  const Model first = build(scene, own);
  int parts = 1;
  for (const SceneGeometry* level : {&fine, &finer}) {
    parts *= 4;
    const Model model = build(scene, *level);
    ASSERT_EQ(model.fibres.cols(), parts * first.fibres.cols());
    ASSERT_EQ(elements(model).size(), static_cast<size_t>(model.mesh.triangle_count()));
    for (int t = 0; t < model.mesh.triangle_count(); ++t) {
      EXPECT_EQ(model.fibres.col(t), first.fibres.col(t / parts));
      EXPECT_EQ(model.fibre_anisotropy[t], first.fibre_anisotropy[t / parts]);
      const auto& rest = elements(model)[static_cast<size_t>(t)];
      EXPECT_NEAR(rest.law.fibre_young, 1e-3 * stiffness_at(centre(mesh_, t / parts)), 1e-12);
      const double area = area_vector(model.X, model.mesh.triangles.col(t)).norm();
      EXPECT_NEAR(rest.volume / area, thickness_at(centre(model.mesh, t)), 1e-9);
    }
  }
}

// However the fibres are known: by a file with a row for each triangle, or along edges between listed nodes,
// which are no edges of the finer meshes.
TEST_F(CarriedValues, LetAMeshStudyConvergeHoweverTheFibresAreKnown) {
  std::ostringstream rows;
  for (int t = 0; t < square(10, 200, CellPattern::Cross).triangle_count(); ++t) rows << "1, 0.5, 0\n";
  folder_.write("fibres.csv", rows.str());
  MeshLevel finest[2];
  int k = 0;
  for (const char* fibres :
       {R"({"file": "fibres.csv"})",
        R"({"defaults": "none", "directions": [{"nodes": [0], "direction": [1, 0.5, 0]}]})"}) {
    const MeshStudy study = study_mesh(scene(200, fibres), scene_solvers(), 2, {});
    ASSERT_EQ(study.levels.size(), 3u);
    EXPECT_TRUE(study.has_converged()) << fibres;
    ASSERT_TRUE(study.levels[2].order);
    std::printf("mesh study with values: order %.2f, %.4f mm from level to level\n", *study.levels[2].order,
                study.levels[2].to_previous->mean);
    EXPECT_GT(*study.levels[2].order, 1.3);
    finest[k++] = study.levels[2];
  }
  // One direction everywhere, said in two ways.
  EXPECT_LT((finest[0].closed.vertices - finest[1].closed.vertices).cwiseAbs().maxCoeff(), 1e-6);
  const MeshStudy along = study_mesh(
      scene(200, R"({"defaults": "none", "directions": [{"nodes": [0, 1], "direction": "along"}]})"),
      scene_solvers(), 1, {});
  EXPECT_TRUE(along.has_converged());
}

TEST_F(CarriedValues, AreMeansNearbyOnTheCoarserMeshesOfACascade) {
  const Scene scene = this->scene(2500);
  const SceneGeometry own = scene_geometry(scene), fine = refined(own);
  for (const SceneGeometry* level : {&own, &fine}) {
    const Coarsening coarsening = coarsen(level->model.mesh, coarsen_options(scene, *level));
    const Model model = build(scene, coarsened(*level, coarsening.mesh, coarsening.kept));
    ASSERT_LT(model.mesh.triangle_count(), level->model.mesh.triangle_count() / 2);
    for (int t = 0; t < model.mesh.triangle_count(); ++t) {
      const auto& rest = elements(model)[static_cast<size_t>(t)];
      const Vec3 x = centre(model.mesh, t);
      EXPECT_NEAR(1e3 * rest.law.fibre_young / stiffness_at(x), 1, 0.02);
      EXPECT_NEAR(rest.volume / area_vector(model.X, model.mesh.triangles.col(t)).norm(), thickness_at(x),
                  1e-9);
    }
  }
}

TEST_F(CarriedValues, GiveTheSameAnswerWithACascade) {
  RunOptions options;
  options.writes = false;
  const RunReport direct = run(scene(2500), scene_solvers(), options),
                  cascade = run(scene(2500, R"({})", true), scene_solvers(), options),
                  again = run(scene(2500, R"({})"), scene_solvers(), options);
  const Result &a = cascade.report.result, &b = again.report.result;
  ASSERT_EQ(a.status, Status::Converged) << a.message;
  ASSERT_EQ(b.status, Status::Converged) << b.message;
  EXPECT_EQ(cascade.report.levels.size(), 2u) << "the coarse mesh was not solved";
  std::printf("cascade with values: %d iterations, directly %d, %.1e mm apart\n", a.iterations, b.iterations,
              (a.q - b.q).cwiseAbs().maxCoeff());
  EXPECT_LT((a.q - b.q).cwiseAbs().maxCoeff(), 1e-5);
  // Values and fibres matter: other fibres give another shape.
  EXPECT_GT((direct.report.result.q - b.q).cwiseAbs().maxCoeff(), 1e-2);
}

// The finer level of a mesh study may itself start from coarser meshes.
TEST_F(CarriedValues, GoThroughACascadeOnARefinedMesh) {
  const Scene scene = this->scene(600, R"({})", true);
  const SceneGeometry own = scene_geometry(scene), fine = refined(own);
  Model model = build(scene, fine);
  const CascadeOutcome cascade = solve_scene(scene, fine, model, setup(scene));
  EXPECT_EQ(cascade.result.status, Status::Converged) << cascade.result.message;
  EXPECT_EQ(cascade.levels.size(), 2u);
  EXPECT_TRUE(cascade.warnings.empty()) << cascade.warnings.front();
  Scene plain = scene;
  plain.solver.cascade = false;
  Model other = build(plain, fine);
  const CascadeOutcome direct = solve_scene(plain, fine, other, setup(plain));
  EXPECT_LT((cascade.result.q - direct.result.q).cwiseAbs().maxCoeff(), 1e-5);
}

// --- factors of studies ------------------------------------------------------------------------------------

TEST_F(CarriedValues, AreMultipliedByTheFactorOfAParameter) {
  const Scene scene = this->scene(200);
  const Model model = build(scaled(scene, find_parameter(scene, "tissue.fibre_young_pre"), 1.25)),
              thick = build(scaled(scene, find_parameter(scene, "tissue.thickness"), 0.5));
  for (int t = 0; t < mesh_.triangle_count(); ++t) {
    const Vec3 x = centre(mesh_, t);
    EXPECT_NEAR(elements(model)[static_cast<size_t>(t)].law.fibre_young, 1.25e-3 * stiffness_at(x), 1e-12);
    EXPECT_NEAR(thick.membrane[static_cast<size_t>(t)].thickness, 0.5 * thickness_at(x), 1e-12);
  }
}

TEST_F(CarriedValues, StayWithinTheirLimitsUnderAFactor) {
  const Scene scene = this->scene(200);
  std::ostringstream poisson;
  poisson << "poisson\n";
  for (int v = 0; v < mesh_.vertex_count(); ++v) poisson << "0.49\n";
  folder_.write("thick.csv", poisson.str());
  try {
    build(scaled(scene, find_parameter(scene, "tissue.poisson"), 1.05));
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("thick.csv: poisson"), std::string::npos) << error.what();
  }
}

// Tissue is tuned like any other membrane, numbers from triangle to triangle included.
TEST(TunedTissue, HasTheFactorsOfItsRegions) {
  const TemporaryFolder folder;
  const Valve valve = mitral_valve({.triangles = 400, .preset = MitralPreset::Benchmark});
  write_valve_scene(valve, folder.path());
  std::ostringstream stiff;
  stiff.precision(17);
  stiff << "shear_modulus [kPa]\n";
  for (int t = 0; t < valve.leaflets.triangle_count(); ++t) stiff << 300 + t << "\n";
  folder.write("stiff.csv", stiff.str());
  std::stringstream text;
  text << std::ifstream(folder.path() / "scene.json").rdbuf();
  std::string tissue = text.str();
  const size_t from = tissue.find("{ \"type\": \"cst_tension_field\"");
  ASSERT_NE(from, std::string::npos);
  tissue.replace(from, tissue.find('}', from) + 1 - from,
                 R"({"type": "cst_neo_hookean", "name": "leaflets", "shear_modulus": "0.33 MPa",
                     "thickness": "0.65 mm", "triangle_values": "stiff.csv"})");
  const Scene scene = load_scene(folder.write("tissue.json", tissue));
  RegionTuningOptions options;
  options.regions = 6;
  const TunedScene tuned(scene, scene_geometry(scene), options);
  ASSERT_EQ(tuned.factor_count(), 6);
  const Vector factors = Vector::LinSpaced(6, 0.5, 3);
  const Model model = build(tuned.scene(factors), tuned.geometry);
  ASSERT_EQ(model.membrane.size(), static_cast<size_t>(valve.leaflets.triangle_count()));
  for (int t = 0; t < valve.leaflets.triangle_count(); ++t) {
    const double factor = factors[tuned.geometry.model.mesh.regions[static_cast<size_t>(t)]];
    EXPECT_NEAR(model.membrane[static_cast<size_t>(t)].young, 3e-3 * (300 + t) * factor, 1e-9);
  }
}

}  // namespace
}  // namespace coapt
