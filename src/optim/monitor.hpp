// Watches one run for every solver alike: trace, stop rules, time by phase, counters, cancellation.
#pragma once

#include "optim/solver.hpp"
#include "optim/stability/equilibrium_watch.hpp"

#include <limits>
#include <optional>

namespace coapt {

class Monitor {
 public:
  Monitor(Objective& objective, const StopRule& stop, const Observer& observer);

  // --- for solvers -----------------------------------------------------------------------------------
  // Evaluations of the objective, timed by phase "gradient", "value", "hessian". An exception from a term
  // counts as a state that cannot be evaluated: +infinity, and a gradient that is not a number.
  double value(const Vector& q);
  double gradient(const Vector& q, Vector& g);
  double hessian(const Vector& q, Vector& g, Eigen::SparseMatrix<double>& h, Projection projection);

  // The greatest admissible s <= most along a direction (Objective::step_limit), timed by phase
  // "collisions".
  double step_limit(const Vector& q, const Vector& direction, double most);

  // The change of an energy near `energy` that may be nothing but round-off. A sum of terms that almost
  // cancel is noisier than its own size tells: the largest force times the extent of the unknowns is the
  // work against which positions are rounded.
  double energy_noise(double energy) const;

  // Call once per accepted iterate, the start included. Returns why to stop, or nothing to go on: among
  // the reasons that many iterates in a row have lowered neither the energy nor the residual.
  // time: simulated since the round began, of a method that has one [s].
  std::optional<Status> accept(const Vector& q, double energy, const Vector& g, double time = 0);

  // For methods that hide their iterates: call it at every evaluation; true = stop now.
  bool is_out_of_time() const;

  void count_factorisation() { ++factorisations_; }
  PhaseTimes& phases() { return phases_; }
  double tolerance() const { return tolerance_; }  // of this round, on the relative residual

  // --- for solve() -------------------------------------------------------------------------------------
  // Asked at each accepted iterate whether the run has no equilibrium to find. It must outlive the run.
  void set_watch(EquilibriumWatch* watch) { watch_ = watch; }
  void begin_outer_iteration(int number, double tolerance, bool is_descent = true);
  void set_path(double share) { path_ = share; }  // done, of the iterates to come: see Iteration::path
  // Ends minimisations after so many more iterations than now; what the whole run may take still holds.
  void limit_iterations(int count) { most_iterations_ = iterations_ + count; }
  bool has_reached_limit() const { return iterations_ >= most_iterations_; }
  void lift_limit() { most_iterations_ = std::numeric_limits<int>::max(); }
  void count_certificate(int factorisations) {
    factorisations_ += factorisations;
    of_certificates_ += factorisations;
  }
  int outer_iteration() const { return outer_iteration_; }
  int iterations() const { return iterations_; }
  bool is_cancelled() const { return cancelled_; }
  double seconds() const { return wall_seconds() - start_; }
  long factorisations() const { return factorisations_; }
  long factorised_steps() const { return factorisations_ - of_certificates_; }
  std::vector<Iteration> take_trace() { return std::move(trace_); }

 private:
  Objective& objective_;
  const StopRule& stop_;
  const Observer& observer_;
  double tolerance_;
  double start_;
  int outer_iteration_ = 0;
  bool is_descent_ = true;
  double path_ = kNaN;
  double time_before_ = 0;  // simulated, before this round [s]
  int iterations_ = 0, most_iterations_ = std::numeric_limits<int>::max();
  bool is_first_of_outer_iteration_ = true;
  double best_energy_ = kInfinity, best_residual_ = kInfinity;  // of this round
  int last_gain_ = 0, last_residual_gain_ = 0;                  // iterations of the last improvements
  bool cancelled_ = false;
  EquilibriumWatch* watch_ = nullptr;
  long factorisations_ = 0, of_certificates_ = 0;
  Vector last_;
  double extent_ = 0, first_extent_ = 0;  // of the unknowns [length]
  std::vector<Iteration> trace_;
  PhaseTimes phases_;
};

}  // namespace coapt
