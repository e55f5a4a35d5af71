// The stability matrix: scenes at the end of what they can be asked for, and for each of them whether the
// answer holds, or whether it is said honestly that there is none. Rows: docs/stress.md.
#pragma once

#include "report/solve_page.hpp"
#include "run/run.hpp"
#include "solve/solve_scene.hpp"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace coapt {

enum class StressVerdict {
  Pass,          // the answer, and it holds to the limit
  OtherBranch,   // an equilibrium of the same scene, confirmed by its residual, but another one
  Stall,         // no answer; the status says so, with a reason and finite positions
  Fail,          // a wrong answer that is called converged, numbers that are not finite, a limit not kept
  NotApplicable  // the row means nothing for this scene, or the scene is refused with a reason
};
std::string_view stress_verdict_name(StressVerdict verdict);  // "pass", "branch", "stall", "fail", "n/a"

// What the rows of an id are about: "units" of S1; empty for an id that is not known.
std::string_view stress_topic(std::string_view id);

// What a row found.
struct StressOutcome {
  StressVerdict verdict = StressVerdict::Fail;
  std::optional<double> figure = {};  // that was measured, in the unit of the row
  std::optional<double> limit = {};   // that it must not exceed
  std::string message = {};           // one sentence
  std::string status = {};            // of the solve that counts, as status_name(); empty: there was none
  std::optional<double> residual = {};
  std::optional<int> iterations = {};
};

struct StressRow {
  std::string id;       // of the matrix, "S3"; several rows may share it
  std::string scene;    // what it is done to
  std::string name;     // what is varied, and how far: "load times 1e-06"
  std::string measure;  // what the figure is
  std::string unit;     // of the figure; empty: a pure number
  bool is_quick = false;
  std::function<StressOutcome()> run;
  // The scene's own solution to look at, where a row has asked for it; may be empty.
  std::function<std::optional<ShownSolve>()> shown = {};
};

struct StressResult {
  StressRow row;
  StressOutcome outcome;
  double wall_s = 0, cpu_s = 0;
};

struct StressMatrix {
  std::string scene_file, scene_title;  // empty: the built-in scenes
  double row_seconds = 0;               // time limit of each solve
  std::vector<StressResult> results;
  bool is_cancelled = false;
  std::optional<ShownSolve> shown;  // a solution that rows were compared with

  int count(StressVerdict verdict) const;
  bool has_failed() const { return count(StressVerdict::Fail) > 0; }
  bool holds() const { return !has_failed() && !is_cancelled; }  // exit code 0 of `coapt stress`
};

struct StressOptions {
  std::vector<std::string> rows;          // ids; empty: all
  bool is_quick = false;                  // only the rows that take next to no time
  double row_seconds = 20;                // time limit of each solve [s]
  std::filesystem::path folder;           // the built-in scenes are written into a folder here
  SolverTable solvers = scene_solvers();  // "newton" and "lbfgs" are used where they are there
  FactorisationTable factorisations = built_in_factorisations();
  IntersectionChecker checker;
  // Solves the scene file in a process of its own and writes the results into the folder, within so many
  // seconds; empty: the row that needs it is left out.
  std::function<void(const std::filesystem::path& scene, const std::filesystem::path& folder, double seconds)>
      solve_apart;
  std::function<bool()> is_cancelled;               // asked at each iterate; may be empty
  std::function<void(const StressResult&)> report;  // called after each row; may be empty
};

// The rows that are done to any scene: scene alone, or the built-in scenes. The scene is solved when the
// first row runs that needs the solution. Throws InputError for a scene that cannot be built, an id that no
// row has (naming those there are), and a folder that cannot be written.
std::vector<StressRow> stress_rows(const Scene& scene, const StressOptions& options);
std::vector<StressRow> stress_rows(const StressOptions& options);

// Runs rows one after the other. An exception of a row is its failure, an InputError a refusal. Ends early
// where is_cancelled says so, without the row that was cut short.
StressMatrix run_stress(const std::vector<StressRow>& rows, const StressOptions& options);

}  // namespace coapt
