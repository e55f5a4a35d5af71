// Valves and films whose every accepted iterate is judged, on every mesh of a cascade.
#include "exchange/import.hpp"
#include "run/contact_fixture.hpp"
#include "run/judged_scene.hpp"
#include "support/meshes.hpp"
#include "support/sanitized.hpp"
#include "valve/generators/mitral.hpp"

namespace coapt {
namespace {

// --- Cascades --------------------------------------------------------------------------------------------

// --- Motion in time ---------------------------------------------------------------------------------------

// Follower pressure on free edges, the barrier and an annulus that moves, all at once.
TEST_F(ContactSceneTest, AValveClosesInTimeWithoutAnIntersectionAtAnyStep) {
  for (const char* integration : {"backward_differences", "semi_implicit_euler"}) {
    const bool is_explicit = integration[0] == 's';
    if (is_explicit && is_sanitized()) continue;  // tens of thousands of steps
    write_valve_scene(mitral_valve({.triangles = is_explicit ? 150 : 300, .preset = MitralPreset::Benchmark}),
                      folder_.path(), {.contact = "barrier", .tolerance = is_explicit ? 1e-4 : 1e-6});
    Scene scene = load_scene(folder_.path() / "scene.json");
    scene.solver.type = "dynamic";
    if (is_explicit) scene.solver.dynamic.integration = TimeIntegration::SemiImplicitEuler;
    const JudgedScene judged = solve_judged(scene);
    expect_contact_without_intersection(std::string("valve in time, ") + integration, judged);
    EXPECT_LT(judged.metrics.orifice_area_mm2.value(), 0.03 * judged.metrics.annulus_area_mm2.value());
  }
}

class ContactCascadeTest : public ContactSceneTest {
 protected:
  Scene valve(const std::string& contact) const {
    write_valve_scene(
        mitral_valve({.triangles = is_sanitized() ? 2200 : 2500, .preset = MitralPreset::Benchmark}),
        folder_.path(), {.contact = contact, .tolerance = is_sanitized() ? 1e-3 : 1e-8});
    Scene scene = load_scene(folder_.path() / "scene.json");
    scene.solver.cascade = true;
    return scene;
  }

  // A film with narrow dimples and a floor that rises into them. Where a coarser mesh has lost a dimple the
  // floor finds nothing in its way, and the next finer mesh, which has it, would start pierced.
  Scene dimpled_film(int cells) const {
    TriangleMesh film = grid_mesh(cells, cells, 20, 20);
    for (int i = 6; i < cells - 4; i += 7)
      for (int j = 6; j < cells - 4; j += 7) film.vertices(2, grid_node(cells, i, j)) = -0.6;
    write("film.obj", film);
    write("floor.obj", moved(grid_mesh(1, 1, 30, 30), {-5, -5, -1}));
    return scene_of(R"({
      "mesh": {"file": "film.obj"}, "obstacles": [{"name": "floor", "file": "floor.obj"}],
      "boundary": [{"nodes": "boundary", "fix": true},
                   {"nodes": "floor", "move_to": {"translate": [0, 0, "0.7 mm"]}}],
      "terms": [{"type": "cst_stvk", "young": "1 MPa", "thickness": "0.1 mm", "prestress": "0.1 N/mm"},
                {"type": "contact_barrier", "gap": "0.1 mm"}],
      "solver": {"type": "newton", "tolerance": 1e-6, "cascade": true}})");
  }
};

TEST_F(ContactCascadeTest, ClosesAValveWithoutAnIntersectionOnAnyMesh) {
  const JudgedScene judged = solve_judged(valve("barrier"));
  expect_contact_without_intersection("valve by a cascade", judged);
  ASSERT_EQ(judged.outcome.levels.size(), 2u);
  EXPECT_TRUE(judged.outcome.warnings.empty()) << judged.outcome.warnings.front();
  const auto& levels = judged.outcome.levels;
  EXPECT_GT(levels[0].iterations, 1);
  EXPECT_GT(judged.iterates, levels[0].iterations + levels[1].iterations) << "a mesh escaped the judge";
  EXPECT_GT(solve_judged(valve("none")).metrics.intersections, 0) << "nothing was in the way";
}

TEST_F(ContactCascadeTest, DoesNotStartTheSceneWhereWhatItFoundIsPierced) {
  const JudgedScene judged = solve_judged(dimpled_film(40));
  expect_no_intersection("dimpled film", judged);
  ASSERT_EQ(judged.outcome.warnings.size(), 1u);
  EXPECT_NE(judged.outcome.warnings[0].find("start that the cascade gave passes through itself"),
            std::string::npos)
      << judged.outcome.warnings[0];
  EXPECT_EQ(judged.outcome.levels.size(), 2u);
}

TEST_F(ContactCascadeTest, DoesNotStartAMiddleMeshWhereWhatItFoundIsPierced) {
  if (is_sanitized()) GTEST_SKIP() << "switched off under the sanitizers: time";
  const JudgedScene judged = solve_judged(dimpled_film(66));
  expect_no_intersection("dimpled film, three meshes", judged);
  ASSERT_EQ(judged.outcome.warnings.size(), 1u);
  EXPECT_NE(
      judged.outcome.warnings[0].find(
          "was solved from its own start: the shape found on a coarser one passes through itself there"),
      std::string::npos)
      << judged.outcome.warnings[0];
  EXPECT_EQ(judged.outcome.levels.size(), 3u) << "what it found serves the scene's own mesh";
}

// --- The published tricuspid valve -----------------------------------------------------------------------

class TricuspidContactTest : public ContactSceneTest {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(kData)) GTEST_SKIP() << "skipped: data not found";
  }

  Scene imported(const std::string& name, const ImportOptions& options) const {
    import_valve(kData / name, folder_.path(), options);
    return load_scene(folder_.path() / "scene.json");
  }

  const std::filesystem::path kData = std::filesystem::path(COAPT_SHARED_DIR) / "data" / "trivalve11-healthy";
};

TEST_F(TricuspidContactTest, ClosesWithoutAnIntersectionAtAnyIterate) {
  const JudgedScene judged = solve_judged(
      imported("valve_coarse.json",
               {.young = "0.05 MPa", .chord_young = "40 MPa", .tolerance = is_sanitized() ? 1e-2 : 1e-8}));
  expect_contact_without_intersection("coarse tricuspid valve, linear", judged);
}

class Nightly : public TricuspidContactTest {};

TEST_F(Nightly, TricuspidValvesCloseWithoutAnIntersectionAtAnyIterate) {
  if (is_sanitized()) GTEST_SKIP() << "switched off under the sanitizers: time";
  expect_contact_without_intersection("coarse tricuspid valve",
                                      solve_judged(imported("valve_coarse.json", {})));
  expect_contact_without_intersection(
      "full tricuspid valve, linear",
      solve_judged(imported("valve.json", {.young = "0.05 MPa", .chord_young = "40 MPa"})));
}

}  // namespace
}  // namespace coapt
