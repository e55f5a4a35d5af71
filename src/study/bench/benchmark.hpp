// Error against run time: methods x tolerances x meshes, and each kind of error measured against a truth of
// its own.
//
//   algebraic       what the tolerance leaves: to the equilibrium on the same mesh, to which newton goes on
//                   from where the method ended; see equilibrium_residual()
//   discretisation  what the mesh leaves: from the distances between equilibria on meshes of 1, 4, 16, ...
//                   times the triangles, one more than is benchmarked
//   method          between the equilibria of the method and of the reference method on the same mesh; the
//                   gap between two models where the method solves another one
//   model           to a given closed surface
//
// Every run is a solve of its own, as `coapt solve` does it: see docs/decisions/007-error-against-time.md.
#pragma once

#include "report/solve_page.hpp"
#include "study/bench/discretisation.hpp"
#include "study/comparison.hpp"

#include <functional>
#include <map>

namespace coapt {

// The residual that is asked for where errors are measured to an equilibrium.
inline constexpr double kEquilibrium = 1e-12;

// Of the tightest tolerance: what is no nearer than this is no truth for the runs to that tolerance.
inline constexpr double kEquilibriumShare = 1e-2;

struct Spread {
  double median = 0, best = 0;  // of all repeats [s]
};

struct NodeError {
  double max = 0, rms = 0;  // over the mesh vertices; over all nodes in a scene without a mesh [mm]
};

// Empty where a truth is not known, or there is none.
struct RunErrors {
  std::optional<NodeError> algebraic;    // none for xpbd, whose constraints have no energy of the scene
  std::optional<double> discretisation;  // an estimate for 95 % of the surface [mm]
  // 95 % of the surface; none for the reference method. Of the run's own shape, and so with its algebraic
  // error, where the equilibrium of the method is not known [mm].
  std::optional<double> method;
  std::optional<DistanceFigures> model;  // both directions
  std::optional<double> total;           // greatest algebraic, discretisation and method together [mm]
};

struct BenchRun {
  size_t method = 0, mesh = 0;  // of the benchmark
  double tolerance = 0;         // on the residual
  Status status = Status::Stalled;
  std::string message = {};
  double residual = 0;  // relative
  double energy = 0;    // [mJ]
  int iterations = 0, outer_iterations = 0;
  EvaluationCounts evaluations = {};
  long factorisations = 0;
  int repeats = 0;
  Spread wall = {}, cpu = {};                  // of the solve, without reading files and building terms
  std::map<std::string, double> phase_s = {};  // wall time of the fastest repeat
  std::optional<double> peak_memory_mb = {};   // resident, of terms and solve, see PeakMemory
  RunErrors errors = {};
};

// Where a method ends on a mesh.
struct BenchEnd {
  size_t method = 0, mesh = 0;
  std::string failure = {};             // empty unless it could not be run at all
  std::optional<double> residual = {};  // of its equilibrium, by newton; none: it was not found
  std::string missing = {};             // why it was not found; empty where it was, or was not looked for
  std::optional<MethodGap> gap = {};    // to the reference method's equilibrium, of its own equilibrium or,
                                        // where there is none, of its last shape
  Verdict verdict = Verdict::Failed;
};

struct BenchMesh {
  int triangles = 0, vertices = 0, nodes = 0;
  bool is_benchmarked = true;                   // the last one only says what the others lack
  std::optional<double> residual = {};          // of the reference equilibrium; none: it was not found
  std::string missing = {};                     // why it was not found; empty where it was
  std::optional<DistanceFigures> to_next = {};  // between the reference equilibria here and on the next mesh
  std::optional<double> order = {};             // log2 of the mean distance from the mesh before over that
  std::optional<double> error_mm = {};          // estimate of the discretisation error, 95 % of the surface
  // CPU time of a Hessian and its factorisation there, in which other times can be told on any machine; only
  // of benchmarked meshes whose equilibrium was found [s].
  std::optional<double> factorisation_s = {};
};

struct BenchMethod {
  std::string name;
  MethodModel model = MethodModel::Scene;
};

struct Benchmark {
  std::string scene_file, scene_title;
  std::string closed_surface;        // file name of the given closed surface; empty: none
  double extent_mm = 0;              // diagonal of the box around the shape at rest
  std::vector<double> tolerances;    // falling
  std::vector<BenchMethod> methods;  // the reference first
  std::vector<BenchMesh> meshes;     // the scene's own first; without a mesh one with the nodes alone
  std::vector<BenchRun> runs;
  std::vector<BenchEnd> ends;
  double assumed_order = 1;  // of what is beyond the last mesh
  // The reference method on the scene's own mesh, solved once more beside the clock for the page: its
  // history, where on the mesh its error is (where that is known), and its account. Empty where nothing is
  // written.
  std::optional<ShownSolve> shown = {};
  std::optional<Branches> branches = {};  // around the equilibrium of that solve, where they were wanted
  bool is_cancelled = false;
  std::filesystem::path folder;  // empty: nothing was written

  // Every run, and every solve for an equilibrium that errors are measured to; no method failed.
  bool has_converged() const;

  // The greatest residual of what counts as an equilibrium. Pre: there are tolerances.
  double equilibrium_residual() const;
};

struct BenchOptions {
  std::vector<std::string> methods;  // each once; see known_methods
  std::string reference;             // one of them; empty: "newton" where it is among them, else the first
  std::vector<double> tolerances;    // on the residual, each once
  int levels = 1;                    // how often the mesh is cut into four; 0 ... 4
  int repeats = 3;                   // of each run, at least one; one that takes long is not repeated
  // Of each solve that is no run but finds an equilibrium to measure errors to, above 0; empty: as of a run
  // [s].
  std::optional<double> truth_seconds = {};
  std::filesystem::path closed;  // given closed surface; empty: the scene's
  // Around the equilibrium of the reference method on the scene's own mesh, beside the clock.
  BranchSearch branches = {.starts = 0};
  std::function<void(const Benchmark&, const BenchRun&)>
      report;  // after each run, errors still to come; may be empty
};

// Every method on every mesh from the loosest tolerance to the tightest, or the first that it does not reach.
// run: as for run(), its solver and tolerance are not used and its time limit is that of each solve. Throws
// InputError, before the first solve, for bad input: all of the options in one pass, then whatever the scene
// is refused for, then a folder that cannot be written.
Benchmark run_benchmark(const Scene& scene, const SolverTable& solvers, const BenchOptions& options,
                        const RunOptions& run);

}  // namespace coapt
