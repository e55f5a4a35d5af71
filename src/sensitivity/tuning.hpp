// Chooses the numbers of an equilibrium's parameters: so that its shape fits a target, or so that figures of
// merit are least, within bounds.
//
//   const auto make = [&](const Vector& q) {                // numbers begin where they begin, whatever q
//     auto equilibrium = std::make_unique<TrackedEquilibrium>(objective, q);
//     equilibrium->add(make_line_lengths(...));
//     return equilibrium;
//   };
//   const auto residuals = make_surface_residuals(triangles, x, target);
//   const auto method = built_in_minimisers().at("gauss_newton")();
//   const Tuning found = tune(make, q, {.residuals = residuals.get()}, *method, {.low = low, .high = high});
//
// Minimised is   cost = w |r(x)|^2 + sum_k w_k J_k + sum_j c_j (z_j - z_j at first)^2,   z_j = scale_j times
// number j. Weights carry the units that make the cost a plain number.
//
// Every trial is a warm solve from the best shape so far, judged by the objective's residual. One that does
// not converge is rejected, and the next starts from the best shape again. Methods are local: a number
// without influence where they begin, such as the length of a slack chord, is left alone unless `restart`
// moves it.
#pragma once

#include "optim/bounded_minimiser.hpp"
#include "sensitivity/metrics/residual_set.hpp"
#include "sensitivity/tracked_equilibrium.hpp"

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace coapt {

struct WeightedMetric {
  const Metric* metric = nullptr;
  double weight = 1;
};

struct TuningGoal {
  const ResidualSet* residuals = nullptr;  // null: none
  double residual_weight = 1;
  std::vector<WeightedMetric> metrics = {};
  Vector change_weights = {};  // c, of each number, not negative; empty: none
};

// One solve on the way.
struct TuningTrial {
  Vector value;                      // of the numbers
  Status status = Status::Stalled;   // of the equilibrium
  double cost = kInfinity;           // infinite where it did not converge
  double misfit = kNaN;              // |r|^2; NaN without residuals or where it did not converge
  std::vector<double> metrics = {};  // J of each; empty where it did not converge
  int iterations = 0;                // of the solve
  bool is_best = false;              // so far
  bool is_aided = false;  // of an easier problem, on the way to where the search begins: it has no cost
  std::optional<LostBranch> lost_branch = {};  // of the step from the best shape before it
  double seconds = 0;                          // wall time since the tuning began
};

// What a tuning is taken up from: its best trial, with the unknowns of that shape, and every trial so far.
struct TuningRecord {
  Vector value, q;
  std::vector<TuningTrial> history;
  double seconds = 0;  // wall time of all sessions
};

// Numbers found by other means, with the unknowns of their shape and the trials that this took.
struct TuningStart {
  Vector value, q;  // empty: none were found
  std::vector<TuningTrial> trials = {};
};

struct TuningOptions {
  Vector low, high;                // bounds of the numbers; finite, and the first value between them
  Vector scales = {};              // z = scale times number, all of like size; empty: 1
  BoundedStop stop = {};           // on z and the cost
  int max_solves = 200;            // over all sessions
  double max_seconds = kInfinity;  // wall time, of this session; a solve that has begun is not cut short
  std::function<void(const TuningTrial&)> report = {};  // after each solve; may be empty
  std::function<void(const TuningRecord&)> keep = {};   // likewise, after the report
  std::function<bool()> is_cancelled = {};              // asked before each solve; may be empty
  const TuningRecord* known = nullptr;                  // to go on from; null: from the start

  // Asked once, after the first numbers or the known record, for other numbers to begin at: taken where their
  // cost is less. May be empty.
  std::function<TuningStart(const TuningRecord& best)> start = {};

  // Asked where the method has ended by itself: numbers to begin once more from, where it may have been
  // trapped; none: it was not. Asked again only after an end that was better than the one before. May be
  // empty.
  std::function<std::optional<Vector>(const TuningRecord& best)> restart = {};
};

enum class TuningStatus {
  Converged,  // by the method's own criterion
  Stalled,    // the method ended without that
  SolveLimit,
  TimeLimit,
  Cancelled,
  NoStart  // the start did not converge
};
std::string_view tuning_status_name(TuningStatus status);  // "converged", "stalled", "solve_limit", ...

struct Tuning {
  TuningStatus status = TuningStatus::NoStart;
  std::string message;  // one sentence
  Vector start;         // the numbers at first
  TuningRecord best;    // with the whole history; without a value where there is no start
  double cost_before = kNaN, cost_after = kNaN;
  int solves = 0, failed = 0, lost_branches = 0;  // over all sessions
  double seconds = 0;                             // likewise

  // The best shape against the one that all changes at once lead to from the first: of trials that each
  // looked harmless. None without a start, where the start is the best, or where the tuning was cancelled.
  std::optional<AnchorCheck> anchor;

  // At the best numbers: the residuals and their derivatives by z (empty without residuals, or where the
  // tuning was cancelled first).
  Vector residuals;
  Eigen::MatrixXd jacobian;
};

// make: an equilibrium taken up at q with all its parameters, whose numbers begin as they did at the first
// call; called again after each trial that was not the best. The last one that it made is gone when it is
// called. q: unknowns at or near an equilibrium for these numbers.
// Throws InputError, all defects in one pass: sizes that do not fit, bounds that are reversed, not finite or
// do not hold the first value, weights, scales or limits out of range, nothing to minimise, a method that
// needs residuals for a goal with metrics.
using EquilibriumMaker = std::function<std::unique_ptr<TrackedEquilibrium>(const Vector& q)>;
Tuning tune(const EquilibriumMaker& make, const Vector& q, const TuningGoal& goal, BoundedMinimiser& method,
            const TuningOptions& options);

}  // namespace coapt
