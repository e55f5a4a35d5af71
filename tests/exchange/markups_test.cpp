#include "formats/json/markups.hpp"

#include "core/error.hpp"
#include "exchange/export.hpp"
#include "exchange/import.hpp"
#include "formats/json/valve_json.hpp"
#include "formats/mesh_io.hpp"
#include "mesh/shapes.hpp"
#include "scene/build/build.hpp"
#include "support/temporary_folder.hpp"
#include "valve/generators/mitral.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <set>
#include <sstream>

namespace coapt {
namespace {

std::string markup_text(const std::string& system) {
  return R"({"markups": [{"type": "ClosedCurve", )" + system + R"("controlPoints": [
    {"id": "1", "label": "a", "position": [1, 2, 3]}, {"position": [4, 5, 6], "positionStatus": "defined"},
    {"position": [0, 0, 0], "positionStatus": "undefined"}, {"position": [7, 8, 10]}]}]})";
}

TEST(Markups, TurnsRasToLps) {
  const TemporaryFolder folder;
  for (const char* system : {"\"coordinateSystem\": \"RAS\", ", "\"coordinateSystem\": 0, "}) {
    const auto markups = read_markups(folder.write("a.mrk.json", markup_text(system)));
    ASSERT_EQ(markups.size(), 1u);
    ASSERT_EQ(markups[0].points.cols(), 3) << "one point is not placed yet";
    EXPECT_EQ(Vec3(markups[0].points.col(0)), Vec3(-1, -2, 3)) << system;
    EXPECT_EQ(markups[0].labels[0], "a");
  }
  for (const char* system : {"\"coordinateSystem\": \"LPS\", ", "\"coordinateSystem\": 1, ", ""})
    EXPECT_EQ(Vec3(annulus_curve(folder.write("a.mrk.json", markup_text(system))).col(2)), Vec3(7, 8, 10))
        << system;
  const auto path = folder.write("a.mrk.json", markup_text("\"coordinateUnits\": \"cm\", "));
  EXPECT_EQ(Vec3(annulus_curve(path).col(1)), Vec3(40, 50, 60));
}

TEST(Markups, ReadsBackBitByBitWhatItWroteAsLps) {
  const TemporaryFolder folder;
  Markup curve{"annulus", "ClosedCurve", Points::Random(3, 12) / 3, {}};
  const auto path = folder.path() / "a.mrk.json";
  write_markups(path, {curve, {"tips", "Fiducial", Points::Ones(3, 2) * 0.1, {"x", "y"}}});
  EXPECT_NE(text_of(path).find("\"coordinateSystem\": \"LPS\""), std::string::npos);
  const auto markups = read_markups(path);
  ASSERT_EQ(markups.size(), 2u);
  EXPECT_EQ(markups[0].points, curve.points);
  EXPECT_EQ(markups[0].labels[11], "annulus-12");
  EXPECT_EQ(markups[1].labels, (std::vector<std::string>{"x", "y"}));
  EXPECT_EQ(annulus_curve(path).cols(), 12);
  EXPECT_EQ(papillary_points(path).cols(), 2);
}

TEST(Markups, NamesEveryBadEntry) {
  const TemporaryFolder folder;
  const auto refused = [&](const std::string& text, const std::vector<std::string>& parts) {
    try {
      read_markups(folder.write("bad.mrk.json", text));
      FAIL() << "accepted: " << text;
    } catch (const InputError& error) {
      for (const std::string& part : parts)
        EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << part << " in " << error.what();
    }
  };
  refused("{}", {"bad.mrk.json", "markups: missing"});
  refused("[", {"bad.mrk.json:1:"});
  refused(
      R"({"markups": [1, {"coordinateSystem": "XYZ", "coordinateUnits": "kg", "controlPoints": [
              {"position": [1, 2]}, {"position": [1, 2, "3"]}, 7]}]})",
      {"markups[0]: expected", "markups[1].coordinateSystem", "markups[1].coordinateUnits",
       "markups[1].controlPoints[0].position", "markups[1].controlPoints[1].position", "controlPoints[2]"});
  refused(R"({"markups": [{"controlPoints": [{"position": [1, null, 2]}, {"position": [1, 1e308, 2]}]}]})",
          {"controlPoints[0].position: expected three numbers",
           "controlPoints[1].position: read [1,1e+308,2]; a coordinate is greater"});
  EXPECT_THROW(annulus_curve(folder.write("no.mrk.json", R"({"markups": []})")), InputError);
  EXPECT_THROW(papillary_points(folder.write("no.mrk.json", R"({"markups": []})")), InputError);
}

