// Models of other programs into scenes and back.
#include "core/error.hpp"
#include "exchange/export.hpp"
#include "exchange/import.hpp"
#include "formats/json/valve_json.hpp"
#include "scene/build/build.hpp"
#include "support/temporary_folder.hpp"
#include "valve/generators/mitral.hpp"
#include "valve/valve_import.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <set>
#include <sstream>

namespace coapt {
namespace {

const std::filesystem::path kTricuspid =
    std::filesystem::path(COAPT_SHARED_DIR) / "data" / "trivalve11-healthy";

std::string file_text(const std::filesystem::path& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

std::array<int, 3> from_smallest(const Eigen::Vector3i& t) {
  const int k = t[0] < t[1] && t[0] < t[2] ? 0 : t[1] < t[2] ? 1 : 2;
  return {t[k], t[(k + 1) % 3], t[(k + 2) % 3]};
}

std::set<std::array<int, 3>> facets(const TriangleMesh& mesh) {
  std::set<std::array<int, 3>> result;
  for (const auto& t : mesh.triangles.colwise()) result.insert(from_smallest(t));
  return result;
}

// The point of `points` that is the same as x but for digits that were not kept.
int same_point(const Points& points, const Vec3& x) {
  Eigen::Index nearest = 0;
  const double squared = (points.colwise() - x).colwise().squaredNorm().minCoeff(&nearest);
  return squared < 1e-12 ? static_cast<int>(nearest) : -1;
}

using ChordEnds = std::array<std::pair<ChordEnd::Kind, int>, 2>;

// Chords by their ends; junctions have the numbers that `junctions` gives them.
std::map<ChordEnds, Chord> by_ends(const Valve& valve, const std::vector<int>& junctions) {
  const auto number = [&](const ChordEnd& end) {
    return end.kind == ChordEnd::Kind::Junction ? junctions[static_cast<size_t>(end.index)] : end.index;
  };
  std::map<ChordEnds, Chord> result;
  for (const Chord& chord : valve.chords.chords)
    result[{std::pair{chord.from.kind, number(chord.from)}, std::pair{chord.to.kind, number(chord.to)}}] =
        chord;
  return result;
}

class TricuspidModel : public testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(kTricuspid / "original")) GTEST_SKIP() << "skipped: data not found";
  }
  const std::filesystem::path file_ = kTricuspid / "original" / "Healthy_QuasiStatic.inp";
};

TEST_F(TricuspidModel, HasTheLeafletsAndMotionOfTheConvertedOne) {
  const Valve read = read_model(file_).valve, known = read_valve(kTricuspid / "valve.json").valve;
  ASSERT_EQ(read.leaflets.vertices, known.leaflets.vertices);
  EXPECT_EQ(read.leaflets.triangle_count(), 16566);
  EXPECT_EQ(facets(read.leaflets), facets(known.leaflets)) << "cut along the same diagonals, normals alike";
  EXPECT_EQ(read.pressure, 0.00306);
  EXPECT_EQ(read.leaflets.region_names.size(), 3u);

  ASSERT_EQ(read.annulus.size(), known.annulus.size());
  ASSERT_EQ(read.annulus_closed.cols(), known.annulus_closed.cols());
  std::map<int, Vec3> closed;
  for (size_t k = 0; k < known.annulus.size(); ++k)
    closed[known.annulus[k]] = known.annulus_closed.col(static_cast<int>(k));
  for (size_t k = 0; k < read.annulus.size(); ++k) {
    ASSERT_TRUE(closed.contains(read.annulus[k]));
    EXPECT_LT((read.annulus_closed.col(static_cast<int>(k)) - closed[read.annulus[k]]).norm(), 1e-6)
        << "kept to six digits there";
  }
  EXPECT_EQ(std::set<int>(read.free_edge.begin(), read.free_edge.end()),
            std::set<int>(known.free_edge.begin(), known.free_edge.end()));
  EXPECT_TRUE(read.supports.empty());
}

