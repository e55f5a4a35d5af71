// What an objective says of a state: whether it is an equilibrium, and what holds it.
#include "energy/objective.hpp"

#include <Eigen/Geometry>

#include <cmath>

namespace coapt {
namespace {

double largest_nodal_force(const Vector& g) {
  double largest = 0;
  for (Eigen::Index k = 0; k < g.size(); k += 3) largest = std::max(largest, g.segment<3>(k).squaredNorm());
  return std::sqrt(largest);
}

}  // namespace

void Objective::measure_reference() {
  if (reference_is_current_) return;
  scale_.measure_reference(terms_, reference_, fixed_);
  reference_is_current_ = true;
}

const ForceScale& Objective::scale_at(const Vector& q) {
  Vector g;
  if (!scale_is_current_ || scale_at_ != q) evaluate(q, &g, nullptr, Projection::None);
  return scale_;
}

double Objective::relative_residual(const Vector& q, const Vector& g) {
  if (!g.allFinite()) return kInfinity;
  const double force = largest_nodal_force(g);
  return force == 0 ? 0 : force / reference_force(q);
}

Points Objective::exact_circulatory_force() const {
  Points force = Points::Zero(3, node_count());
  for (const auto& term : terms_) term->simplest().add_circulatory_force(x_, force);
  return force * load_factor_;
}

Points Objective::exact_gradient(const Points& circulatory) const {
  Points g = Points::Zero(3, node_count());
  for (const auto& term : terms_) pour(term->simplest(), Sink(g.data()));
  return g - circulatory;
}

Points Objective::exact_load() const {
  Points gradient = -exact_circulatory_force();
  for (const auto& term : terms_)
    if (term->role() == TermRole::Load) pour(term->simplest(), Sink(gradient.data()));
  return -gradient;  // the force on the nodes is minus the gradient of the potential
}

double Objective::total_load(const Vector& q) {
  prepare(q);
  return exact_load().colwise().norm().sum();
}

double Objective::true_residual(const Vector& q) {
  Vector g;
  if (!has_circulatory_force()) {
    gradient(q, g);
    return relative_residual(q, g);
  }
  ++counts_.gradient;
  measure_reference();
  scale_is_current_ = false;  // from here on it is that of the exact load
  prepare(q);
  scale_.measure_loads(-exact_load(), fixed_);
  split(exact_gradient(exact_circulatory_force()), g);
  if (is_damped()) add_dampers(q, &g, nullptr);
  if (!g.allFinite()) return kInfinity;
  const double force = largest_nodal_force(g);
  return force == 0 ? 0 : force / scale_.force();
}

Points Objective::reactions(const Vector& q) {
  prepare(q);
  return fixed_.select(exact_gradient(exact_circulatory_force()), Points::Zero(3, node_count()));
}

Balance Objective::balance(const Vector& q) {
  const Points support = reactions(q), load = exact_load();
  const Vec3 centre = x_.cols() == 0 ? Vec3::Zero() : Vec3(x_.rowwise().mean());
  Vec3 force = Vec3::Zero(), moment = Vec3::Zero();
  double force_sum = 0, moment_sum = 0;
  for (int node = 0; node < node_count(); ++node) {
    const Vec3 arm = x_.col(node) - centre, f = load.col(node) + support.col(node);
    force += f;
    moment += arm.cross(f);
    force_sum += load.col(node).norm() + support.col(node).norm();
    moment_sum += arm.norm() * (load.col(node).norm() + support.col(node).norm());
  }
  return {force_sum > 0 ? force.norm() / force_sum : 0, moment_sum > 0 ? moment.norm() / moment_sum : 0};
}

}  // namespace coapt
