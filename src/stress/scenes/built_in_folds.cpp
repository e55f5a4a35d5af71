// S13 and S26: sheets with holes and cracks, folded, twisted, and drawn through a funnel.
#include "mesh/shapes.hpp"
#include "stress/scenes/pressed.hpp"

#include <Eigen/Geometry>

#include <cmath>
#include <numbers>

namespace coapt {
namespace {

// How one of these scenes differs from the next. Lengths in mm.
struct Draped {
  std::string name;
  TriangleMesh sheet;
  std::string held;            // entries of `boundary`
  TriangleMesh obstacle = {};  // without triangles: none
  double weight = 1e-3;        // on the sheet, downwards [MPa]
  double bending = 1e-5;       // [mJ]
  double gap = 0.02;
  std::map<std::string, Points> stations = {};
};

BuiltScene draped_scene(const Draped& draped) {
  BuiltScene scene;
  scene.name = draped.name;
  scene.mesh = draped.sheet;
  scene.points = draped.stations;
  scene.text = "{ // A sheet, and what it meets. Lengths in mm.\n  \"mesh\": { \"file\": \"mesh.obj\" },\n";
  if (draped.obstacle.triangle_count() > 0) {
    scene.others = {{"obstacle", draped.obstacle}};
    scene.text += "  \"obstacles\": [{ \"name\": \"obstacle\", \"file\": \"obstacle.obj\" }],\n";
  }
  scene.text += "  \"boundary\": [" + draped.held + "],\n" +
                filled(R"(  "terms": [
    { "type": "cst_tension_field", "young": "1 MPa", "poisson": 0.3, "thickness": "1 mm" },
    { "type": "bending", "stiffness": "$BENDING mJ" },
    { "type": "load_field", "direction": [0, 0, -1], "pressure": "$WEIGHT MPa" },
    { "type": "contact_barrier", "gap": "$GAP mm" }
  ],
  "solver": { "type": "newton", "tolerance": 1e-6, "max_iterations": 3000 }
}
)",
                       {{"BENDING", draped.bending}, {"WEIGHT", draped.weight}, {"GAP", draped.gap}});
  return scene;
}

// What is left of a mesh where the middle of a triangle is kept, with the vertices of that alone.
template <class Kept>
TriangleMesh part_of(const TriangleMesh& mesh, const Kept& is_kept) {
  std::vector<int> triangles, number(static_cast<size_t>(mesh.vertex_count()), -1), vertices;
  for (int t = 0; t < mesh.triangle_count(); ++t)
    if (is_kept(Vec3(mesh.vertices(Eigen::all, mesh.triangles.col(t)).rowwise().mean())))
      triangles.push_back(t);
  TriangleMesh part;
  part.triangles = mesh.triangles(Eigen::all, triangles);
  for (int& corner : part.triangles.reshaped()) {
    int& known = number[static_cast<size_t>(corner)];
    if (known < 0) {
      known = static_cast<int>(vertices.size());
      vertices.push_back(corner);
    }
    corner = known;
  }
  part.vertices = mesh.vertices(Eigen::all, vertices);
  return part;
}

const char* const kSides = R"(
    { "nodes": { "plane": { "axis": "x" } }, "fix": true },
    { "nodes": { "plane": { "axis": "x", "at": "1 mm" } }, "fix": true },
    { "nodes": { "plane": { "axis": "y" } }, "fix": true },
    { "nodes": { "plane": { "axis": "y", "at": "1 mm" } }, "fix": true })";

// As the sheet falls the hole becomes too tight for the spike in it.
BuiltRow hole_row() {
  const TriangleMesh sheet = part_of(square(1, 242), [](const Vec3& middle) {
    return (middle - Vec3(0.5, 0.5, 0)).lpNorm<Eigen::Infinity>() > 0.05;
  });
  return contact_row("S13", "a spike in a hole", false,
                     draped_scene({.name = "S13_hole",
                                   .sheet = shifted_mesh(sheet, {0, 0, 0.05}),
                                   .held = kSides,
                                   .obstacle = spike_mesh({0.505, 0.493, 0.3}, 0.6, 0.09),
                                   .weight = 0.2}));
}

// Two sheets side by side leave a crack; a blade stands in it that is wider below than the crack.
BuiltRow crack_row() {
  const TriangleMesh half = rectangle(0.49, 1, 144);
  return contact_row(
      "S13", "a spike in a crack", false,
      draped_scene({.name = "S13_crack",
                    .sheet = shifted_mesh(both_meshes(half, shifted_mesh(half, {0.51, 0, 0})), {0, 0, 0.05}),
                    .held = kSides,
                    .obstacle = spike_mesh({0.5, 0.5, 0.065}, 0.25, 0.12),
                    .weight = 0.2,
                    .gap = 0.008}));
}

