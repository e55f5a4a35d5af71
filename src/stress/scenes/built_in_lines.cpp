// S5 and S11: a weight on one chord or tether, with the answer in closed form.
#include "core/number_text.hpp"
#include "stress/scenes/built_in.hpp"

#include <cmath>

namespace coapt {
namespace {

constexpr double kWeight = 3;  // [N]

// From the anchor at the origin to a junction at `start`, where the weight hangs.
ChordNetwork one_chord(const Vec3& start, double rest_length) {
  ChordNetwork network;
  network.papillary = Vec3::Zero();
  network.junctions = start;
  Chord& chord = network.chords.emplace_back();
  chord.from = {ChordEnd::Kind::Papillary, 0};
  chord.to = {ChordEnd::Kind::Junction, 0};
  chord.rest_length = rest_length;
  chord.area = 1;
  return network;
}

// term: the line's, with its braces.
BuiltScene weight_scene(const std::string& name, const std::string& term, const Vec3& start,
                        double rest_length) {
  return {.name = name,
          .text = "{ // A weight on one line. Lengths in mm.\n  \"terms\": [\n    " + term +
                  filled(R"(,
    { "type": "load_field", "direction": [0, 0, -1], "force": "$WEIGHT N", "nodes": "junctions" }
  ],
  "solver": { "type": "newton", "tolerance": 1e-10, "max_iterations": 1000 }
}
)",
                         {{"WEIGHT", kWeight}}),
          .chords = one_chord(start, rest_length)};
}

BuiltRow weight_row(const char* id, const std::string& name, bool is_quick, BuiltScene scene, double exact) {
  constexpr double kLimit = 1e-8;
  return {id,
          name,
          "error of the line's length",
          "",
          is_quick,
          std::move(scene),
          [exact](const StressScene& built, const StressRun& solved) {
            const double length = (solved.x.col(1) - solved.x.col(0)).norm();
            return converged_and(solved, built, std::abs(length / exact - 1), kLimit, "the length is wrong");
          }};
}

// t ((d - r)/rho)^3 under the weight W: d = r + rho^(3/2) sqrt(W/(3 t)).
BuiltRow tether_row(double strength) {
  constexpr double kScale = 0.5, kLength = 1;
  const double exact = kLength + std::pow(kScale, 1.5) * std::sqrt(kWeight / (3 * strength));
  const std::string term = filled(
      R"({ "type": "tether_cubic", "network": "chords.json", "strength": "$STRENGTH mJ", "scale": "$SCALE mm" })",
      {{"STRENGTH", strength}, {"SCALE", kScale}});
  return weight_row(
      "S5", "cubic tether of " + number_text(strength) + " mJ, stretched by half", strength == 1e9,
      weight_scene("S5_tether_" + number_text(strength), term, {0.1, -0.05, -1.5}, kLength), exact);
}

BuiltRow coincident_row() {
  constexpr double kYoung = 4, kLength = 0.5;
  return weight_row(
      "S5", "chord with both ends in one place", true,
      weight_scene(
          "S5_coincident",
          filled(R"({ "type": "cable", "network": "chords.json", "young": "$YOUNG MPa", "smoothing": 0 })",
                 {{"YOUNG", kYoung}}),
          {0, 0, 0}, kLength),
      kLength * (1 + kWeight / kYoung));
}

// The weight stretches the chord exactly to its knee.
BuiltRow knee_row() {
  constexpr double kStrain = 0.1, kLength = 1;
  return weight_row(
      "S11", "chord exactly at its knee", true,
      weight_scene(
          "S11_knee",
          filled(R"({ "type": "cable_bilinear", "network": "chords.json",
      "young_pre": "$SOFT MPa", "young_post": "$HARD MPa", "transition_strain": $STRAIN, "knee": 0, "smoothing": 0 })",
                 {{"SOFT", kWeight / kStrain}, {"HARD", 50 * kWeight / kStrain}, {"STRAIN", kStrain}}),
          {0.02, -0.01, -1}, kLength),
      kLength * (1 + kStrain));
}

}  // namespace

std::vector<BuiltRow> line_rows() {
  std::vector<BuiltRow> rows;
  for (const double strength : {1e-3, 1.0, 1e3, 1e6, 1e9}) rows.push_back(tether_row(strength));
  rows.push_back(coincident_row());
  rows.push_back(knee_row());
  return rows;
}

}  // namespace coapt
