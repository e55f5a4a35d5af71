// What a finite repulsion, or none, lets through is counted and said.
#include "energy/contact_facet.hpp"
#include "run/contact_fixture.hpp"
#include "run/judged_scene.hpp"
#include "support/contact_scene.hpp"

#include <algorithm>
#include <sstream>

namespace coapt {
namespace {

constexpr const char* kCounted = "pairs of facets pass through each other in the result";
constexpr const char* kTooWeak = "two sheets can be pressed through each other";
constexpr const char* kIdleObstacle = "obstacles: nothing keeps the membrane off them";

bool warns_of(const RunReport& run, const std::string& piece) {
  const std::vector<std::string>& warnings = run.report.warnings;
  return std::any_of(warnings.begin(), warnings.end(),
                     [&](const std::string& warning) { return warning.find(piece) != std::string::npos; });
}

// A sheet of side 10 held at its rim at height z; a pressure presses it downwards.
TriangleMesh pressed_sheet(int cells, double z) {
  TriangleMesh sheet = moved(grid_mesh(cells, cells, 10, 10), {0, 0, z});
  sheet.triangles.row(1).swap(sheet.triangles.row(2));
  return sheet;
}

constexpr const char* kMembrane =
    R"({"type": "cst_stvk", "young": "1 MPa", "thickness": "0.1 mm", "prestress": "0.01 N/mm"})";

// --- An obstacle below a sheet ---------------------------------------------------------------------------

class SheetOverFloorTest : public ContactSceneTest {
 protected:
  SheetOverFloorTest() {
    write("sheet.obj", pressed_sheet(10, 0.5));
    write("floor.obj", moved(grid_mesh(1, 1, 30, 30), {-11, -9, 0}));
  }

  static std::string scene(const std::string& contact) {
    return R"({"mesh": {"file": "sheet.obj"}, "obstacles": [{"name": "floor", "file": "floor.obj"}],
      "boundary": [{"nodes": "boundary", "fix": true}],
      "terms": [)" +
           std::string(kMembrane) + R"(, {"type": "load_pressure", "value": "20 kPa"})" + contact +
           R"(], "solver": {"type": "newton", "tolerance": 1e-6}})";
  }
};

TEST_F(SheetOverFloorTest, PassesThroughItWithACountAndWarningsUnlessABarrierStandsBetween) {
  for (const std::string contact : {"", R"(, {"type": "contact_facet"})"}) {
    const RunReport run = run_scene(scene(contact));
    EXPECT_EQ(run.report.result.status, Status::Converged) << run.report.result.message;
    EXPECT_GT(run.report.metrics.intersections, 0) << contact;
    EXPECT_TRUE(warns_of(run, kIdleObstacle)) << contact;
    EXPECT_TRUE(warns_of(run, kCounted)) << contact;
  }
  const RunReport run = run_scene(scene(R"(, {"type": "contact_barrier"})"));
  EXPECT_EQ(run.report.result.status, Status::Converged) << run.report.result.message;
  EXPECT_EQ(run.report.metrics.intersections, 0);
  EXPECT_TRUE(run.report.warnings.empty()) << run.report.warnings.front();
}

TEST_F(SheetOverFloorTest, ObstaclesMayPassThroughEachOther) {
  TriangleMesh wall = grid_mesh(1, 1, 30, 4);
  wall.vertices.row(2).swap(wall.vertices.row(1));  // upright, beside the sheet and through the floor
  write("floor.obj", joined(moved(grid_mesh(1, 1, 30, 30), {-11, -9, 0}), moved(wall, {-11, -3, -2})));
  const RunReport run = run_scene(scene(R"(, {"type": "contact_barrier"})"));
  EXPECT_EQ(run.report.result.status, Status::Converged) << run.report.result.message;
  EXPECT_EQ(run.report.metrics.intersections, 0);
}

// --- S14: pressed harder than the finite law can carry ---------------------------------------------------

// A sheet half a range above another that is wider and held: what passes through it must intersect it.
class PressedSheetsTest : public ContactSceneTest {
 protected:
  static constexpr double kCapacity = 1e-3, kRange = 0.5;  // of contact_facet [MPa], [mm]

  PressedSheetsTest() {
    const TriangleMesh below = moved(grid_mesh(17, 17, 16, 16), {-3.05, -2.93, 0});
    const TriangleMesh above = pressed_sheet(12, 0.5);
    write("sheets.obj", joined(below, above));
    std::vector<int> held = rim_of(above);
    for (int& node : held) node += below.vertex_count();
    for (int node = 0; node < below.vertex_count(); ++node) held.push_back(node);
    for (const int node : held) held_ += (held_.empty() ? "" : ", ") + std::to_string(node);
  }

  // times: pressure over the greatest that the repulsion can carry.
  std::string scene(double times, const std::string& solver, const std::string& contact) const {
    return R"({"mesh": {"file": "sheets.obj"}, "boundary": [{"nodes": [)" + held_ +
           R"(], "fix": true}], "terms": [)" + kMembrane + R"(, {"type": "load_pressure", "value": ")" +
           std::to_string(times * 1000 * kCapacity) + R"( kPa"}, )" + contact + R"(], "solver": {"type": ")" +
           solver + R"(", "tolerance": 1e-6, "max_iterations": 2000}})";
  }

  static std::string facet_law() {
    std::ostringstream text;
    text << R"({"type": "contact_facet", "range": ")" << kRange << R"( mm", "strength": ")"
         << contact_facet_strength(kCapacity, kRange, 3, 1) << R"( N/mm^3"})";
    return text.str();
  }

  std::string held_;
};

TEST_F(PressedSheetsTest, NeverPassThroughEachOtherInSilence) {
  for (const double times : {0.5, 0.9, 1.1, 10.0})
    for (const std::string solver : {"newton", "lbfgs"}) {
      const RunReport run = run_scene(scene(times, solver, facet_law()));
      const long intersections = run.report.metrics.intersections;
      EXPECT_TRUE(intersections == 0 || (warns_of(run, kTooWeak) && warns_of(run, kCounted)))
          << times << " " << solver << ": " << intersections << " intersections";
      EXPECT_EQ(warns_of(run, kCounted), intersections > 0) << times << " " << solver;
      EXPECT_TRUE(times < 0.9 || warns_of(run, kTooWeak)) << times << " " << solver;
      EXPECT_TRUE(times > 1 || intersections == 0) << times << " " << solver;
      EXPECT_TRUE(times < 10 || intersections > 0) << times << " " << solver;
    }
}

TEST_F(PressedSheetsTest, StayApartWhereTheFacetLawIsTooWeakButABarrierStandsBetween) {
  const JudgedScene judged =
      solve_judged(scene_of(scene(10, "newton", R"({"type": "contact_barrier", "gap": "0.3 mm"})")));
  expect_contact_without_intersection("pressed sheets", judged);
  EXPECT_TRUE(judged.model.warnings.empty());
}

}  // namespace
}  // namespace coapt
