// The objective as seen by a minimiser that owns its loop (Ceres, NLopt): evaluations go through the
// monitor, iterates are reported to it, and its verdict, not the library's, ends the run.
//
// Such libraries carry absolute thresholds inside. They are therefore given scaled unknowns
// z = (q - origin) / length and a scaled energy, so that steps and gradients are of order one in any units
// and at any stage of convergence.
#pragma once

#include "optim/monitor.hpp"

#include <optional>

namespace coapt {

class ExternalSolverRun {
 public:
  // Evaluates at q and reports it as the first iterate; status() tells whether there is anything to do.
  ExternalSolverRun(Monitor& monitor, const Vector& q);

  // To be called before each attempt of the library, which then starts at z = 0: the last accepted
  // iterate. From the second attempt on a change of energy is measured by the work of the forces,
  // 1/2 (g + g_0) . (q - q_0): exact for a quadratic energy and, unlike a difference of two sums, free of
  // their round-off. Returns false when the last attempts have gained too little to try again.
  bool begin_attempt();

  // Scaled energy at z and its gradient; +infinity where either is not finite or the run has ended.
  double evaluate(const Vector& z, Vector& gradient);

  // For a library that names its iterates: the point z of an earlier evaluation was accepted.
  // Returns false when the run has ended.
  bool accept(const Vector& z);

  // For a library that hides its iterates: accepts the last evaluation if it improves on the last
  // accepted one, in energy or, where energies differ by round-off alone, in the size of the gradient.
  bool accept_if_better();

  const std::optional<Status>& status() const { return status_; }
  const Vector& q() const { return accepted_.q; }  // last accepted iterate

 private:
  struct Evaluation {
    Vector q, g;
    double energy = 0;
  };
  bool evaluate_last(const Vector& z);
  void report();

  Monitor& monitor_;
  std::optional<Status> status_;
  Evaluation last_, accepted_;
  Vector last_z_;
  Evaluation origin_;     // of this attempt
  double length_ = 1;     // scale of the unknowns in this attempt [length]
  double energy_ = 1;     // scale of the energy in this attempt [force x length]
  double last_step_ = 0;  // largest change of an unknown between the last two iterates [length]
  int attempts_ = 0, attempts_without_gain_ = 0;
  double gradient_at_attempt_ = kInfinity;
  int refused_ = 0;  // evaluations in a row that were not finite
};

}  // namespace coapt
