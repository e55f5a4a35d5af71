#include "optim/newton.hpp"

#include "linear/gmres.hpp"
#include "optim/line_search.hpp"
#include "optim/shifted_hessian.hpp"
#include "optim/slack_junctions.hpp"
#include "optim/worst_part.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace coapt {
namespace {

constexpr double kFirstShift = 5;                // times force over length of the scene
constexpr double kFirstDampedShift = 1.5;        // the same where dampers hold what is slack
constexpr double kFar = 0.1, kFarDamped = 0.01;  // residual of a start from which on the first shift is whole
constexpr double kFall = 0.2;                    // of the shift after a step that kept its promise
constexpr double kRise = 4;                      // after one that was shortened much
constexpr double kMostShiftOverUnit = 1e9;       // beyond it no step is found
constexpr double kKept = 0.5, kShortened = 0.3;  // share of the promised decrease; of the step
constexpr double kExact = 0.1;                   // deviation of the decrease from what is expected
constexpr double kNear = 1e-3;                   // residual at which an equilibrium is near
constexpr double kForcing = 1e-3;                // relative residual of GMRES
constexpr int kKrylovVectors = 20;               // of GMRES with the exact tangent

// Iterates in a row near an equilibrium that better neither the energy nor the residual, before the rest is
// left to round-off. Towards a flat minimum, as after a saddle, 34 were seen; far from one the monitor
// decides.
constexpr int kIdlePatience = 40;
constexpr double kNearEnough = 1e-6;
constexpr double kBetter = 0.9;  // of the least residual so far

// Conjugate gradients: how many at most, to which share of the gradient, and the share of the projected
// curvature below which a direction counts as flat.
constexpr int kConjugate = 15;
constexpr double kCurved = 0.1, kFlat = 0.2;

// Parts in balance at the end of a step: how many one after the other, iterations of each (which cost no more
// than kPartWork of the whole), to which share of the force elsewhere it is solved, and how far nodes may go,
// over the scene's extent: half of it lost a little (docs/decisions/011), a tenth all of the gain.
constexpr int kParts = 4, kPartIterations = 15;
constexpr double kPartWork = 2, kPartTolerance = 0.3, kPartReach = 0.0125;

// Share of the residual that a step towards a double root leaves: a quarter where it is the only one.
constexpr double kLeastLeft = 0.2, kMostLeft = 0.6;

// Rounding of the kinks, as a share of the element's length.
constexpr double kOverloaded = 3;                            // residual of a start that asks for it
constexpr double kFirstRounding = 1, kLeastRounding = 1e-3;  // widest and least rounding
constexpr double kSharpen = 0.3;                             // fall of the rounding
constexpr double kSharpenBelow = 0.03;                       // residual at which it falls
constexpr double kGivenWay = 1;                              // below which limits of stress are raised

class Newton {
 public:
  // is_part: the objective is part of one whose laws are in the hands of another run.
  Newton(const SolverOptions& options, Objective& objective, Monitor& monitor, bool is_part = false)
      : objective_(objective),
        monitor_(monitor),
        options_(options),
        is_part_(is_part),
        hessian_(options.factorisation) {
    if (!is_part && !objective.is_damped()) junctions_.emplace(objective);
  }
  ~Newton() {
    if (is_part_) return;
    if (rounding_ > 0) objective_.round_kinks(0);
    objective_.release_stress_limits();
  }
  Newton(const Newton&) = delete;
  Newton& operator=(const Newton&) = delete;

  Status minimize(Vector& q) {
    at_.q = q;
    if (!is_part_) objective_.limit_stress(q);
    evaluate();
    if (!is_part_ && wants_rounding() && objective_.round_kinks(kFirstRounding)) {
      rounding_ = kFirstRounding;
      evaluate();
    }
    while (true) {
      slacken_junctions();
      q = at_.q;
      if (const auto status = accept()) return *status;
      if (is_at_round_off()) return Status::Stalled;
      if (unit_ == 0) start_shift();
      if (!hessian_.factorise(objective_, monitor_, at_.q, at_.g, shift_)) return Status::Stalled;
      bool is_found = false;
      while (!is_found) {
        find_direction();
        is_found = options_.globalisation == Globalisation::LineSearch ? search() : try_whole_step();
        if (is_found) break;
        if (monitor_.is_out_of_time()) return Status::TimeLimit;
        if (is_part_) return Status::LineSearchFailed;  // most often its nodes may go no farther
        if (shift_ > kMostShiftOverUnit * unit_ || !hessian_.raise(monitor_, shift_))
          return Status::LineSearchFailed;
      }
      std::swap(at_, next_);
      raise_limits();
    }
  }

