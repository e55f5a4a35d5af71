#include "exchange/import.hpp"

#include "core/error.hpp"
#include "exchange/check.hpp"
#include "formats/json/valve_json.hpp"
#include "formats/mesh_io.hpp"
#include "formats/whole_file.hpp"
#include "mesh/mesh_check.hpp"
#include "mesh/remesh/repair_slivers.hpp"
#include "run/run.hpp"
#include "scene/build/build.hpp"
#include "solve/solve_scene.hpp"
#include "support/temporary_folder.hpp"
#include "valve/generators/mitral.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <set>
#include <sstream>
#include <stdexcept>

namespace coapt {
namespace {

std::filesystem::path data_file(const std::string& name) {
  return std::filesystem::path(COAPT_SHARED_DIR) / "data" / name;
}

TEST(Import, MakesASceneOfTheTricuspidValveThatBuilds) {
  const auto valve = data_file("trivalve11-healthy/valve_coarse.json");
  if (!std::filesystem::exists(valve)) GTEST_SKIP() << "skipped: data not found";
  const TemporaryFolder folder;
  import_valve(valve, folder.path() / "out", {.pressure_model = "frozen"});
  const Model model = build(load_scene(folder.path() / "out" / "scene.json"));
  EXPECT_EQ(model.mesh.triangle_count(), 1735);
  EXPECT_EQ(model.X.cols(), 964 + 32 + 94);
  EXPECT_EQ(model.lines.size(), 507u);
  EXPECT_DOUBLE_EQ(model.applied_pressure, 0.00306);
  EXPECT_TRUE(model.closed_reference.has_value());
  ASSERT_TRUE(model.motion.positions != nullptr);
  const Valve source = read_valve(valve).valve;
  const Points end = model.motion.positions(1);
  for (size_t k = 0; k < source.annulus.size(); ++k)
    EXPECT_LT(
        (end.col(source.annulus[k]) + model.origin - source.annulus_closed.col(static_cast<int>(k))).norm(),
        1e-12);
  EXPECT_EQ(model.objective->free_count(), 3 * (964 - 76 + 94));
}

TEST(Import, FixesTheAnnulusOfAValveWithoutMotion) {
  const auto valve = data_file("mitral-ct-normal1/valve_n32.json");
  if (!std::filesystem::exists(valve)) GTEST_SKIP() << "skipped: data not found";
  const TemporaryFolder folder;
  const auto warnings = import_valve(valve, folder.path(), {.pressure_model = "field"});
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("thickness"), std::string::npos);
  const std::string text = text_of(folder.path() / "scene.json");
  EXPECT_NE(text.find(R"({ "nodes": "annulus", "fix": true })"), std::string::npos) << text;
  EXPECT_NE(text.find(R"("toward_line": "annulus", "pressure": "120 mmHg")"), std::string::npos) << text;
  const Model model = build(load_scene(folder.path() / "scene.json"));
  EXPECT_GT(model.origin.norm(), 100);  // scanner coordinates
  EXPECT_TRUE(model.motion.positions == nullptr);
}

TEST(Import, LeavesOutChordsWhereThereAreNone) {
  const auto valve = data_file("bhv-trileaflet/valve_coarse.json");
  if (!std::filesystem::exists(valve)) GTEST_SKIP() << "skipped: data not found";
  const TemporaryFolder folder;
  import_valve(valve, folder.path());
  const std::string text = text_of(folder.path() / "scene.json");
  EXPECT_EQ(text.find("cable"), std::string::npos);
  EXPECT_EQ(text.find("papillary"), std::string::npos);
  EXPECT_NE(text.find(R"("thickness": "0.386 mm")"), std::string::npos) << text;
  EXPECT_EQ(build(load_scene(folder.path() / "scene.json")).lines.size(), 0u);
}

TEST(Import, RefusesUnknownOptionsAllAtOnce) {
  const TemporaryFolder folder;
  try {
    write_valve_scene({}, folder.path(), {.young = "1 mm", .pressure_model = "soft", .contact = "maybe"});
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_EQ(error.defects().size(), 3u) << error.what();
  }
}

bool says(const std::vector<std::string>& sentences, const std::string& part) {
  return std::any_of(sentences.begin(), sentences.end(),
                     [&](const std::string& sentence) { return sentence.find(part) != std::string::npos; });
}

// Without chords of a fan that end at one vertex, which would be named.
Valve generated_valve() {
  Valve valve = mitral_valve({.triangles = 400, .preset = MitralPreset::Benchmark});
  std::set<std::array<int, 4>> seen;
  std::erase_if(valve.chords.chords, [&](const Chord& c) {
    return !seen.insert({int(c.from.kind), c.from.index, int(c.to.kind), c.to.index}).second;
  });
  return valve;
}

// One with two needles: an inner vertex close to another, both away from rims and chords.
Valve valve_with_needles() {
  Valve valve = generated_valve();
  std::vector<bool> named(static_cast<size_t>(valve.leaflets.vertex_count()), false);
  for (const auto& loop : boundary_loops(valve.leaflets.triangles))
    for (const int v : loop) named[static_cast<size_t>(v)] = true;
  for (const Chord& chord : valve.chords.chords)
    if (chord.to.kind == ChordEnd::Kind::Leaflet) named[static_cast<size_t>(chord.to.index)] = true;
  for (const Eigen::Vector3i corners : valve.leaflets.triangles.colwise()) {
    const int v = corners[0], u = corners[1];
    if (named[static_cast<size_t>(v)] || named[static_cast<size_t>(u)]) continue;
    Points& x = valve.leaflets.vertices;
    x.col(v) = x.col(u) + 1e-5 * (x.col(v) - x.col(u));
    return valve;
  }
  throw std::logic_error("no edge away from rims and chords");
}

TEST(Import, LeavesAGoodMeshAsItIsByteForByte) {
  const TemporaryFolder folder;
  write_valve_scene(generated_valve(), folder.path() / "a");
  const auto warnings = import_valve(folder.path() / "a" / "valve.json", folder.path() / "b");
  EXPECT_TRUE(warnings.empty()) << warnings.front();
  for (const char* name : {"leaflets.obj", "valve.json", "scene.json"})
    EXPECT_EQ(text_of(folder.path() / "a" / name), text_of(folder.path() / "b" / name)) << name;
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "b" / "repairs.csv"));
  EXPECT_TRUE(check(folder.path() / "b" / "scene.json").warnings.empty());
}

