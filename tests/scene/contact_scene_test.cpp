// Contact as a scene asks for it: obstacles that move, states that rigid contact has in closed form, and what
// is refused.
#include "core/error.hpp"
#include "mesh/generators/shapes.hpp"
#include "mesh/mesh_io.hpp"
#include "scene/run.hpp"
#include "scene/temporary_folder.hpp"
#include "support/meshes.hpp"
#include "support/sheets.hpp"
#include "support/term_suite.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace coapt {
namespace {

class ContactSceneTest : public testing::Test {
 protected:
  RunReport run_scene(const std::string& text) {
    const Scene scene = load_scene(folder_.write("scene.json", text));
    RunOptions options;
    options.writes = false;
    options.factorisations = {{"auto", best_factorisation()}, {"eigen", make_eigen_factorisation}};
    return run(scene, built_in_solvers(), options);
  }

  std::string refusal(const std::string& text) {
    try {
      run_scene(text);
      return "accepted";
    } catch (const InputError& error) {
      return error.what();
    }
  }

  void write(const std::string& name, const TriangleMesh& mesh) const {
    write_mesh(folder_.path() / name, mesh);
  }

  TemporaryFolder folder_;
};

Points final_positions(const RunReport& run) { return run.model.objective->positions(run.report.result.q); }

// Forces of the contact on all nodes.
Points contact_forces(const RunReport& run) {
  const Points x = final_positions(run);
  for (const auto& term : run.model.objective->terms())
    if (term->role() == TermRole::Contact) return -evaluate_term(*term, x).gradient;
  return Points::Zero(3, x.cols());
}

Vec3 contact_force(const RunReport& run, const std::vector<int>& nodes) {
  return contact_forces(run)(Eigen::all, nodes).rowwise().sum();
}

// --- A ball pressed into a film --------------------------------------------------------------------------

constexpr double kRim = 10, kBall = 4, kTension = 0.1;

// A film of constant tension in a circular frame at z = 0, its middle carried by a sphere of radius a around
// (0, 0, -below) that it leaves tangentially. Outside it is the catenoid r = c cosh((z - z0) / c); the
// balance of any disc around the axis gives c = a sin^2 angle, 2 pi T c being the axial force.
struct BallInFilm {
  double a, below;

  double rim_above_centre(double angle) const {
    const double c = a * std::pow(std::sin(angle), 2);
    return c * (std::acosh(kRim / c) - std::acosh(1 / std::sin(angle))) - a * std::cos(angle);
  }
  // Angle between the axis and the circle of contact; the film touches the lower side.
  double angle() const {
    double low = 1e-3, high = 0.5 * std::numbers::pi;
    for (int k = 0; k < 100; ++k) {
      const double middle = 0.5 * (low + high);
      (rim_above_centre(middle) < below ? low : high) = middle;
    }
    return low;
  }
  double force() const { return 2 * std::numbers::pi * kTension * a * std::pow(std::sin(angle()), 2); }
};

TEST_F(ContactSceneTest, ABallPressedIntoAFilmLeavesItAsACatenoid) {
  write("film.obj", disc(kRim, 1500));
  TriangleMesh ball = sphere(kBall, 1280);
  ball.vertices.row(2).array() += kBall + 0.5;
  write("ball.obj", ball);
  const RunReport run = run_scene(R"({
    "mesh": {"file": "film.obj"}, "obstacles": [{"name": "ball", "file": "ball.obj"}],
    "boundary": [{"nodes": "boundary", "fix": true},
                 {"nodes": "ball", "move_to": {"translate": [0, 0, "-2.5 mm"]}}],
    "terms": [{"type": "surface_tension", "tension": "0.1 N/mm"},
              {"type": "cst_stvk", "young": "0.05 MPa", "poisson": 0.3, "thickness": "0.1 mm"},
              {"type": "contact_barrier", "gap": "0.3 mm"}],
    "solver": {"type": "newton", "tolerance": 1e-6, "max_iterations": 2000}})");
  ASSERT_EQ(run.report.result.status, Status::Converged) << run.report.result.message;
  EXPECT_EQ(run.report.metrics.intersections, 0);