TEST_F(TricuspidModel, HasTheChordsOfTheConvertedOne) {
  const Valve read = read_model(file_).valve, known = read_valve(kTricuspid / "valve.json").valve;
  EXPECT_EQ(read.chords.papillary, known.chords.papillary);
  EXPECT_EQ(read.chords.papillary_closed.cols(), 0) << "they stay";
  EXPECT_EQ(read.chords.junctions.cols(), 94);
  std::vector<int> own(94), matched;
  std::iota(own.begin(), own.end(), 0);
  for (const auto& x : known.chords.junctions.colwise())
    matched.push_back(same_point(read.chords.junctions, x));
  EXPECT_EQ(std::set<int>(matched.begin(), matched.end()), std::set<int>(own.begin(), own.end()));
  ASSERT_EQ(read.chords.chords.size(), 1836u);
  const auto chords = by_ends(read, own), wanted = by_ends(known, matched);
  ASSERT_EQ(chords.size(), wanted.size());
  for (const auto& [place, chord] : wanted) {
    ASSERT_TRUE(chords.contains(place));
    const Chord& found = chords.at(place);
    EXPECT_NEAR(found.rest_length, chord.rest_length, 1e-6) << "kept to six digits there";
    EXPECT_EQ(found.area, chord.area);
    EXPECT_EQ(found.level, chord.level);
  }
}

TEST_F(TricuspidModel, BringsItsMaterialsIntoAScene) {
  const TemporaryFolder folder;
  const auto warnings = import_valve(file_, folder.path(), {.keeps_bulk = true});
  std::string all;
  for (const std::string& warning : warnings) all += warning + "\n";
  for (const char* part :
       {"*FRICTION", "*DYNAMIC", "*DENSITY", "*VARIABLE MASS SCALING", "*TRANSVERSE SHEAR"})
    EXPECT_NE(all.find(part), std::string::npos) << part << " in\n" << all;
  EXPECT_EQ(warnings.size(), 2u) << all;
  EXPECT_NE(all.find(": each joins the same two points"), std::string::npos) << all;  // the published network
  const Scene scene = load_scene(folder.path() / "scene.json");
  std::map<std::string, const TermSpec*> terms;
  for (const TermSpec& term : scene.terms) terms[term.name] = &term;
  const TermSpec& septal = *terms.at("Septal_Leaflet_Elements");
  EXPECT_EQ(septal.type, "cst_exponential");
  EXPECT_EQ(septal.parameters.number("c0"), 0.001);
  EXPECT_EQ(septal.parameters.number("c1"), 0.000191);
  EXPECT_EQ(septal.parameters.number("c2"), 17.75149);
  EXPECT_DOUBLE_EQ(septal.parameters.number("bulk"), 2 / 20.06689);
  EXPECT_EQ(septal.parameters.number("thickness"), 0.65);
  const TermSpec& posterior = *terms.at("Posterior_Chordae");
  EXPECT_EQ(posterior.type, "cable_ogden");
  EXPECT_EQ(posterior.parameters.numbers("mu")[2], 0.000037265674134);
  EXPECT_EQ(posterior.parameters.numbers("alpha")[0], 55.914887194545429);
  const Model model = build(scene);
  EXPECT_EQ(model.lines.size(), 1836u);
  EXPECT_EQ(model.applied_pressure, 0.00306);

  import_valve(file_, folder.path());
  EXPECT_EQ(file_text(folder.path() / "scene.json").find("bulk"), std::string::npos);
}

// A scene, its FEBio model, and the scene of that.
struct RoundTrip {
  Valve before, after;
  Scene scene_before, scene_after;
  std::vector<std::string> exported, imported;  // warnings
};

RoundTrip round_trip(const TemporaryFolder& folder, const Valve& valve, const ImportOptions& options) {
  const auto a = folder.path() / "a", b = folder.path() / "b", feb = folder.path() / "model.feb";
  write_valve_scene(valve, a, options);
  RoundTrip trip;
  trip.exported = export_file(a / "scene.json", feb);
  trip.imported = import_valve(feb, b, {.membrane = options.membrane, .keeps_bulk = true});
  trip.before = read_valve(a / "valve.json").valve;
  trip.after = read_valve(b / "valve.json").valve;
  trip.scene_before = load_scene(a / "scene.json");
  trip.scene_after = load_scene(b / "scene.json");
  return trip;
}

