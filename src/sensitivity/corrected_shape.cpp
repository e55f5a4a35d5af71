// Where a solve for other numbers would end, by corrections of a shape that is near.
#include "sensitivity/tracked_equilibrium.hpp"

#include <algorithm>
#include <cmath>

namespace coapt {
namespace {

constexpr double kLinear = 1e-2;    // residual of the linear system of a correction, relative
constexpr double kClosingIn = 0.5;  // of the correction before by the same tangent; more leads nowhere
constexpr int kMostSteps = 12;      // corrections of one shape
constexpr int kMostTangents = 2;    // of one shape

double greatest(const Points& motion, const std::vector<int>& nodes) {
  double most = 0;
  for (const int node : nodes) most = std::max(most, motion.col(node).squaredNorm());
  return std::sqrt(most);
}

}  // namespace

// Successive corrections by one tangent tell whether they close in: each is below its predecessor by the
// same factor, or worse (the natural monotonicity test of Deuflhard 2011, Newton Methods for Nonlinear
// Problems, section 2.1). Where they do not, the tangent is taken anew.
CorrectedShape TrackedEquilibrium::corrected(const Vector& numbers, const Points& start,
                                             const std::vector<int>& nodes, double until, double most,
                                             const std::function<void(const CorrectedShape&)>& look) {
  require_solved();
  require_sound(numbers);
  const Points home = positions();
  const auto back = [&] {
    assign(solved_value_);
    objective_.prescribe(home);
    is_tangent_ready_ = false;  // the objective knows the skew part of one tangent alone
  };
  CorrectedShape found;
  try {
    assign(numbers);
    found.x = start;
    for (const auto& parameter : parameters_) parameter->place(found.x);
    objective_.prescribe(found.x);
    close_in(found, nodes, until, most);
    found.is_found = found.is_found && objective_.step_limit(home, found.x - home, 1) == 1;
    if (found.is_found && look) look(found);
  } catch (...) {
    back();
    throw;
  }
  back();
  return found;
}

// Pre: the numbers are in the terms and the prescribed nodes in place, in `found.x` as well.
void TrackedEquilibrium::close_in(CorrectedShape& found, const std::vector<int>& nodes, double until,
                                  double most) {
  const Points start = found.x;
  const int negative = system_.negative_modes();
  TangentSystem tangent(options_.factorisation);
  Vector q = objective_.unknowns(start), last_q = q, g, step;
  double before = kInfinity;
  bool is_new = true;  // the tangent is to be taken here
  while (found.steps < kMostSteps && !found.is_found && found.distance <= most) {
    if (is_new) {
      if (found.tangents++ == kMostTangents) return;
      if (objective_.has_circulatory_force()) objective_.set_path_anchor(q);
      if (!tangent.assemble(objective_, q, g) || !tangent.factorise(objective_, q)) return;
      before = kInfinity;
    } else if (!std::isfinite(objective_.gradient(q, g)) || !g.allFinite()) {
      return;
    }
    ++found.steps;
    const bool is_solved = tangent.solve(-g, step, kLinear) < 2 * kLinear;
    const Points x = objective_.positions(q + step);
    const double length = greatest(x - found.x, nodes), ratio = length / before;
    const bool closes_in = is_solved && std::isfinite(length) && (ratio <= kClosingIn || length <= until);
    if (!closes_in && is_new) return;
    is_new = !closes_in;
    if (is_new) {
      if (!(ratio <= 1)) q = last_q;  // the step that led here was none
      found.x = objective_.positions(q);
      continue;
    }
    last_q = q;
    q += step;
    found.x = x;
    found.distance = greatest(x - start, nodes);
    found.left = std::isfinite(before) ? length * std::min(ratio / (1 - ratio), 1.0) : length;
    found.is_found = found.left <= until;
    // Another number of negative eigenvalues: it may be a saddle, unless they were those of the way.
    if (found.is_found && tangent.negative_modes() != negative) {
      found.is_found = false;
      is_new = true;
    }
    before = length;
  }
}

}  // namespace coapt
