// A valve before and after its interventions: both solved from the same start, and every figure of both.
#pragma once

#include "results/changed_figures.hpp"
#include "run/run.hpp"

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace coapt {

struct InterveneOptions {
  std::vector<std::filesystem::path> files = {};      // of interventions as JSON, behind those of the scene
  std::vector<std::string> edits = {};                // JSON text of more, behind those
  std::function<void(const RunReport&)> report = {};  // after each of the two solves; may be empty
};

struct BeforeAfter {
  std::string scene_file, scene_title;
  std::vector<std::string> interventions;  // JSON text of each between the two states
  std::optional<RunReport> before, after;  // the latter empty where the first solve was cancelled
  std::filesystem::path folder;

  bool has_converged() const;  // both
};

// What is before: with edits the scene as it stands (its own interventions may be what ails it), without them
// the scene without its interventions. Solves that into the folder `before`, then with all of them into
// `after`, within the folder of the run options (empty: that of the scene). Both scenes are built before the
// first solve, so that an intervention that cannot be made is refused at once. Throws InputError: bad input,
// no intervention, a folder that cannot be written.
BeforeAfter intervene(const std::filesystem::path& scene, const SolverTable& solvers,
                      const InterveneOptions& options, const RunOptions& run);

// Every figure of both states.
std::vector<ChangedFigure> changed_figures(const BeforeAfter& found);

// The text of intervene.json. Numbers that are not finite or not defined are null.
std::string intervene_json(const BeforeAfter& found);

// intervene.html: the figures, and both shapes where they have the same triangles.
std::string intervene_page(const BeforeAfter& found);

// Writes intervene.json, intervene.csv (a row for each figure) and intervene.html. Throws InputError when a
// file cannot be written.
void write_intervene(const BeforeAfter& found);

}  // namespace coapt
