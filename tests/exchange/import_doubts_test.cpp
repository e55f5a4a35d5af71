// Valves and scenes with wrong data, which import and check name before any solve.
#include "core/error.hpp"
#include "exchange/check.hpp"
#include "exchange/import.hpp"
#include "formats/json/valve_json.hpp"
#include "formats/mesh_io.hpp"
#include "formats/whole_file.hpp"
#include "mesh/distance/intersections.hpp"
#include "scene/build/build.hpp"
#include "support/temporary_folder.hpp"
#include "valve/generators/mitral.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <stdexcept>

namespace coapt {
namespace {

bool tells(const std::vector<std::string>& sentences, const std::string& part) {
  return std::any_of(sentences.begin(), sentences.end(),
                     [&](const std::string& sentence) { return sentence.find(part) != std::string::npos; });
}

std::string with_piece(std::string text, const std::string& old, const std::string& fresh) {
  const size_t at = text.find(old);
  if (at == std::string::npos) throw std::logic_error("no " + old);
  return text.replace(at, old.size(), fresh);
}

// A folder "a" with a written valve, and its import to "b".
class ImportDoubts : public testing::Test {
 protected:
  std::vector<std::string> imported(const Valve& valve, const ImportOptions& options = {}) {
    write_valve_scene(valve, folder_.path() / "a");
    return import_valve(folder_.path() / "a" / "valve.json", folder_.path() / "b", options);
  }

  // The sentences of the refusal.
  std::vector<std::string> refusal(const Valve& valve, const ImportOptions& options = {}) {
    try {
      imported(valve, options);
    } catch (const InputError& error) {
      return error.defects();
    }
    return {"accepted"};
  }

  // Of the scene that was written for the mean valve, with a piece of its text replaced.
  std::vector<std::string> checked(const std::string& old, const std::string& fresh) {
    write_valve_scene(mitral_valve({.triangles = 400, .preset = MitralPreset::Benchmark}),
                      folder_.path() / "a");
    const std::filesystem::path file = folder_.path() / "a" / "scene.json";
    const std::string text = with_piece(formats::read_whole(file), old, fresh);
    formats::write_whole(file, text);
    return check(file).warnings;
  }

  TemporaryFolder folder_;
};

TEST_F(ImportDoubts, RefuseANegativePressure) {
  write_valve_scene(mitral_valve({.triangles = 400, .preset = MitralPreset::Benchmark}),
                    folder_.path() / "a");
  const std::filesystem::path file = folder_.path() / "a" / "valve.json";
  const std::string text = formats::read_whole(file);
  const size_t pressure = text.find("\"pressure\""), value = text.find("\"value\"", pressure);
  ASSERT_NE(value, std::string::npos);
  const size_t number = text.find_first_of("0123456789", value + 7);
  formats::write_whole(file, std::string(text).insert(number, "-"));
  try {
    import_valve(file, folder_.path() / "b");
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_TRUE(tells(error.defects(), "pressure.value: is negative (-0.0159")) << error.what();
    EXPECT_TRUE(tells(error.defects(), "turn the triangles over")) << error.what();
  }
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "b"));
  EXPECT_NO_THROW(import_valve(file, folder_.path() / "b", {.pressure = "100 mmHg"}));
}

TEST_F(ImportDoubts, NameANegativePressureOfAScene) {
  EXPECT_TRUE(tells(checked("\"120 mmHg\"", "\"-120 mmHg\""), "value: is negative"));
}

TEST_F(ImportDoubts, NameLoadsOfAnotherUnit) {
  EXPECT_TRUE(tells(checked("\"120 mmHg\"", "\"1 Pa\""), "Check the unit of the pressure"));
  EXPECT_TRUE(tells(checked("\"120 mmHg\"", "\"1e6 MPa\""), "Check the unit of the pressure"));
}

TEST_F(ImportDoubts, NameAPressureInKilopascalsThatWasMeantInMmhg) {
  EXPECT_TRUE(tells(checked("\"120 mmHg\"", "\"120 kPa\""), "the pressure is 900 mmHg"));
  EXPECT_FALSE(tells(checked("\"120 mmHg\"", "\"16 kPa\""), "the pressure is"));
}

