#include "optim/monitor.hpp"

#include <cmath>
#include <exception>
#include <new>

namespace coapt {
namespace {

constexpr double kEnergyNoise = 1e-12;  // relative to the energy
constexpr double kWorkNoise = 1e-14;    // relative to force times extent
constexpr size_t kUsualTrace = 1000;    // iterates for which the trace never grows
constexpr int kPatience = 1000;         // iterates without gain
constexpr int kPathPatience = 10000;    // iterates whose residual gains nothing, where no energy has to
constexpr double kRunaway = 1e12;       // growth of the unknowns' extent that no equilibrium explains
constexpr double kFarGrowth = 1e4;      // growth that few do: only while the residual falls
constexpr int kFarPatience = 400;       // iterates

template <typename Evaluate>
double guarded(Vector& g, Eigen::Index size, const Evaluate& evaluate) {
  try {
    return evaluate();
  } catch (const std::bad_alloc&) {
    throw;  // too little memory says nothing about the shape
  } catch (const std::exception&) {
    g.setConstant(size, kNaN);
    return kInfinity;
  }
}

}  // namespace

Monitor::Monitor(Objective& objective, const StopRule& stop, const Observer& observer)
    : objective_(objective),
      stop_(stop),
      observer_(observer),
      tolerance_(stop.tolerance),
      start_(wall_seconds()) {
  trace_.reserve(kUsualTrace);
}

double Monitor::value(const Vector& q) {
  PhaseTimer timer(phases_, "value");
  Vector none;
  return guarded(none, 0, [&] { return objective_.value(q); });
}

double Monitor::gradient(const Vector& q, Vector& g) {
  PhaseTimer timer(phases_, "gradient");
  return guarded(g, q.size(), [&] { return objective_.gradient(q, g); });
}

double Monitor::hessian(const Vector& q, Vector& g, Eigen::SparseMatrix<double>& h, Projection projection) {
  PhaseTimer timer(phases_, "hessian");
  return guarded(g, q.size(), [&] { return objective_.hessian(q, g, h, projection); });
}

double Monitor::step_limit(const Vector& q, const Vector& direction, double most) {
  if (objective_.step_limiting_term() == nullptr) return most;
  PhaseTimer timer(phases_, "collisions");
  return objective_.step_limit(q, direction, most);
}

bool Monitor::is_out_of_time() const { return seconds() >= stop_.max_seconds; }

double Monitor::energy_noise(double energy) const {
  return kEnergyNoise * std::abs(energy) + kWorkNoise * objective_.largest_force() * extent_;
}

void Monitor::begin_outer_iteration(int number, double tolerance, bool is_descent) {
  outer_iteration_ = number;
  is_descent_ = is_descent;
  tolerance_ = tolerance;
  is_first_of_outer_iteration_ = true;
  time_before_ = trace_.empty() ? 0 : trace_.back().time;
  best_energy_ = best_residual_ = kInfinity;
  last_gain_ = last_residual_gain_ = iterations_;
}

std::optional<Status> Monitor::accept(const Vector& q, double energy, const Vector& g, double time) {
  // Forces whose squares overflow cannot be measured either.
  if (!std::isfinite(energy) || !std::isfinite(g.squaredNorm())) return Status::NonFinite;
  if (!is_first_of_outer_iteration_) ++iterations_;
  is_first_of_outer_iteration_ = false;

  Iteration now;
  now.iteration = iterations_;
  now.outer_iteration = outer_iteration_;
  now.is_descent = is_descent_;
  now.path = path_;
  now.energy = energy;
  now.residual = objective_.relative_residual(q, g);
  now.step = last_.size() == q.size() && q.size() > 0 ? (q - last_).lpNorm<Eigen::Infinity>() : 0;
  now.seconds = seconds();
  now.time = time_before_ + time;
  now.evaluations = objective_.counts().gradient + objective_.counts().hessian;
  last_ = q;
  objective_.advance(q);
  extent_ = q.size() == 0 ? 0 : q.maxCoeff() - q.minCoeff();
  if (first_extent_ == 0 && q.size() > 0) {
    const Points x = objective_.positions(q);
    first_extent_ = x.maxCoeff() - x.minCoeff();
  }
  trace_.push_back(now);

  if (observer_ && !observer_(now, q)) {
    cancelled_ = true;
    return Status::Cancelled;
  }
  // Before the residual is asked: what is out of balance on a shape that has run away may be nothing beside
  // the reactions there.
  const bool is_far = extent_ > kFarGrowth * first_extent_;
  if (extent_ > kRunaway * first_extent_ || (is_far && iterations_ - last_residual_gain_ > kFarPatience))
    return Status::NoEquilibrium;
  if (now.residual <= tolerance_) return Status::Converged;
  if (is_out_of_time()) return Status::TimeLimit;
  if (iterations_ >= std::min(stop_.max_iterations, most_iterations_)) return Status::IterationLimit;
  // Small gains add up: they are measured from the last iterate that counted as one.
  const bool is_closer = now.residual < 0.9 * best_residual_;
  if (is_closer) last_residual_gain_ = iterations_;
  if (is_closer || energy < best_energy_ - energy_noise(energy)) {
    last_gain_ = iterations_;
    best_energy_ = std::min(best_energy_, energy);
    best_residual_ = std::min(best_residual_, now.residual);
  }
  if (watch_ != nullptr && watch_->has_no_equilibrium(objective_, q, now.residual))
    return Status::NoEquilibrium;
  if (iterations_ - last_gain_ >= kPatience) return Status::Stalled;
  // A force without potential can drive a shape in circles for ever: its work along the path always falls.
  if (objective_.has_circulatory_force() && iterations_ - last_residual_gain_ >= kPathPatience)
    return Status::Stalled;
  return std::nullopt;
}

}  // namespace coapt
