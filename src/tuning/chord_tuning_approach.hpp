// Brings the closed valve near a target before its chords are fitted. Private to this room.
#pragma once

#include "tuning/chord_tuning_parts.hpp"

namespace coapt {

// A valve that closes in another way than the target, or whose chords are slack where the target's are taut,
// traps a fit. Springs that draw the leaflets to the target (TargetAttraction) hold them where the target
// is: there slack chords take up their slack, and the lengths are fitted while the springs get weaker.
//
// model: its supports where their motion ends; the springs belong to a model of its own. first: what is
// known of it. The trials are marked as aided. Without a value where the leaflets could not be drawn to the
// target, a limit was reached, or no load says how strong springs should be. options: bounds, scales, weights
// of changes, report and limits, which hold for all trials together.
TuningStart approach_target(const PreparedTuning& ready, const Model& model, const TriangleMesh& target,
                            const TuningGoal& goal, const TuningOptions& options, const TuningRecord& first);

}  // namespace coapt
