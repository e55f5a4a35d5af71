// Scenes of our own for the stability matrix. Each is written as files, so that whoever wonders about a row
// can look at its scene and solve it. Private to this room.
#pragma once

#include "formats/valve.hpp"
#include "stress/bench.hpp"

#include <initializer_list>
#include <map>
#include <string>
#include <string_view>
#include <utility>

namespace coapt {

struct BuiltScene {
  std::string name;                                 // of its folder
  std::string text;                                 // scene.json
  TriangleMesh mesh = {};                           // mesh.obj; without triangles: none
  std::map<std::string, TriangleMesh> others = {};  // NAME.obj
  std::map<std::string, Points> points = {};        // NAME.csv
  ChordNetwork chords = {};                         // chords.json; without chords: none
};

// The scene from its files in the folder, which are written first. Throws InputError.
StressScene written(const std::filesystem::path& folder, const BuiltScene& built);

// The text with each $NAME replaced by its number, in all its digits. Longer names first where one begins
// with another.
std::string filled(std::string_view text, std::initializer_list<std::pair<std::string_view, double>> numbers);

// Points on the boundary of a mesh, in the order of the node set "boundary".
Points boundary_points(const Points& x, const Triangles& triangles);

// A row on a scene of its own; `judge` says what the solved scene must be like.
struct BuiltRow {
  std::string id, name, measure, unit;
  bool is_quick = false;
  BuiltScene scene;
  std::function<StressOutcome(const StressScene&, const StressRun&)> checker;
  bool judges_every_state = false;
};
StressRow row_of(const StressRunner& bench, const BuiltRow& row);

// A pass or failure of something that did converge, else the stall.
StressOutcome converged_and(const StressRun& solved, const StressScene& scene, double figure, double limit,
                            const std::string& message);

// The rows by family.
std::vector<BuiltRow> load_rows();            // S3, S25: a disc under any load
std::vector<BuiltRow> line_rows();            // S5, S11: chords and tethers
std::vector<BuiltRow> sheet_rows();           // S6, S8, S9, S11: sheets
std::vector<BuiltRow> no_equilibrium_rows();  // S10, S12: no equilibrium, or another branch
std::vector<BuiltRow> degenerate_rows();      // S13, S26: contact
std::vector<BuiltRow> folded_rows();          // S13, S26: sheets that meet themselves or have holes
std::vector<BuiltRow> tunnelling_rows();      // S14, S25: contact under load

// Rows that are no solve of one scene.
std::vector<StressRow> collision_query_rows();                        // S15
std::vector<StressRow> bad_input_rows(const StressRunner& bench);     // S20
std::vector<StressRow> random_scene_rows(const StressRunner& bench);  // S21
std::vector<StressRow> large_scene_rows(const StressRunner& bench);   // S24
std::vector<StressRow> coincident_rows(const StressRunner& bench);    // S13

// The generated valve, 300 triangles, for the rows that are done to any scene. Written into the folder.
StressScene built_in_valve(const std::filesystem::path& folder, bool has_contact);

// The same with 5,200 triangles and without contact: elements enough for several threads.
StressScene large_valve(const std::filesystem::path& folder);

}  // namespace coapt
