#include "optim/move_prescribed.hpp"

#include "optim/harmonic_extension.hpp"

#include <algorithm>
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

namespace {

// Whether the prescribed nodes can go from `start` to `x` with the free ones carried along. Leaves them at x.
enum class Way { Free, Collision, Overload };
Way way_to(const Points& x, const Points& start, Objective& objective, const Vector& q, Vector& carried) {
  carried = extended_harmonically(objective, q, x);
  objective.prescribe(x);
  if (objective.step_limit(start, objective.positions(carried) - start, 1) < 1) return Way::Collision;
  return is_finite(objective, carried) ? Way::Free : Way::Overload;
}

}  // namespace

Move move_prescribed(const MotionPath& motion, double from, double to, Objective& objective, Vector& q) {
  const Points start = objective.positions(q);
  bool is_overloaded = false;
  Vector carried;
  for (double t = to; t > from; t = from + 0.5 * (t - from)) {
    const Way way = way_to(motion.positions(t), start, objective, q, carried);
    if (way == Way::Free) {
      q = carried;
      return {t, is_overloaded};
    }
    is_overloaded = way == Way::Overload;
    objective.prescribe(start);
    if (t - from < kLeastMotion) break;
  }
  return {from, is_overloaded};
}

std::string blocked_parts(const MotionPath& motion, double at, Objective& objective, const Vector& q) {
  const Points start = objective.positions(q),
               further = motion.positions(std::min(1.0, at + 2 * kLeastMotion));
  std::string names;
  Vector carried;
  for (const MotionPath::Part& part : motion.parts) {
    Points x = start;
    for (const int node : part.nodes) x.col(node) = further.col(node);
    if (way_to(x, start, objective, q, carried) != Way::Free)
      names += (names.empty() ? "" : ", ") + part.name;
    objective.prescribe(start);
  }
  return names;
}

}  // namespace coapt