TEST(Import, RepairsSliversAndSaysHowFarTheSurfaceMoved) {
  const TemporaryFolder folder;
  write_valve_scene(valve_with_needles(), folder.path() / "a");
  EXPECT_TRUE(says(check(folder.path() / "a" / "scene.json").warnings, "slivers, longest edge up to"));
  const auto warnings = import_valve(folder.path() / "a" / "valve.json", folder.path() / "b");
  ASSERT_EQ(warnings.size(), 1u) << warnings.front();
  EXPECT_TRUE(says(warnings, "repaired 2 slivers (triangles "));
  EXPECT_TRUE(says(warnings, "1 edge collapsed; no vertex moved by more than "));
  const std::string list = text_of(folder.path() / "b" / "repairs.csv");
  EXPECT_EQ(std::count(list.begin(), list.end(), '\n'), 2) << list;
  EXPECT_NE(list.find("\ncollapse,"), std::string::npos) << list;
  EXPECT_TRUE(check(folder.path() / "b" / "scene.json").is_sound());
  EXPECT_TRUE(slivers(read_mesh(folder.path() / "b" / "leaflets.obj").mesh, kSliverAspect).empty());
  // A list is not left beside a mesh that was not repaired.
  const auto kept = import_valve(folder.path() / "a" / "valve.json", folder.path() / "b", {.repairs = false});
  EXPECT_TRUE(says(kept, "slivers, longest edge up to"));
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "b" / "repairs.csv"));
  EXPECT_EQ(text_of(folder.path() / "a" / "leaflets.obj"), text_of(folder.path() / "b" / "leaflets.obj"));
}

TEST(Import, NamesSliversThatNoStepRepairs) {
  const TemporaryFolder folder;
  Valve valve = valve_with_needles();
  const std::vector<int> needles = slivers(valve.leaflets, kSliverAspect);
  ASSERT_EQ(needles.size(), 2u);
  Support all{"clamped", {}, {true, true, true}, Points(3, 0)};  // of two supports neither may be lost
  Support other{"other", {}, {true, true, true}, Points(3, 0)};
  const Eigen::Vector3i corners = valve.leaflets.triangles.col(needles[0]);
  for (int k = 0; k < 3; ++k) (k % 2 == 0 ? all : other).vertices.push_back(corners[k]);
  valve.supports = {all, other};
  for (const int v : corners)
    valve.chords.chords.push_back(
        {{ChordEnd::Kind::Papillary, 0}, {ChordEnd::Kind::Leaflet, v}, 30, 1, "", 0});
  write_valve_scene(valve, folder.path() / "a");
  try {
    import_valve(folder.path() / "a" / "valve.json", folder.path() / "b");
    FAIL() << "accepted";
  } catch (const InputError& error) {
    const std::string what = error.what();
    EXPECT_NE(
        what.find("triangles " + std::to_string(needles[0] + 1) + ", " + std::to_string(needles[1] + 1)),
        std::string::npos)
        << what;
    EXPECT_NE(what.find("--no-repair"), std::string::npos) << what;
  }
  EXPECT_NO_THROW(import_valve(folder.path() / "a" / "valve.json", folder.path() / "b", {.repairs = false}));
}

