#include "energy/load_dead.hpp"

#include "energy/moving_part.hpp"
#include "mesh/triangle_mesh.hpp"

namespace coapt {

LoadDead::LoadDead(std::string name, std::string type, const Points& forces, const Points& reference,
                   TermKind kind)
    : EnergyTerm(std::move(name)), type_(std::move(type)), stencils_{1, {}}, kind_(kind) {
  for (int node = 0; node < forces.cols(); ++node)
    if (!forces.col(node).isZero(0)) stencils_.nodes.push_back(node);
  forces_ = forces(Eigen::all, stencils_.nodes);
  reference_ = reference(Eigen::all, stencils_.nodes);
}

double LoadDead::evaluate(const Points& x, Sink& sink) const {
  double energy = 0;
  for (int k = 0; k < stencils_.count(); ++k) {
    const int node = stencils_.nodes[k];
    energy -= forces_.col(k).dot(x.col(node) - reference_.col(k));
    if (sink.wants_gradient()) sink.add_gradient(node, -forces_.col(k));
  }
  return energy;
}

std::unique_ptr<EnergyTerm> LoadDead::part(MovingPart& moving) const {
  Points forces = Points::Zero(3, moving.moving_count()), reference = forces;
  for (int k = 0; k < stencils_.count(); ++k) {
    const int node = stencils_.nodes[static_cast<size_t>(k)];
    if (!moving.moves(node)) continue;
    forces.col(moving.number(node)) = forces_.col(k);
    reference.col(moving.number(node)) = reference_.col(k);
  }
  return std::make_unique<LoadDead>(name(), type_, forces, reference, kind_);
}

Points frozen_pressure_forces(const Points& X, const Triangles& triangles, double p) {
  Points forces = Points::Zero(3, X.cols());
  for (int t = 0; t < triangles.cols(); ++t) {
    const Vec3 third = p / 3 * area_vector(X, triangles.col(t));
    for (int k = 0; k < 3; ++k) forces.col(triangles(k, t)) += third;
  }
  return forces;
}

Points area_forces(const Vector& nodal_areas, const Vec3& traction) {
  return traction * nodal_areas.transpose();
}

Points forces_toward_line(const Points& X, const Vector& magnitudes, const Vec3& a, const Vec3& b) {
  const Vec3 along = (b - a).normalized();
  Points forces = Points::Zero(3, X.cols());
  for (int node = 0; node < X.cols(); ++node) {
    const Vec3 from_a = X.col(node) - a;
    const Vec3 to_line = along * along.dot(from_a) - from_a;
    const double distance = to_line.norm();
    if (distance > 0) forces.col(node) = magnitudes[node] / distance * to_line;
  }
  return forces;
}

}  // namespace coapt
