#include "optim/move_prescribed.hpp"

#include "optim/harmonic_extension.hpp"

#include <cmath>
#include <exception>

namespace coapt {

bool is_finite(Objective& objective, const Vector& q) {
  Vector g;
  try {
    return std::isfinite(objective.gradient(q, g)) && std::isfinite(g.squaredNorm());
  } catch (const std::exception&) {  // of a term that a program wrote
    return false;
  }
}

Move move_prescribed(const MotionPath& motion, double from, double to, Objective& objective, Vector& q) {
  const Points start = objective.positions(q);
  bool is_overloaded = false;
  for (double t = to; t > from; t = from + 0.5 * (t - from)) {
    const Points x = motion.positions(t);
    const Vector carried = extended_harmonically(objective, q, x);
    objective.prescribe(x);
    const bool is_free = objective.step_limit(start, objective.positions(carried) - start, 1) == 1;
    if (is_free && is_finite(objective, carried)) {
      q = carried;
      return {t, is_overloaded};
    }
    is_overloaded = is_free;
    objective.prescribe(start);
    if (t - from < kLeastMotion) break;
  }
  return {from, is_overloaded};
}

}  // namespace coapt