void expect_same_geometry(const RoundTrip& trip) {
  const Valve &a = trip.before, &b = trip.after;
  const double tolerance = 1e-12;
  ASSERT_EQ(b.leaflets.vertices.cols(), a.leaflets.vertices.cols());
  EXPECT_LT((b.leaflets.vertices - a.leaflets.vertices).cwiseAbs().maxCoeff(), tolerance);
  EXPECT_EQ(facets(b.leaflets), facets(a.leaflets));
  EXPECT_EQ(b.annulus, a.annulus);
  EXPECT_EQ(b.free_edge, a.free_edge);
  EXPECT_EQ(b.commissures, a.commissures);
  EXPECT_EQ(b.sets, a.sets);
  ASSERT_EQ(b.annulus_closed.cols(), a.annulus_closed.cols());
  if (a.annulus_closed.cols() > 0) {
    EXPECT_LT((b.annulus_closed - a.annulus_closed).cwiseAbs().maxCoeff(), tolerance);
  }
  ASSERT_EQ(b.chords.papillary.cols(), a.chords.papillary.cols());
  EXPECT_LT((b.chords.papillary - a.chords.papillary).cwiseAbs().maxCoeff(), tolerance);
  ASSERT_EQ(b.chords.papillary_closed.cols(), a.chords.papillary_closed.cols());
  if (a.chords.papillary_closed.cols() > 0) {
    EXPECT_LT((b.chords.papillary_closed - a.chords.papillary_closed).cwiseAbs().maxCoeff(), tolerance);
  }
  ASSERT_EQ(b.chords.junctions.cols(), a.chords.junctions.cols());
  EXPECT_LT((b.chords.junctions - a.chords.junctions).cwiseAbs().maxCoeff(), tolerance);
  ASSERT_EQ(b.chords.chords.size(), a.chords.chords.size());
  for (size_t k = 0; k < a.chords.chords.size(); ++k) {
    const Chord &before = a.chords.chords[k], &after = b.chords.chords[k];
    EXPECT_EQ(after.from.kind, before.from.kind);
    EXPECT_EQ(after.from.index, before.from.index);
    EXPECT_EQ(after.to.index, before.to.index);
    EXPECT_NEAR(after.rest_length, before.rest_length, tolerance);
    EXPECT_EQ(after.area, before.area);
    EXPECT_EQ(after.material, before.material);
  }
}

double number_of(const Scene& scene, const std::string& type, const std::string& key) {
  for (const TermSpec& term : scene.terms)
    if (term.type == type) return term.parameters.number(key);
  ADD_FAILURE() << "no term " << type;
  return 0;
}

std::set<std::string> types_of(const Scene& scene) {
  std::set<std::string> types;
  for (const TermSpec& term : scene.terms) types.insert(term.type);
  return types;
}

bool has_pugixml() {
#ifdef COAPT_HAS_PUGIXML
  return true;
#else
  return false;
#endif
}