TEST(Markups, TakesPlacedPointsOfListsOnly) {
  const TemporaryFolder folder;
  const auto path = folder.write("a.mrk.json", R"({"markups": [
    {"type": "Plane", "controlPoints": [{"position": [9, 9, 9]}]},
    {"type": "Fiducial", "controlPoints": [{"position": [1, 2, 3]},
      {"position": [0, 0, 0], "positionStatus": "missing"}, {"position": [0, 0, 0], "positionStatus": "preview"},
      {"position": [4, 5, 6], "positionStatus": "defined"}]}]})");
  const Points tips = papillary_points(path);
  ASSERT_EQ(tips.cols(), 2);
  EXPECT_EQ(Vec3(tips.col(0)), Vec3(1, 2, 3));
  EXPECT_EQ(Vec3(tips.col(1)), Vec3(4, 5, 6));
}

TEST(Markups, RefusesACurveWithoutLength) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "a.mrk.json";
  write_markups(path, {{"ring", "ClosedCurve", Points::Ones(3, 8), {}}});
  try {
    annulus_curve(path);
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("all points of the curve \"ring\" are the same"),
              std::string::npos);
  }
}

// A tube of height 10 and radius 15, open at both ends.
TriangleMesh tube() {
  constexpr int kAround = 40, kRows = 3;
  TriangleMesh mesh;
  mesh.vertices.resize(3, kAround * kRows);
  for (int j = 0; j < kRows; ++j)
    for (int i = 0; i < kAround; ++i) {
      const double angle = 2 * std::numbers::pi * i / kAround, radius = 15 - 2 * j;
      mesh.vertices.col(j * kAround + i) << radius * std::cos(angle), radius * std::sin(angle), -5. * j;
    }
  mesh.triangles.resize(3, 2 * kAround * (kRows - 1));
  for (int j = 0, t = 0; j + 1 < kRows; ++j)
    for (int i = 0; i < kAround; ++i) {
      const int a = j * kAround + i, b = j * kAround + (i + 1) % kAround;
      mesh.triangles.col(t++) << a, a + kAround, b;
      mesh.triangles.col(t++) << b, a + kAround, b + kAround;
    }
  return mesh;
}

TEST(Markups, AMeshAndCurvesGiveAScene) {
  const TemporaryFolder folder;
  write_mesh(folder.path() / "leaflets.ply", tube(), std::nullopt, "LPS");
  Points ring(3, 9), tips(3, 2);
  for (int k = 0; k < 9; ++k) {
    const double angle = 1 - 2 * std::numbers::pi * k / 9;  // the other way round, from elsewhere
    ring.col(k) << -14 * std::cos(angle), -14 * std::sin(angle), 1;
  }
  tips << 8, -8, 0, 0, -25, -25;
  folder.write("closed.mrk.json", "");
  write_markups(folder.path() / "closed.mrk.json", {{"closed", "ClosedCurve", ring, {}}});
  write_markups(folder.path() / "tips.mrk.json", {{"tips", "Fiducial", tips, {}}});
  const auto out = folder.path() / "out";
  const auto warnings = import_valve(
      folder.path() / "leaflets.ply", out,
      {.annulus_closed = folder.path() / "closed.mrk.json", .papillary = folder.path() / "tips.mrk.json"});
  EXPECT_GE(warnings.size(), 2u) << "no thickness, no pressure, chords that were made";
  const Valve valve = read_valve(out / "valve.json").valve;
  ASSERT_EQ(valve.annulus.size(), 40u);
  EXPECT_EQ(valve.free_edge.size(), 40u);
  for (int k = 0; k < 40; ++k) {
    const Vec3 open = valve.leaflets.vertices.col(valve.annulus[static_cast<size_t>(k)]);
    EXPECT_EQ(open.z(), 0);
    const Vec3 closed = valve.annulus_closed.col(k);
    EXPECT_LT((closed - Vec3(open.x() * 14 / 15, open.y() * 14 / 15, 1)).norm(), 0.1);
  }
  EXPECT_EQ(valve.chords.papillary, tips);
  EXPECT_EQ(valve.chords.chords.size(), 24u);
  const std::set<int> edge(valve.free_edge.begin(), valve.free_edge.end());
  for (const Chord& chord : valve.chords.chords) EXPECT_TRUE(edge.contains(chord.to.index));
  const Model model = build(load_scene(out / "scene.json"));
  EXPECT_EQ(model.lines.size(), 24u);
  ASSERT_TRUE(model.motion.positions != nullptr);
}

