#include "sensitivity/tracked_equilibrium.hpp"

#include "core/error.hpp"
#include "core/number_text.hpp"
#include "optim/newton.hpp"
#include "optim/slack_junctions.hpp"

#include <algorithm>
#include <cmath>

namespace coapt {
namespace {

// Residuals of linear systems: of a prediction, whose own error is of second order; and of a Newton step, as
// a share of what is asked of its end, or of what second order leaves, and within these limits.
constexpr double kPrediction = 1e-5;
constexpr double kStepShare = 0.1, kForcing = 0.03, kLeastStep = 1e-9, kMostStep = 1e-2;
constexpr double kSuspicious = 1;  // jump over the predicted travel
constexpr double kNotBack = 0.1;   // of the jump, that a shape may miss its start by when it comes back
constexpr double kNoise = 1e-7;    // of the extent: jumps below say nothing
constexpr int kHalvings = 6;       // of a Newton step that betters nothing
constexpr int kMostNearby = 10;    // applications of a factor of a state nearby: a fresh one costs as much
constexpr char kSingular[] =
    "equilibrium: the tangent is singular or not finite, derivatives are not defined here";

double greatest(const Points& v) {
  return v.cols() == 0 ? 0 : std::sqrt(v.colwise().squaredNorm().maxCoeff());
}

}  // namespace

TrackedEquilibrium::TrackedEquilibrium(Objective& objective, Vector q, TrackingOptions options)
    : objective_(objective),
      options_(std::move(options)),
      q_(std::move(q)),
      system_(options_.factorisation),
      near_(options_.factorisation) {}

size_t TrackedEquilibrium::add(std::unique_ptr<Parameter> parameter) {
  std::vector<std::string> defects;
  if (std::string clash = clash_within(*parameter); !clash.empty()) defects.push_back(std::move(clash));
  for (const auto& other : parameters_) {
    if (other->name() == parameter->name())
      throw InputError("parameter \"" + parameter->name() + "\": there is one of that name already");
    if (std::string clash = clash_of(*parameter, *other); !clash.empty()) defects.push_back(std::move(clash));
  }
  if (!defects.empty()) throw InputError(defects);
  const Vector value = parameter->value();
  first_.push_back(number_count_);
  number_count_ += static_cast<int>(value.size());
  const auto append = [&](Vector& to) {
    to.conservativeResize(number_count_);
    to.tail(value.size()) = value;
  };
  append(solved_value_);
  if (anchor_) append(anchor_->value);
  parameters_.push_back(std::move(parameter));
  return parameters_.size() - 1;
}

Vector TrackedEquilibrium::value() const {
  Vector all(number_count_);
  for (size_t k = 0; k < parameters_.size(); ++k) {
    const Vector value = parameters_[k]->value();
    all.segment(first_[k], value.size()) = value;
  }
  return all;
}

Vector TrackedEquilibrium::numbers_of(const Parameter& parameter, size_t index, const Vector& all) const {
  return all.segment(first_[index], parameter.value().size());
}

void TrackedEquilibrium::require_sound(const Vector& value) const {
  if (value.size() != number_count_)
    throw InputError("parameters: " + std::to_string(value.size()) + " numbers were given; there are " +
                     std::to_string(number_count_));
  std::vector<std::string> defects;
  for (size_t k = 0; k < parameters_.size(); ++k)
    if (std::string defect = parameters_[k]->defect(numbers_of(*parameters_[k], k, value)); !defect.empty())
      defects.push_back(std::move(defect));
  if (!defects.empty()) throw InputError(defects);
}

void TrackedEquilibrium::set(const Vector& value) {
  require_sound(value);
  // While the terms are still those of the solved shape: what the prediction needs of them.
  if (is_solved_) ready_tangent();
  assign(value);
}

void TrackedEquilibrium::assign(const Vector& value) {
  assign_numbers(value);
  objective_.remeasure_reference();
}

void TrackedEquilibrium::assign_numbers(const Vector& value) {
  for (size_t k = 0; k < parameters_.size(); ++k)
    if (const Vector numbers = numbers_of(*parameters_[k], k, value); numbers != parameters_[k]->value())
      parameters_[k]->set(numbers);
}

void TrackedEquilibrium::resume_at(const Vector& value, const Vector& q) {
  require_sound(value);
  if (q.size() != q_.size())
    throw InputError("resume: " + std::to_string(q.size()) + " unknowns were given; there are " +
                     std::to_string(q_.size()));
  assign(value);
  q_ = q;
  const Points x = prescribed();
  objective_.prescribe(x);
  q_ = objective_.unknowns(x);
  is_solved_ = is_tangent_ready_ = false;
  kinks_.reset();
  states_.reset();
  solved_value_ = value;
}

Points TrackedEquilibrium::prescribed() const {
  Points x = objective_.positions(q_);
  for (const auto& parameter : parameters_) parameter->place(x);
  return x;
}

double TrackedEquilibrium::residual_at(const Vector& q) {
  if (objective_.has_circulatory_force()) objective_.set_path_anchor(q);
  return objective_.true_residual(q);
}

void TrackedEquilibrium::ready_tangent() {
  if (is_tangent_ready_) return;
  if (objective_.has_circulatory_force()) objective_.set_path_anchor(q_);
  if (!system_.assemble(objective_, q_, g_) || (!system_.has_factor() && !system_.factorise(objective_, q_)))
    throw InputError(kSingular);
  is_tangent_ready_ = true;
  is_nodal_ready_ = false;
}

// Each factor counts the negative eigenvalues of its own state.
void TrackedEquilibrium::factorise_tangent() {
  ready_tangent();
  if (!system_.is_fresh() && !system_.factorise(objective_, q_)) throw InputError(kSingular);
  negative_modes_ = system_.negative_modes();
}

// By the factor of a state nearby where few applications of it do. Pre: the tangent is assembled at q_.
double TrackedEquilibrium::solve_tangent(const Vector& b, Vector& x, double tolerance, bool is_transposed) {
  const auto solve = [&](int most) {
    return is_transposed ? system_.solve_transposed(b, x, tolerance, most)
                         : system_.solve(b, x, tolerance, most);
  };
  if (system_.is_fresh()) return solve(TangentSystem::kUnlimited);
  if (system_.has_factor())
    if (const double residual = solve(kMostNearby); residual <= tolerance) return residual;
  return system_.factorise(objective_, q_) ? solve(TangentSystem::kUnlimited) : kInfinity;
}

void TrackedEquilibrium::require_solved() const {
  if (!is_solved_ || solved_value_ != value())
    throw InputError(
        "equilibrium: derivatives are those of a solved shape; call solve() first, and see "
        "that it converged");
}

// A term of the caller's may throw anywhere on the way: the numbers are then those that were asked for, and
// nothing is solved.
WarmSolve TrackedEquilibrium::solve() {
  const Vector wanted = value();
  try {
    return solve_at(wanted);
  } catch (...) {
    is_solved_ = is_tangent_ready_ = false;
    assign(wanted);
    throw;
  }
}

// Pre: the numbers are `now`.
WarmSolve TrackedEquilibrium::solve_at(const Vector& now) {
  const double start = wall_seconds();
  Place from{q_, positions(), solved_value_, negative_modes_};
  const bool is_followed = is_solved_ && is_tangent_ready_;
  const Points none = Points::Zero(3, from.x.cols());
  const Points predicted =
      is_followed ? predicted_change(from, now) : objective_.fixed().select(prescribed() - from.x, none);
  WarmSolve report = move_to(from, predicted);
  if (is_solved_) {
    try {
      factorise_tangent();
    } catch (const InputError& error) {
      report.message += std::string("; ") + error.what();
    }
  }
  if (report.status == Status::Converged && is_followed && options_.checks_branch)
    report.lost_branch = check_branch(from, report);
  if (report.lost_branch)
    report.message +=
        "; the shape has changed to another branch of equilibria: when the change was undone, it "
        "came back " +
        number_text(report.lost_branch->distance) + " away from where it was";
  if (report.status == Status::Converged) {
    ElementStates states = element_states(objective_, positions());
    if (states_) report.switched = switches_between(objective_, *states_, states);
    states_ = std::move(states);
  }
  if (report.status == Status::Converged) check_anchor_in_time(report);
  report.seconds = wall_seconds() - start;
  return report;
}

// From a shape to that of the present values.
WarmSolve TrackedEquilibrium::move_to(const Place& from, const Points& predicted) {
  WarmSolve report;
  is_solved_ = is_tangent_ready_ = false;
  kinks_.reset();
  solved_value_ = value();
  if (!move_quickly(predicted, report)) {
    report.is_quick = false;
    objective_.prescribe(from.x);
    const Points to = objective_.fixed().select(from.x + predicted, from.x);
    Problem problem{objective_, from.q};
    if (to != from.x) problem.motion = {1, [&](double t) { return Points(from.x + t * (to - from.x)); }};
    SolverOptions method;
    method.factorisation = options_.factorisation;
    const Result result =
        coapt::solve(*make_newton(method), problem,
                     {options_.tolerance, options_.max_iterations, options_.max_seconds}, options_.observer);
    q_ = result.q;
    report.status = result.status;
    report.iterations = result.iterations;
    report.message = result.message;
    report.residual = residual_at(q_);
  }
  const Points moved = positions() - from.x;
  report.predicted = greatest(predicted);
  report.travel = greatest(moved);
  report.jump = greatest(moved - predicted);
  is_solved_ = report.status == Status::Converged;
  return report;
}

// Newton's method with the exact tangent from the predicted shape. False: it did not converge; q_ is then
// anywhere.
bool TrackedEquilibrium::move_quickly(const Points& predicted, WarmSolve& report) {
  const Points x = positions();
  if (objective_.step_limit(x, predicted, 1) < 1) return false;
  objective_.prescribe(x + predicted);
  q_ = objective_.unknowns(x + predicted);
  // The prediction leaves what is slack where it is, and lines may have become shorter.
  SlackJunctions junctions(objective_);
  junctions.slacken(q_);
  if (objective_.has_circulatory_force()) objective_.set_path_anchor(q_);
  if (!std::isfinite(objective_.gradient(q_, g_)) || !g_.allFinite()) return false;
  Vector direction, next_q, next_g;
  for (report.iterations = 0;; ++report.iterations) {
    report.residual = objective_.relative_residual(q_, g_);
    if (report.residual <= options_.tolerance) {
      report.residual = residual_at(q_);
      report.status = report.residual <= options_.tolerance ? Status::Converged : Status::Stalled;
      report.message = "converged at residual " + number_text(report.residual);
      return report.status == Status::Converged;
    }
    if (report.iterations == options_.quick_steps) return false;
    if (options_.observer &&
        !options_.observer({.iteration = report.iterations, .residual = report.residual}, q_))
      return false;  // the whole method asks again, and ends there
    if (!system_.assemble(objective_, q_, g_)) return false;
    const double asked =
        std::clamp(std::max(kStepShare * options_.tolerance, kForcing * report.residual * report.residual) /
                       report.residual,
                   kLeastStep, kMostStep);
    if (!(solve_tangent(-g_, direction, asked, false) < 2 * kMostStep)) return false;
    double step = objective_.step_limit(q_, direction, 1);
    bool is_better = false;
    for (int halving = 0; halving < kHalvings && !is_better; ++halving, step *= 0.5) {
      next_q = q_ + step * direction;
      is_better = std::isfinite(objective_.gradient(next_q, next_g)) && next_g.allFinite() &&
                  next_g.norm() < (1 - 0.1 * step) * g_.norm();
    }
    if (!is_better) return false;
    q_.swap(next_q);
    g_.swap(next_g);
    if (junctions.slacken(q_)) objective_.gradient(q_, g_);
    objective_.advance(q_);
  }
}

// A jump far beyond the prediction, or other signs of the eigenvalues, are put to the test: the change is
// undone, and a shape that does not come back has changed branches.
std::optional<LostBranch> TrackedEquilibrium::check_branch(const Place& from, const WarmSolve& report) {
  const double extent = objective_.extent(q_);
  const bool has_jumped = report.jump > std::max(kSuspicious * report.predicted, kNoise * extent);
  const int negative = negative_modes_;
  if (!has_jumped && negative == from.negative) return std::nullopt;
  const Place now{q_, positions(), value(), negative};
  const Points home = from.x - now.x, none = Points::Zero(3, home.cols());
  Points predicted = none;
  try {
    predicted = predict(from.value - now.value, kPrediction);
  } catch (const InputError&) {
  }  // from where it stands, then
  assign(from.value);
  const WarmSolve back = move_to(now, objective_.fixed().select(home, predicted));
  const double distance = held_distance(from.x);
  take_up(now);
  if (back.status != Status::Converged || distance > std::max(kNotBack * report.jump, kNoise * extent))
    return LostBranch{distance, report.jump, from.negative, negative};
  return std::nullopt;
}

}  // namespace coapt