TEST_F(ImportDoubts, NameAStiffnessThatThePressureOverwhelms) {
  EXPECT_TRUE(tells(checked("\"1 MPa\"", "\"1 kPa\""), "stretches the membrane by more than 50 %"));
  EXPECT_TRUE(tells(checked("\"0.8 mm\"", "\"0.8 um\""), "stretches the membrane by more than 50 %"));
  for (const char* young : {"\"0.3 MPa\"", "\"1 MPa\"", "\"50 MPa\""})
    EXPECT_FALSE(tells(checked("\"1 MPa\"", young), "stretches the membrane")) << young;
}

TEST_F(ImportDoubts, NameAPressureThatHardlyStretches) {
  EXPECT_TRUE(tells(checked("\"120 mmHg\"", "\"2 Pa\""), "stretches the membrane by less than"));
}

// As others leave them: leaflets between two rims.
TEST_F(ImportDoubts, OfferChordsToLeafletsWithoutThem) {
  const Valve valve = mitral_valve({.triangles = 400, .preset = MitralPreset::Benchmark});
  std::filesystem::create_directories(folder_.path() / "a");
  const std::filesystem::path leaflets = folder_.path() / "a" / "leaflets.obj";
  write_mesh(leaflets, valve.leaflets);
  const auto warnings = import_valve(leaflets, folder_.path() / "b");
  EXPECT_TRUE(tells(warnings, "brings no chords"));
  EXPECT_TRUE(tells(warnings, "`coapt chords " + leaflets.string() + " -o FOLDER/valve.json --tip X Y Z"));
  Valve bare = valve;
  bare.chords = {};
  EXPECT_TRUE(tells(imported(bare), "brings no chords"));
  EXPECT_FALSE(tells(imported(valve), "brings no chords"));
}

// The message names the triangle as leaflets.obj counts it.
TEST_F(ImportDoubts, CountTheLeafletsOfAValveAsTheirFileDoes) {
  Valve valve = mitral_valve({.triangles = 400, .preset = MitralPreset::Benchmark});
  const int t = 17;
  std::swap(valve.leaflets.triangles(0, t), valve.leaflets.triangles(1, t));
  const auto warnings = imported(valve);
  EXPECT_TRUE(tells(warnings, "counted from 1"));
}

TEST_F(ImportDoubts, NameModuliOfAnotherUnit) {
  for (const char* young : {"\"1 Pa\"", "\"1e6 MPa\""})
    EXPECT_TRUE(tells(checked("\"1 MPa\"", young), "\"leaflets\": a membrane that, stretched by 10 % both"))
        << young;
  for (const char* young : {"\"40 Pa\"", "\"4e7 MPa\""})
    EXPECT_TRUE(tells(checked("\"40 MPa\"", young), "\"chords\": chords whose law at a strain of 2 %"))
        << young;
  EXPECT_FALSE(tells(checked("\"40 MPa\"", "\"400 MPa\""), "Check the unit"));
  const auto warnings =
      imported(mitral_valve({.triangles = 400, .preset = MitralPreset::Benchmark}), {.young = "1e6 MPa"});
  EXPECT_TRUE(tells(warnings, "Check the unit of its moduli"));
}

// Of meshes alone: a valve of these sizes is refused by import and can only be written by hand.
TEST_F(ImportDoubts, NameSizesThatNoValveHasInACheckedScene) {
  const std::string mesh = R"("mesh": { )";
  for (const char* unit : {"um", "m"})
    EXPECT_TRUE(tells(checked(mesh, mesh + "\"unit\": \"" + unit + "\", "), "mm across")) << unit;
  EXPECT_TRUE(tells(checked("\"0.8 mm\"", "\"15 mm\""), "15 mm thick and only"));
  EXPECT_TRUE(tells(checked("\"0.8 mm\"", "\"0.8 m\""), "800 mm thick"));
  EXPECT_FALSE(tells(checked(mesh, mesh), "mm across"));
}

TEST_F(ImportDoubts, KnowAScene) {
  imported(mitral_valve({.triangles = 400, .preset = MitralPreset::Benchmark}));
  const std::filesystem::path scene = folder_.path() / "b" / "scene.json";
  try {
    import_valve(scene, folder_.path() / "c");
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()), scene.string() + ": is a scene already: `coapt solve " +
                                             scene.string() + "` solves it as it is");
  }
}

