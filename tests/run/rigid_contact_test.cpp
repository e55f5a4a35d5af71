// States of films and strips on obstacles that rigid contact has in closed form.
#include "mesh/shapes.hpp"
#include "run/contact_fixture.hpp"
#include "run/judged_scene.hpp"
#include "support/meshes.hpp"
#include "support/term_suite.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace coapt {
namespace {

// Forces of the contact on all nodes.
Points contact_forces(const JudgedScene& judged) {
  const Points x = judged.positions();
  for (const auto& term : judged.model.objective->terms())
    if (term->role() == TermRole::Contact) return -evaluate_term(*term, x).gradient;
  return Points::Zero(3, x.cols());
}

Vec3 contact_force(const JudgedScene& judged, const std::string& set) {
  return contact_forces(judged)(Eigen::all, judged.model.sets.at(set)).rowwise().sum();
}

// --- A ball pressed into a film --------------------------------------------------------------------------

constexpr double kRimRadius = 10, kBall = 4, kTension = 0.1;

// A film of constant tension in a circular frame at z = 0, its middle carried by a sphere of radius a around
// (0, 0, -below) that it leaves tangentially. Outside it is the catenoid r = c cosh((z - z0) / c); the
// balance of any disc around the axis gives c = a sin^2 angle, 2 pi T c being the axial force.
struct BallInFilm {
  double a, below;

  double rim_above_centre(double angle) const {
    const double c = a * std::pow(std::sin(angle), 2);
    return c * (std::acosh(kRimRadius / c) - std::acosh(1 / std::sin(angle))) - a * std::cos(angle);
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

class BallInFilmTest : public ContactSceneTest {
 protected:
  BallInFilmTest() {
    write("film.obj", disc(kRimRadius, 1500));
    TriangleMesh ball = sphere(kBall, 1280);
    ball.vertices.row(2).array() += kBall + 0.5;
    write("ball.obj", ball);
  }

  // more: terms beside the film.
  JudgedScene solve(const std::string& more, double depth = 2.5) const {
    return solve_judged(scene_of(R"({
    "mesh": {"file": "film.obj"}, "obstacles": [{"name": "ball", "file": "ball.obj"}],
    "boundary": [{"nodes": "boundary", "fix": true},
                 {"nodes": "ball", "move_to": {"translate": [0, 0, "-)" +
                                 std::to_string(depth) + R"( mm"]}}],
    "terms": [{"type": "surface_tension", "tension": "0.1 N/mm"})" +
                                 more + R"(],
    "solver": {"type": "newton", "tolerance": 1e-8, "max_iterations": 2000}})"));
  }
};

constexpr const char* kSheet =
    R"(, {"type": "cst_stvk", "young": "0.05 MPa", "poisson": 0.3, "thickness": "0.1 mm"})";
constexpr const char* kContact = R"(, {"type": "contact_barrier", "gap": "0.3 mm"})";

TEST_F(BallInFilmTest, LeavesItAsACatenoid) {
  const JudgedScene judged = solve(std::string(kSheet) + kContact);
  expect_contact_without_intersection("ball in film", judged);

  const Points x = judged.positions();
  const Vec3 centre(0, 0, kBall - 2);
  // The film as rigid contact sees it lies where the barrier carries it: mean distance, weighted by force.
  const Points forces = contact_forces(judged);
  double weight = 0, distance = 0;
  for (int v = 0; v < judged.model.mesh.vertex_count(); ++v) {
    const double share = forces.col(v).norm();
    weight += share;
    distance += share * (x.col(v) - centre).norm();
  }
  distance /= weight;
  EXPECT_GT(distance, 0.99 * kBall);
  EXPECT_LT(distance, kBall + 0.3);
  const BallInFilm rigid{distance, -centre[2]};
  const Vec3 force = contact_force(judged, "ball");
  EXPECT_NEAR(force[2], rigid.force(), 0.03 * rigid.force());
  EXPECT_LT(std::hypot(force[0], force[1]), 0.01 * force[2]);
  std::printf("ball in film: force %.5f N, rigid contact %.5f N\n", force[2], rigid.force());
}

TEST_F(BallInFilmTest, PassesThroughItWithoutABarrier) { EXPECT_GT(solve(kSheet).metrics.intersections, 0); }

// The film in contact goes along with the ball: without that each step of the motion ends after a part of the
// gap, 50 to 250 iterations.
TEST_F(BallInFilmTest, IsPressedIntoAFilmAloneInFewIterations) {
  for (const double depth : {1.5, 2.5, 4.0}) {
    SCOPED_TRACE(depth);
    const JudgedScene judged = solve(kContact, depth);
    expect_contact_without_intersection("ball in film alone", judged);
    EXPECT_LE(judged.outcome.result.iterations, 30);
  }
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

class StripOnPlaneTest : public ContactSceneTest {
 protected:
  StripOnPlaneTest() {
    TriangleMesh strip = grid_mesh(120, 2, 20, 0.4);
    strip.vertices.row(2).setConstant(1);
    strip.triangles.row(1).swap(strip.triangles.row(2));  // normals, and with them the pressure, downwards
    write("strip.obj", strip);
    write("plane.obj", moved(grid_mesh(1, 1, 30, 5), {-5, -2, 0}));
  }

  JudgedScene solve(const std::string& contact) const {
    return solve_judged(scene_of(R"({
    "mesh": {"file": "strip.obj"}, "obstacles": [{"name": "floor", "file": "plane.obj"}],
    "boundary": [{"nodes": "all", "fix": ["y"]},
                 {"nodes": {"plane": {"axis": "x", "at": 0}}, "fix": true},
                 {"nodes": {"plane": {"axis": "x", "at": 20}}, "fix": true},
                 {"nodes": "floor", "fix": true}],
    "terms": [{"type": "cst_stvk", "young": "1 MPa", "poisson": 0, "thickness": "0.1 mm"},
              {"type": "load_pressure", "value": "0.21 kPa"})" +
                                 contact + R"(],
    "solver": {"type": "newton", "tolerance": 1e-7, "max_iterations": 2000}})"));
  }
};

TEST_F(StripOnPlaneTest, TouchesItAsWideAsRigidContactSays) {
  const JudgedScene judged = solve(R"(, {"type": "contact_barrier", "gap": "0.05 mm"})");
  expect_contact_without_intersection("strip on a plane", judged);

  const double pressure = 2.1e-4;
  const Points x = judged.positions().leftCols(judged.model.mesh.vertex_count());
  const double lowest = x.row(2).minCoeff();
  EXPECT_GT(lowest, 0);
  EXPECT_LT(lowest, 0.05);
  const StripOnPlane rigid{20, 1 - lowest, 0.1, pressure};
  const double width = rigid.width(rigid.radius());
  // On the plane the contact carries the pressure, whatever the distance at which it does.
  const double carried = -contact_force(judged, "floor")[2] / (pressure * 0.4);
  EXPECT_NEAR(carried, width, 0.02 * width);
  double from = kInfinity, to = -kInfinity;
  for (int v = 0; v < x.cols(); ++v)
    if (x(2, v) < lowest + 0.005) {
      from = std::min(from, x(0, v));
      to = std::max(to, x(0, v));
    }
  EXPECT_NEAR(to - from, width, 3 * 20.0 / 120);
  std::printf("strip on a plane: width %.4f by force, %.4f by distance, rigid contact %.4f mm\n", carried,
              to - from, width);
}

TEST_F(StripOnPlaneTest, PassesThroughItWithoutABarrier) { EXPECT_GT(solve("").metrics.intersections, 0); }

}  // namespace
}  // namespace coapt
