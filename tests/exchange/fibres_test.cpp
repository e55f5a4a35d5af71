// The scene's keys `fibres` and `chords`, from the file to the result.
#include "core/error.hpp"
#include "exchange/import.hpp"
#include "formats/json/valve_json.hpp"
#include "formats/mesh_io.hpp"
#include "mesh/shapes.hpp"
#include "results/fields.hpp"
#include "results/result_surfaces.hpp"
#include "run/run.hpp"
#include "scene/build/build.hpp"
#include "scene/build/coarsen_scene.hpp"
#include "solve/cascade.hpp"
#include "solve/solve_scene.hpp"
#include "support/temporary_folder.hpp"
#include "valve/fibre_guides.hpp"
#include "valve/generators/leaflet_chords.hpp"
#include "valve/generators/mitral.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <set>
#include <sstream>

namespace coapt {
namespace {

std::vector<std::string> defects_of(const std::function<void()>& call) {
  try {
    call();
  } catch (const InputError& error) {
    return error.defects();
  }
  return {};
}

bool mentions(const std::vector<std::string>& texts, const std::string& part) {
  return std::any_of(texts.begin(), texts.end(),
                     [&](const std::string& text) { return text.find(part) != std::string::npos; });
}

class FibresTest : public testing::Test {
 protected:
  FibresTest() { write_mesh(folder_.path() / "sheet.obj", square(10, 200, CellPattern::Cross)); }

  static constexpr const char* kIsotropic =
      R"({"type": "cst_stvk", "young": "1 MPa", "thickness": "0.1 mm"})";
  static constexpr const char* kFibrous =
      R"({"type": "cst_orthotropic", "fibre_young_pre": "1 MPa", "fibre_young_post": "2 MPa",
          "fibre_transition": 0.2, "cross_young_pre": "0.3 MPa", "cross_young_post": "0.5 MPa",
          "cross_transition": 0.3, "thickness": "0.1 mm"})";

  Scene scene(const std::string& more, const std::string& membrane = kIsotropic) {
    return load_scene(folder_.write("scene.json", R"({"mesh": {"file": "sheet.obj"},
      "boundary": [{"nodes": "boundary", "fix": true}],
      "terms": [)" + membrane + R"(, {"type": "load_pressure", "value": "1 kPa"}])" +
                                                      more + "}"));
  }

  TemporaryFolder folder_;
};

TEST_F(FibresTest, CostNothingWhereNothingAsks) {
  const Scene plain = scene("");
  const SceneGeometry geometry = scene_geometry(plain);
  const Model model = build(plain, geometry);
  EXPECT_EQ(model.fibres.cols(), 0);
  EXPECT_FALSE(geometry.fibres->has_value());
  for (const VtpArray& array : closed_surface(model, compute_fields(model, model.X)).triangle_arrays)
    EXPECT_NE(array.name, "fibre");
}

// Terms ask for fibres themselves: the key changes them, but need not be there.
TEST_F(FibresTest, AreFoundForTermsThatNeedThem) {
  const Model asked = build(scene("", kFibrous)), named = build(scene(R"(, "fibres": {})"));
  ASSERT_EQ(asked.fibres.cols(), asked.mesh.triangle_count());
  EXPECT_EQ(asked.fibres, named.fibres);
  EXPECT_TRUE(mentions(defects_of([&] { build(scene(R"(, "fibres": {"defaults": "none"})", kFibrous)); }),
                       "no fibre direction is known"));
}

TEST_F(FibresTest, AreOneDirectionByAUsersVector) {
  const Model model = build(scene(R"(, "fibres": {"defaults": "none",
      "directions": [{"nodes": [0], "direction": [3, 4, 10]}]})"));
  ASSERT_EQ(model.fibres.cols(), model.mesh.triangle_count());
  for (const auto& d : model.fibres.colwise()) EXPECT_NEAR(std::abs(d.dot(Vec3(0.6, 0.8, 0))), 1, 1e-9);
  EXPECT_NEAR(model.fibre_anisotropy.minCoeff(), 1, 1e-9);
}

