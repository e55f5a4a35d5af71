// Valves that xpbd closes and opens: against the barrier, with the motion of the annulus, by the numbers of
// the paper.
#include "exchange/import.hpp"
#include "exchange/valve_models.hpp"
#include "run/judged_scene.hpp"
#include "run/run.hpp"
#include "scene/build/build.hpp"
#include "scene/build/scene_geometry.hpp"
#include "scene/file/scene_text.hpp"
#include "solve/solve_scene.hpp"
#include "support/temporary_folder.hpp"
#include "valve/generators/leaflet_chords.hpp"
#include "valve/generators/mitral.hpp"
#include "xpbd/options.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace coapt {
namespace {

Scene xpbd_scene(const TemporaryFolder& folder, const XpbdOptions& options) {
  Scene scene = load_scene(folder.path() / "scene.json");
  scene.solver.type = "xpbd";
  scene.solver.xpbd = std::make_shared<const XpbdOptions>(options);
  return scene;
}

double orifice_of(Model& model, const Vector& q) {
  const Points x = model.objective->positions(q);
  EXPECT_TRUE(x.allFinite());
  return measure(model, q, compute_fields(model, x)).orifice_area_mm2.value();
}

// --- Contact ----------------------------------------------------------------------------------------------

constexpr int kTriangles = 300, kSteps = 300, kIterations = 8;

class XpbdClosing : public testing::TestWithParam<std::string> {};

// Nothing passes through anything at any accepted state, and yet it closes.
TEST_P(XpbdClosing, ClosesAgainstTheBarrier) {
  const TemporaryFolder folder;
  Valve valve = mitral_valve({.triangles = kTriangles, .preset = MitralPreset::Benchmark});
  ImportOptions import;
  import.contact = "barrier";
  if (GetParam() != "membrane") apply_valve_model(GetParam(), valve, import);
  write_valve_scene(valve, folder.path(), import);
  XpbdOptions options;
  options.steps = kSteps;
  options.iterations = kIterations;
  const Scene scene = xpbd_scene(folder, options);
  JudgedScene judged = solve_judged(scene);
  const Result& result = judged.outcome.result;
  Model open = build(scene);
  const double first = orifice_of(open, open.q0), last = judged.metrics.orifice_area_mm2.value();
  std::printf("%s: orifice %.1f -> %.1f mm2 of %.1f, %.2f s; %s\n", GetParam().c_str(), first, last,
              judged.metrics.annulus_area_mm2.value(), result.wall_s, result.message.c_str());
  EXPECT_GT(judged.iterates, 200);
  EXPECT_EQ(judged.intersections, 0) << "at an accepted state";
  EXPECT_EQ(judged.metrics.intersections, 0);
  EXPECT_LT(last, 0.05 * judged.metrics.annulus_area_mm2.value());
  EXPECT_LT(last, 0.15 * first);
  EXPECT_TRUE(std::isfinite(result.energy));
  EXPECT_LT(result.residual, 1e3);
}

INSTANTIATE_TEST_SUITE_P(All, XpbdClosing, testing::Values("membrane", "hammer-2008", "hammer-2011"),
                         [](const auto& instance) {
                           return instance.param.substr(instance.param.find('-') + 1);
                         });

// --- Phases -----------------------------------------------------------------------------------------------

class XpbdValve : public testing::Test {
 protected:
  XpbdValve() {
    write_valve_scene(mitral_valve({.triangles = 300, .preset = MitralPreset::Benchmark}), folder_.path(),
                      {.contact = "none"});
  }
  TemporaryFolder folder_;
};

TEST_F(XpbdValve, TheAnnulusGoesWithThePhasesAndTheOrificeOpensAgain) {
  XpbdOptions options;
  options.steps = 150;
  options.iterations = 10;
  options.motion_time = 0.01;  // 100 steps
  options.phase = HeartPhase::Diastole;
  const Scene scene = xpbd_scene(folder_, options);
  const SceneGeometry geometry = scene_geometry(scene);
  Model model = build(scene, geometry);
  SolveSetup setup = solve_setup(scene, scene_solvers(), {});
  std::vector<Points> states;
  setup.observer = [&](const Iteration&, const Vector& q) {
    states.push_back(model.objective->positions(q));
    return true;
  };
  const double open = orifice_of(model, model.q0);
  const Result result = solve_scene(scene, geometry, model, setup).result;
  ASSERT_EQ(states.size(), 301U);
  const std::vector<int>& annulus = model.sets.at("annulus");
  const Points first = model.X(Eigen::all, annulus), closed = model.motion.positions(1)(Eigen::all, annulus);
  ASSERT_GT((closed - first).norm(), 1);
  const auto away = [&](size_t state, double share) {
    const Points wanted = first + share * (closed - first);
    return (states[state](Eigen::all, annulus) - wanted).cwiseAbs().maxCoeff();
  };
  EXPECT_EQ(away(0, 0), 0);
  EXPECT_LT(away(50, 0.5), 1e-12);
  EXPECT_LT(away(100, 1), 1e-12);
  EXPECT_LT(away(150, 1), 1e-12);
  EXPECT_LT(away(200, 0.5), 1e-12);
  EXPECT_LT(away(300, 0), 1e-12);
  // No step is a jump: of the annulus alone, not of what the blood moves.
  for (size_t k = 1; k < states.size(); ++k)
    EXPECT_LT((states[k] - states[k - 1])(Eigen::all, annulus).cwiseAbs().maxCoeff(),
              0.011 * (closed - first).cwiseAbs().maxCoeff() + 1e-12);
  const double opened = orifice_of(model, result.q);
  model.objective->prescribe(states[150]);
  const double shut = orifice_of(model, model.objective->unknowns(states[150]));
  std::printf("orifice %.1f open, %.1f closed, %.1f opened; %s\n", open, shut, opened,
              result.message.c_str());
  EXPECT_LT(shut, 0.3 * open);
  EXPECT_GT(opened, open);
  EXPECT_NE(result.message.find("of opening"), std::string::npos) << result.message;
  EXPECT_NE(result.message.find("membrane area"), std::string::npos) << result.message;
}

// --- The paper --------------------------------------------------------------------------------------------

XpbdOptions paper_options(int steps) {
  XpbdOptions options = walczak_2019();
  options.steps = steps;
  return options;
}

// The model as it is written, by 3 sweeps until it rests. The paper: closure in all cases, after 700 to 3,800
// steps, and a leaflet area within 4 mm2 of the first, mostly within 2.
TEST(XpbdPaperModel, ClosesAValveToRestAndKeepsTheAreaOfItsLeaflets) {
  const TemporaryFolder folder;
  Valve valve = mitral_valve({.triangles = 1600, .preset = MitralPreset::Benchmark});
  ImportOptions import;
  apply_valve_model("walczak-2019", valve, import);
  write_valve_scene(valve, folder.path(), import);
  const Scene scene = load_scene(folder.path() / "scene.json");
  const JudgedScene closed = solve_judged(scene);
  Model open_model = build(scene);
  const double open = orifice_of(open_model, open_model.q0), shut = closed.metrics.orifice_area_mm2.value();
  const Result& result = closed.outcome.result;
  std::printf("model: orifice %.1f -> %.1f mm2, %ld intersections; %s\n", open, shut,
              closed.metrics.intersections, result.message.c_str());
  EXPECT_NE(result.message.find("at rest after"), std::string::npos) << result.message;
  EXPECT_LT(result.iterations, 3800);
  EXPECT_LT(shut, 0.06 * open);
  EXPECT_LT(std::abs(closed.metrics.leaflet_area_change_mm2), 4);
}

// With Coapt's barrier nothing passes through anything, in both phases.
TEST_F(XpbdValve, MovesByThePapersNumbersInBothPhases) {
  write_valve_scene(mitral_valve({.triangles = 300, .preset = MitralPreset::Benchmark}), folder_.path(),
                    {.contact = "barrier"});
  XpbdOptions options = paper_options(300);
  const Scene scene = xpbd_scene(folder_, options);
  const auto has = [&](const char* type) {
    return std::any_of(scene.terms.begin(), scene.terms.end(),
                       [&](const TermSpec& t) { return t.type == type; });
  };
  ASSERT_TRUE(has("bending") && has("contact_barrier"));
  ASSERT_EQ(options.thickness, 0.5);
  const JudgedScene closed = solve_judged(scene);
  Model open_model = build(scene);
  const double open = orifice_of(open_model, open_model.q0), shut = closed.metrics.orifice_area_mm2.value();
  std::printf("by the paper: orifice %.1f -> %.1f mm2; %s\n", open, shut,
              closed.outcome.result.message.c_str());
  EXPECT_EQ(closed.intersections, 0);
  EXPECT_LT(shut, 0.5 * open);
  EXPECT_LT(std::abs(closed.metrics.leaflet_area_change_mm2), 4);
  options.phase = HeartPhase::Diastole;
  const JudgedScene opened = solve_judged(xpbd_scene(folder_, options));
  std::printf("opened: %.1f mm2; %s\n", opened.metrics.orifice_area_mm2.value(),
              opened.outcome.result.message.c_str());
  EXPECT_EQ(opened.intersections, 0);
  EXPECT_GT(opened.metrics.orifice_area_mm2.value(), open);
  EXPECT_LT(std::abs(opened.metrics.leaflet_area_change_mm2), 4);
}

// Without hinges, to rest: leaflets keep their area. So coarse a valve stays open by 31.5 mm2.
TEST_F(XpbdValve, KeepsTheAreaOfLeafletsByThePapersNumbers) {
  write_valve_scene(mitral_valve({.triangles = 300, .preset = MitralPreset::Benchmark}), folder_.path(),
                    {.contact = "barrier", .bends = false});
  const JudgedScene closed = solve_judged(xpbd_scene(folder_, paper_options(1500)));
  std::printf("without hinges: orifice %.1f of %.1f mm2; %s\n", closed.metrics.orifice_area_mm2.value(),
              closed.metrics.annulus_area_mm2.value(), closed.outcome.result.message.c_str());
  EXPECT_EQ(closed.intersections, 0);
  EXPECT_NE(closed.outcome.result.message.find("at rest after"), std::string::npos);
  EXPECT_LT(closed.metrics.orifice_area_mm2.value(), 33);
  EXPECT_LT(std::abs(closed.metrics.leaflet_area_change_mm2), 4);
}

// --- Clips ------------------------------------------------------------------------------------------------

// The paper's model of a valve with chords by its rule (section 3.5).
void write_paper_valve(const TemporaryFolder& folder) {
  Valve valve = mitral_valve({.triangles = 630, .preset = MitralPreset::Benchmark});
  valve.chords = {};
  LeafletChordOptions chords;
  chords.zones = {chord_zone("free_edge"), chord_zone("rough")};
  chords.lengths = ChordLengths::Sum;
  valve.chords = leaflet_chords(valve, chords);
  ImportOptions import;
  apply_valve_model("walczak-2019", valve, import);
  write_valve_scene(valve, folder.path(), import);
}

struct Clipped {
  Closure closure;
  double orifice_mm2 = 0, open_pair_mm = 0, pair_mm = 0;  // the farthest pair, at first and in the end
  std::string message;
};

Clipped solved_with_clips(const TemporaryFolder& folder, const std::string& at, const XpbdOptions& options) {
  const auto file = folder.path() / "scene.json";
  Scene scene = parse_scene(
      with_interventions(scene_text(file), {R"([{"type": "clip", "at": )" + at + "}]"}, file.string()), file);
  scene.solver.xpbd = std::make_shared<const XpbdOptions>(options);
  const JudgedScene judged = solve_judged(scene);
  Clipped found{judged.metrics.closure.value(), judged.metrics.orifice_area_mm2.value(), 0, 0,
                judged.outcome.result.message};
  const Points x = judged.positions();
  const SceneGeometry geometry = scene_geometry(scene);
  for (const auto& [a, b] : geometry.links.at("clip")) {
    found.open_pair_mm = std::max(found.open_pair_mm, (judged.model.X.col(a) - judged.model.X.col(b)).norm());
    found.pair_mm = std::max(found.pair_mm, (x.col(a) - x.col(b)).norm());
  }
  std::printf("clip at %s: orifice %.1f mm2, %zu outlines, pairs %.3f -> %.4f mm; %s\n", at.c_str(),
              found.orifice_mm2, found.closure.orifices.size(), found.open_pair_mm, found.pair_mm,
              found.message.c_str());
  return found;
}

// Walczak et al. 2019, section 3.8: distance constraints without compliance and of zero length. The open
// valve with a clip has two orifices (its figure 8), and a compliance lets the clip open.
TEST(XpbdClips, CloseAValveAndDivideItsOrifice) {
  const TemporaryFolder folder;
  write_paper_valve(folder);
  XpbdOptions options = walczak_2019();
  const Clipped closed = solved_with_clips(folder, "[0.5]", options);
  EXPECT_GT(closed.open_pair_mm, 5);
  EXPECT_LT(closed.pair_mm, 0.2 * options.thickness);  // 3 sweeps and contact leave that of 20 mm
  options.phase = HeartPhase::Diastole;
  const Clipped opened = solved_with_clips(folder, "[0.5]", options),
                with_two = solved_with_clips(folder, "[0.4, 0.6]", options);
  EXPECT_LT(closed.orifice_mm2, 0.15 * opened.orifice_mm2);
  EXPECT_EQ(opened.closure.orifices.size(), 2U);
  EXPECT_LT(opened.pair_mm, 0.2 * options.thickness);
  EXPECT_LT(with_two.orifice_mm2, 0.8 * opened.orifice_mm2);
  options.paper.tether_compliance = 1e-3;
  const Clipped soft = solved_with_clips(folder, "[0.5]", options);
  EXPECT_GT(soft.pair_mm, 5 * opened.pair_mm);
}

}  // namespace
}  // namespace coapt
