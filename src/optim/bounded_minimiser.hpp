// Minimisers of functions of few variables within bounds, of which every evaluation is expensive: what tunes
// the parameters of an equilibrium. (A Solver finds the equilibrium itself.)
#pragma once

#include "core/types.hpp"

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>

namespace coapt {

// Variables z of like size; a function asked twice for the same z answers the second time from memory.
class BoundedFunction {
 public:
  virtual ~BoundedFunction() = default;

  virtual const Vector& low() const = 0;  // bounds, low <= high, finite
  virtual const Vector& high() const = 0;

  // Value at z, and its gradient where that is not null. +infinity where the function cannot be evaluated;
  // the gradient is then not set. Pre: z is within the bounds.
  virtual double value(const Vector& z, Vector* gradient) = 0;

  // Of a function that is the sum of squares of residuals: these, and their derivatives where `jacobian` is
  // not null (one row for each). False where they cannot be evaluated.
  virtual bool has_residuals() const { return false; }
  virtual bool residuals(const Vector& /*z*/, Vector& /*r*/, Eigen::MatrixXd* /*jacobian*/) { return false; }

  // Whether the caller wants an end now; nothing is evaluated any more, and every value is +infinity.
  virtual bool is_over() const = 0;
};

struct BoundedStop {
  double step = 1e-3;  // of any variable: smaller ones end the search
  double gain = 1e-6;  // relative, of the value: a smaller one that is to be expected ends the search
  double enough = 0;   // a value below which the search ends
  // Of the first step, over the greatest diagonal of J^T J: more keeps numbers of little influence, and all
  // that few residuals leave open, nearer to the start.
  double damping = 1e-3;
};

struct BoundedOutcome {
  bool has_converged = false;  // by the method's own criterion, at these tolerances
  std::string message;         // one sentence, without a full stop
};

// Keeps nothing from one call to the next. The function remembers where it was least.
class BoundedMinimiser {
 public:
  virtual ~BoundedMinimiser() = default;
  virtual std::string_view name() const = 0;
  virtual bool needs_residuals() const = 0;

  // Pre: start is within the bounds and can be evaluated; residuals are there where they are needed.
  virtual BoundedOutcome minimise(BoundedFunction& function, const Vector& start,
                                  const BoundedStop& stop) = 0;
};

using BoundedMinimiserTable = std::map<std::string, std::function<std::unique_ptr<BoundedMinimiser>()>>;

// "gauss_newton": steps of Levenberg and Marquardt, each the exact minimum of the damped linearised problem
// within the bounds (Nielsen's update of the damping: Madsen, Nielsen & Tingleff 2004). A trial that cannot
// be evaluated, or is no better, raises the damping. It has converged where the undamped step is short or
// promises little, or where no step of `step` or more lowers the value, whichever its damping.
BoundedMinimiserTable built_in_minimisers();

// The s with low <= s <= high that minimises s.A s/2 + g.s, by an active-set method. Pre: A is symmetric and
// positive definite, low <= 0 <= high.
Vector bounded_step(const Eigen::MatrixXd& A, const Vector& g, const Vector& low, const Vector& high);

}  // namespace coapt
