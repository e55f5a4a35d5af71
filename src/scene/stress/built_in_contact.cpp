// S13, S14, S25, S26: sheets pressed on obstacles that are as awkward as can be. Judged at every accepted
// state by exact predicates that share nothing with the barrier.
#include "energy/contact_facet.hpp"
#include "mesh/generators/shapes.hpp"
#include "scene/stress/built_in.hpp"

#include <cmath>

namespace coapt {
namespace {

const char* const kIntersections = "most pairs of facets through each other at any state";

TriangleMesh joined(const TriangleMesh& a, const TriangleMesh& b) {
  TriangleMesh both;
  both.vertices.resize(3, a.vertex_count() + b.vertex_count());
  both.vertices << a.vertices, b.vertices;
  both.triangles.resize(3, a.triangle_count() + b.triangle_count());
  both.triangles << a.triangles, (b.triangles.array() + a.vertex_count()).matrix();
  return both;
}

TriangleMesh moved(TriangleMesh mesh, const Vec3& by) {
  mesh.vertices.colwise() += by;
  return mesh;
}

// A pyramid without a bottom.
TriangleMesh spike(const Vec3& apex, double height, double half_width) {
  TriangleMesh mesh;
  mesh.vertices.resize(3, 5);
  mesh.vertices.colwise() = apex;
  mesh.vertices.rightCols(4).colwise() -= Vec3(0, 0, height);
  mesh.vertices.block<2, 4>(0, 1) += half_width * Eigen::Matrix<double, 2, 4>{{-1, 1, 1, -1}, {-1, -1, 1, 1}};
  mesh.triangles.resize(3, 4);
  mesh.triangles << 0, 0, 0, 0, 1, 2, 3, 4, 2, 3, 4, 1;
  return mesh;
}

// A roof whose ridge lies along x or along y.
TriangleMesh ridge(const Vec3& from, const Vec3& to, double height, double half_width) {
  const Vec3 side = (to - from).cross(Vec3::UnitZ()).normalized() * half_width, down(0, 0, -height);
  TriangleMesh mesh;
  mesh.vertices.resize(3, 6);
  mesh.vertices << from, to, from + side + down, to + side + down, from - side + down, to - side + down;
  mesh.triangles.resize(3, 4);
  mesh.triangles << 0, 0, 0, 0, 2, 3, 1, 5, 3, 1, 5, 4;
  return mesh;
}

// A sheet of side 1 mm, held at its rim at some height above z = 0, and pressed down on an obstacle. contact:
// the term, with its braces.
BuiltScene pressed_scene(const std::string& name, int triangles, double height, const TriangleMesh& obstacle,
                         double pressure, const std::string& contact) {
  return {.name = name,
          .text = filled(R"({ // A sheet pressed on an obstacle. Lengths in mm.
  "mesh": { "file": "mesh.obj" },
  "obstacles": [{ "name": "obstacle", "file": "obstacle.obj" }],
  "boundary": [{ "nodes": "boundary", "fix": true }],
  "terms": [
    { "type": "cst_tension_field", "young": "1 MPa", "poisson": 0.3, "thickness": "1 mm" },
    { "type": "bending", "stiffness": "1e-5 mJ" },
    { "type": "load_field", "direction": [0, 0, -1], "pressure": "$PRESSURE MPa" },
    )",
                         {{"PRESSURE", pressure}}) +
                  contact + R"(
  ],
  "solver": { "type": "newton", "tolerance": 1e-6, "max_iterations": 3000 }
}
)",
          .mesh = moved(square(1, triangles), {0, 0, height}),
          .others = {{"obstacle", obstacle}}};
}

std::string barrier(double gap) {
  return filled(R"({ "type": "contact_barrier", "gap": "$GAP mm" })", {{"GAP", gap}});
}

// Held, and nothing ever through anything. A barrier that is not reached proves nothing.
StressOutcome nothing_through(const StressScene& scene, const Stressed& solved, bool must_touch) {
  if (auto outcome = not_converged(solved, scene.scene.solver.tolerance)) return *outcome;
  long touching = 0;
  for (const TermReport& term : solved.result.terms)
    if (term.type == "contact_barrier") touching = term.counters.elements;
  if (must_touch && touching == 0)
    return outcome_of(solved, StressVerdict::Fail, "nothing touches in the solution");
  StressOutcome outcome =
      measured(solved, static_cast<double>(solved.intersections), 0, "facets pass through each other");
  outcome.message += "; " + std::to_string(touching) + " pairs touch, " + std::to_string(solved.judged) +
                     " states were judged";
  return outcome;
}

