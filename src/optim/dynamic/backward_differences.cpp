#include "linear/gmres.hpp"
#include "optim/dynamic/time_integrator.hpp"
#include "optim/shifted_hessian.hpp"

#include <Eigen/IterativeLinearSolvers>

#include <algorithm>
#include <cmath>

namespace coapt {
namespace {

constexpr int kMostIterations = 6;  // of Newton's method in a step
constexpr int kFew = 2, kMany = 4;  // that make the next step longer, or shorter
constexpr double kGrowth = 2;       // below 1 + sqrt(2), up to which the method is stable
constexpr double kShrinkage = 0.5;  // of the step after one that took many
constexpr double kEnough = 2;       // out of balance, relative to the static force, at which a step ends
constexpr double kDecrease = 1e-4;  // share of the decrease promised by the slope that a step must keep
constexpr int kTrials = 12;         // halvings of a step
constexpr int kKrylovVectors = 30;  // of GMRES
constexpr double kForcing = 1e-2;   // relative residual of linear solves
constexpr int kMostProducts = 300;  // of conjugate gradients in a solve; a shorter step is better conditioned
constexpr int kProjectedRun = 8;    // factorisations after an indefinite Hessian that do not ask for it again

class BackwardDifferences final : public TimeIntegrator {
 public:
  BackwardDifferences(const TimeIntegratorContext& context, const DynamicOptions& options,
                      const FactorisationFactory& factorisation)
      : objective_(context.objective),
        monitor_(context.monitor),
        mass_(context.mass),
        applied_(context.applied),
        drag_(options.relaxation_time > 0 ? 1 / options.relaxation_time : 0),
        uses_conjugate_gradients_(options.uses_conjugate_gradients),
        hessian_(factorisation, &context.mass) {
    conjugate_gradients_.setTolerance(kForcing);
    conjugate_gradients_.setMaxIterations(kMostProducts);
  }

  void restart() override { last_step_ = 0; }

  double next_step(double h, const Motion&) override {
    if (iterations_ >= kMany || products_ > 0.9 * kMostProducts) return kShrinkage * h;
    return iterations_ <= kFew && products_ < 0.4 * kMostProducts ? kGrowth * h : h;
  }

  bool step(double h, Motion& at) override {
    aim(h, at);
    now_.q = at.q;
    now_.energy = at.energy;
    now_.g = at.g;
    products_ = 0;
    for (iterations_ = 0; iterations_ < kMostIterations; ++iterations_) {
      imbalance_ = now_.g - applied_ + inertia_ * mass_.cwiseProduct(now_.q - target_);
      if (iterations_ > 0 && is_enough()) {
        finish(h, at);
        return true;
      }
      if (monitor_.is_out_of_time() || !find_direction() || !descend()) return false;
    }
    return false;
  }

 private:
  // The backward difference of q is rate (q - drift), its second difference gives the target:
  //   v = rate (q - drift),   M inertia (q - target) + dE/dq = 0
  void aim(double h, const Motion& at) {
    const double r = last_step_ > 0 ? h / last_step_ : 0;  // 0: implicit Euler
    const double b1 = -(1 + r) / h, b2 = r * r / (1 + r) / h;
    rate_ = (1 + 2 * r) / (1 + r) / h;
    inertia_ = rate_ * rate_ + drag_ * rate_;
    drift_ = -b1 / rate_ * at.q;
    target_ = -b1 / inertia_ * at.v;
    if (r > 0) {
      drift_ -= b2 / rate_ * before_.q;
      target_ -= b2 / inertia_ * before_.v;
    }
    target_ += drift_;
  }

  bool is_enough() const {
    return objective_.relative_residual(now_.q, imbalance_) <=
           std::max(kEnough * objective_.relative_residual(now_.q, now_.g), 0.1 * monitor_.tolerance());
  }

  // From the symmetric part of the tangent, corrected for the skew one where that leads downhill too.
  bool find_direction() {
    if (!(uses_conjugate_gradients_ ? iterate_symmetric() : factorise_symmetric())) return false;
    direction_ = symmetric_;
    if (objective_.has_skew_tangent()) {
      PhaseTimer timer(monitor_.phases(), "direction");
      gmres_.solve(
          [this](const Vector& v, Vector& out) {
            work_.setZero();
            objective_.add_skew_product(v, work_);
            solve_symmetric(work_, out);
          },
          symmetric_, kForcing, direction_);
    }
    slope_ = imbalance_.dot(direction_);
    if (slope_ < 0) return true;
    direction_ = symmetric_;
    slope_ = imbalance_.dot(direction_);
    return slope_ < 0;
  }

