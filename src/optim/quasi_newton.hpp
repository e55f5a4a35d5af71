// The loop that quasi-Newton methods share: direction, line search, update. A method is what it remembers.
#pragma once

#include "optim/monitor.hpp"

namespace coapt {

// An approximation of the inverse Hessian, learned from steps and the changes of the gradient over them.
class InverseHessian {
 public:
  virtual ~InverseHessian() = default;
  virtual void visit(const Vector& /*q*/) {}                 // called at each iterate, before its direction
  virtual bool is_empty() const = 0;                         // nothing known: the direction is -g
  virtual void clear() = 0;                                  // forgets; called often enough it is empty
  virtual Vector direction(const Vector& g) = 0;             // -H g
  virtual void learn(const Vector& s, const Vector& y) = 0;  // step and change of the gradient
};

// Whether a pair carries curvature beyond round-off; others would make the approximation indefinite.
inline bool has_curvature(const Vector& s, const Vector& y) { return s.dot(y) > 1e-14 * s.norm() * y.norm(); }

// Descends from q until the monitor says stop or no step can be found even along steepest descent.
// q is the last accepted iterate.
Status descend(InverseHessian& inverse, Vector& q, Monitor& monitor);

}  // namespace coapt
