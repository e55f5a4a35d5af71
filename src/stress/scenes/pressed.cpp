#include "stress/scenes/pressed.hpp"

#include "mesh/shapes.hpp"
#include "scene/terms/term_types.hpp"

namespace coapt {
namespace {

// Held, and nothing ever through anything. A barrier that is not reached proves nothing.
StressOutcome nothing_through(const StressScene& scene, const StressRun& solved, bool must_touch) {
  if (auto outcome = not_converged(solved, scene.scene.solver.tolerance)) return *outcome;
  long touching = 0;
  for (const TermReport& term : solved.result.terms)
    if (const TermType* type = find_term_type(term.type); type != nullptr && type->is_barrier)
      touching = term.counters.elements;
  if (must_touch && touching == 0)
    return outcome_of(solved, StressVerdict::Fail, "nothing touches in the solution");
  StressOutcome outcome =
      measured(solved, static_cast<double>(solved.intersections), 0, "facets pass through each other");
  outcome.message += "; " + std::to_string(touching) + " pairs touch, " + std::to_string(solved.judged) +
                     " states were judged";
  return outcome;
}

}  // namespace

TriangleMesh both_meshes(const TriangleMesh& a, const TriangleMesh& b) {
  TriangleMesh both;
  both.vertices.resize(3, a.vertex_count() + b.vertex_count());
  both.vertices << a.vertices, b.vertices;
  both.triangles.resize(3, a.triangle_count() + b.triangle_count());
  both.triangles << a.triangles, (b.triangles.array() + a.vertex_count()).matrix();
  return both;
}

TriangleMesh shifted_mesh(TriangleMesh mesh, const Vec3& by) {
  mesh.vertices.colwise() += by;
  return mesh;
}

TriangleMesh spike_mesh(const Vec3& apex, double height, double half_width) {
  TriangleMesh mesh;
  mesh.vertices.resize(3, 5);
  mesh.vertices.colwise() = apex;
  mesh.vertices.rightCols(4).colwise() -= Vec3(0, 0, height);
  mesh.vertices.block<2, 4>(0, 1) += half_width * Eigen::Matrix<double, 2, 4>{{-1, 1, 1, -1}, {-1, -1, 1, 1}};
  mesh.triangles.resize(3, 4);
  mesh.triangles << 0, 0, 0, 0, 1, 2, 3, 4, 2, 3, 4, 1;
  return mesh;
}

TriangleMesh ridge_mesh(const Vec3& from, const Vec3& to, double height, double half_width) {
  const Vec3 side = (to - from).cross(Vec3::UnitZ()).normalized() * half_width, down(0, 0, -height);
  TriangleMesh mesh;
  mesh.vertices.resize(3, 6);
  mesh.vertices << from, to, from + side + down, to + side + down, from - side + down, to - side + down;
  mesh.triangles.resize(3, 4);
  mesh.triangles << 0, 0, 0, 0, 2, 3, 1, 5, 3, 1, 5, 4;
  return mesh;
}

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
          .mesh = shifted_mesh(square(1, triangles), {0, 0, height}),
          .others = {{"obstacle", obstacle}}};
}

std::string barrier_term(double gap) {
  return filled(R"({ "type": "contact_barrier", "gap": "$GAP mm" })", {{"GAP", gap}});
}

BuiltRow contact_row(const char* id, const std::string& name, bool is_quick, BuiltScene scene,
                     bool must_touch) {
  return {id,
          name,
          "most pairs of facets through each other at any state",
          "",
          is_quick,
          std::move(scene),
          [must_touch](const StressScene& built, const StressRun& solved) {
            return nothing_through(built, solved, must_touch);
          },
          true};
}

}  // namespace coapt
