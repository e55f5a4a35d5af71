// How much the equilibrium of a scene depends on each of its parameters.
//
// One solve, and the derivative of its shape by each parameter: a linear system with the exact tangent. The
// closed surface is compared with the one that this moves it to, and with the scene's reference surface where
// it has one. Where finite changes are asked for, or where a derivative is not defined, the parameter is made
// smaller and larger by a share and the scene solved again. The study is that of Hammer et al. 2011
// (mass-spring mitral valve, change of the mean surface error per change of a parameter).
#pragma once

#include "results/reference/reference_distance.hpp"
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
  std::string name;                  // TERM.KEY
  double value = 0;                  // before any change, in `unit`; 1 for a diameter or a list of numbers
  std::string unit;                  // internal; empty for pure numbers
  std::vector<SensitivityRun> runs;  // with the parameter smaller, then larger; none: by the derivative
  std::string message;               // why the derivative is not defined, where it was wanted
  double wall_s = 0;                 // of all that it took

  // Mean distance from the first closed surface per change of 100 %, the mean of both signs [mm]; empty
  // where a solve did not converge.
  std::optional<double> movement;
  // Change of the mean distance from the reference per 100 %, between both signs [mm]; negative where a
  // larger value comes nearer. Empty without a reference, too.
  std::optional<double> error_change;

  bool has_converged() const;
};

constexpr double kPerturbation = 0.05;

struct SensitivityOptions {
  std::vector<std::string> parameters;  // TERM.KEY; empty: all of the elastic terms (scene_parameter.hpp)
  // Share by which each is made smaller and larger, in (0, 1); empty: derivatives, and for solves with
  // starts_anew or in place of a derivative kPerturbation.
  std::optional<double> perturbation;
  bool starts_anew = false;  // solves again, each from the scene's own start and not from the first solution
  std::function<void(const ParameterSensitivity&)> report = {};  // after each parameter; may be empty
};

struct SensitivityStudy {
  std::string scene_file, solver;
  double tolerance = 0;
  std::optional<double> perturbation;  // of finite changes; empty: derivatives
  bool starts_anew = false;
  SensitivityRun base;
  std::vector<std::string> doubts;               // of the first solve, see doubts() in result_warnings.hpp
  std::vector<ParameterSensitivity> parameters;  // fewer than wanted where the study was cancelled
  std::vector<std::string> left_out;  // parameters nobody named that cannot be varied so: why, by sentence
  bool is_cancelled = false;
  double wall_s = 0;  // of everything

  bool has_converged() const;  // the first solve and all others, and none was cancelled
};

// options.run: as for run(); its time limit is that of each solve. Throws InputError for bad input, all
// defects of the parameters together, before the first solve. A first solve that does not converge ends the
// study. Where no parameters are named, those that the change takes beyond a limit are left out; for a
// derivative that is 0.01 %.
SensitivityStudy study_sensitivity(const Scene& scene, const SolverTable& solvers,
                                   const SensitivityOptions& options, const RunOptions& run);

// Writes sensitivity.json and sensitivity.csv, one row for each solve or derivative. Throws InputError when a
// file cannot be written.
void write_sensitivity(const std::filesystem::path& folder, const SensitivityStudy& study);

}  // namespace coapt
