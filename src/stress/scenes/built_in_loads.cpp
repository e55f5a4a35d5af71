// S3 and S25: a clamped disc, inflated from flat, under loads and with numbers far from the usual.
#include "core/number_text.hpp"
#include "mesh/shapes.hpp"
#include "stress/scenes/built_in.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace coapt {
namespace {

constexpr double kRadius = 10;  // [mm]

BuiltScene disc_scene(const std::string& name, int triangles, double young, double thickness, double pressure,
                      double tolerance) {
  return {.name = name,
          .text = filled(
              R"({ // A clamped disc, inflated from flat. Lengths in mm.
  "mesh": { "file": "mesh.obj" },
  "boundary": [{ "nodes": "boundary", "fix": true }],
  "terms": [
    { "type": "cst_tension_field", "young": "$YOUNG MPa", "poisson": 0.3, "thickness": "$THICKNESS mm" },
    { "type": "load_pressure", "value": "$PRESSURE MPa" }
  ],
  "solver": { "type": "newton", "tolerance": $TOLERANCE, "max_iterations": 1000 }
}
)",
              {{"YOUNG", young}, {"THICKNESS", thickness}, {"PRESSURE", pressure}, {"TOLERANCE", tolerance}}),
          .mesh = disc(kRadius, triangles)};
}

double rise(const StressRun& solved) { return solved.x.row(2).maxCoeff(); }

// q = p a / (E h), and the deflection of the centre over the radius: Hencky's asymptote for small q (1915, as
// corrected by Campbell 1956), beyond it the axisymmetric equations of exact geometry, solved by shooting.
struct Load {
  double q, exact;
};

BuiltRow disc_row(const Load& load) {
  constexpr double kLimit = 1e-3, kYoung = 1, kThickness = 0.1;
  const double pressure = load.q * kYoung * kThickness / kRadius;
  return {"S3",
          "p a/(E h) = " + number_text(load.q),
          "error of the centre's deflection",
          "",
          load.q == 1e-6,
          disc_scene("S3_disc_" + number_text(load.q), 1500, kYoung, kThickness, pressure, 1e-6),
          [load](const StressScene& scene, const StressRun& solved) {
            return converged_and(solved, scene, std::abs(rise(solved) / kRadius / load.exact - 1), kLimit,
                                 "the deflection is wrong");
          }};
}

// Thinner than an atom: far beyond its rest size the linear law's bubble is as wide as p a / (E h) times a
// number of the order of one says.
BuiltRow bubble_row() {
  constexpr double kQ = 1e6;
  return {"S25",
          "a sheet of 1e-9 mm",
          "q over the rise of the bubble in radii",
          "",
          true,
          disc_scene("S25_thin", 250, 1, 1e-9, kQ * 1e-9 / kRadius, 1e-8),
          [](const StressScene& scene, const StressRun& solved) {
            return converged_and(solved, scene, kQ * kRadius / rise(solved), 10, "the bubble is too small");
          }};
}

// Stiff beyond measure: deflections far below the rounding of the radius.
BuiltRow stiff_row() {
  const double q = 1e-15 * kRadius / 1e15;
  return {"S25",
          "1e15 MPa under 1e-15 MPa",
          "rise over the radius times the root of q",
          "",
          true,
          disc_scene("S25_stiff", 250, 1e15, 1, 1e-15, 1e-8),
          [q](const StressScene& scene, const StressRun& solved) {
            if (auto outcome = not_converged(solved, scene.scene.solver.tolerance)) return *outcome;
            return measured(solved, std::abs(rise(solved)) / (kRadius * std::cbrt(q)), 1,
                            "moves farther than it can");
          }};
}

}  // namespace

std::vector<BuiltRow> load_rows() {
  constexpr double kHencky = 0.653443345;  // of the cube root of q
  std::vector<BuiltRow> rows;
  for (const double q : {1e-9, 1e-6}) rows.push_back(disc_row({q, kHencky * std::cbrt(q)}));
  for (const Load& load :
       {Load{1e-3, 0.0654043749}, Load{1e-2, 0.14138457}, Load{1e-1, 0.309515382}, Load{1, 0.720924752}})
    rows.push_back(disc_row(load));
  rows.push_back(bubble_row());
  rows.push_back(stiff_row());
  return rows;
}

}  // namespace coapt
