// The model of Burlina et al. 2010: what of the paper is in the scene, and what a valve must have for it.
#include "core/error.hpp"
#include "exchange/import.hpp"
#include "exchange/valve_models.hpp"
#include "formats/json/read_json.hpp"
#include "formats/mesh_io.hpp"
#include "mesh/mesh_topology.hpp"
#include "run/run.hpp"
#include "scene/build/build.hpp"
#include "solve/solve_scene.hpp"
#include "support/temporary_folder.hpp"
#include "valve/generators/mitral.hpp"
#include "valve/generators/rough_valve.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace coapt {
namespace {

class BurlinaModel : public testing::Test {
 protected:
  Scene scene(Valve valve) {
    ImportOptions options;
    apply_valve_model("burlina-2010", valve, options);
    write_valve_scene(valve, folder_.path(), options);
    return load_scene(folder_.path() / "scene.json");
  }

  std::string refusal(Valve valve, ImportOptions options = {}) {
    try {
      apply_valve_model("burlina-2010", valve, options);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }

  TemporaryFolder folder_;
};

TEST_F(BurlinaModel, HasTheEnergiesOfThePaperAndNoOther) {
  const Scene written = scene(mitral_valve({.triangles = 500, .preset = MitralPreset::Benchmark}));
  std::vector<std::string> types;
  for (const TermSpec& term : written.terms) types.push_back(term.type);
  EXPECT_EQ(types, (std::vector<std::string>{"cst_stvk", "tether_cubic", "load_field", "contact_facet"}));
  EXPECT_EQ(written.solver.type, "bfgs");
}

TEST_F(BurlinaModel, HoldsTheAnnulusAndAllThatIsBeyondItsPlane) {
  Valve valve = mitral_valve({.triangles = 500, .preset = MitralPreset::Benchmark});
  const std::set<int> annulus(valve.annulus.begin(), valve.annulus.end());
  int lifted = 0;  // the generator's leaflets all hang below: one vertex beside the annulus is put above
  while (annulus.contains(lifted)) ++lifted;
  const double middle = valve.leaflets.vertices(2, valve.annulus).mean();
  valve.leaflets.vertices(2, lifted) = middle + 3;
  const Model model = build(scene(valve));
  int held = 0, below = 0;
  for (int v = 0; v < valve.leaflets.vertex_count(); ++v) {
    const bool is_held = model.objective->fixed().col(v).all();
    if (is_held) ++held;
    if (annulus.contains(v) || v == lifted)
      EXPECT_TRUE(is_held) << v;
    else if (valve.leaflets.vertices(2, v) < middle - 2)
      below += is_held ? 1 : 0;
  }
  EXPECT_EQ(below, 0);
  EXPECT_LT(held, valve.leaflets.vertex_count() / 2);
}

// A constant force whose potential is linear: its gradient is the force, wherever the nodes are.
TEST_F(BurlinaModel, PullsEveryNodeTowardTheCommissureLine) {
  const Valve valve = mitral_valve({.triangles = 500, .preset = MitralPreset::Benchmark});
  const Model model = build(scene(valve));
  const Points& X = model.X;
  const Vec3 a = X.col(valve.commissures[0]), along = (X.col(valve.commissures[1]) - a).normalized();
  const auto& terms = model.objective->terms();
  const auto term = std::find_if(terms.begin(), terms.end(),
                                 [](const auto& entry) { return entry->type() == "load_field"; });
  ASSERT_NE(term, terms.end());
  Points gradient = Points::Zero(3, X.cols());
  Sink sink(gradient.data());
  (*term)->evaluate(X, sink);
  int pulled = 0;
  for (int v = 0; v < valve.leaflets.vertex_count(); ++v) {
    const Vec3 apart = X.col(v) - a, across = along * along.dot(apart) - apart;
    if (across.norm() < 1e-6) continue;
    EXPECT_NEAR(gradient.col(v).normalized().dot(across.normalized()), -1, 1e-9) << v;
    ++pulled;
  }
  EXPECT_GT(pulled, 100);
}

TEST_F(BurlinaModel, TethersTheRimAloneAndByTheLengthAlongTheChords) {
  const Valve valve = mitral_valve({.triangles = 500, .preset = MitralPreset::Benchmark});
  Valve modelled = valve;
  ImportOptions options;
  apply_valve_model("burlina-2010", modelled, options);
  std::set<int> rim;
  for (const auto& loop : boundary_loops(valve.leaflets.triangles)) rim.insert(loop.begin(), loop.end());
  ASSERT_GT(modelled.chords.chords.size(), 10u);
  EXPECT_LT(modelled.chords.chords.size(), valve.chords.chords.size());
  for (const Chord& chord : modelled.chords.chords) {
    EXPECT_EQ(chord.from.kind, ChordEnd::Kind::Papillary);
    EXPECT_EQ(chord.to.kind, ChordEnd::Kind::Leaflet);
    EXPECT_TRUE(rim.contains(chord.to.index));
    double shortest = kInfinity;  // of the trunk and the branch of each insertion at the vertex
    for (const Chord& last : valve.chords.chords) {
      if (last.to.kind != ChordEnd::Kind::Leaflet || last.to.index != chord.to.index) continue;
      for (const Chord& trunk : valve.chords.chords)
        if (trunk.from.kind == ChordEnd::Kind::Papillary && trunk.to.index == last.from.index)
          shortest = std::min(shortest, trunk.rest_length + last.rest_length);
    }
    EXPECT_NEAR(chord.rest_length, shortest, 1e-12);
  }
}

double range_of(const Scene& scene) {
  for (const TermSpec& term : scene.terms)
    if (term.type == "contact_facet") return term.parameters.number("range");
  return 0;
}

TEST_F(BurlinaModel, TakesTheRangeOfContactFromTheMesh) {
  const auto shortest = [](const TriangleMesh& mesh) {
    double length = kInfinity;
    for (const Edge& edge : edges(mesh.triangles))
      length = std::min(length, (mesh.vertices.col(edge.a) - mesh.vertices.col(edge.b)).norm());
    return length;
  };
  const Valve even = mitral_valve({.triangles = 500, .preset = MitralPreset::Benchmark}),
              rough = rough_valve({.seed = 1, .triangles = 400});
  EXPECT_NEAR(range_of(scene(even)), shortest(even.leaflets), 1e-5);
  const double mean = mean_edge_length(rough.leaflets.vertices, rough.leaflets.triangles);
  EXPECT_LT(shortest(rough.leaflets), 0.1 * mean);
  EXPECT_NEAR(range_of(scene(rough)), 0.25 * mean, 1e-5);
}

TEST_F(BurlinaModel, ComesToRest) {
  RunOptions how;
  how.writes = false;
  const RunReport done =
      run(scene(mitral_valve({.triangles = 300, .preset = MitralPreset::Benchmark})), scene_solvers(), how);
  EXPECT_EQ(done.report.result.status, Status::Converged) << done.report.result.message;
  EXPECT_LT(done.report.metrics.orifice_area_mm2.value(), 0.3 * done.report.metrics.annulus_area_mm2.value());
}

TEST_F(BurlinaModel, SaysWhatThePaperLeavesOpenBesideTheScene) {
  scene(mitral_valve({.triangles = 500, .preset = MitralPreset::Benchmark}));
  const std::string text = read_text(folder_.path() / "README.md");
  for (const char* part :
       {"eq. 15", "leaves open", "Young's modulus", "120 mmHg", "Where it is not followed"})
    EXPECT_NE(text.find(part), std::string::npos) << part;
  EXPECT_EQ(text.find('$'), std::string::npos) << "a place that was not filled";
}

TEST_F(BurlinaModel, NamesAllThatAValveLacksWithTheRemedy) {
  Valve bare;
  bare.leaflets = mitral_valve({.triangles = 300, .preset = MitralPreset::Benchmark}).leaflets;
  bare.leaflets.regions.clear();
  bare.leaflets.region_names.clear();
  const std::string lacks = refusal(bare);
  for (const char* part : {"annulus", "--annulus-closed", "commissures", "valve JSON", "--papillary"})
    EXPECT_NE(lacks.find(part), std::string::npos) << part << " in " << lacks;
  ImportOptions follower;
  follower.pressure_model = "follower";
  EXPECT_NE(refusal(mitral_valve({.triangles = 300, .preset = MitralPreset::Benchmark}), follower)
                .find("leave --pressure out"),
            std::string::npos);
}

// Where the commissures are not named they are where two regions meet.
TEST_F(BurlinaModel, FindsTheCommissuresWhereRegionsMeet) {
  Valve valve = mitral_valve({.triangles = 500, .preset = MitralPreset::Benchmark});
  const std::set<int> named(valve.commissures.begin(), valve.commissures.end());
  valve.commissures.clear();
  ImportOptions options;
  apply_valve_model("burlina-2010", valve, options);
  EXPECT_EQ(std::set<int>(valve.commissures.begin(), valve.commissures.end()), named);
}

TEST_F(BurlinaModel, IsImportedInThePlaceOfTheLawsOfAFile) {
  const Valve valve = mitral_valve({.triangles = 300, .preset = MitralPreset::Benchmark});
  write_valve_scene(valve, folder_.path() / "usual");
  ImportOptions options;
  options.model = "burlina-2010";
  import_valve(folder_.path() / "usual" / "valve.json", folder_.path() / "paper", options);
  EXPECT_EQ(load_scene(folder_.path() / "paper" / "scene.json").terms[0].type, "cst_stvk");
  EXPECT_TRUE(std::filesystem::exists(folder_.path() / "paper" / "README.md"));
  options.young = "1 MPa";
  EXPECT_THROW(import_valve(folder_.path() / "usual" / "valve.json", folder_.path() / "other", options),
               InputError);
  // A bare mesh has a longest rim, but no commissures and no chords.
  write_mesh(folder_.path() / "bare.obj", valve.leaflets);
  options.young.clear();
  options.model = "hammer-2011";
  import_valve(folder_.path() / "bare.obj", folder_.path() / "springs", options);
  EXPECT_EQ(load_scene(folder_.path() / "springs" / "scene.json").terms[0].type, "spring");
}

}  // namespace
}  // namespace coapt
