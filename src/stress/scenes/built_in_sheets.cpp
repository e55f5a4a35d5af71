// S6, S8, S9, S11: sheets of slivers, with nothing to do, on a saddle, and on the border of taut and
// wrinkled.
#include "core/number_text.hpp"
#include "mesh/shapes.hpp"
#include "stress/scenes/built_in.hpp"

#include <cmath>

namespace coapt {
namespace {

constexpr double kSide = 100;  // [mm]

// A square flattened to the aspect, its rim moved by an affine map that the inside must follow.
BuiltRow patch_row(double aspect) {
  Eigen::Matrix3d map = Eigen::Matrix3d::Identity();
  map.topLeftCorner<2, 2>() << 1.2, 0.1, 0.05, 1.1;
  TriangleMesh mesh = square(kSide, 72);
  mesh.vertices.row(1) /= aspect;
  const Points exact = map * mesh.vertices;
  constexpr double kLimit = 1e-6;
  return {"S6",
          "patch test, slivers of aspect " + number_text(aspect),
          "error over the width",
          "",
          aspect == 1e4,
          {.name = "S6_patch_" + number_text(aspect),
           .text = R"({ // The rim of a plane sheet of slivers is moved by an affine map. Lengths in mm.
  "mesh": { "file": "mesh.obj" },
  "boundary": [{ "nodes": "boundary", "move_to": "rim.csv" }],
  "terms": [{ "type": "cst_tension_field", "young": "1 MPa", "poisson": 0.3, "thickness": "1 mm" }],
  "solver": { "type": "newton", "tolerance": 1e-8, "max_iterations": 500 }
}
)",
           .mesh = mesh,
           .points = {{"rim", boundary_points(exact, mesh.triangles)}}},
          [exact](const StressScene& scene, const StressRun& solved) {
            const Points x = solved.x.colwise() + solved.model.origin;
            return converged_and(solved, scene, (x - exact).cwiseAbs().maxCoeff() / kSide, kLimit,
                                 "the inside does not follow the rim");
          }};
}

// boundary, load: JSON, the latter with its comma.
BuiltRow idle_row(const std::string& name, const std::string& folder, const std::string& boundary,
                  const std::string& load) {
  return {"S8",
          name,
          "iterations",
          "",
          true,
          {.name = folder,
           .text = R"({ // Nothing is to be done. Lengths in mm.
  "mesh": { "file": "mesh.obj" },
  "boundary": [)" + boundary +
                   R"(],
  "terms": [{ "type": "cst_tension_field", "young": "1 MPa", "poisson": 0.3, "thickness": "1 mm" })" +
                   load + R"(],
  "solver": { "type": "newton", "tolerance": 1e-8 }
}
)",
           .mesh = square(kSide, 200)},
          [](const StressScene& scene, const StressRun& solved) {
            return converged_and(solved, scene, solved.result.iterations, 0,
                                 "looked for what was there already");
          }};
}

// A strip pushed together along itself stays flat, and in equilibrium, unless somebody looks.
BuiltRow saddle_row() {
  constexpr double kPush = 5;  // [mm]
  return {"S9",
          "a strip pushed together, exactly flat",
          "negative eigenvalues that are not told",
          "",
          true,
          {.name = "S9_saddle",
           .text = filled(R"({ // A strip pushed together along itself, exactly flat. Lengths in mm.
  "mesh": { "file": "mesh.obj" },
  "boundary": [
    { "nodes": "all", "fix": ["y"] },
    { "nodes": { "plane": { "axis": "x" } }, "fix": true },
    { "nodes": { "plane": { "axis": "x", "at": "$SIDE mm" } }, "move_to": { "translate": [-$PUSH, 0, 0] } }
  ],
  "terms": [
    { "type": "cst_stvk", "young": "1 MPa", "poisson": 0, "thickness": "1 mm" },
    { "type": "bending", "stiffness": "1 mJ" }
  ],
  "solver": { "type": "newton", "tolerance": 1e-8, "max_iterations": 2000 }
}
)",
                          {{"SIDE", kSide}, {"PUSH", kPush}}),
           .mesh = rectangle(kSide, 10, 128)},
          [](const StressScene& scene, const StressRun& solved) {
            if (auto outcome = not_converged(solved, scene.scene.solver.tolerance)) return *outcome;
            const Stability verdict = solved.result.certificate.stability.verdict;
            const bool is_told = solved.result.message.find("saddle") != std::string::npos;
            const bool is_flat = solved.x.row(2).cwiseAbs().maxCoeff() == 0;
            const bool is_silent =
                !is_told && (verdict == Stability::NotKnown || verdict == Stability::Saddle || is_flat);
            return measured(solved, is_silent ? 1 : 0, 0, "ends on a saddle and does not say so");
          }};
}

// Pulled along x with free sides: uniaxial tension everywhere, which is where taut ends and wrinkled begins.
// The exact width of St. Venant-Kirchhoff at the stretch 1.1: l2^2 = 1 - nu (l1^2 - 1).
BuiltRow border_row() {
  constexpr double kStretch = 1.1, kPoisson = 0.3, kLimit = 1e-8;
  const double exact = std::sqrt(1 - kPoisson * (kStretch * kStretch - 1));
  return {"S11",
          "a sheet exactly between taut and wrinkled",
          "error of its width",
          "",
          true,
          {.name = "S11_border",
           .text = filled(
               R"({ // A sheet pulled lengthwise, its sides free: between taut and wrinkled. Lengths in mm.
  "mesh": { "file": "mesh.obj" },
  "boundary": [
    { "nodes": "all", "fix": ["z"] },
    { "nodes": { "plane": { "axis": "x" } }, "fix": ["x", "z"] },
    { "nodes": { "plane": { "axis": "x", "at": "$SIDE mm" } }, "fix": ["x", "z"],
      "move_to": { "translate": [$PULL, 0, 0] } },
    { "nodes": { "nearest": [0, 0, 0] }, "fix": true }
  ],
  "terms": [{ "type": "cst_tension_field", "young": "1 MPa", "poisson": $POISSON, "thickness": "1 mm" }],
  "solver": { "type": "newton", "tolerance": 1e-10, "max_iterations": 500 }
}
)",
               {{"SIDE", kSide}, {"PULL", (kStretch - 1) * kSide}, {"POISSON", kPoisson}}),
           .mesh = square(kSide, 200)},
          [exact](const StressScene& scene, const StressRun& solved) {
            const double width = solved.x.row(1).maxCoeff() - solved.x.row(1).minCoeff();
            return converged_and(solved, scene, std::abs(width / kSide / exact - 1), kLimit,
                                 "the width is wrong");
          }};
}

}  // namespace

std::vector<BuiltRow> sheet_rows() {
  const std::string pressure = R"(, { "type": "load_pressure", "value": "1 kPa" })";
  return {patch_row(1e2),
          patch_row(1e4),
          patch_row(1e6),
          idle_row("every node held", "S8_held", R"({ "nodes": "all", "fix": true })", pressure),
          idle_row("no load", "S8_unloaded", R"({ "nodes": "boundary", "fix": true })", ""),
          saddle_row(),
          border_row()};
}

}  // namespace coapt