TEST_F(ImportDoubts, NameLengthsOfChordsThatLetTheLeafletsTurnOver) {
  const std::string young = "\"young\": \"40 MPa\"";
  EXPECT_FALSE(tells(checked(young, young), "slack"));
  EXPECT_FALSE(tells(checked(young, young + ", \"length_scale\": 1.1"), "slack"));
  EXPECT_TRUE(tells(checked(young, young + ", \"length_scale\": 2.2"), "all chords are slack"));
  EXPECT_TRUE(tells(checked(young, young + ", \"length_scale\": 3"), "all chords are slack"));
  EXPECT_TRUE(tells(checked(young, young + ", \"length_scale\": 0.5"), "farther from the papillary tip"));
}

TEST_F(ImportDoubts, WriteASceneOfAValveWithoutChordsThatBuilds) {
  Valve valve = mitral_valve({.triangles = 400, .preset = MitralPreset::Benchmark});
  valve.chords.chords.clear();
  valve.chords.junctions.resize(3, 0);
  EXPECT_TRUE(tells(imported(valve), "has 8 papillary tips and no chords"));
  const CheckReport report = check(folder_.path() / "b" / "scene.json");
  EXPECT_TRUE(report.defects.empty()) << report.defects.front();
  EXPECT_TRUE(tells(report.warnings, "no term makes chords"));
}

TEST_F(ImportDoubts, JudgeChordsByTheirLaw) {
  Valve valve = mitral_valve({.triangles = 400, .preset = MitralPreset::Benchmark});
  valve.chords.papillary_closed.resize(3, 0);  // tips that stay
  std::set<std::string> materials;
  for (Chord& chord : valve.chords.chords) {
    chord.rest_length *= 0.87;  // 15 %
    materials.insert(chord.material);
  }
  EXPECT_FALSE(tells(imported(valve), "farther"));
  for (const std::string& material : materials)
    valve.cables[material] = {"cable_ogden", {{"mu", "[\"60 MPa\"]"}, {"alpha", "[98]"}}};
  EXPECT_TRUE(tells(imported(valve), "pulls with more than 1000 MPa"));
  EXPECT_TRUE(tells(check(folder_.path() / "b" / "scene.json").warnings, "pulls with more than 1000 MPa"));
}

// An inner vertex, away from rims and chords, reflected over the edge of its first triangle.
Valve valve_with_folded_fan() {
  Valve valve = mitral_valve({.triangles = 400, .preset = MitralPreset::Benchmark});
  std::vector<bool> named(static_cast<size_t>(valve.leaflets.vertex_count()), false);
  for (const auto& loop : boundary_loops(valve.leaflets.triangles))
    for (const int v : loop) named[static_cast<size_t>(v)] = true;
  for (const Chord& chord : valve.chords.chords)
    if (chord.to.kind == ChordEnd::Kind::Leaflet) named[static_cast<size_t>(chord.to.index)] = true;
  Points& x = valve.leaflets.vertices;
  for (const Eigen::Vector3i corners : valve.leaflets.triangles.colwise()) {
    if (named[static_cast<size_t>(corners[0])]) continue;
    const Vec3 old = x.col(corners[0]);
    x.col(corners[0]) = x.col(corners[1]) + x.col(corners[2]) - old;
    if (!intersecting_pairs(x, valve.leaflets.triangles).empty()) return valve;
    x.col(corners[0]) = old;
  }
  throw std::logic_error("no vertex whose fan folds");
}

TEST_F(ImportDoubts, RefuseWhatContactCannotStartFrom) {
  const Valve valve = valve_with_folded_fan();
  const auto pairs = intersecting_pairs(valve.leaflets.vertices, valve.leaflets.triangles);
  const std::string first = std::to_string(pairs[0][0] + 1) + "-" + std::to_string(pairs[0][1] + 1);
  const auto defects = refusal(valve);
  EXPECT_TRUE(tells(defects, first)) << defects.front();
  EXPECT_TRUE(tells(defects, "--contact none")) << defects.front();
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "b"));
  const auto without = imported(valve, {.contact = "none"});
  EXPECT_TRUE(tells(without, first));
  EXPECT_TRUE(tells(without, "the scene has no contact, so it can be solved"));
  EXPECT_NO_THROW(build(load_scene(folder_.path() / "b" / "scene.json")));
  const auto kept = imported(valve, {.contact = "barrier", .repairs = false});
  EXPECT_TRUE(tells(kept, "the scene cannot be solved as it is"));
}

