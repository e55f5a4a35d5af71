// S10 and S12: where there is no equilibrium, and where the path to one leads past a limit point.
#include "mesh/shapes.hpp"
#include "stress/scenes/pressed.hpp"

#include <cmath>
#include <numbers>

namespace coapt {
namespace {

constexpr double kMostIterations = 1000;

// Whatever has no equilibrium must be named so, in time.
StressOutcome named_as_no_equilibrium(const StressScene& scene, const StressRun& solved) {
  if (auto wrong = untruth(solved, scene.scene.solver.tolerance)) return *wrong;
  if (solved.result.status == Status::Converged)
    return outcome_of(solved, StressVerdict::Fail, "found an equilibrium where there is none");
  if (solved.result.status != Status::NoEquilibrium)
    return outcome_of(solved, StressVerdict::Stall, solved.result.message);
  return measured(solved, solved.result.iterations, kMostIterations, "takes too long to see it");
}

BuiltRow no_equilibrium_row(const std::string& name, bool is_quick, BuiltScene scene) {
  return {"S10", name, "iterations", "", is_quick, std::move(scene), named_as_no_equilibrium};
}

constexpr double kModulus = 0.1, kThickness = 0.1, kRadius = 10;  // of the balloon [MPa, mm, mm]

// p R/(mu h) of a neo-Hookean balloon at stretch l, incompressible: 2 (1/l - 1/l^7); greatest at l = 7^(1/6).
double balloon_pressure(double stretch) {
  return kModulus * kThickness / kRadius * 2 * (1 / stretch - std::pow(stretch, -7));
}
double greatest_pressure() { return balloon_pressure(std::pow(7, 1.0 / 6)); }

BuiltScene balloon_scene(const std::string& name, double pressure) {
  return {
      .name = name,
      .text = filled(
          R"({ // A neo-Hookean balloon. Lengths in mm.
  "mesh": { "file": "mesh.obj" },
  "boundary": [{ "nodes": { "nearest": [0, 0, -$RADIUS] }, "fix": true }],
  "terms": [
    { "type": "cst_neo_hookean", "shear_modulus": "$MODULUS MPa", "thickness": "$THICKNESS mm" },
    { "type": "load_pressure", "value": "$PRESSURE MPa", "model": "volume" }
  ],
  "solver": { "type": "newton", "tolerance": 1e-8, "max_iterations": 2000 }
}
)",
          {{"RADIUS", kRadius}, {"MODULUS", kModulus}, {"THICKNESS", kThickness}, {"PRESSURE", pressure}}),
      .mesh = sphere(kRadius, 1280)};
}

// Just below the greatest pressure there is an equilibrium; its stretch is that of the facets, so the radius
// is off by the mesh.
BuiltRow balloon_row() {
  constexpr double kStretch = 1.25, kLimit = 0.01;
  return {"S10",
          "neo-Hookean balloon below its greatest pressure",
          "error of its width",
          "",
          false,
          balloon_scene("S10_balloon", balloon_pressure(kStretch)),
          [](const StressScene& scene, const StressRun& solved) {
            const double width = solved.x.row(0).maxCoeff() - solved.x.row(0).minCoeff();
            const Points& rest = scene.geometry.model.X;
            const double before = rest.row(0).maxCoeff() - rest.row(0).minCoeff();
            return converged_and(solved, scene, std::abs(width / before / kStretch - 1), kLimit,
                                 "the balloon has another size");
          }};
}

// Two rings of radius 10 mm and a cylinder between them.
TriangleMesh cylinder(double height, int around, int rows) {
  TriangleMesh mesh;
  mesh.vertices.resize(3, around * (rows + 1));
  mesh.triangles.resize(3, 2 * around * rows);
  int t = 0;
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i < around; ++i) {
      const double angle = 2 * std::numbers::pi * i / around;
      const int a = i + around * j, b = (i + 1) % around + around * j;
      mesh.vertices.col(a) = Vec3(10 * std::cos(angle), 10 * std::sin(angle), height * j / rows);
      if (j == rows) continue;
      mesh.triangles.col(t++) << a, b, b + around;
      mesh.triangles.col(t++) << a, b + around, a + around;
    }
  return mesh;
}

// Beyond 13.25 mm no film spans two rings of 10 mm (the root of the catenoid's equation).
BuiltScene rings_scene() {
  return {.name = "S10_rings",
          .text = R"({ // A soap film between two rings that are too far apart. Lengths in mm.
  "mesh": { "file": "mesh.obj" },
  "boundary": [{ "nodes": "boundary", "fix": true }],
  "terms": [{ "type": "surface_tension", "tension": "1 N/m" }],
  "solver": { "type": "newton", "tolerance": 1e-8, "max_iterations": 2000 }
}
)",
          .mesh = cylinder(14, 24, 12)};
}

BuiltScene loose_scene(const std::string& name, const std::string& load) {
  return {.name = name,
          .text = R"({ // A sheet that nothing holds. Lengths in mm.
  "mesh": { "file": "mesh.obj" },
  "terms": [
    { "type": "cst_tension_field", "young": "1 MPa", "poisson": 0.3, "thickness": "0.1 mm" },
    )" + load + R"(
  ],
  "solver": { "type": "newton", "tolerance": 1e-8, "max_iterations": 2000 }
}
)",
          .mesh = disc(10, 200)};
}