constexpr double kFoldedLength = 2;  // of the sheets that are folded and twisted [mm]

// Where the end at x = 2 mm is at each of `count` stations: turned by so much about `axis` through `centre`,
// and shifted by so much.
std::map<std::string, Points> turning_end(const TriangleMesh& sheet, int count, double angle,
                                          const Vec3& axis, const Vec3& centre, const Vec3& shift) {
  std::vector<int> end;
  for (int v = 0; v < sheet.vertex_count(); ++v)
    if (sheet.vertices(0, v) > kFoldedLength - 1e-9) end.push_back(v);
  std::map<std::string, Points> stations;
  for (int k = 1; k <= count; ++k) {
    const double t = static_cast<double>(k) / count;
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(t * angle, axis).toRotationMatrix();
    Points x = sheet.vertices(Eigen::all, end);
    x.colwise() -= centre;
    x = turn * x;
    x.colwise() += centre + t * shift;
    stations["station" + std::to_string(100 + k)] = x;
  }
  return stations;
}

std::string held_and_turned(const std::map<std::string, Points>& stations) {
  std::string path;
  for (const auto& [name, points] : stations) path += (path.empty() ? "\"" : ", \"") + name + ".csv\"";
  return R"(
    { "nodes": { "plane": { "axis": "x" } }, "fix": true },
    { "nodes": { "plane": { "axis": "x", "at": "2 mm" } }, "move_to": [)" +
         path + "] }";
}

// One end goes up and over the other in a half circle and comes down on it.
BuiltRow fold_row() {
  const TriangleMesh sheet = rectangle(kFoldedLength, 0.5, 288);
  const auto stations =
      turning_end(sheet, 16, -std::numbers::pi, Vec3::UnitY(), {kFoldedLength / 2, 0, 0}, {0, 0, 0.05});
  return contact_row("S13", "a sheet folded onto itself", false,
                     draped_scene({.name = "S13_fold",
                                   .sheet = sheet,
                                   .held = held_and_turned(stations),
                                   .obstacle = shifted_mesh(square(4, 2), {-1, -1, -0.05}),
                                   .weight = 0.01,
                                   .bending = 1e-4,
                                   .stations = stations}));
}

// One end turns one and a half times and comes nearer: the mat sags and wraps around itself.
BuiltRow mat_row() {
  const TriangleMesh mat = rectangle(kFoldedLength, 1, 576);
  const auto stations = turning_end(mat, 36, 3 * std::numbers::pi, Vec3::UnitX(), {0, 0.5, 0}, {-0.5, 0, 0});
  return contact_row(
      "S26", "a mat twisted one and a half times", false,
      draped_scene(
          {.name = "S26_mat", .sheet = mat, .held = held_and_turned(stations), .stations = stations}));
}

// A cone with its narrow end below.
TriangleMesh funnel(double top_radius, double bottom_radius, double height, int around) {
  TriangleMesh mesh;
  mesh.vertices.resize(3, 2 * around);
  mesh.triangles.resize(3, 2 * around);
  for (int k = 0; k < around; ++k) {
    const double angle = 2 * std::numbers::pi * k / around;
    const Vec3 out(std::cos(angle), std::sin(angle), 0);
    const int next = (k + 1) % around;
    mesh.vertices.col(k) = top_radius * out;
    mesh.vertices.col(around + k) = bottom_radius * out - height * Vec3::UnitZ();
    mesh.triangles.col(2 * k) << k, around + k, next;
    mesh.triangles.col(2 * k + 1) << next, around + k, around + next;
  }
  return mesh;
}

// The middle of a round cloth goes down through the narrow end.
BuiltRow funnel_row() {
  return contact_row("S26", "a cloth drawn through a funnel", false,
                     draped_scene({.name = "S26_funnel",
                                   .sheet = shifted_mesh(disc(1, 600), {0, 0, 0.3}),
                                   .held = R"(
    { "nodes": { "nearest": [0, 0, 0.3] }, "move_to": [
      { "translate": [0, 0, -0.3] }, { "translate": [0, 0, -0.6] }, { "translate": [0, 0, -0.9] },
      { "translate": [0, 0, -1.2] }, { "translate": [0, 0, -1.5] }] })",
                                   .obstacle = funnel(1.3, 0.35, 0.6, 24),
                                   .bending = 1e-4}));
}

}  // namespace

std::vector<BuiltRow> folded_rows() { return {hole_row(), crack_row(), fold_row(), mat_row(), funnel_row()}; }

}  // namespace coapt
