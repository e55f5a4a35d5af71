#include "optim/dynamic/time_integrator.hpp"

#include <algorithm>
#include <cmath>

namespace coapt {
namespace {

constexpr int kRenewal = 20;  // steps between bounds of the highest frequency
// Share of the longest stable step. A step from rest is one along the gradient, which is stable up to
// 1/sqrt(2) only.
constexpr double kSafety = 0.8, kSafetyFromRest = 0.5;
constexpr double kMostGain = 1;  // of energy in a step, over the kinetic energy: it swings even if stable

class SemiImplicitEuler final : public TimeIntegrator {
 public:
  SemiImplicitEuler(const TimeIntegratorContext& context, const DynamicOptions& options)
      : context_(context),
        adapts_(options.adapts_steps),
        safety_(options.has_kinetic_damping ? kSafetyFromRest : kSafety),
        drag_(Vector::Constant(context.mass.size(),
                               options.relaxation_time > 0 ? 1 / options.relaxation_time : 0)) {
    if (options.drag == Drag::Equal && drag_.size() > 0)
      drag_.array() *= context.mass.mean() / context.mass.array();
  }

  bool step(double h, Motion& at) override {
    next_.v = (at.v.array() - h * (at.g - context_.applied).array() / context_.mass.array()) /
              (1 + h * drag_.array());
    // What is in the way takes the velocity of all: contact is inelastic.
    next_.v *= context_.monitor.step_limit(at.q, next_.v, h) / h;
    next_.q = at.q + h * next_.v;
    next_.energy = context_.monitor.gradient(next_.q, next_.g);
    if (!std::isfinite(next_.energy) || !next_.g.allFinite()) return false;
    next_.time = at.time + h;
    // What was slack when the frequencies were bounded may have become taut.
    const double before = at.energy + kinetic_energy(at, context_.mass),
                 kinetic = kinetic_energy(next_, context_.mass);
    if (adapts_ &&
        next_.energy + kinetic > before + kMostGain * kinetic + context_.monitor.energy_noise(before)) {
      age_ = 0;
      return false;
    }
    std::swap(at, next_);
    return true;
  }

  double next_step(double h, const Motion& at) override {
    if (age_++ % kRenewal == 0) stable_step_ = longest_stable_step(at);
    return std::min(2 * h, safety_ * stable_step_);
  }

 private:
  // The eigenvalues of M^-1 H are at most its largest sum of magnitudes in a row.
  double longest_stable_step(const Motion& at) {
    if (at.q.size() == 0) return kInfinity;  // nothing is free
    context_.monitor.hessian(at.q, work_, hessian_, Projection::PositiveSemidefinite);
    work_.setZero(at.q.size());
    for (int column = 0; column < hessian_.outerSize(); ++column)
      for (SparseMatrix::InnerIterator entry(hessian_, column); entry; ++entry) {
        if (entry.row() < entry.col()) continue;  // blocks of the diagonal are whole
        work_[entry.row()] += std::abs(entry.value());
        if (entry.row() > entry.col()) work_[entry.col()] += std::abs(entry.value());
      }
    const double square = (work_.array() / context_.mass.array()).maxCoeff();
    return square > 0 ? 2 / std::sqrt(square) : kInfinity;
  }

  TimeIntegratorContext context_;
  bool adapts_;
  double safety_;
  Vector drag_;  // of each unknown [1/time]
  int age_ = 0;
  double stable_step_ = kInfinity;
  Motion next_;
  Vector work_;
  SparseMatrix hessian_;
};

}  // namespace

std::unique_ptr<TimeIntegrator> make_semi_implicit_euler(const TimeIntegratorContext& context,
                                                         const DynamicOptions& options) {
  return std::make_unique<SemiImplicitEuler>(context, options);
}

}  // namespace coapt