  bool factorise_symmetric() {
    double shift = inertia_;
    const bool tries_exact = projected_run_ == 0;
    if (!hessian_.factorise(objective_, monitor_, now_.q, work_, shift, tries_exact)) return false;
    count_projected(tries_exact, hessian_.is_exact());
    PhaseTimer timer(monitor_.phases(), "direction");
    work_ = -imbalance_;
    solve_symmetric(work_, symmetric_);
    return true;
  }

  // With the exact Hessian, unless it shows that it is not positive definite; then with the projected one.
  // Returns false where the iterations do not suffice.
  bool iterate_symmetric() {
    const bool tries_exact = projected_run_ == 0;
    for (const Projection projection : {Projection::None, Projection::PositiveSemidefinite}) {
      if (projection == Projection::None && !tries_exact) continue;
      if (!std::isfinite(monitor_.hessian(now_.q, work_, matrix_, projection))) return false;
      PhaseTimer timer(monitor_.phases(), "direction");
      matrix_.diagonal() += inertia_ * mass_;
      conjugate_gradients_.compute(matrix_);
      work_ = -imbalance_;
      solve_symmetric(work_, symmetric_);
      if (symmetric_.allFinite() && imbalance_.dot(symmetric_) < 0 &&
          conjugate_gradients_.info() == Eigen::Success) {
        count_projected(tries_exact, projection == Projection::None);
        return true;
      }
    }
    return false;
  }

  // An indefinite Hessian stays so for a while: to ask for it in each step would cost as much as the
  // projected one.
  void count_projected(bool tried_exact, bool is_exact) {
    projected_run_ = is_exact ? 0 : tried_exact ? kProjectedRun : projected_run_ - 1;
  }

  void solve_symmetric(const Vector& b, Vector& x) {
    if (!uses_conjugate_gradients_) return hessian_.solve(b, x);
    x = conjugate_gradients_.solve(b);
    products_ = std::max(products_, static_cast<int>(conjugate_gradients_.iterations()));
  }

  // The potential of the step, whose gradient is imbalance_.
  double merit(const Motion& at) const {
    return at.energy - applied_.dot(at.q) + 0.5 * inertia_ * (at.q - target_).cwiseAbs2().dot(mass_);
  }

  bool descend() {
    const double from = merit(now_), noise = monitor_.energy_noise(from);
    double step = monitor_.step_limit(now_.q, direction_, 1);
    for (int trial = 0; trial < kTrials && step > 0; ++trial, step *= 0.5) {
      next_.q = now_.q + step * direction_;
      next_.energy = monitor_.gradient(next_.q, next_.g);
      if (!std::isfinite(next_.energy) || !next_.g.allFinite()) continue;
      if (merit(next_) > from + kDecrease * step * slope_ + noise) continue;
      std::swap(now_, next_);
      return true;
    }
    return false;
  }

  void finish(double h, Motion& at) {
    now_.v = rate_ * (now_.q - drift_);
    now_.time = at.time + h;
    last_step_ = h;
    std::swap(before_, at);
    std::swap(at, now_);
  }

  Objective& objective_;
  Monitor& monitor_;
  const Vector &mass_, &applied_;
  double drag_;  // [1/time]
  bool uses_conjugate_gradients_;
  ShiftedHessian hessian_;
  Gmres gmres_{kKrylovVectors};
  SparseMatrix matrix_;
  Eigen::ConjugateGradient<SparseMatrix, Eigen::Lower> conjugate_gradients_;

  double last_step_ = 0;           // 0: there was none
  double rate_ = 0, inertia_ = 0;  // [1/time], [1/time^2]
  double slope_ = 0;               // of the merit along the direction
  int iterations_ = 0;             // of the last step
  int products_ = 0;               // of the longest of its solves by conjugate gradients
  int projected_run_ = 0;          // factorisations to come without the exact Hessian
  Motion before_, now_, next_;     // the state before `at`; iterates of the step
  Vector drift_, target_, imbalance_, direction_, symmetric_, work_;
};

}  // namespace

std::unique_ptr<TimeIntegrator> make_backward_differences(const TimeIntegratorContext& context,
                                                          const DynamicOptions& options,
                                                          const FactorisationFactory& factorisation) {
  return std::make_unique<BackwardDifferences>(context, options, factorisation);
}

}  // namespace coapt