  const Points x = final_positions(run);
  const Vec3 centre(0, 0, kBall - 2);
  // The film as rigid contact sees it lies where the barrier carries it: mean distance, weighted by force.
  const Points forces = contact_forces(run);
  double weight = 0, distance = 0;
  for (int v = 0; v < run.model.mesh.vertex_count(); ++v) {
    const double share = forces.col(v).norm();
    weight += share;
    distance += share * (x.col(v) - centre).norm();
  }
  distance /= weight;
  EXPECT_GT(distance, 0.99 * kBall);
  EXPECT_LT(distance, kBall + 0.3);
  const BallInFilm rigid{distance, -centre[2]};
  const Vec3 force = contact_force(run, run.model.sets.at("ball"));
  EXPECT_NEAR(force[2], rigid.force(), 0.03 * rigid.force());
  EXPECT_LT(std::hypot(force[0], force[1]), 0.01 * force[2]);
  std::printf("ball in film: force %.5f N, rigid contact %.5f N, %d iterations, %.2f s\n", force[2],
              rigid.force(), run.report.result.iterations, run.report.result.wall_s);
}

// --- A strip pressed onto a plane ------------------------------------------------------------------------

// A strip of length L and stiffness E h in plane strain across, held at its ends at height H above a plane
// without friction, pressed by p: arcs of radius R = T / p that touch the plane, straight in between.
struct StripOnPlane {
  double length, height, stiffness, pressure;

  double half_arc(double radius) const { return std::sqrt(2 * radius * height - height * height); }
  double width(double radius) const { return length - 2 * half_arc(radius); }
  double tension(double radius) const {  // St. Venant-Kirchhoff, per current width
    const double stretch = (width(radius) + 2 * radius * std::asin(half_arc(radius) / radius)) / length;
    return stiffness * stretch * 0.5 * (stretch * stretch - 1);
  }
  double radius() const {
    double low = height, high = 0.5 * (0.25 * length * length + height * height) / height;
    for (int k = 0; k < 100; ++k) {
      const double middle = 0.5 * (low + high);
      (pressure * middle < tension(middle) ? low : high) = middle;
    }
    return low;
  }
};

TEST_F(ContactSceneTest, AStripPressedOntoAPlaneTouchesItAsWideAsRigidContactSays) {
  TriangleMesh strip = grid_mesh(120, 2, 20, 0.4);
  strip.vertices.row(2).setConstant(1);
  strip.triangles.row(1).swap(strip.triangles.row(2));  // normals, and with them the pressure, downwards
  write("strip.obj", strip);
  TriangleMesh plane = grid_mesh(1, 1, 30, 5);
  plane.vertices.colwise() -= Vec3(5, 2, 0);
  write("plane.obj", plane);
  const double pressure = 2.1e-4;
  const RunReport run = run_scene(R"({
    "mesh": {"file": "strip.obj"}, "obstacles": [{"name": "floor", "file": "plane.obj"}],
    "boundary": [{"nodes": "all", "fix": ["y"]},
                 {"nodes": {"plane": {"axis": "x", "at": 0}}, "fix": true},
                 {"nodes": {"plane": {"axis": "x", "at": 20}}, "fix": true},
                 {"nodes": "floor", "fix": true}],
    "terms": [{"type": "cst_stvk", "young": "1 MPa", "poisson": 0, "thickness": "0.1 mm"},
              {"type": "load_pressure", "value": "0.21 kPa"}, {"type": "contact_barrier", "gap": "0.05 mm"}],
    "solver": {"type": "newton", "tolerance": 1e-7, "max_iterations": 2000}})");
  ASSERT_EQ(run.report.result.status, Status::Converged) << run.report.result.message;
  EXPECT_EQ(run.report.metrics.intersections, 0);

  const Points x = final_positions(run).leftCols(run.model.mesh.vertex_count());
  const double lowest = x.row(2).minCoeff();
  EXPECT_GT(lowest, 0);
  EXPECT_LT(lowest, 0.05);
  const StripOnPlane rigid{20, 1 - lowest, 0.1, pressure};
  const double width = rigid.width(rigid.radius());
  // On the plane the contact carries the pressure, whatever the distance at which it does.
  const double carried = -contact_force(run, run.model.sets.at("floor"))[2] / (pressure * 0.4);
  EXPECT_NEAR(carried, width, 0.02 * width);
  double from = kInfinity, to = -kInfinity;
  for (int v = 0; v < x.cols(); ++v)
    if (x(2, v) < lowest + 0.005) {
      from = std::min(from, x(0, v));
      to = std::max(to, x(0, v));
    }
  EXPECT_NEAR(to - from, width, 3 * 20.0 / 120);
  std::printf(
      "strip on a plane: width %.4f by force, %.4f by distance, rigid contact %.4f mm, %d iterations\n",
      carried, to - from, width, run.report.result.iterations);
}