TEST_F(FibresTest, FollowTheBoundaryByDefaultAndAUserAgainstIt) {
  const Model along = build(scene(R"(, "fibres": {})"));
  const Model across =
      build(scene(R"(, "fibres": {"directions": [{"nodes": "boundary", "direction": "across"}]})"));
  int edge_triangles = 0;
  for (const Edge& edge : edges(along.mesh.triangles)) {
    if (edge.triangles.size() != 1) continue;
    const Vec3 t = (along.X.col(edge.b) - along.X.col(edge.a)).normalized();
    const Vec3 middle = 0.5 * (along.X.col(edge.b) + along.X.col(edge.a));
    if ((middle.head<2>().array() - 5).abs().minCoeff() > 2.5) continue;  // near a corner
    const int f = edge.triangles[0];
    EXPECT_GT(std::abs(along.fibres.col(f).dot(t)), 0.99);
    EXPECT_LT(std::abs(across.fibres.col(f).dot(t)), 0.14);
    ++edge_triangles;
  }
  EXPECT_GT(edge_triangles, 10);
}

TEST_F(FibresTest, AreReadFromAFile) {
  const Model sheet = build(scene(""));
  std::string rows = "x,y,z\n";
  for (int t = 0; t < sheet.mesh.triangle_count(); ++t) rows += "0, -2, 1\n";
  folder_.write("fibres.csv", rows);
  const Model model = build(scene(R"(, "fibres": {"file": "fibres.csv"})"));
  for (const auto& d : model.fibres.colwise()) EXPECT_NEAR(std::abs(d.y()), 1, 1e-12);
  folder_.write("fibres.csv", "1,0,0\n0,0,1\n");
  EXPECT_TRUE(mentions(defects_of([&] { build(scene(R"(, "fibres": {"file": "fibres.csv"})")); }),
                       "fibres.csv: holds 2 directions"));
}

TEST_F(FibresTest, NameTheirDefects) {
  const auto wrong = [&](const std::string& fibres, const std::string& part) {
    const auto defects = defects_of([&] { build(scene(R"(, "fibres": )" + fibres)); });
    EXPECT_TRUE(mentions(defects, part)) << fibres << ": " << (defects.empty() ? "no defect" : defects[0]);
  };
  wrong(R"({"directions": [{"nodes": [0], "direction": "round"}]})", "fibres.directions[0].direction");
  wrong(R"({"directions": [{"nodes": [0], "direction": [0, 0, 0]}]})", "the vector is zero");
  wrong(R"({"directions": [{"nodes": [0], "direction": [0, 0, 1]}]})",
        "fibres: fibre direction at vertex 1, counted from 1");
  wrong(R"({"directions": [{"nodes": [0], "direction": "along"}]})", "no mesh edge joins two");
  wrong(R"({"directions": [{"nodes": "annulus", "direction": "along"}]})", "no node set \"annulus\"");
  wrong(R"({"defaults": "valve"})", "needs the node set \"annulus\"");
  wrong(R"({"defaults": "none"})", "no fibre direction is known on the part");
  folder_.write("some.csv", "1,0,0\n");
  wrong(R"({"file": "some.csv", "directions": []})", "keep one of them");
}

// In the closed shape the directions are those of the deformed sheet.
TEST_F(FibresTest, AreWrittenAsTheyLieInTheClosedShape) {
  const Model model = build(scene(R"(, "fibres": {"defaults": "none",
      "directions": [{"nodes": [0], "direction": [1, 1, 0]}]})"));
  Points x = model.X;
  x.row(0) *= 2;
  bool is_there = false;
  for (const VtpArray& array : closed_surface(model, compute_fields(model, x)).triangle_arrays) {
    if (array.name != "fibre") continue;
    is_there = true;
    for (const auto& d : array.values.colwise())
      EXPECT_NEAR(std::abs(Vec3(d).dot(Vec3(2, 1, 0).normalized())), 1, 1e-9);
  }
  EXPECT_TRUE(is_there);
}

class MitralFibresTest : public testing::Test {
 protected:
  // The scene of the generated valve with some of its text replaced, and keys added in front.
  Scene scene(int triangles, const std::string& keys,
              const std::vector<std::pair<std::string, std::string>>& changes = {}) {
    write_valve_scene(mitral_valve({.triangles = triangles, .preset = MitralPreset::Benchmark}),
                      folder_.path());
    std::ifstream file(folder_.path() / "scene.json");
    std::stringstream buffer;
    buffer << file.rdbuf();
    std::string text = buffer.str();
    for (const auto& [from, to] : changes) {
      const size_t at = text.find(from);
      if (at == std::string::npos) throw std::logic_error("the scene has no " + from);
      text.replace(at, from.size(), to);
    }
    text.insert(text.find("\"mesh\""), keys);
    return load_scene(folder_.write("scene.json", text));
  }

  TemporaryFolder folder_;
};

