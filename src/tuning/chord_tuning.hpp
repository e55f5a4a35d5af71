// Fits the rest lengths of chords to a closed surface, or to the least orifice and chord force:
// docs/tuning.md.
#pragma once

#include "formats/table.hpp"
#include "optim/bounded_minimiser.hpp"
#include "run/run.hpp"
#include "sensitivity/determinacy.hpp"
#include "sensitivity/metrics/surface_residuals.hpp"
#include "sensitivity/tuning.hpp"
#include "solve/work_identity.hpp"

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace coapt {

// What gets one factor: each chord, the chords on a papillary tip, of a material, of a term, or all.
enum class ChordGrouping { Chord, Tip, Material, Term, All };

// A tuning that can be taken up: its record, and the shape before it (3 x node_count).
struct ChordTuningRecord {
  TuningRecord tuning;
  Points x_before;
};

// The cost is distance_weight times the mean square distance of the closed surface from the target [mm2],
// plus orifice_weight times the smooth orifice [mm2], plus force_weight times the smooth greatest chord force
// [N], plus change_weight times the sum over the chords of the square of their change [mm2].
struct ChordTuningOptions {
  std::filesystem::path target;           // a surface; empty: the scene's reference, where a fit is wanted
  double target_scale = 1;                // mm per unit of that file
  std::optional<double> distance_weight;  // [1/mm2]; empty: 1 with a target or without other weights, else 0
  double orifice_weight = 0;              // [1/mm2]
  double force_weight = 0;                // [1/N]
  std::optional<double> change_weight;    // [1/mm2]; empty: 1e-6 for a fit alone, else 1e-3

  ChordGrouping grouping = ChordGrouping::Chord;
  std::vector<std::string> only = {};   // names of chords or groups; empty: all chords
  double lowest = -0.2, highest = 0.2;  // greatest relative changes

  FitSides sides = FitSides::Both;  // of a fit, whose vertices look for the other surface
  bool is_direct = false;  // a fit searches from the lengths as they are, not drawn to the target first

  std::string method;              // of the table; empty: gauss_newton for a fit alone, else slsqp
  double step = 1e-3;              // of a length: below, the search ends [mm]
  double gain = 1e-6;              // of the cost, relative: likewise
  int max_solves = 200;            // closures, the first and those of earlier sessions included
  double max_seconds = kInfinity;  // of this session

  // Standard deviation of the target's distances, independent by vertex [mm]. A fit that leaves more
  // determines nothing.
  double noise = 0.1;
  double determined = 0.05;  // greatest standard deviation of a length that counts as determined [mm]

  std::function<void(const RunReport&)> report_before = {};         // each may be empty
  std::function<void(int solves, const TuningTrial&)> report = {};  // after each trial
  std::function<void(const ChordTuningRecord&)> keep = {};          // likewise
  std::function<bool()> is_cancelled = {};                          // asked between solves
  const ChordTuningRecord* known = nullptr;                         // to go on from
  std::vector<std::string> defects = {};  // that the caller found, to be said with all others
};

struct TunedLength {
  std::string name;              // of the group
  int chords = 0;                // in it
  double before = 0, after = 0;  // rest length, mean of its chords [mm]
  double factor = 1;
  double low = 0, high = 0;     // bounds of the mean length [mm]
  int at_bound = 0;             // -1: at the lower, 1: at the upper
  bool is_slack = false;        // no chord of it carries a force, before the last change or after
  double deviation = kNaN;      // standard deviation of the mean length [mm]; NaN: not known
  double extension = 0;         // of its most extended line, beyond its rest length [mm]
  bool is_hardly_taut = false;  // its deviation is known, and three of them longer it might pull no more
  // Its deviation is known and small enough, it is not hardly taut, and the noise explains the misfit.
  bool is_determined = false;
};

struct ChordTuning {
  std::string scene_file, scene_title, method, target;  // the last: as it was named; empty without one
  double distance_weight = 0, orifice_weight = 0, force_weight = 0, change_weight = 0;
  double noise = 0, determined = 0;
  Tuning tuning;
  std::vector<TunedLength> lengths;
  std::optional<Determinacy> determinacy;  // of the mean lengths [mm], of a fit
  bool is_explained = false;               // what a fit leaves, by the noise
  RunReport before;
  std::optional<RunReport> after;  // the tuned scene as written, solved again from the tuned shape
  std::string tuned_scene;         // file name
  int solves = 0;                  // of closures: the first, the trials and the last
  double seconds = 0;              // wall time of all sessions
  std::filesystem::path folder;

  // The method's own criterion holds, and both shapes are equilibria.
  bool has_converged() const;
  double misfit_before() const;  // root mean square distance [mm]; NaN without a target
  double misfit_after() const;
};

// Solves the scene into the folder `before`, tunes it, writes `tuned.json`, and solves that from the tuned
// shape into `after`; the folders stand in that of the run options (empty: the scene's). Nothing else is
// written, see write_chord_tuning(). The time limit and observer of the run options hold for the first solve
// and the last. Throws InputError, all defects in one pass: a scene without chords, a target that is missing
// or not read, names that no chord has, weights, bounds or limits out of range, an orifice without annulus, a
// method that is not in the table (naming what is) or does not fit the goal.
ChordTuning tune_chords(const std::filesystem::path& scene, const SolverTable& solvers,
                        const BoundedMinimiserTable& minimisers, const ChordTuningOptions& options,
                        const RunOptions& run);

// What two sessions of one tuning have in common: scene with its files, target, weights, groups, bounds,
// tolerance. Method and limits may differ.
Identity chord_tuning_identity(const Scene& scene, const ChordTuningOptions& options, const RunOptions& run);

// As write_checkpoint() and read_checkpoint() do with a run.
void write_chord_tuning_checkpoint(const std::filesystem::path& path, const Identity& identity,
                                   const ChordTuningRecord& record);
ChordTuningRecord read_chord_tuning_checkpoint(const std::filesystem::path& path, const Identity& identity);

// The text of tuning.json. Numbers that are not finite or not known are null.
std::string chord_tuning_json(const ChordTuning& found);

// tuning.html: the history, every figure before and after, the lengths, what determines them, both shapes.
std::string chord_tuning_page(const ChordTuning& found);

// One row for each length: tuning.csv but for the columns "change_mm" and "remarks", and what the page and
// `coapt tune` show of it.
Table length_table(const ChordTuning& found);
inline const std::vector<std::string> kShownOfLengths = {
    "name", "before_mm", "after_mm", "change_mm", "standard_deviation_mm", "remarks"};

// Writes tuning.json, tuning.csv (a row for each length) and tuning.html. Throws InputError when a file
// cannot be written.
void write_chord_tuning(const ChordTuning& found);

}  // namespace coapt
