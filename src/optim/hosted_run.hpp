// The objective as seen by a minimiser that owns its loop (Ceres, NLopt): evaluations go through the
// monitor, iterates are reported to it, and its verdict, not the library's, ends the run.
#pragma once

#include "optim/monitor.hpp"

#include <optional>

namespace coapt {

class HostedRun {
 public:
  // Evaluates at q and reports it as the first iterate; status() tells whether there is anything to do.
  HostedRun(Monitor& monitor, const Vector& q);

  // Energy at q and its gradient; +infinity where either is not finite or the run has ended.
  double evaluate(const Vector& q, Vector& g);

  // For a library that names its iterates: the point q of an earlier evaluation was accepted.
  // Returns false when the run has ended.
  bool accept(const Vector& q);

  // For a library that hides its iterates: accepts the last evaluation if it improves on the last
  // accepted one, in energy or, where energies differ by round-off alone, in the size of the gradient.
  bool accept_if_better();

  // To be called before each attempt of the library. From the second on the last one gave up at the last
  // accepted iterate; a change of energy is then measured by the work of the forces from there,
  // 1/2 (g + g_0) . (q - q_0): exact for a quadratic energy and, unlike a difference of two sums, free of
  // their round-off. Returns false when the last attempt has gained too little to try again.
  bool begin_attempt();

  const std::optional<Status>& status() const { return status_; }
  const Vector& q() const { return accepted_.q; }  // last accepted iterate

 private:
  struct Evaluation {
    Vector q, g;
    double energy = 0;
  };
  void report(const Evaluation& evaluation);

  Monitor& monitor_;
  std::optional<Status> status_;
  Evaluation last_, accepted_;
  std::optional<Evaluation> base_;  // of the work; none before the first restart
  int attempts_ = 0;
  double gradient_at_attempt_ = kInfinity;
  int refused_ = 0;  // evaluations in a row that were not finite
};

}  // namespace coapt
