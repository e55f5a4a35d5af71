// The derivatives of a tracked equilibrium: linear systems with its exact tangent.
#include "core/error.hpp"
#include "core/number_text.hpp"
#include "sensitivity/metrics/covariance.hpp"
#include "sensitivity/tracked_equilibrium.hpp"

#include <algorithm>

namespace coapt {
namespace {

constexpr double kExact =
    TrackedEquilibrium::kExactResponse;  // residual of the linear systems of derivatives
constexpr double kSolved = 1e-6;         // relative residual beyond which a linear system counts as singular

// Displacements of nodes from those of unknowns.
Points nodal_motion(const Objective& objective, const Vector& direction) {
  Points motion = Points::Zero(3, objective.node_count());
  Eigen::Index k = 0;
  for (Eigen::Index node = 0; node < motion.cols(); ++node) {
    if (objective.fixed().col(node).all()) continue;
    motion.col(node) = objective.fixed().col(node).select(0, direction.segment<3>(k).array());
    k += 3;
  }
  return motion;
}

}  // namespace

void TrackedEquilibrium::check_solved(double residual, double tolerance) const {
  if (!(residual <= std::max(kSolved, tolerance)))
    throw InputError("equilibrium: the tangent is nearly singular (its linear system solves to " +
                     number_text(residual) +
                     " only), or the metric depends on nodes that nothing holds, such as junctions of slack "
                     "chords; derivatives are not defined here");
}

// Of all numbers alike: through the terms' data and through the nodes that they move.
Points TrackedEquilibrium::force_change(const Points& x, const Vector& change) {
  Points g = Points::Zero(3, x.cols()), motion = g;
  bool moves = false;
  for (size_t k = 0; k < parameters_.size(); ++k) {
    const Vector part = numbers_of(*parameters_[k], k, change);
    if (part.isZero(0)) continue;
    parameters_[k]->push_forward(x, part, g);
    parameters_[k]->push_forward_motion(part, motion);
    moves = moves || parameters_[k]->moves_nodes();
  }
  if (moves) {
    if (!is_nodal_ready_) nodal_.assemble(objective_, x);
    is_nodal_ready_ = true;
    g += nodal_.product(motion);
  }
  return g;
}

// Pre: the tangent is ready at q_.
Points TrackedEquilibrium::predict(const Vector& change, double tolerance) {
  const Points x = positions(), none = Points::Zero(3, x.cols());
  const Vector b = -objective_.unknowns(objective_.fixed().select(none, force_change(x, change)));
  Vector dq;
  check_solved(solve_tangent(b, dq, tolerance, false), tolerance);
  Points motion = none;
  for (size_t k = 0; k < parameters_.size(); ++k)
    parameters_[k]->push_forward_motion(numbers_of(*parameters_[k], k, change), motion);
  return nodal_motion(objective_, dq) + motion;
}

Vector TrackedEquilibrium::pull_back(const Eigen::Ref<const Points>& weights) {
  require_solved();
  ready_tangent();
  const Points x = positions(), none = Points::Zero(3, x.cols());
  const Vector b = objective_.unknowns(objective_.fixed().select(none, weights));
  Vector lambda;
  const double residual = solve_tangent(b, lambda, kExact, true);
  check_solved(residual, kExact);
  adjoint_residual_ = residual;
  const Points nodal = nodal_motion(objective_, lambda);
  Vector result = Vector::Zero(number_count_);
  Points motion_weights = weights;
  if (std::any_of(parameters_.begin(), parameters_.end(), [](const auto& p) { return p->moves_nodes(); })) {
    if (!is_nodal_ready_) nodal_.assemble(objective_, x);
    is_nodal_ready_ = true;
    motion_weights -= nodal_.transposed_product(nodal);
  }
  for (size_t k = 0; k < parameters_.size(); ++k) {
    const Parameter& parameter = *parameters_[k];
    const Vector part = parameter.pull_back_motion(motion_weights) - parameter.pull_back(x, nodal);
    result.segment(first_[k], part.size()) = part;
  }
  return result;
}

Derivatives TrackedEquilibrium::derivatives(const Metric& metric) {
  require_solved();
  const Points x = positions();
  Points by_x(3, x.cols());
  Derivatives result;
  result.value = metric.evaluate(x, &by_x);
  result.gradient = pull_back(by_x);
  result.gradient += partial(metric, x);
  result.residual = adjoint_residual_;
  result.kinks = kinks();
  return result;
}

const std::vector<Switch>& TrackedEquilibrium::kinks() {
  require_solved();
  if (!kinks_) kinks_ = kinks_at(objective_, positions());
  return *kinks_;
}

Points TrackedEquilibrium::response(const Vector& change, double tolerance) {
  require_solved();
  if (change.size() != number_count_)
    throw InputError("response: " + std::to_string(change.size()) + " numbers were given; there are " +
                     std::to_string(number_count_));
  ready_tangent();
  return predict(change, tolerance);
}

void TrackedEquilibrium::require_wanted() const {
  if (options_.observer && !options_.observer({}, q_))
    throw InputError("equilibrium: the observer ended the work on derivatives");
}

// At fixed positions, by all numbers.
Vector TrackedEquilibrium::partial(const Metric& metric, const Points& x) const {
  Vector direct(number_count_);
  for (size_t k = 0; k < parameters_.size(); ++k) {
    const Vector part = metric.partial(*parameters_[k], x);
    direct.segment(first_[k], part.size()) = part;
  }
  return direct;
}

// As few linear systems as will do: one for each metric, or for each number.
Eigen::MatrixXd TrackedEquilibrium::jacobian(const std::vector<const Metric*>& metrics) {
  const auto count = static_cast<Eigen::Index>(metrics.size());
  Eigen::MatrixXd rows(count, number_count_);
  if (count <= number_count_) {
    for (Eigen::Index k = 0; k < count; ++k) {
      require_wanted();
      rows.row(k) = derivatives(*metrics[static_cast<size_t>(k)]).gradient.transpose();
    }
    return rows;
  }
  std::vector<Points> motions;
  for (int number = 0; number < number_count_; ++number) {
    require_wanted();
    motions.push_back(response(Vector::Unit(number_count_, number)));
  }
  const Points x = positions();
  Points by_x(3, x.cols());
  for (Eigen::Index k = 0; k < count; ++k) {
    const Metric& metric = *metrics[static_cast<size_t>(k)];
    metric.evaluate(x, &by_x);
    rows.row(k) = partial(metric, x).transpose();
    for (int number = 0; number < number_count_; ++number)
      rows(k, number) += by_x.cwiseProduct(motions[static_cast<size_t>(number)]).sum();
  }
  return rows;
}

Vector TrackedEquilibrium::gauss_newton_product(const std::vector<const Metric*>& residuals,
                                                const Vector& change) {
  const Points motion = response(change), x = positions();
  Points by_x(3, x.cols()), weights = Points::Zero(3, x.cols());
  Vector direct = Vector::Zero(number_count_);
  for (const Metric* residual : residuals) {
    residual->evaluate(x, &by_x);
    const Vector own = partial(*residual, x);
    const double along = by_x.cwiseProduct(motion).sum() + own.dot(change);
    weights += along * by_x;
    direct += along * own;
  }
  return pull_back(weights) + direct;
}

Eigen::MatrixXd TrackedEquilibrium::metric_covariance(const std::vector<const Metric*>& metrics,
                                                      const Eigen::MatrixXd& covariance) {
  return first_order_covariance(jacobian(metrics), covariance);
}

std::vector<Switch> TrackedEquilibrium::switches(const Vector& change) {
  const Points motion = response(change), x = positions();
  const Vector here = value();
  for (const double sign : {-1.0, 1.0}) require_sound(here + sign * change);
  const auto states_at = [&](double sign) {
    assign(here + sign * change);
    return element_states(objective_, x + sign * motion);
  };
  const ElementStates before = states_at(-1), after = states_at(1);
  assign(here);
  return switches_between(objective_, before, after);
}

}  // namespace coapt