  std::string remark() const {
    if (idle_ < kIdlePatience) return {};
    return "round-off forbids more, as " + std::to_string(kIdlePatience) +
           " iterates in a row bettered neither the residual nor the energy";
  }

 private:
  void evaluate() { at_.energy = monitor_.gradient(at_.q, at_.g); }

  // Not on rounded kinks, which are no double roots.
  void slacken_junctions() {
    if (!junctions_ || rounding_ > 0 || objective_.relative_residual(at_.q, at_.g) >= kNear) return;
    if (junctions_->slacken(at_.q)) evaluate();
  }

  // Where elements lie beyond the limits of their laws the limits follow, once what is stretched has given
  // way as far as these allow. Near an equilibrium they follow to the end, and go.
  void raise_limits() {
    while (objective_.has_stress_limits()) {
      const double residual = objective_.relative_residual(at_.q, at_.g);
      if (residual > kGivenWay) return;
      const double excess = objective_.raise_stress_limits(at_.q);
      if (residual < kSharpenBelow && excess < kExact) objective_.release_stress_limits();
      if (excess > 0) evaluate();
      if (!(residual < kSharpenBelow)) return;
    }
  }

  // From a start whose forces exceed its loads, because stiff chords already pull, many of them become slack
  // and taut again and again, and the Hessian sees neither coming. With kinks as wide as the chords are long
  // it does. Not where dampers carry over such kinks; not with contact: loose chords let sheets pass through
  // each other where a repulsion is finite.
  bool wants_rounding() const {
    const auto& terms = objective_.terms();
    return !objective_.is_damped() && objective_.relative_residual(at_.q, at_.g) > kOverloaded &&
           std::none_of(terms.begin(), terms.end(), [](const auto& term) {
             return term->role() == TermRole::Contact && !term->limits_steps();
           });
  }

  // Why to stop at this iterate, if so. Narrows the kinks, step by step, near an equilibrium for those
  // there are: from then on the energy is another one, which the trace has as another outer iteration.
  std::optional<Status> accept() {
    while (true) {
      const auto status = monitor_.accept(at_.q, at_.energy, at_.g);
      if (rounding_ == 0 || (status && *status != Status::Converged)) return status;
      if (objective_.relative_residual(at_.q, at_.g) > std::max(kSharpenBelow, monitor_.tolerance()))
        return status;
      rounding_ = rounding_ * kSharpen < kLeastRounding ? 0 : rounding_ * kSharpen;
      objective_.round_kinks(rounding_);
      monitor_.begin_outer_iteration(monitor_.outer_iteration() + 1, monitor_.tolerance());
      least_energy_ = least_residual_ = kInfinity;
      evaluate();
    }
  }

  // Every step of this method promises a gain. Where none comes for long, it is too small to be seen.
  bool is_at_round_off() {
    residual_ = objective_.relative_residual(at_.q, at_.g);
    const bool is_better = residual_ < kBetter * least_residual_ ||
                           at_.energy < least_energy_ - monitor_.energy_noise(at_.energy);
    idle_ = is_better || residual_ > kNearEnough ? 0 : idle_ + 1;
    if (is_better) {
      least_residual_ = std::min(least_residual_, residual_);
      least_energy_ = std::min(least_energy_, at_.energy);
    }
    return idle_ >= kIdlePatience;
  }

  // Force over length: what resists a displacement of the scene's size with the scene's force. A start near
  // an equilibrium, as at the end of a path, needs less, in proportion to the force out of balance.
  void start_shift() {
    const double extent = objective_.extent(at_.q);
    unit_ = objective_.reference_force(at_.q) / (extent > 0 ? extent : 1);
    const bool is_damped = objective_.is_damped() && !is_part_;
    const double share = is_part_ ? 1 : std::min(1.0, residual_ / (is_damped ? kFarDamped : kFar));
    shift_ = (is_damped ? kFirstDampedShift : kFirstShift) * unit_ * share;
    for (Vector* vector : {&left_, &conjugate_, &image_, &better_.q, &better_.g})
      vector->resize(at_.q.size());
    worst_ = WorstPart(at_.q.size() / 3);
  }

  // (K + shift) d = -g; the skew part of K, where there is one, by GMRES. With a positive definite symmetric
  // part d always descends.
  void find_direction() {
    PhaseTimer timer(monitor_.phases(), "direction");
    work_ = -at_.g;
    hessian_.solve(work_, symmetric_);
    if (is_beyond_the_potential() && solve_by_gmres(true)) return;
    if (!hessian_.is_exact()) use_exact_curvature();
    direction_ = symmetric_;
    at_.slope = at_.g.dot(direction_);
    if (!objective_.has_skew_tangent() || solve_by_gmres(false)) return;
    direction_ = symmetric_;  // GMRES stopped early
    at_.slope = at_.g.dot(direction_);
  }