// --- Motion that facets are in the way of, and what is refused -------------------------------------------

class SmallContactTest : public ContactSceneTest {
 protected:
  SmallContactTest() {
    write("film.obj", disc(kRim, 200));
    TriangleMesh ball = sphere(2, 80);
    ball.vertices.row(2).array() += 3;
    write("ball.obj", ball);
  }

  static std::string scene(const std::string& boundary,
                           const std::string& obstacles = R"({"name": "ball", "file": "ball.obj"})") {
    return R"({"mesh": {"file": "film.obj"}, "obstacles": [)" + obstacles +
           R"(], "boundary": [{"nodes": "boundary", "fix": true})" + boundary +
           R"(], "terms": [{"type": "cst_stvk", "young": "1 MPa", "thickness": "0.1 mm", "prestress": "0.1 N/mm"},
              {"type": "contact_barrier"}],
              "solver": {"type": "newton", "tolerance": 1e-4, "max_iterations": 2000}})";
  }
};

TEST_F(SmallContactTest, MotionThroughAHeldRimEndsBeforeItAndSaysSo) {
  const RunReport run = run_scene(scene(R"(, {"nodes": "ball", "move_to": {"translate": [9, 0, -3]}})"));
  EXPECT_EQ(run.report.result.status, Status::Stalled) << run.report.result.message;
  EXPECT_NE(run.report.result.message.find("presses facets against each other"), std::string::npos)
      << run.report.result.message;
  EXPECT_EQ(run.report.metrics.intersections, 0);
}

TEST_F(SmallContactTest, RefusesAStartThatIntersectsAnObstacleNamingTheirFacets) {
  TriangleMesh ball = sphere(2, 80);
  ball.vertices.row(2).array() += 1.5;
  write("ball.obj", ball);
  const std::string message = refusal(scene(""));
  EXPECT_NE(message.find("terms[1]"), std::string::npos) << message;
  EXPECT_NE(message.find("obstacles after the mesh"), std::string::npos) << message;
  EXPECT_NE(message.find("coapt check --repair"), std::string::npos) << message;
}

TEST_F(SmallContactTest, RefusesCoincidentSheets) {
  const TriangleMesh film = disc(kRim, 200);
  write("ball.obj", film);  // the obstacle is the film itself
  EXPECT_NE(refusal(scene("")).find("touch or pass through each other"), std::string::npos);
}

TEST_F(SmallContactTest, RefusesAnObstacleThatIsSetFree) {
  EXPECT_NE(refusal(scene(R"(, {"nodes": "ball", "fix": false})")).find("sets nodes of an obstacle free"),
            std::string::npos);
  EXPECT_NE(refusal(scene(R"(, {"nodes": "ball", "fix": ["x"]})")).find("sets nodes of an obstacle free"),
            std::string::npos);
}

TEST_F(SmallContactTest, RefusesTwoObstaclesOfOneName) {
  const std::string twice = R"({"name": "ball", "file": "ball.obj"}, {"name": "ball", "file": "ball.obj"})";
  EXPECT_NE(refusal(scene("", twice)).find("obstacles[1].name"), std::string::npos)
      << refusal(scene("", twice));
}

// Stands for any solver that chooses its steps itself.
class FreeSteps final : public Solver {
 public:
  std::string_view name() const override { return "free_steps"; }
  bool honours_step_limits() const override { return false; }
  Status minimize(Objective&, Vector&, Monitor&) override { return Status::Converged; }
};

TEST_F(SmallContactTest, RefusesSolversThatCannotKeepStepsFreeOfCollisionsNamingSolverAndTerm) {
  Scene asked = load_scene(folder_.write("scene.json", scene("")));
  asked.solver.type = "free_steps";
  RunOptions options;
  options.writes = false;
  const SolverTable table = {
      {"free_steps", [](const SolverOptions&) { return std::make_unique<FreeSteps>(); }}};
  try {
    run(asked, table, options);
    FAIL() << "accepted";
  } catch (const InputError& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find("\"free_steps\""), std::string::npos) << message;
    EXPECT_NE(message.find("contact_barrier"), std::string::npos) << message;
  }
}

}  // namespace
}  // namespace coapt
