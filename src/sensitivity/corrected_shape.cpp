// Where a solve for other numbers would end, by corrections of a shape that is near.
#include "sensitivity/tracked_equilibrium.hpp"

#include <algorithm>
#include <cmath>

namespace coapt {
namespace {

constexpr double kLinear = 1e-2;     // residual of the linear system of a correction, relative
constexpr double kClosingIn = 0.5;   // of the correction before by the same tangent; more leads nowhere
constexpr double kLeastRate = 0.25;  // that is believed: what is soft comes in late, and creeps
constexpr double kNothing = 0.01;    // of what may be left: rounding, which need not shrink
constexpr int kMostSteps = 12;       // corrections of one shape
constexpr int kMostTangents = 2;     // of one shape

double greatest(const Points& motion, const std::vector<int>& nodes) {
  double most = 0;
  for (const int node : nodes) most = std::max(most, motion.col(node).squaredNorm());
  return std::sqrt(most);
}

}  // namespace

// The numbers are put into the terms, and taken out again, without measuring the reference state anew: no
// residual is asked for between.
template <typename Work>
void TrackedEquilibrium::with_numbers(const Vector& numbers, Points& start, const Work& work) {
  require_solved();
  require_sound(numbers);
  const Points home = positions();
  const auto back = [&] {
    assign_numbers(solved_value_);
    objective_.prescribe(home);
    is_tangent_ready_ = false;  // the objective knows the skew part of one tangent alone
  };
  try {
    assign_numbers(numbers);
    for (const auto& parameter : parameters_) parameter->place(start);
    objective_.prescribe(start);
    work(home);
  } catch (...) {
    back();
    throw;
  }
  back();
}

double TrackedEquilibrium::step_by_solved_factor(const Vector& numbers, const Points& start,
                                                 const std::vector<int>& nodes) {
  double length = kInfinity;
  Points x = start;
  with_numbers(numbers, x, [&](const Points&) {
    const Vector q = objective_.unknowns(x);
    Vector g, step;
    if (objective_.has_circulatory_force()) objective_.set_path_anchor(q);
    if (!system_.has_factor() || !std::isfinite(objective_.gradient(q, g)) || !g.allFinite()) return;
    system_.apply_factor(g, step);
    length = greatest(objective_.positions(q + step) - x, nodes);
  });
  return length;
}

// Successive corrections by one tangent tell whether they close in: each is below its predecessor by the
// same factor, or worse (the natural monotonicity test of Deuflhard 2011, Newton Methods for Nonlinear
// Problems, section 2.1). A long first one hides what is soft and creeps, so that two have to say it. Where
// they do not the tangent is taken anew, once; where it has other signs than that of the solved shape, the
// start is taken for too far.
CorrectedShape TrackedEquilibrium::corrected(const Vector& numbers, const Points& start,
                                             const std::vector<int>& nodes, double until, double most,
                                             const std::function<void(const CorrectedShape&)>& look) {
  CorrectedShape found;
  found.x = start;
  with_numbers(numbers, found.x, [&](const Points& home) {
    close_in(found, nodes, until, most);
    found.is_found = found.is_found && objective_.step_limit(home, found.x - home, 1) == 1;
    if (found.is_found && look) look(found);
  });
  return found;
}

// Pre: the numbers are in the terms and the prescribed nodes in place, in `found.x` as well.
void TrackedEquilibrium::close_in(CorrectedShape& found, const std::vector<int>& nodes, double until,
                                  double most) {
  const Points start = found.x;
  for (int tangent = 0; tangent < kMostTangents && !found.is_found && found.distance <= most; ++tangent)
    if (!close_in_by_one_tangent(found, start, nodes, until, most)) return;
}

// With the tangent at found.x. Returns whether another one may lead on: this one's corrections did not shrink
// fast enough.
bool TrackedEquilibrium::close_in_by_one_tangent(CorrectedShape& found, const Points& start,
                                                 const std::vector<int>& nodes, double until, double most) {
  Vector q = objective_.unknowns(found.x), g, step;
  if (objective_.has_circulatory_force()) objective_.set_path_anchor(q);
  if (!near_.assemble(objective_, q, g)) return false;
  const int negative = negative_modes_;
  const bool is_factorised = near_.factorise_exactly();
  if (!is_factorised && (negative == 0 || !near_.factorise(objective_, q))) return false;
  if (near_.negative_modes() != negative) return false;
  double before = kInfinity;
  bool was_near = false;
  bool is_exact = !is_factorised;  // else by the factor alone
  for (bool is_first = true; found.steps < kMostSteps && found.distance <= most; is_first = false) {
    if (!is_first && (!std::isfinite(objective_.gradient(q, g)) || !g.allFinite())) return false;
    ++found.steps;
    if (!is_exact)
      near_.apply_factor(-g, step);
    else if (!(near_.solve(-g, step, kLinear) < 2 * kLinear))
      return false;
    const Points x = objective_.positions(q + step);
    const double length = greatest(x - found.x, nodes), ratio = length / before;
    if (!std::isfinite(length)) return false;
    if (!(ratio <= kClosingIn || length <= kNothing * until)) {
      if (is_exact || near_.is_of_all()) return true;
      is_exact = true;  // what the skew part moves has not come in yet: counted anew
      before = kInfinity;
      was_near = false;
      continue;
    }
    q += step;
    found.x = x;
    found.distance = greatest(x - start, nodes);
    const double rate = std::max(ratio, kLeastRate);
    found.left = std::isfinite(before) ? length * std::min(rate / (1 - rate), 1.0) : length;
    const bool is_near = found.left <= until;
    found.is_found = is_near && was_near;
    if (found.is_found) return false;
    was_near = is_near;
    before = length;
  }
  return false;
}

}  // namespace coapt