TEST_F(MitralFibresTest, RunAroundTheLeafletsAndRadiallyAtTheTrigones) {
  const Model model = build(scene(2500, R"("fibres": {}, )"));
  const TriangleMesh& mesh = model.mesh;
  ASSERT_EQ(model.fibres.cols(), mesh.triangle_count());
  const std::vector<int>& annulus = model.sets.at("annulus");
  const std::vector<int>& trigones = model.sets.at("commissures");
  std::vector<double> at_trigones, elsewhere;
  for (size_t k = 0; k < annulus.size(); ++k) {
    const int a = annulus[k], b = annulus[(k + 1) % annulus.size()];
    double distance = kInfinity;
    for (const int v : trigones) distance = std::min(distance, (model.X.col(a) - model.X.col(v)).norm());
    for (int t = 0; t < mesh.triangle_count(); ++t) {
      const auto corners = mesh.triangles.col(t);
      if (!(corners.array() == a).any() || !(corners.array() == b).any()) continue;
      const double along = std::abs(model.fibres.col(t).dot((model.X.col(b) - model.X.col(a)).normalized()));
      if (distance < 2) at_trigones.push_back(along);
      if (distance > 12) elsewhere.push_back(along);
    }
  }
  ASSERT_FALSE(at_trigones.empty());
  ASSERT_FALSE(elsewhere.empty());
  EXPECT_LT(*std::max_element(at_trigones.begin(), at_trigones.end()), 0.5);
  EXPECT_GT(*std::min_element(elsewhere.begin(), elsewhere.end()), 0.9);
}

// The fibres of a coarse mesh of the cascade are those of the scene's own: nowhere far from them, given by a
// file as well.
TEST_F(MitralFibresTest, PassToTheCoarserMeshesOfACascade) {
  Scene fine = scene(2500, R"("fibres": {}, )");
  const SceneGeometry geometry = scene_geometry(fine);
  const Model model = build(fine, geometry);
  const Coarsening step = coarsen(geometry.model.mesh, coarsen_options(fine, geometry));
  const Model coarse = build(fine, coarsened(geometry, step.mesh, step.kept));
  ASSERT_EQ(coarse.fibres.cols(), step.mesh.triangle_count());
  ASSERT_LT(step.mesh.triangle_count(), model.mesh.triangle_count() / 2);
  std::ostringstream csv;
  for (const auto& d : model.fibres.colwise()) csv << d[0] << "," << d[1] << "," << d[2] << "\n";
  folder_.write("fibres.csv", csv.str());
  Scene from_file = fine;
  from_file.fibres->file = folder_.path() / "fibres.csv";
  const SceneGeometry file_ground = scene_geometry(from_file);
  const Model coarse_from_file = build(from_file, coarsened(file_ground, step.mesh, step.kept));
  int compared = 0, far = 0;
  for (int t = 0; t < step.mesh.triangle_count(); ++t) {
    const Vec3 normal = area_vector(coarse.X, step.mesh.triangles.col(t)).normalized();
    EXPECT_NEAR(coarse.fibres.col(t).norm(), 1, 1e-12);
    EXPECT_NEAR(coarse.fibres.col(t).dot(normal), 0, 1e-9);
    if (coarse.fibre_anisotropy[t] < 0.5) continue;
    const Vec3 centre = coarse.X(Eigen::all, step.mesh.triangles.col(t)).rowwise().mean();
    Eigen::Index nearest = 0;
    double least = kInfinity;
    for (int f = 0; f < model.mesh.triangle_count(); ++f) {
      const Vec3 c = model.X(Eigen::all, model.mesh.triangles.col(f)).rowwise().mean();
      if ((c - centre).norm() >= least) continue;
      least = (c - centre).norm();
      nearest = f;
    }
    ++compared;
    far += std::abs(coarse.fibres.col(t).dot(model.fibres.col(nearest))) < 0.8;
    far += std::abs(coarse_from_file.fibres.col(t).dot(model.fibres.col(nearest))) < 0.8;
  }
  EXPECT_GT(compared, 100);
  EXPECT_LT(far, compared / 10);
}

