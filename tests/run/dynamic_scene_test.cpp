// The dynamic solver as a scene asks for it: masses, keys, frames.
#include "core/error.hpp"
#include "formats/mesh_io.hpp"
#include "mesh/shapes.hpp"
#include "run/run.hpp"
#include "scene/build/build.hpp"
#include "scene/build/masses.hpp"
#include "solve/solve_scene.hpp"
#include "support/temporary_folder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>

namespace coapt {
namespace {

class DynamicScene : public testing::Test {
 protected:
  DynamicScene() { write_mesh(folder_.path() / "disc.obj", disc(10, 200)); }

  Scene scene(const std::string& solver, const std::string& more = "") {
    return load_scene(folder_.write("scene.json", R"({"mesh": {"file": "disc.obj"},
      "boundary": [{"nodes": "boundary", "fix": true}],
      "terms": [{"type": "cst_tension_field", "young": "1 MPa", "thickness": "0.5 mm"},
                {"type": "load_pressure", "value": "1 kPa"}],
      "solver": )" + solver + more + "}"));
  }
  std::string text(const std::string& name) {
    std::ifstream in(folder_.path() / name);
    return {std::istreambuf_iterator<char>(in), {}};
  }

  // That a list of frames names.
  static std::vector<double> times_of(const std::string& list) {
    const std::string key = "timestep=\"";
    std::vector<double> times;
    for (size_t at = list.find(key); at != std::string::npos; at = list.find(key, at + 1))
      times.push_back(std::stod(list.substr(at + key.size())));
    return times;
  }

  TemporaryFolder folder_;
};

TEST_F(DynamicScene, LumpsTheMassOfTheMembrane) {
  const Model model = build(scene(R"({"type": "dynamic", "density": "1000 kg/m^3"})"));
  const Vector masses = lumped_masses(model, 1e-9);
  ASSERT_EQ(masses.size(), model.X.cols());
  const double area = nodal_areas(model.X, model.mesh.triangles).sum();
  EXPECT_NEAR(masses.sum(), 1e-9 * 0.5 * area, 1e-12 * masses.sum());
  EXPECT_GT(masses.minCoeff(), 0);
}

TEST_F(DynamicScene, LumpsTheMassOfCablesAndSparesNodesWithoutAny) {
  const Model model = build(load_scene(folder_.write("cables.json", R"({"mesh": {"file": "disc.obj"},
    "boundary": [{"nodes": [0], "fix": true}],
    "terms": [{"type": "cable", "edges": "boundary", "young": "10 MPa", "area": "2 mm2"},
              {"type": "load_field", "nodes": "boundary", "force": "1 N", "direction": [0, 0, 1]}]})")));
  const Vector masses = lumped_masses(model, 1e-9);
  double length = 0;
  for (const Line& line : model.lines) length += line.rest_length;
  std::vector<char> is_on_cable(static_cast<size_t>(model.X.cols()), 0);
  for (const Line& line : model.lines)
    for (const int end : {line.a, line.b}) is_on_cable[static_cast<size_t>(end)] = 1;
  double on_cables = 0;
  for (Eigen::Index k = 0; k < masses.size(); ++k)
    if (is_on_cable[static_cast<size_t>(k)]) on_cables += masses[k];
  EXPECT_NEAR(on_cables, 1e-9 * 2 * length, 1e-12 * on_cables);
  EXPECT_NEAR(masses.minCoeff(),
              0.01 * on_cables / static_cast<double>(std::count(is_on_cable.begin(), is_on_cable.end(), 1)),
              1e-9 * on_cables);
}

TEST_F(DynamicScene, RefusesASceneWithoutMass) {
  const Model model = build(load_scene(folder_.write("film.json", R"({"mesh": {"file": "disc.obj"},
    "boundary": [{"nodes": "boundary", "fix": true}],
    "terms": [{"type": "surface_tension", "tension": "1 N/mm"}], "solver": {"type": "dynamic"}})")));
  try {
    lumped_masses(model, 1e-9);
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("nothing in the scene has a mass"), std::string::npos);
  }
}

TEST_F(DynamicScene, EndsWhereNewtonDoesAndWritesFrames) {
  const RunReport newton = run(scene(R"({"tolerance": 1e-9})"), scene_solvers());
  ASSERT_EQ(newton.report.result.status, Status::Converged);
  for (const std::string dynamics :
       {R"({"time_step": "0.2 ms"})", R"({"kinetic_damping": true, "relaxation_time": "0 s"})",
        R"({"linear_solver": "conjugate_gradients"})",
        R"({"collisions": "inelastic", "collision_distance": "0.1 mm"})"}) {
    const RunReport dynamic =
        run(scene(R"({"type": "dynamic", "tolerance": 1e-9, "dynamics": )" + dynamics + "}",
                  R"(, "output": {"frames": 5})"),
            scene_solvers());
    const Result& result = dynamic.report.result;
    ASSERT_EQ(result.status, Status::Converged) << dynamics << result.message;
    EXPECT_LT((result.q - newton.report.result.q).cwiseAbs().maxCoeff(), 2e-5) << dynamics;  // 1e-6 of 20 mm

    // Iterates 0, 5, 10 ..., each with the time that the motion had got to.
    const std::string list = text("result/frames.pvd");
    const size_t wanted = static_cast<size_t>(result.iterations) / 5 + 1;
    const std::vector<double> times = times_of(list);
    ASSERT_EQ(times.size(), wanted);
    for (size_t k = 0; k < wanted; ++k)
      EXPECT_NEAR(times[k], result.trace[5 * k].time, 1e-8 * result.trace.back().time);
    const auto last = std::to_string(wanted - 1);
    const std::filesystem::path file =
        folder_.path() / "result/frames" / ("frame_" + std::string(6 - last.size(), '0') + last + ".vtp");
    ASSERT_TRUE(std::filesystem::exists(file)) << file;
    EXPECT_EQ(read_mesh(file).mesh.triangle_count(), dynamic.model.mesh.triangle_count());
    EXPECT_NE(text("result/trace.csv").find(",time_s\n"), std::string::npos);
  }
  // The frames of an earlier solve do not stay.
  run(scene(R"({"tolerance": 1e-9})"), scene_solvers());
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "result/frames.pvd"));
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "result/frames"));
}

// Each place of the rim is a motion of its own: time goes on from one to the next.
TEST_F(DynamicScene, KeepsOneTimeOverAMovingRim) {
  const Scene rim = load_scene(folder_.write("rim.json", R"({"mesh": {"file": "disc.obj"},
    "boundary": [{"nodes": "boundary", "move_to": {"translate": [0, 0, "3 mm"]}}],
    "terms": [{"type": "cst_tension_field", "young": "1 MPa", "thickness": "0.5 mm"},
              {"type": "load_pressure", "value": "1 kPa"}],
    "motion": {"steps": 3}, "output": {"frames": 1},
    "solver": {"type": "dynamic", "tolerance": 1e-6}})"));
  const RunReport report = run(rim, scene_solvers());
  const Result& result = report.report.result;
  ASSERT_EQ(result.status, Status::Converged) << result.message;
  for (size_t k = 1; k < result.trace.size(); ++k)
    ASSERT_GE(result.trace[k].time, result.trace[k - 1].time) << k;
  const std::vector<double> times = times_of(text("result/frames.pvd"));
  ASSERT_GT(times.size(), 10U);
  for (size_t k = 1; k < times.size(); ++k) ASSERT_GT(times[k], times[k - 1]) << k;
  EXPECT_NEAR(times.back(), result.trace.back().time, 1e-8 * times.back());
}

}  // namespace
}  // namespace coapt