TEST(Import, NamesWhatIsDoubtfulAboutAValveAsCheckDoes) {
  const TemporaryFolder folder;
  Valve valve = generated_valve();
  valve.leaflets.triangles.row(0).swap(valve.leaflets.triangles.row(1));
  valve.pressure *= 1000;
  valve.chords.chords.push_back(valve.chords.chords.front());
  const std::string copy = "chord " + std::to_string(valve.chords.chords.size() - 1) + ": joins the same two";
  write_valve_scene(valve, folder.path() / "a");
  const auto warnings =
      import_valve(folder.path() / "a" / "valve.json", folder.path() / "b", {.takes_any_size = true});
  const auto checked = check(folder.path() / "b" / "scene.json").warnings;
  for (const char* part : {"wrong side", "the pressure is 1.2e+05 mmHg", copy.c_str()}) {
    EXPECT_TRUE(says(warnings, part)) << part;
    EXPECT_TRUE(says(checked, part)) << part;
  }
  // The other side of a surface that is turned over is the right one.
  std::string text = text_of(folder.path() / "b" / "scene.json");
  text.replace(text.find("\"front\""), 7, "\"back\"");
  std::ofstream(folder.path() / "b" / "scene.json") << text;
  EXPECT_FALSE(says(check(folder.path() / "b" / "scene.json").warnings, "wrong side"));
}

TEST(Import, OfWhatOpensTheValveAFillingPressureAloneIsNoDoubt) {
  const TemporaryFolder folder;
  write_valve_scene(generated_valve(), folder.path());
  std::string text = text_of(folder.path() / "scene.json");
  text.replace(text.find("\"front\""), 7, "\"back\"");
  std::ofstream(folder.path() / "scene.json") << text;
  EXPECT_TRUE(says(check(folder.path() / "scene.json").warnings, "wrong side and opens the valve"));
  const size_t value = text.find("120 mmHg");
  ASSERT_NE(value, std::string::npos) << text;
  text.replace(value, 8, "2 mmHg");
  std::ofstream(folder.path() / "scene.json") << text;
  EXPECT_FALSE(says(check(folder.path() / "scene.json").warnings, "wrong side"));
}

// Without contact a valve has one shape as a rule where its leaflets wrinkle; where they resist compression
// it may have several.
TEST(Import, LeavesThePathOutWhereAValveHasOneShape) {
  const TemporaryFolder folder;
  const Valve valve = mitral_valve({.triangles = 300});
  const auto steps = [&](const Valve& given, const ImportOptions& options) {
    write_valve_scene(given, folder.path(), options);
    return load_scene(folder.path() / "scene.json").solver.continuation.damped_steps;
  };
  EXPECT_EQ(steps(valve, {}), 20);
  EXPECT_EQ(steps(valve, {.contact = "none"}), 0);
  EXPECT_EQ(steps(valve, {.membrane = LinearLeaflets::Springs, .contact = "none"}), 0);
  EXPECT_EQ(steps(valve, {.membrane = LinearLeaflets::ResistsCompression, .contact = "none"}), 20);
  Valve resists = valve;
  for (auto& [region, law] : resists.membranes) law.type = "cst_stvk";
  EXPECT_EQ(steps(resists, {.contact = "none"}), 20);
}

// Without the repair it stalls after tens of thousands of iterations at a residual above 20.
TEST(Import, MakesTheRelaxedMitralValveSolvable) {
  for (const char* size : {"n64", "n128"}) {
    const auto file = data_file(std::string("mitral-ct-normal1/valve_") + size + ".json");
    if (!std::filesystem::exists(file)) GTEST_SKIP() << "skipped: data not found";
    const TemporaryFolder folder;
    const auto warnings = import_valve(file, folder.path());
    EXPECT_TRUE(
        says(warnings, "flat triangles cut off the rim; no vertex moved, and the surface by no more than"));
    const Valve given = read_valve(file).valve, valve = read_valve(folder.path() / "valve.json").valve;
    EXPECT_EQ(valve.annulus, given.annulus);
    EXPECT_EQ(valve.leaflets.vertices, given.leaflets.vertices);
    EXPECT_EQ(valve.closed_reference->triangles, valve.leaflets.triangles);
    RunOptions options;
    options.writes = false;
    Scene scene = load_scene(folder.path() / "scene.json");
    EXPECT_NE(formats::read_whole(folder.path() / "scene.json").find("144 solves came within 1e-5 mm"),
              std::string::npos)
        << "the scene promises of the path what was measured";
    EXPECT_EQ(scene.solver.continuation.damped_steps, 20);
    scene.solver.continuation.damped_steps = 0;  // what slivers cost is what a solve at once needs
    const RunReport report = run(scene, scene_solvers(), options);
    EXPECT_EQ(report.report.result.status, Status::Converged) << size;
    EXPECT_LE(report.report.result.iterations, 60) << size;
  }
}

}  // namespace
}  // namespace coapt