// A vertex of one sheet just through another one.
TEST_F(ImportDoubts, PushApartWhatTouchesOnAShortWay) {
  Valve valve = mitral_valve({.triangles = 400, .preset = MitralPreset::Benchmark});
  TriangleMesh& mesh = valve.leaflets;
  const int n = mesh.vertex_count(), t = mesh.triangle_count() / 2;
  const Vec3 normal = area_vector(mesh.vertices, mesh.triangles.col(t)).normalized();
  Vec3 centre = Vec3::Zero();
  for (const int v : mesh.triangles.col(t)) centre += mesh.vertices.col(v) / 3;
  const Vec3 along = (mesh.vertices.col(mesh.triangles(0, t)) - centre).normalized();
  mesh.vertices.conservativeResize(3, n + 3);
  mesh.vertices.col(n) = centre - 1e-3 * normal;
  mesh.vertices.col(n + 1) = centre + 2 * normal + along;
  mesh.vertices.col(n + 2) = centre + 2 * normal - along;
  mesh.triangles.conservativeResize(3, mesh.triangle_count() + 1);
  mesh.triangles.rightCols(1) << n, n + 1, n + 2;
  mesh.regions.push_back(0);
  EXPECT_TRUE(tells(imported(valve), "were pushed apart; no vertex moved by more than"));
  const Valve pushed = read_valve(folder_.path() / "b" / "valve.json").valve;
  EXPECT_TRUE(intersecting_pairs(pushed.leaflets.vertices, pushed.leaflets.triangles).empty());
}

// A sheet of two triangles of which the second is turned over, and one without area, in a file of each
// format.
TEST_F(ImportDoubts, CountVerticesAndTrianglesAsTheFileOfTheMeshDoes) {
  TriangleMesh mesh;
  mesh.vertices = (Points(3, 5) << 0, 1, 1, 0, 2, 0, 0, 1, 1, 0, 0, 0, 0, 0, 0).finished();
  mesh.triangles = (Triangles(3, 3) << 0, 0, 1, 1, 3, 0, 2, 2, 4).finished();
  const auto judged = [&](const std::string& file) {
    write_mesh(folder_.path() / file, mesh);
    formats::write_whole(
        folder_.path() / "scene.json",
        R"({"mesh": {"file": ")" + file + R"("}, "boundary": [{"nodes": [0], "fix": true}], "terms": [)" +
            R"({"type": "cst_stvk", "young": "1 MPa", "poisson": 0.4, "thickness": 1},)" +
            R"({"type": "load_pressure", "value": "0.01 MPa"}], "solver": {"type": "newton"}})");
    return check(folder_.path() / "scene.json");
  };
  const CheckReport obj = judged("sheet.obj"), off = judged("sheet.off");
  EXPECT_TRUE(tells(obj.defects, "sheet.obj: triangle 3, counted from 1: no area")) << obj.defects.front();
  EXPECT_TRUE(tells(off.defects, "sheet.off: triangle 2: no area")) << off.defects.front();
  mesh.vertices(1, 4) = -1;
  EXPECT_TRUE(
      tells(judged("sheet.obj").warnings, "sheet.obj: triangle 2, counted from 1: the normal points"));
  EXPECT_TRUE(tells(judged("sheet.off").warnings, "sheet.off: triangle 1: the normal points"));
}

TEST_F(ImportDoubts, AreNoneOfThePublishedValves) {
  for (const char* name : {"trivalve11-healthy/valve_coarse.json", "mitral-ct-normal1/valve_n32.json",
                           "mitral-ct-normal1/valve_n64.json", "bhv-trileaflet/valve_coarse.json"}) {
    const auto file = std::filesystem::path(COAPT_SHARED_DIR) / "data" / name;
    if (!std::filesystem::exists(file)) GTEST_SKIP() << "skipped: data not found";
    const auto warnings = import_valve(file, folder_.path() / "b");
    const auto checked = check(folder_.path() / "b" / "scene.json").warnings;
    for (const char* part : {"wrong side", "no chord", "farther", "slack", "folded", "Check the unit",
                             "cannot be solved", "through each other", "is negative"}) {
      EXPECT_FALSE(tells(warnings, part)) << name << ": " << part;
      EXPECT_FALSE(tells(checked, part)) << name << ": " << part;
    }
    // The same turned over: the free edge of the tricuspid valve is as wide as its annulus.
    Valve valve = read_valve(file).valve;
    valve.leaflets.triangles.row(0).swap(valve.leaflets.triangles.row(1));
    valve.closed_reference.reset();
    EXPECT_TRUE(tells(imported(valve), "wrong side; turn all triangles over")) << name;
  }
}

}  // namespace
}  // namespace coapt