  // Where the force has no potential the symmetric part of the tangent need not be positive definite at an
  // equilibrium; steps that take it to be so approach it slowly.
  bool is_beyond_the_potential() const {
    return objective_.has_skew_tangent() && !hessian_.is_exact() && residual_ < kNear;
  }

  // From symmetric_, with the skew part of the tangent; with the exact symmetric part too, unshifted, or with
  // that which is factorised. Returns whether the direction descends.
  bool solve_by_gmres(bool with_exact_curvature) {
    gmres_.solve(
        [&](const Vector& v, Vector& out) {
          work_.setZero();
          if (with_exact_curvature) hessian_.add_exact_product(v, work_);
          objective_.add_skew_product(v, work_);
          hessian_.solve(work_, out);
          if (with_exact_curvature) out -= v;
        },
        symmetric_, kForcing, direction_);
    at_.slope = at_.g.dot(direction_);
    return at_.slope < 0;
  }

  // Projected elements are too stiff wherever contact or bending took part in a negative eigenvalue: the
  // energy falls by more than they promise. Conjugate gradients on the exact Hessian with the projected one
  // as preconditioner take that back, up to a direction of next to no or negative curvature, which is
  // followed as far as the projected one says (after Steihaug 1983). Every iterate descends.
  void use_exact_curvature() {
    left_ = -at_.g;
    conjugate_ = symmetric_;
    image_ = left_;  // of `conjugate_` under the projected Hessian
    symmetric_.setZero();
    double square = left_.dot(conjugate_);
    const double enough = kCurved * kCurved * square;
    for (int k = 0; k < kConjugate; ++k) {
      work_ = shift_ * conjugate_;
      hessian_.add_exact_product(conjugate_, work_);
      const double curvature = conjugate_.dot(work_), projected = conjugate_.dot(image_);
      if (!(curvature > kFlat * projected)) {
        symmetric_ += (square / projected) * conjugate_;
        return;
      }
      symmetric_ += (square / curvature) * conjugate_;
      left_ -= (square / curvature) * work_;
      hessian_.solve(left_, work_);
      const double next = left_.dot(work_);
      if (!(next > enough)) return;
      conjugate_ = work_ + (next / square) * conjugate_;
      image_ = left_ + (next / square) * image_;
      square = next;
    }
  }

  bool search() {
    Replacement balance_parts;
    if (!is_part_) balance_parts = [this](LinePoint& to) { return balance_worst_parts(to); };
    if (!search_line(monitor_, at_, direction_, first_step(), next_, balance_parts)) return false;
    if (!is_part_ && residual_ < kNear) balance_double_root();
    const double step = std::min(next_.step, 1.0);  // the model promises nothing more beyond its minimum
    // The shift is no part of the energy, so that more is expected than the shifted model promises; and what
    // cuts a step short is no fault of the model. Without dampers bolder steps lead elsewhere.
    const bool is_damped = objective_.is_damped();
    const double gained = at_.energy - next_.energy, promised = at_.promised(step);
    const double unshifted = is_damped ? 0.5 * step * step * shift_ * direction_.squaredNorm() : 0;
    const double expected = promised + unshifted;
    if ((next_.step >= 0.9 || (is_damped && next_.is_limited)) && gained > kKept * promised)
      shift_ *= std::abs(gained - expected) < kExact * expected ? kFall * kFall : kFall;
    else if (next_.step < kShortened)
      shift_ = std::max(kRise * shift_, 1e-9 * unit_);
    return true;
  }

  // Where a step misses its promise, often a few ends and junctions of chords and pairs in contact bear
  // nearly all of the force: before the step is measured they are brought into balance, all others held
  // (nonlinear elimination: Lanzkron, Rose & Wilkes 1996; Cai & Li 2011). What is missed falls with the
  // square of the way left, and each goes about as far. False as soon as it cannot be enough any more.
  bool balance_worst_parts(LinePoint& to) {
    better_ = to;
    const double wanted = at_.energy - kFewKept * at_.promised(std::min(to.step, 1.0));
    for (int left = kParts - 1; better_.energy > wanted; --left) {
      const double way = left / (left + 1.0), enough = wanted + way * way * (better_.energy - wanted);
      if (!balance_worst_part(better_) || !(better_.energy <= enough)) return false;
    }
    std::swap(to, better_);
    return true;
  }