// Two sheets, of which only the one at the left is held; no node of the other one is near a held one.
BuiltScene half_loose_scene() {
  const TriangleMesh held = rectangle(10, 10, 100);
  return {.name = "S10_component",
          .text = R"({ // Of two sheets one is held, the other lies beside it. Lengths in mm.
  "mesh": { "file": "mesh.obj" },
  "boundary": [{ "nodes": { "plane": { "axis": "x" } }, "fix": true }, { "nodes": { "plane": { "axis": "x", "at": "10 mm" } }, "fix": true }],
  "terms": [
    { "type": "cst_tension_field", "young": "1 MPa", "poisson": 0.3, "thickness": "0.1 mm" },
    { "type": "load_field", "direction": [0, 0, -1], "pressure": "1 kPa" }
  ],
  "solver": { "type": "newton", "tolerance": 1e-8, "max_iterations": 2000 }
}
)",
          .mesh = both_meshes(held, shifted_mesh(held, {20, 0, 0}))};
}

// A shallow hinged arch, z = b sin(pi x/L), under the load q sin(pi x/L). In the theory of shallow arches it
// stays a sine of height a with q = (pi/L)^4 (D (b - a) + E h a (b^2 - a^2)/4), which is greatest at
// a = sqrt((b^2 - 4 D/(E h))/3). Beyond that load the arch snaps through to the other side.
BuiltRow arch_row() {
  constexpr double kSpan = 100, kRise = 3.5, kBending = 0.7, kOverload = 1.5;  // [mm, mm, mJ]; E h = 1 N/mm
  TriangleMesh mesh = rectangle(kSpan, 6.25, 128);
  const Vector areas = nodal_areas(mesh.vertices, mesh.triangles);
  const double at_limit = std::sqrt((kRise * kRise - 4 * kBending) / 3),
               load =
                   kOverload * std::pow(std::numbers::pi / kSpan, 4) *
                   (kBending * (kRise - at_limit) + 0.25 * at_limit * (kRise * kRise - at_limit * at_limit));
  Points forces = Points::Zero(3, mesh.vertex_count());
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    const double wave = std::sin(std::numbers::pi * mesh.vertices(0, v) / kSpan);
    forces(2, v) = -load * areas[v] * wave;
    mesh.vertices(2, v) = kRise * wave;
  }
  return {
      "S12",
      "a shallow arch under more than it carries, in 24 steps",
      "snaps that are not told",
      "",
      true,
      {.name = "S12_arch",
       .text = filled(R"({ // A shallow arch that snaps through on its way to the full load. Lengths in mm.
  "mesh": { "file": "mesh.obj" },
  "boundary": [
    { "nodes": "all", "fix": ["y"] },
    { "nodes": { "plane": { "axis": "x" } }, "fix": true },
    { "nodes": { "plane": { "axis": "x", "at": "$SPAN mm" } }, "fix": true }
  ],
  "terms": [
    { "type": "cst_stvk", "young": "1 MPa", "poisson": 0, "thickness": "1 mm" },
    { "type": "bending", "stiffness": "$BENDING mJ" },
    { "type": "load_field", "forces": "load.csv" }
  ],
  "solver": { "type": "newton", "tolerance": 1e-8, "max_iterations": 2000, "continuation": { "load_steps": 24 } }
}
)",
                      {{"SPAN", kSpan}, {"BENDING", kBending}}),
       .mesh = mesh,
       .points = {{"load", forces}}},
      [](const StressScene& scene, const StressRun& solved) {
        if (auto outcome = not_converged(solved, scene.scene.solver.tolerance)) return *outcome;
        const bool has_snapped = solved.x.row(2).mean() + solved.model.origin[2] < 0,
                   is_told = !solved.result.branch_changes.empty();
        return measured(solved, has_snapped != is_told || !has_snapped ? 1 : 0, 0,
                        has_snapped ? "snapped through and does not say so" : "stands where it cannot stand");
      }};
}

}  // namespace

std::vector<BuiltRow> no_equilibrium_rows() {
  return {balloon_row(),
          no_equilibrium_row("neo-Hookean balloon, 1.1 times its greatest pressure", true,
                             balloon_scene("S10_burst", 1.1 * greatest_pressure())),
          no_equilibrium_row("soap film between rings too far apart", false, rings_scene()),
          no_equilibrium_row(
              "sheet that nothing holds, under its weight", true,
              loose_scene("S10_weight",
                          R"({ "type": "load_field", "direction": [0, 0, -1], "pressure": "1 kPa" })")),
          no_equilibrium_row("sheet that nothing holds, under pressure", false,
                             loose_scene("S10_pressure", R"({ "type": "load_pressure", "value": "1 kPa" })")),
          no_equilibrium_row("of two sheets one that nothing holds, under their weight", true,
                             half_loose_scene()),
          arch_row()};
}

}  // namespace coapt
