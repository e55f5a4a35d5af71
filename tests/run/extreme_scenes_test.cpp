// Stress row S25 from the scene file on: thickness, modulus, pressure and contact range far from anything
// that a sheet has. The answer is finite and its status true, or the scene is refused with the reason.
#include "core/error.hpp"
#include "formats/mesh_io.hpp"
#include "mesh/shapes.hpp"
#include "run/run.hpp"
#include "solve/solve_scene.hpp"
#include "support/meshes.hpp"
#include "support/sheets.hpp"
#include "support/temporary_folder.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

namespace coapt {
namespace {

// A disc of radius 10 mm held at its rim, 2 mm above the floor where there is one.
class ExtremeScene : public testing::Test {
 protected:
  static constexpr double kRadius = 10, kHeight = 2;  // [mm]; edges of some 2 mm

  ExtremeScene() {
    TriangleMesh sheet = disc(kRadius, 200);
    write_mesh(folder_.path() / "flat.obj", sheet);
    sheet.vertices.row(2).array() += kHeight;
    sheet.triangles.row(1).swap(sheet.triangles.row(2));  // normals, and with them the pressure, downwards
    write_mesh(folder_.path() / "above.obj", sheet);
    TriangleMesh floor = grid_mesh(1, 1, 60, 60);
    floor.vertices.colwise() -= Vec3(31, 29, 0);
    write_mesh(folder_.path() / "floor.obj", floor);
  }

  RunReport solved(const std::string& name, const std::string& scene) {
    RunOptions options;
    options.writes = false;
    options.factorisations = built_in_factorisations();
    RunReport found = run(load_scene(folder_.write("scene.json", scene)), scene_solvers(), options);
    const Result& result = found.report.result;
    std::printf("S25 %s: %s, %d iterations\n", name.c_str(), result.message.c_str(), result.iterations);
    EXPECT_TRUE(result.q.allFinite()) << name;
    EXPECT_TRUE(std::isfinite(result.energy) && std::isfinite(result.residual)) << name;
    EXPECT_EQ(result.status == Status::Converged, result.residual <= 1e-8) << name;
    return found;
  }

  RunReport inflated(const std::string& young, const std::string& thickness, const std::string& pressure) {
    return solved(young + ", " + thickness + ", " + pressure,
                  R"({"mesh": {"file": "flat.obj"}, "boundary": [{"nodes": "boundary", "fix": true}],
                      "terms": [{"type": "cst_tension_field", "young": ")" +
                      young + R"(", "poisson": 0.3, "thickness": ")" + thickness +
                      R"("}, {"type": "bending"}, {"type": "load_pressure", "value": ")" + pressure +
                      R"("}],
                      "solver": {"type": "newton", "tolerance": 1e-8, "max_iterations": 1000}})");
  }

  RunReport pressed(const std::string& gap, const std::string& pressure) {
    return solved("gap " + gap + ", " + pressure,
                  R"({"mesh": {"file": "above.obj"}, "obstacles": [{"name": "floor", "file": "floor.obj"}],
                      "boundary": [{"nodes": "boundary", "fix": true}, {"nodes": "floor", "fix": true}],
                      "terms": [{"type": "cst_tension_field", "young": "1 MPa", "poisson": 0.3,
                                 "thickness": "0.1 mm"},
                                {"type": "bending"}, {"type": "load_pressure", "value": ")" +
                      pressure + R"("}, {"type": "contact_barrier", "gap": ")" + gap + R"("}],
                      "solver": {"type": "newton", "tolerance": 1e-8, "max_iterations": 1000}})");
  }

  static double height(const RunReport& found) {
    return found.model.objective->positions(found.report.result.q).row(2).maxCoeff();
  }

  TemporaryFolder folder_;
};

// A thickness of 1e-9 mm under 0.1 kPa: p a / (E h) = 1e6. The linear law does have an equilibrium there, a
// bubble whose size is proportional to that number once the rest size counts for nothing.
TEST_F(ExtremeScene, S25ASheetThinnerThanAnAtomIsABubble) {
  const RunReport small = inflated("1 MPa", "1e-9 mm", "0.1 kPa"),
                  large = inflated("1 MPa", "1e-9 mm", "100 kPa");
  ASSERT_EQ(small.report.result.status, Status::Converged) << small.report.result.message;
  ASSERT_EQ(large.report.result.status, Status::Converged) << large.report.result.message;
  EXPECT_GT(height(small), 1e5 * kRadius);
  EXPECT_NEAR(height(large) / height(small), 1e3, 1e-3 * 1e3);
}

// Stiff beyond measure: a plate, whose deflection under p is far below the rounding of its radius.
TEST_F(ExtremeScene, S25AStiffSheetUnderNextToNoPressureStaysFlat) {
  for (const char* const thickness : {"1 mm", "1e-9 mm"}) {
    const RunReport found = inflated("1e15 MPa", thickness, "1e-12 kPa");
    const double q = 1e-15 * kRadius / (1e15 * (std::string(thickness) == "1 mm" ? 1 : 1e-9));
    EXPECT_GE(height(found), 0);
    EXPECT_LT(height(found), kRadius * std::cbrt(q));  // the membrane's alone would be 0.66 of that
  }
}

// A contact range of 1e-9 of an edge: out of reach it costs nothing, within it holds the sheet off the floor.
TEST_F(ExtremeScene, S25AContactRangeOfABillionthOfAnEdgeLetsNothingThrough) {
  const RunReport clear = pressed("2e-9 mm", "0.02 kPa");
  EXPECT_EQ(clear.report.result.status, Status::Converged) << clear.report.result.message;
  EXPECT_EQ(clear.report.metrics.intersections, 0);
  const auto sheet = [](const RunReport& found) {
    const Points x = found.model.objective->positions(found.report.result.q);
    return Points(x.leftCols(found.model.mesh.vertex_count()));
  };
  EXPECT_GT(sheet(clear).row(2).minCoeff(), 0.1);
  EXPECT_LT(sheet(clear).row(2).minCoeff(), kHeight - 0.1);
  const RunReport pressed_down = pressed("2e-9 mm", "2 kPa");
  EXPECT_EQ(pressed_down.report.metrics.intersections, 0);
  EXPECT_GT(sheet(pressed_down).row(2).minCoeff(), 0);
  EXPECT_LT(sheet(pressed_down).row(2).minCoeff(), 2e-9);
}

TEST_F(ExtremeScene, S25NothingAtAllIsRefusedByName) {
  for (const auto& [thickness, gap] : {std::pair{"0 mm", "1 mm"}, std::pair{"1 mm", "0 mm"}}) {
    try {
      solved("none", R"({"mesh": {"file": "flat.obj"}, "terms": [
          {"type": "cst_tension_field", "young": "1 MPa", "thickness": ")" +
                         std::string(thickness) + R"("}, {"type": "contact_barrier", "gap": ")" + gap +
                         R"("}]})");
      ADD_FAILURE() << "accepted: " << thickness << ", " << gap;
    } catch (const InputError& error) {
      const std::string wanted = std::string(thickness) == "0 mm" ? "thickness" : "gap";
      EXPECT_NE(std::string(error.what()).find(wanted), std::string::npos) << error.what();
    }
  }
}

}  // namespace
}  // namespace coapt