BuiltRow contact_row(const char* id, const std::string& name, bool is_quick, BuiltScene scene,
                     bool must_touch = true) {
  return {id,
          name,
          kIntersections,
          "",
          is_quick,
          std::move(scene),
          [must_touch](const StressScene& built, const Stressed& solved) {
            return nothing_through(built, solved, must_touch);
          },
          true};
}

TriangleMesh floor_at(double z) { return moved(square(3, 2), {-1, -1, z}); }

// Of the repulsion of facets that a load can overcome: what goes through must be counted, and said
// beforehand.
BuiltRow facet_row() {
  constexpr double kRange = 0.05, kPressure = 0.02, kPart = 0.1;
  constexpr int kExponent = 3;
  const double strength = contact_facet_strength(kPressure, kRange, kExponent, kPart);
  return {"S14",
          "facet repulsion under ten times what it carries",
          "intersections not warned of",
          "",
          true,
          pressed_scene(
              "S14_facet", 128, 0.03, moved(square(1.4, 98), {-0.2, -0.2, 0}), kPressure,
              filled(R"({ "type": "contact_facet", "range": "$RANGE mm", "strength": "$STRENGTH N/mm^3" })",
                     {{"RANGE", kRange}, {"STRENGTH", strength}})),
          [](const StressScene& scene, const Stressed& solved) {
            if (auto wrong = untruth(solved, scene.scene.solver.tolerance)) return *wrong;
            const bool is_said = !solved.model.warnings.empty();
            StressOutcome outcome = measured(solved, is_said ? 0 : static_cast<double>(solved.intersections),
                                             0, "facets pass through each other, and nobody was warned");
            outcome.message += "; " + std::to_string(solved.intersections) + " pairs of facets intersect";
            return outcome;
          }};
}

}  // namespace

std::vector<BuiltRow> degenerate_rows() {
  const double height = 0.05, gap = 0.02, pressure = 0.1;
  const auto row = [&](const std::string& name, const char* folder, bool is_quick,
                       const TriangleMesh& obstacle) {
    return contact_row("S13", name, is_quick,
                       pressed_scene(folder, 200, height, obstacle, pressure, barrier(gap)));
  };
  TriangleMesh spikes = spike({0.52, 0.47, 0}, 0.5, 0.05), wall = square(1, 2), needles;
  for (const double x : {0.23, 0.81}) spikes = joined(spikes, spike({x, 0.33, -0.01}, 0.5, 0.03));
  wall.vertices.row(0) *= 0.5;
  TriangleMesh top = wall;
  wall.vertices.row(2) = 2 * wall.vertices.row(0).array() - 1;
  wall.vertices.row(0).setConstant(0.5);
  for (const double x : {0.21, 0.42, 0.58, 0.79})
    for (const double y : {0.22, 0.5, 0.77})
      needles = joined(needles, spike({x, y, 0.04 * std::sin(9 * x * y)}, 0.8, 0.01));
  return {row("three spikes", "S13_spikes", false, spikes),
          row("a spike under a vertex", "S13_vertex", true, spike({0.5, 0.5, 0.01}, 0.5, 0.1)),
          row("two ridges along edges of the mesh", "S13_ridges", false,
              joined(ridge({0.1, 0.5, 0}, {0.9, 0.5, 0}, 0.4, 0.1),
                     ridge({0.3, 0.1, 0}, {0.3, 0.9, 0}, 0.4, 0.1))),
          row("the edge of a cliff", "S13_cliff", false, joined(top, wall)),
          row("the same mesh below, edge on edge", "S13_edges", false, square(1, 200)),
          contact_row("S26", "cloth over twelve needles", false,
                      pressed_scene("S26_needles", 450, height, needles, 0.3, barrier(0.01)))};
}

std::vector<BuiltRow> tunnelling_rows() {
  const double carried = contact_facet_capacity(contact_facet_strength(0.01, 0.05, 3, 1), 0.05, 3);
  std::vector<BuiltRow> rows;
  for (const double share : {0.5, 0.9, 1.1, 10.0})
    rows.push_back(contact_row(
        "S14", "barrier, " + short_number(share) + " of what a facet repulsion carries", share == 10,
        pressed_scene("S14_" + short_number(share), 128, 0.03, moved(square(1.4, 98), {-0.2, -0.2, 0}),
                      share * carried, barrier(0.02))));
  rows.push_back(contact_row("S14", "a first step far through the floor", false,
                             pressed_scene("S14_step", 128, 0.5, floor_at(0.2), 5, barrier(0.02))));
  rows.push_back(facet_row());
  rows.push_back(contact_row("S25", "a contact range of 1e-9 edges", false,
                             pressed_scene("S25_range", 128, 0.5, floor_at(0), 0.01, barrier(1e-10)), false));
  return rows;
}

}  // namespace coapt