TEST(Markups, AMeshInRasIsTurned) {
  const TemporaryFolder folder;
  write_mesh(folder.path() / "leaflets.obj", tube(), std::nullopt, "RAS");
  import_valve(folder.path() / "leaflets.obj", folder.path() / "out", {});
  const Valve valve = read_valve(folder.path() / "out" / "valve.json").valve;
  EXPECT_EQ(Vec3(valve.leaflets.vertices.col(0)), Vec3(-15, 0, 0));
  EXPECT_EQ(valve.annulus.size(), 40u) << "the longer rim";
  EXPECT_EQ(valve.leaflets.vertices(2, valve.annulus[0]), 0);
  const auto turned = folder.path() / "lps.obj";
  EXPECT_EQ(export_file(folder.path() / "leaflets.obj", turned, "").size(), 1u) << "says that it was turned";
  EXPECT_NE(text_of(turned).find("SPACE=LPS"), std::string::npos);
  EXPECT_EQ(Vec3(read_mesh(turned).mesh.vertices.col(0)), Vec3(-15, 0, 0));
}

TEST(Markups, NamesThatAreNotUtf8ComeThroughAnImport) {
  const TemporaryFolder folder;
  const auto mesh = folder.path() / "R\xf6hre.obj";
  TriangleMesh surface = tube();
  surface.regions.assign(static_cast<size_t>(surface.triangle_count()), 0);
  surface.regions[0] = 1;
  surface.region_names = {"rest", "W\xe4nde"};
  write_mesh(mesh, surface);
  import_valve(mesh, folder.path() / "out", {});
  const Scene scene = load_scene(folder.path() / "out" / "scene.json");
  EXPECT_EQ(scene.name, "R\xc3\xb6hre");
  EXPECT_EQ(build(scene).mesh.region_names[0], "W\xc3\xa4nde") << "of the first triangle";
}

