// How much the equilibrium of a scene depends on each of its parameters.
//
// Every parameter is made larger and smaller by the same share, the scene solved again, and the closed
// surface compared with the one found at first, and with the scene's reference surface where it has one. The
// study is that of Hammer et al. 2011 (mass-spring mitral valve, change of the mean surface error per change
// of a parameter).
#pragma once

#include "results/reference_distance.hpp"
#include "run/run.hpp"

#include <functional>
#include <string>
#include <vector>

namespace coapt {

// One solve.
struct SensitivityRun {
  double factor = 1;  // on the parameter
  Status status = Status::Stalled;
  double residual = 0;  // relative
  int iterations = 0;
  double wall_s = 0;
  DistanceFigures to_base = {};  // from the closed surface of the first solve, both directions
  std::optional<DistanceFigures> to_reference = {};  // from the scene's reference surface, likewise
};

struct ParameterSensitivity {
  std::string name;  // TERM.KEY
  double value = 0;  // before any change, in `unit`; 1 for a diameter or a list of numbers
  std::string unit;  // internal; empty for pure numbers
  SensitivityRun smaller, larger;

  // Mean distance from the first closed surface per change of 100 %, the mean of both signs [mm]; empty
  // unless both solves converged.
  std::optional<double> movement;
  // Change of the mean distance from the reference per 100 %, between both signs [mm]; negative where a
  // larger value comes nearer. Empty without a reference, too.
  std::optional<double> error_change;
};

struct SensitivityOptions {
  std::vector<std::string> parameters;  // TERM.KEY; empty: all of the elastic terms (scene_parameter.hpp)
  double perturbation = 0.05;           // share by which each is made larger and smaller, in (0, 1)
  bool starts_anew = false;  // each solve from the scene's own start; false: from the first solution
  std::function<void(const ParameterSensitivity&)> report = {};  // after each parameter; may be empty
};

struct SensitivityStudy {
  std::string scene_file, solver;
  double tolerance = 0, perturbation = 0;
  bool starts_anew = false;
  SensitivityRun base;
  std::vector<ParameterSensitivity> parameters;  // fewer than wanted where the study was cancelled
  std::vector<std::string> left_out;  // parameters nobody named that cannot be varied so: why, by sentence
  bool is_cancelled = false;
  double wall_s = 0;  // of everything

  bool has_converged() const;  // the first solve and all others, and none was cancelled
};

// options.run: as for run(); its time limit is that of each solve. Throws InputError for bad input, all
// defects of the parameters in one pass, before the first solve. A first solve that does not converge ends
// the study. Where no parameters are named, those that the perturbation takes beyond a limit are left out.
SensitivityStudy study_sensitivity(const Scene& scene, const SolverTable& solvers,
                                   const SensitivityOptions& options, const RunOptions& run);

// Writes sensitivity.json and sensitivity.csv, one row per solve. Throws InputError when a file cannot be
// written.
void write_sensitivity(const std::filesystem::path& folder, const SensitivityStudy& study);

}  // namespace coapt