TEST(FebioModel, GivesAGeneratedValveBack) {
  if (!has_pugixml()) GTEST_SKIP() << "skipped: built without pugixml";
  const TemporaryFolder folder;
  Valve valve = mitral_valve({.triangles = 300, .preset = MitralPreset::Benchmark});
  std::set<std::string> materials;
  for (const Chord& chord : valve.chords.chords) materials.insert(chord.material);
  for (const std::string& material : materials) valve.cables[material] = {"cable", {{"young", "\"40 MPa\""}}};
  valve.sets["belly"] = {5, 7, 11};
  const RoundTrip trip = round_trip(folder, valve, {});
  expect_same_geometry(trip);
  EXPECT_EQ(types_of(trip.scene_after), types_of(trip.scene_before));
  for (const char* key : {"young", "poisson", "thickness"})
    EXPECT_EQ(number_of(trip.scene_after, "cst_tension_field", key),
              number_of(trip.scene_before, "cst_tension_field", key));
  EXPECT_EQ(number_of(trip.scene_after, "cable", "young"), 40);
  EXPECT_EQ(number_of(trip.scene_after, "load_pressure", "value"),
            number_of(trip.scene_before, "load_pressure", "value"));
  const Model before = build(trip.scene_before), after = build(trip.scene_after);
  ASSERT_EQ(after.X.cols(), before.X.cols());
  EXPECT_LT((after.motion.positions(1) - before.motion.positions(1)).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_EQ(after.objective->free_count(), before.objective->free_count());
  bool warns = false;
  for (const std::string& warning : trip.exported)
    warns = warns || warning.find("\"leaflets\" wrinkles instead of being compressed") != std::string::npos;
  EXPECT_TRUE(warns);
}

TEST(FebioModel, GivesLawsAndSupportsBack) {
  if (!has_pugixml()) GTEST_SKIP() << "skipped: built without pugixml";
  const TemporaryFolder folder;
  Valve valve = mitral_valve({.triangles = 300, .preset = MitralPreset::Benchmark});
  TriangleMesh& mesh = valve.leaflets;
  mesh.region_names = {"one", "two", "three"};
  mesh.regions.assign(static_cast<size_t>(mesh.triangle_count()), 0);
  for (size_t t = 0; t < mesh.regions.size(); ++t)
    mesh.regions[t] = static_cast<int>(3 * t / mesh.regions.size());
  valve.membranes["one"] = {
      "cst_exponential",
      {{"c0", "\"1 kPa\""}, {"c1", "\"0.1 kPa\""}, {"c2", "5.5"}, {"thickness", "\"0.6 mm\""}}};
  valve.membranes["two"] = {"cst_neo_hookean",
                            {{"shear_modulus", "\"30 kPa\""}, {"thickness", "\"0.7 mm\""}}};
  valve.membranes["three"] = {
      "cst_neo_hookean",
      {{"shear_modulus", "\"30 kPa\""}, {"bulk", "\"0.1 MPa\""}, {"thickness", "\"0.7 mm\""}}};
  for (Chord& chord : valve.chords.chords) chord.material = "all";
  valve.cables["all"] = {
      "cable_bilinear",
      {{"young_pre", "\"5 MPa\""}, {"young_post", "\"50 MPa\""}, {"transition_strain", "0.03"}}};
  const int belly = valve.free_edge[3];
  valve.supports = {
      {"belt", {belly}, {true, false, true}, Points(mesh.vertices.col(belly) + Vec3(0.5, 0, 0.25))}};
  const RoundTrip trip = round_trip(folder, valve, {.pressure_model = "frozen", .contact = "none"});
  expect_same_geometry(trip);
  EXPECT_EQ(types_of(trip.scene_after), types_of(trip.scene_before));
  ASSERT_EQ(trip.after.membranes.size(), 3u);
  for (const auto& term : trip.scene_before.terms)
    for (const auto& other : trip.scene_after.terms) {
      if (term.name != other.name) continue;
      for (const char* key : {"c0", "c1", "c2", "bulk", "shear_modulus", "thickness", "young_pre",
                              "young_post", "transition_strain", "value"})
        if (term.parameters.has(key)) {
          EXPECT_NEAR(other.parameters.number(key), term.parameters.number(key),
                      1e-11 * term.parameters.number(key))
              << term.name << " " << key;
        }
      EXPECT_EQ(other.parameters.has("bulk"), term.parameters.has("bulk")) << term.name;
    }
  ASSERT_EQ(trip.after.supports.size(), 1u);
  EXPECT_EQ(trip.after.supports[0].name, "belt");
  EXPECT_EQ(trip.after.supports[0].vertices, valve.supports[0].vertices);
  EXPECT_EQ(trip.after.supports[0].axes, valve.supports[0].axes);
  EXPECT_EQ(trip.scene_after.terms.back().parameters.text("model"), "frozen");
  const Model before = build(trip.scene_before), after = build(trip.scene_after);
  EXPECT_LT((after.motion.positions(1) - before.motion.positions(1)).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_EQ(after.objective->unknown_count(), before.objective->unknown_count());
}

TEST(FebioModel, SpringsHaveTheForcesOfTheChords) {
  if (!has_pugixml()) GTEST_SKIP() << "skipped: built without pugixml";
  const TemporaryFolder folder;
  Valve valve = mitral_valve({.triangles = 300, .preset = MitralPreset::Benchmark});
  write_valve_scene(valve, folder.path(), {});
  export_file(folder.path() / "scene.json", folder.path() / "model.feb");
  const std::string text = file_text(folder.path() / "model.feb");
  // The first spring at a strain of its distance: scale times the line through its last two points.
  const Chord& chord = valve.chords.chords[0];
  const auto number_after = [&](const std::string& mark, size_t from) {
    const size_t at = text.find(mark, from);
    EXPECT_NE(at, std::string::npos) << mark;
    return std::pair{std::stod(text.substr(at + mark.size(), 40)), at + mark.size()};
  };
  const size_t begin = text.find("<discrete_material");
  const auto [scale, behind] = number_after("<scale>", begin);
  const auto [s0, p0] = number_after("<pt>", behind);
  const auto [s1, p1] = number_after("<pt>", p0);
  const auto [s2, p2] = number_after("<pt>", p1);
  const double stress = std::stod(text.substr(text.find(',', p2) + 1, 40));
  const Points& tips = valve.chords.papillary;
  const Vec3 from = tips.col(chord.from.index);
  const Vec3 to = chord.to.kind == ChordEnd::Kind::Junction
                      ? Vec3(valve.chords.junctions.col(chord.to.index))
                      : Vec3(valve.leaflets.vertices.col(chord.to.index));
  const double distance = (to - from).norm();
  EXPECT_EQ(s0, s1 - 1);
  EXPECT_NEAR(distance * (1 + s1), chord.rest_length, 1e-12) << "slack up to the rest length";
  const double length = 1.1 * chord.rest_length;
  const double force = scale * stress * (length / distance - 1 - s1) / (s2 - s1);
  EXPECT_NEAR(force, 40 * chord.area * 0.1, 1e-9);
}

TEST(FebioModel, KeepsTheLengthsOfChordsWhoseLawItCannotRead) {
  if (!has_pugixml()) GTEST_SKIP() << "skipped: built without pugixml";
  const TemporaryFolder folder;
  Valve valve = mitral_valve({.triangles = 300, .preset = MitralPreset::Benchmark});
  for (Chord& chord : valve.chords.chords) chord.material = "tendon";
  valve.cables["tendon"] = {"cable_ogden", {{"mu", "[\"4 MPa\", \"2 MPa\"]"}, {"alpha", "[30, 60]"}}};
  const RoundTrip trip = round_trip(folder, valve, {});
  expect_same_geometry(trip);
  EXPECT_TRUE(trip.after.cables.empty());
  std::string all;
  for (const auto* warnings : {&trip.exported, &trip.imported})
    for (const std::string& warning : *warnings) all += warning + "\n";
  EXPECT_NE(all.find("term \"tendon\" is written as curves"), std::string::npos) << all;
  EXPECT_NE(all.find("springs of 'tendon' have a curve"), std::string::npos) << all;
}

TEST(FebioModel, RefusesWhatFebioHasNoLikeOf) {
  const TemporaryFolder folder;
  Valve valve = mitral_valve({.triangles = 300, .preset = MitralPreset::Benchmark});
  write_valve_scene(valve, folder.path(), {.pressure_model = "field"});
  try {
    export_file(folder.path() / "scene.json", folder.path() / "model.feb");
    FAIL() << "written";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("term \"load_field\": FEBio has no like of load_field"),
              std::string::npos)
        << error.what();
  }
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "model.feb"));
}

}  // namespace
}  // namespace coapt
