// S13, S14, S25, S26: sheets pressed on obstacles that are as awkward as can be. Judged at every accepted
// state by exact predicates that share nothing with the barrier.
#include "core/error.hpp"
#include "core/number_text.hpp"
#include "energy/contact_facet.hpp"
#include "mesh/shapes.hpp"
#include "stress/scenes/pressed.hpp"

#include <cmath>

namespace coapt {
namespace {

TriangleMesh floor_at(double z) { return shifted_mesh(square(3, 2), {-1, -1, z}); }

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
              "S14_facet", 128, 0.03, shifted_mesh(square(1.4, 98), {-0.2, -0.2, 0}), kPressure,
              filled(R"({ "type": "contact_facet", "range": "$RANGE mm", "strength": "$STRENGTH N/mm^3" })",
                     {{"RANGE", kRange}, {"STRENGTH", strength}})),
          [](const StressScene& scene, const StressRun& solved) {
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
                       pressed_scene(folder, 200, height, obstacle, pressure, barrier_term(gap)));
  };
  TriangleMesh spikes = spike_mesh({0.52, 0.47, 0}, 0.5, 0.05), wall = square(1, 2), needles;
  for (const double x : {0.23, 0.81}) spikes = both_meshes(spikes, spike_mesh({x, 0.33, -0.01}, 0.5, 0.03));
  wall.vertices.row(0) *= 0.5;
  TriangleMesh top = wall;
  wall.vertices.row(2) = 2 * wall.vertices.row(0).array() - 1;
  wall.vertices.row(0).setConstant(0.5);
  for (const double x : {0.21, 0.42, 0.58, 0.79})
    for (const double y : {0.22, 0.5, 0.77})
      needles = both_meshes(needles, spike_mesh({x, y, 0.04 * std::sin(9 * x * y)}, 0.8, 0.01));
  return {row("three spikes", "S13_spikes", false, spikes),
          row("a spike under a vertex", "S13_vertex", true, spike_mesh({0.5, 0.5, 0.01}, 0.5, 0.1)),
          row("two ridges along edges of the mesh", "S13_ridges", false,
              both_meshes(ridge_mesh({0.1, 0.5, 0}, {0.9, 0.5, 0}, 0.4, 0.1),
                          ridge_mesh({0.3, 0.1, 0}, {0.3, 0.9, 0}, 0.4, 0.1))),
          row("the edge of a cliff", "S13_cliff", false, both_meshes(top, wall)),
          row("the same mesh below, edge on edge", "S13_edges", false, square(1, 200)),
          contact_row("S26", "cloth over twelve needles", false,
                      pressed_scene("S26_needles", 450, height, needles, 0.3, barrier_term(0.01)))};
}

std::vector<StressRow> coincident_rows(const StressRunner& bench) {
  const auto refused = [bench]() -> StressOutcome {
    StressOutcome outcome{StressVerdict::Fail, 1, 0, "was not refused: no barrier is finite there"};
    try {
      bench.solve(written(bench.options().folder / "scenes",
                          pressed_scene("S13_coincident", 200, 0, square(1, 200), 0.1, barrier_term(0.02))));
    } catch (const InputError& error) {
      const std::string said = error.what();
      const bool names_pairs =
          said.find("terms[3]") != std::string::npos && said.find("(0-200, ") != std::string::npos;
      outcome = {names_pairs ? StressVerdict::Pass : StressVerdict::Fail, names_pairs ? 0 : 1, 0,
                 "as it must be: " + said};
    }
    return outcome;
  };
  return {{"S13", "S13_coincident", "a sheet that lies in its obstacle, triangle on triangle",
           "refusals that name no pairs of facets", "", true, refused}};
}

std::vector<BuiltRow> tunnelling_rows() {
  const double carried = contact_facet_capacity(contact_facet_strength(0.01, 0.05, 3, 1), 0.05, 3);
  std::vector<BuiltRow> rows;
  for (const double share : {0.5, 0.9, 1.1, 10.0})
    rows.push_back(contact_row(
        "S14", "barrier, " + number_text(share) + " of what a facet repulsion carries", share == 10,
        pressed_scene("S14_" + number_text(share), 128, 0.03, shifted_mesh(square(1.4, 98), {-0.2, -0.2, 0}),
                      share * carried, barrier_term(0.02))));
  rows.push_back(contact_row("S14", "a first step far through the floor", false,
                             pressed_scene("S14_step", 128, 0.5, floor_at(0.2), 5, barrier_term(0.02))));
  rows.push_back(facet_row());
  rows.push_back(contact_row("S25", "a contact range of 1e-9 edges", false,
                             pressed_scene("S25_range", 128, 0.5, floor_at(0), 0.01, barrier_term(1e-10)),
                             false));
  return rows;
}

}  // namespace coapt
