// A scene that is ready to be tuned, and what a search for its chords' lengths is made of. Private to this
// room.
#pragma once

#include "scene/build/scene_geometry.hpp"
#include "solve/solve_scene.hpp"
#include "tuning/chord_groups.hpp"

namespace coapt {

struct PreparedTuning {
  Scene scene;
  SolveSetup setup;
  SceneGeometry geometry;
  std::vector<TunableChord> chords;
  std::vector<ChordGroup> groups;
  std::vector<size_t> lines;  // of the chords that are tuned
};

// Builds `model` and finds every defect before the first solve. Throws InputError with all of them, those
// that the options bring along included.
PreparedTuning prepare_tuning(const std::string& text, const std::filesystem::path& file,
                              const SolverTable& solvers, const BoundedMinimiserTable& minimisers,
                              const ChordTuningOptions& options, const RunOptions& run_options, Model& model);

// Equilibria of the model, with the factors of the groups as their parameter, which begins at 1: the lengths
// that the chords have now. Both must outlive it.
EquilibriumMaker equilibrium_maker(const PreparedTuning& ready, Model& model, bool checks_branch);

// A slack chord tells nothing of how much shorter it should be; one that is just taut does. Factors with
// which each slack group takes up what its tautest path from leaflet to tip lacks at the unknowns q of the
// model: a straight way. None where nothing is slack, or may become shorter. Pre: Model::lines are those of
// factors 1.
std::optional<Vector> with_slack_taken_up(const PreparedTuning& ready, const Model& model, const Vector& low,
                                          const Vector& factors, const Vector& q);

}  // namespace coapt
