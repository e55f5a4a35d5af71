// Watches one run for every solver alike: trace, stop rules, time by phase, counters, cancellation.
#pragma once

#include "optim/solver.hpp"

#include <optional>

namespace coapt {

class Monitor {
 public:
  Monitor(Objective& objective, const StopRule& stop, const Observer& observer);

  // --- for solvers -----------------------------------------------------------------------------------
  // Evaluations of the objective, timed by phase "gradient", "value", "hessian".
  double value(const Vector& q);
  double gradient(const Vector& q, Vector& g);
  double hessian(const Vector& q, Vector& g, Eigen::SparseMatrix<double>& h, Projection projection);

  // Call once per accepted iterate, the start included. Returns why to stop, or nothing to go on.
  std::optional<Status> accept(const Vector& q, double energy, const Vector& g);

  // For methods that hide their iterates: call it at every evaluation; true = stop now.
  bool is_out_of_time() const;

  void count_factorisation() { ++factorisations_; }
  PhaseTimes& phases() { return phases_; }
  double tolerance() const { return tolerance_; }  // of this round, on the relative residual

  // --- for solve() -------------------------------------------------------------------------------------
  void begin_round(int round, double tolerance);
  int round() const { return round_; }
  int iterations() const { return iterations_; }
  bool is_cancelled() const { return cancelled_; }
  double seconds() const { return wall_seconds() - start_; }
  long factorisations() const { return factorisations_; }
  std::vector<Iteration> take_trace() { return std::move(trace_); }

 private:
  Objective& objective_;
  const StopRule& stop_;
  const Observer& observer_;
  double tolerance_;
  double start_;
  int round_ = 0;
  int iterations_ = 0;
  bool is_first_of_round_ = true;
  bool cancelled_ = false;
  long factorisations_ = 0;
  Vector last_;
  std::vector<Iteration> trace_;
  PhaseTimes phases_;
};

}  // namespace coapt