// The generated valve with its own chords taken away and others made in their place closes all the same.
TEST_F(MitralFibresTest, ClosesOnChordsMadeByTheScene) {
  const std::vector<std::pair<std::string, std::string>> changes{
      {R"("network": "valve.json")", R"("network": "generated")"}};
  std::map<std::string, double> heights;  // of coaptation
  for (const std::string lengths : {R"(, "lengths": "plane")", ""}) {
    const Scene generated = scene(
        625, R"("chords": {"zones": ["free_edge", "rough"], "count": 12, "depth": "8 mm")" + lengths + "}, ",
        changes);
    const Model model = build(generated);
    ASSERT_EQ(model.lines.size(), 24u);
    ASSERT_EQ(model.sets.at("papillary").size(), 8u);
    RunOptions options;
    options.writes = false;
    const RunReport run = coapt::run(generated, scene_solvers(), options);
    EXPECT_EQ(run.report.result.status, Status::Converged) << run.report.result.message;
    EXPECT_LE(run.report.result.residual, 1e-8);
    const Metrics& metrics = run.report.metrics;
    ASSERT_TRUE(metrics.orifice_area_percent && metrics.tenting_height_mm && metrics.coaptation_height_mm);
    EXPECT_LT(*metrics.orifice_area_percent, 2);
    if (!lengths.empty()) {
      EXPECT_NEAR(*metrics.tenting_height_mm, 8, 2) << "the depth that was asked for";
    }
    EXPECT_GT(run.report.fields.line_force.maxCoeff(), 0.05);
    heights[lengths] = *metrics.coaptation_height_mm;
  }
  EXPECT_GT(heights[""], heights.rbegin()->second) << "the free edge hangs";
}

TEST_F(MitralFibresTest, NamesDefectsOfGeneratedChords) {
  const std::vector<std::pair<std::string, std::string>> changes{
      {R"("network": "valve.json")", R"("network": "generated")"}};
  const auto wrong = [&](const std::string& keys, const std::string& part, bool is_named = true) {
    const auto defects = defects_of([&] {
      build(scene(625, keys, is_named ? changes : std::vector<std::pair<std::string, std::string>>{}));
    });
    EXPECT_TRUE(mentions(defects, part)) << keys << ": " << (defects.empty() ? "no defect" : defects[0]);
  };
  wrong("", "\"generated\" needs the scene's key `chords`");
  wrong(R"("chords": {}, )", "no term takes them", false);
  wrong(R"("chords": {"zones": ["free_edge", "ruogh"]}, )", "chords.zones: ");
  wrong(R"("chords": {"levels": 2, "level_areas": ["1 mm2"]}, )", "holds 1 areas for 2 levels");
  wrong(R"("chords": {"tips": [{"at": [0, 0, -25]}, {"at": [9, 0, -25], "closed_at": [9, 0, -24]}]}, )",
        "for all tips or for none");
  wrong(R"("chords": {"tips": [{"at": [0, 0, 40]}, {"at": [0, 0, -40]}]}, )", "chords: tip ");
  wrong(R"("chords": {"count": 5000}, )", "scene.json: chords: zone of the primary chords: 5000 insertions");
}

// Leaflets that nobody here made: a human tricuspid valve, and a bioprosthesis of three separate leaflets
// without chords, which gets tips far on the side of its free edges.
TEST(RealLeaflets, GetFibresAndChords) {
  for (const char* name : {"trivalve11-healthy/valve_coarse.json", "bhv-trileaflet/valve_coarse.json"}) {
    const std::filesystem::path path = std::filesystem::path(COAPT_SHARED_DIR) / "data" / name;
    if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not here";
    Valve valve = read_valve(path).valve;
    const Points& X = valve.leaflets.vertices;
    find_rims(valve);
    if (valve.chords.papillary.cols() == 0) {
      const Vec3 rim = X(Eigen::all, valve.annulus).rowwise().mean();
      const Vec3 down = (X(Eigen::all, valve.free_edge).rowwise().mean() - rim).normalized();
      valve.chords.papillary = rim + 40 * down;
    }
    const ChordNetwork network = leaflet_chords(
        valve,
        {.zones = {chord_zone("free_edge"), chord_zone("rough")}, .count = 10, .levels = 2, .branches = 2});
    EXPECT_EQ(network.chords.size(), 2 * 10 * 3u) << name;
    std::set<int> ends;
    for (const Chord& chord : network.chords) {
      EXPECT_GT(chord.rest_length, 0);
      if (chord.to.kind == ChordEnd::Kind::Leaflet) ends.insert(chord.to.index);
    }
    EXPECT_EQ(ends.size(), 40u) << name;
    for (const int v : valve.annulus) EXPECT_FALSE(ends.contains(v)) << name;

    const FibreField field = fibre_field(
        valve.leaflets,
        valve_guides(valve.leaflets, valve.annulus, region_meetings(valve.leaflets, valve.annulus), {}));
    EXPECT_TRUE(field.directions.allFinite()) << name;
    EXPECT_GT(field.anisotropy.mean(), 0.5) << name;
  }
}

}  // namespace
}  // namespace coapt
