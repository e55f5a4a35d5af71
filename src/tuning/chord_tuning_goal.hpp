// What a tuning of chords minimises, as residuals and metrics of a model. Private to this room.
#pragma once

#include "tuning/chord_tuning.hpp"

namespace coapt {

struct ChordTuningGoal {
  std::unique_ptr<MeasuredResiduals> residuals;  // null without a target
  std::vector<std::unique_ptr<Metric>> metrics;
  TuningGoal goal;  // of these; without weights of changes
};

// Weights and change weight where the options leave them open.
double distance_weight_of(const ChordTuningOptions& options);
double change_weight_of(const ChordTuningOptions& options);

// Everything wrong with the options that needs no model, naming those of the command.
std::vector<std::string> chord_tuning_defects(const ChordTuningOptions& options,
                                              const BoundedMinimiserTable& minimisers);
std::string chord_tuning_method(const ChordTuningOptions& options);

// The target of a fit, relative to the model's origin. Throws InputError.
TriangleMesh read_target(const ChordTuningOptions& options, const Model& model);

// before: positions before the tuning (3 x node_count). lines: of the model, whose force counts. Throws
// InputError.
ChordTuningGoal make_chord_tuning_goal(const ChordTuningOptions& options, const Model& model,
                                       const Fields& before, const std::vector<size_t>& lines);

}  // namespace coapt