TEST(Markups, RefusesCurvesWhereTheyDoNotFit) {
  const TemporaryFolder folder;
  write_markups(folder.path() / "tips.mrk.json", {{"tips", "Fiducial", Points::Ones(3, 2), {}}});
  write_valve(folder.path() / "valve.json",
              mitral_valve({.triangles = 300, .preset = MitralPreset::Benchmark}));
  const auto valve = folder.path() / "valve.json", tips = folder.path() / "tips.mrk.json";
  const auto message = [&](const ImportOptions& options, const std::filesystem::path& file) {
    try {
      import_valve(file, folder.path() / "out", options);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  EXPECT_NE(message({.papillary = tips}, valve).find("has papillary tips already"), std::string::npos);
  EXPECT_NE(message({.papillary_closed = tips}, valve).find("2 points for"), std::string::npos);
  EXPECT_NE(message({.annulus_closed = tips}, valve).find("no closed curve"), std::string::npos);
  EXPECT_NE(message({}, tips).find("--annulus-closed"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "out"));
}

TEST(Markups, AreExportedFromAScene) {
  const TemporaryFolder folder;
  const Valve valve = mitral_valve({.triangles = 300, .preset = MitralPreset::Benchmark});
  write_valve_scene(valve, folder.path(), {});
  const auto scene = folder.path() / "scene.json", out = folder.path() / "points.mrk.json";
  export_file(scene, out);
  EXPECT_EQ(annulus_curve(out), Points(valve.leaflets.vertices(Eigen::all, valve.annulus)));
  EXPECT_EQ(read_markups(out)[0].type, "ClosedCurve");
  export_file(scene, out, "annulus_closed");
  EXPECT_EQ(annulus_curve(out), valve.annulus_closed);
  export_file(scene, out, "papillary_closed");
  EXPECT_EQ(papillary_points(out), valve.chords.papillary_closed);
  EXPECT_THROW(export_file(scene, out, "papilary"), InputError);
  EXPECT_THROW(export_file(scene, scene), InputError);
}

TEST(ExportedMeshes, SayTheirSpaceAndKeepTheirPlaces) {
  const TemporaryFolder folder;
  const Valve valve = mitral_valve({.triangles = 300, .preset = MitralPreset::Benchmark});
  write_valve_scene(valve, folder.path(), {});
  for (const char* name : {"a.obj", "a.ply", "a.off", "a.vtp"}) {
    const auto path = folder.path() / name;
    export_file(folder.path() / "scene.json", path);
    const std::string text = text_of(path);
    if (std::string(name) == "a.vtp") {
      EXPECT_NE(text.find("Name=\"SPACE\""), std::string::npos);
      continue;
    }
    EXPECT_NE(text.find("SPACE=LPS"), std::string::npos) << name;
    const TriangleMesh mesh = read_mesh(path).mesh;
    EXPECT_EQ(mesh.vertices, valve.leaflets.vertices) << name;
    EXPECT_EQ(mesh.triangles, valve.leaflets.triangles) << name;
  }
  export_file(folder.path() / "a.ply", folder.path() / "b.stl");
  EXPECT_EQ(read_mesh(folder.path() / "b.stl").mesh.triangle_count(), valve.leaflets.triangle_count());
}

TEST(ValveLaws, AreReadBackAndWrittenIntoTheScene) {
  const TemporaryFolder folder;
  Valve valve = mitral_valve({.triangles = 300, .preset = MitralPreset::Benchmark});
  valve.leaflets.region_names = {"front", "rest"};
  valve.leaflets.regions.assign(static_cast<size_t>(valve.leaflets.triangle_count()), 1);
  valve.leaflets.regions[0] = 0;
  valve.membranes["front"] = {"cst_stvk", {{"young", "\"3 MPa\""}, {"thickness", "\"0.5 mm\""}}};
  for (size_t k = 0; k < valve.chords.chords.size(); ++k)
    valve.chords.chords[k].material = k % 2 == 0 ? "thick" : "thin";
  valve.cables["thin"] = {"cable_ogden", {{"mu", "[\"4 MPa\"]"}, {"alpha", "[50]"}}};
  valve.supports = {{"pin", {3, 4}, {false, true, false}, Points(3, 0)}};
  write_valve(folder.path() / "v.json", valve);
  const Valve read = read_valve(folder.path() / "v.json").valve;
  EXPECT_EQ(read.membranes.at("front").type, "cst_stvk");
  std::map<std::string, std::string> keys(read.membranes.at("front").keys.begin(),
                                          read.membranes.at("front").keys.end());
  EXPECT_EQ(keys, (std::map<std::string, std::string>{{"young", "\"3 MPa\""}, {"thickness", "\"0.5 mm\""}}));
  EXPECT_EQ(read.cables.at("thin").type, "cable_ogden");
  ASSERT_EQ(read.supports.size(), 1u);
  EXPECT_EQ(read.supports[0].vertices, (std::vector<int>{3, 4}));
  EXPECT_EQ(read.supports[0].axes, (std::array{false, true, false}));

  import_valve(folder.path() / "v.json", folder.path() / "out", {});
  const Scene scene = load_scene(folder.path() / "out" / "scene.json");
  std::map<std::string, const TermSpec*> terms;
  for (const TermSpec& term : scene.terms) terms[term.name] = &term;
  EXPECT_EQ(terms.at("front")->parameters.texts("region"), std::vector<std::string>{"front"});
  EXPECT_EQ(terms.at("leaflets")->parameters.texts("region"), std::vector<std::string>{"rest"});
  EXPECT_EQ(terms.at("thin")->type, "cable_ogden");
  EXPECT_EQ(terms.at("chords")->parameters.texts("materials"), std::vector<std::string>{"thick"});
  const Model model = build(scene);
  EXPECT_EQ(model.lines.size(), valve.chords.chords.size());
  EXPECT_EQ(model.membrane[0].young, 3);
}

TEST(ValveLaws, BadOnesAreNamed) {
  const TemporaryFolder folder;
  try {
    read_valve(folder.write("v.json", R"({"membranes": [], "cables": {"a": {"young": "1 MPa"}},
      "supports": [{"fix": ["x"]}, {"name": "gone", "fix": ["w"]}]})"));
    FAIL() << "accepted";
  } catch (const InputError& error) {
    for (const char* part : {"membranes: expected", "cables.a: expected", "supports[0]: expected", "\"gone\"",
                             "supports[1].fix: expected"})
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << part << " in " << error.what();
  }
}

}  // namespace
}  // namespace coapt
