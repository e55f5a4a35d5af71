// Finds the stiffness of each region of the leaflets with which no chord, and where they have a yield of
// their own no leaflet, is strained beyond its yield while the valve closes, after the tuning of 14 regions
// in Toma et al. 2016.
//
// Unknown are the logarithms of a factor per region on all moduli of the membrane, and, where wanted, of one
// per elastic cable term on the cross-sections. Minimised is the sum of squares of what exceeds the limits
// (strain of each chord over the yield strain, orifice over its limit, each with a margin of 1 %), as every
// tuning is (sensitivity/tuning.hpp): each trial is a warm solve, with exact derivatives by all factors.
#pragma once

#include "formats/table.hpp"
#include "run/run.hpp"

#include <functional>
#include <string>
#include <vector>

namespace coapt {

// How a valve stands with certain factors.
struct TuningState {
  double max_chord_strain = 0;                   // length over rest length, less 1
  double max_yield_ratio = 0;                    // of chords and facets: strain over that at yield
  int strained_chords = 0, strained_facets = 0;  // beyond the yield strain
  std::optional<double> orifice_area_mm2;
  std::vector<std::string> doubts = {};  // of the equilibrium, see doubts() in result_warnings.hpp
};

struct TunedFactor {
  std::string name;      // of the region or of the cable term
  int triangles = 0;     // 0 for a cable term
  double factor = 1;     // on the moduli, or on the cross-sections
  bool is_tuned = true;  // false for a region that no term with a modulus covers; its factor is 1
};

struct RegionTuningOptions {
  int regions = 14;  // 0: the regions of the scene's mesh as they are
  int zones = 2;     // from annulus to free edge
  // Of every chord; empty: chords and leaflets each by the yield of their own fibres (`yield_strain` of
  // terms).
  std::optional<double> yield_strain;
  std::optional<double> orifice_limit_mm2;  // empty: 2 % of the annulus area
  bool tunes_chords = false;                // the cross-sections too
  double greatest_factor = 10;              // and its inverse is the least
  int max_solves = 60;
  std::function<void(int round, const TuningState&)> report = {};  // after each accepted step; may be empty
};

struct RegionTuning {
  std::string scene_file;
  bool is_reached = false;
  std::string message;  // one sentence
  std::optional<double> yield_strain, orifice_limit_mm2;
  TuningState before, after;
  std::vector<TunedFactor> regions, chords;
  std::vector<int> region_of_triangle;
  int rounds = 0;                     // trials that came nearer
  int solves = 0, failed_solves = 0;  // the first, the trials and the last; those that did not converge
  double wall_s = 0;
};

// Throws InputError for a scene without chords, membrane moduli or an annulus, and for options without
// meaning. Where no factors do it, or a solve does not converge, the best state found is returned, not
// reached, with the reason.
RegionTuning tune_regions(const Scene& scene, const SolverTable& solvers, const RegionTuningOptions& options,
                          const RunOptions& run);

// One row for each region and each cable term: region_tuning.csv but for the column "of", and what
// `coapt tune-regions` prints.
Table factor_table(const RegionTuning& tuning);

// Writes region_tuning.json, region_tuning.csv (factors) and triangle_factors.csv (region and factor of each
// triangle). Throws InputError when a file cannot be written.
void write_region_tuning(const std::filesystem::path& folder, const RegionTuning& tuning);

}  // namespace coapt