  // Returns false where there is no such part, or the point cannot be evaluated any more.
  bool balance_worst_part(LinePoint& at) {
    if (!worst_.find(at.g, hessian_.matrix())) return false;
    PhaseTimer timer(monitor_.phases(), "parts");
    const auto part = objective_.part(at.q, worst_.blocks, kPartReach * objective_.extent(at.q));
    if (!part) return false;
    const double elsewhere = worst_.outside / objective_.reference_force(at.q);
    const auto most = static_cast<int>(std::min<double>(kPartIterations, kPartWork / worst_.share()));
    const StopRule stop{std::max(0.5 * monitor_.tolerance(), kPartTolerance * elsewhere), most};
    const Observer nobody;
    Monitor monitor(*part, stop, nobody);
    Vector q = part->unknowns();
    Newton(options_, *part, monitor, true).minimize(q);
    for (size_t k = 0; k < worst_.blocks.size(); ++k)
      at.q.segment<3>(3 * worst_.blocks[k]) = q.segment<3>(3 * static_cast<Eigen::Index>(k));
    at.energy = monitor_.gradient(at.q, at.g);
    return std::isfinite(at.energy) && at.g.allFinite();
  }

  // Where the force falls by halves or quarters, lines between more than junctions are at their onset, which
  // is a double root: the part around them ends the series.
  void balance_double_root() {
    const double residual = objective_.relative_residual(next_.q, next_.g), left = residual / residual_;
    if (residual <= monitor_.tolerance() || left < kLeastLeft || left > kMostLeft) return;
    better_ = next_;
    if (balance_worst_part(better_) && better_.energy <= next_.energy + monitor_.energy_noise(next_.energy))
      std::swap(next_, better_);
  }

  // One, but for a double root, such as a slack chord's onset of tension, which Newton's method approaches by
  // halves: there the step that ends the series (Decker & Kelley 1980). Only near the solution: far from it a
  // stiffening law halves its excess too, and the long step would make it slack.
  double first_step() {
    double step = 1;
    if (last_.size() == direction_.size() && residual_ < kNear) {
      const double ratio = direction_.dot(last_) / last_.squaredNorm();
      if (ratio > 0.4 && ratio < 0.6 &&
          (direction_ - ratio * last_).squaredNorm() < 0.01 * direction_.squaredNorm())
        step = 1 / (1 - ratio);
    }
    last_ = direction_;
    return step;
  }

  // The shift takes the place of the radius (Levenberg, Marquardt; More 1978).
  bool try_whole_step() {
    next_.step = 1;
    const double limit = monitor_.step_limit(at_.q, direction_, 1);
    if (!(limit > 0)) return false;
    direction_ *= limit;
    at_.slope = at_.g.dot(direction_);
    next_.q = at_.q + direction_;
    next_.energy = monitor_.gradient(next_.q, next_.g);
    if (!std::isfinite(next_.energy) || !next_.g.allFinite()) return false;
    const double promised = 0.5 * (shift_ * direction_.squaredNorm() - at_.slope);
    const double noise = monitor_.energy_noise(at_.energy);
    const double gain = at_.energy - next_.energy;
    if (gain < 1e-4 * promised && !(std::abs(gain) <= noise && next_.g.norm() < 0.9 * at_.g.norm()))
      return false;
    if (gain > 0.75 * promised || std::abs(gain) <= noise)
      shift_ *= kFall;
    else if (gain < 0.25 * promised)
      shift_ = std::max(kRise * shift_, 1e-9 * unit_);
    return true;
  }

  Objective& objective_;
  Monitor& monitor_;
  const SolverOptions& options_;
  const bool is_part_;
  std::optional<SlackJunctions> junctions_;  // of a whole objective without dampers
  ShiftedHessian hessian_;
  Gmres gmres_{kKrylovVectors};
  double unit_ = 0, shift_ = 0;  // [force/length]
  double rounding_ = 0;
  double residual_ = kInfinity;                                   // of this iterate
  double least_energy_ = kInfinity, least_residual_ = kInfinity;  // that counted as a gain
  int idle_ = 0;                                                  // iterates since
  LinePoint at_, next_, better_;
  WorstPart worst_{0};  // nodes out of balance at `better_`
  Vector work_, symmetric_, direction_, last_;
  Vector left_, conjugate_, image_;  // of the conjugate gradients
};

class SolverNewton final : public Solver {
 public:
  explicit SolverNewton(const SolverOptions& options) : options_(options) {}

  std::string_view name() const override { return "newton"; }
  bool follows_path() const override { return true; }
  bool raises_stress_limits() const override { return true; }

  Status minimize(Objective& objective, Vector& q, Monitor& monitor) override {
    Newton newton(options_, objective, monitor);
    const Status status = newton.minimize(q);
    remark_ = newton.remark();
    return status;
  }

  std::string remark() const override { return remark_; }

 private:
  SolverOptions options_;
  std::string remark_;
};

}  // namespace

std::unique_ptr<Solver> make_newton(const SolverOptions& options) {
  return std::make_unique<SolverNewton>(options);
}

}  // namespace coapt
