// One triangle of a membrane law under a uniform strain, and what can be read off its nodal forces.
#pragma once

#include "support/tissue_laws.hpp"

#include <Eigen/Dense>

#include <cmath>

namespace coapt {

inline Eigen::Matrix2d plane(double f11, double f12, double f22) {
  Eigen::Matrix2d F;
  F << f11, f12, 0, f22;
  return F;
}

// Under a plane deformation F; the fibre lies at an angle to the first axis.
template <typename Law>
struct Single {
  using K = KernelOf<Law>;
  static constexpr double kThickness = 0.4;
  typename K::Type::Rest rest;
  Points X = Points::Zero(3, 3);
  CstVector x, g;
  CstMatrix H;
  double energy = 0, volume = 0;

  Single(const Law& law, const Eigen::Matrix2d& F, double fibre_angle = 0, bool relaxes = true) {
    X << 0, 1.1, 0.3, 0, 0.1, 0.9, 0, 0, 0;
    const Vec3 fibre(std::cos(fibre_angle), std::sin(fibre_angle), 0);
    rest = K::rest(X.col(0), X.col(1), X.col(2), fibre, law, kThickness, relaxes);
    Points image = X;
    image.topRows<2>() = F * X.topRows<2>();
    x = Eigen::Map<const CstVector>(image.data());
    energy = K::Type::evaluate(rest, x, &g, &H);
    const Vec3 e1 = X.col(1) - X.col(0), e2 = X.col(2) - X.col(0);
    volume = 0.5 * e1.cross(e2).norm() * kThickness;
  }

  // First Piola-Kirchhoff stress from the nodal forces: V P = (g1 g2) (e1 e2)^T in the plane.
  Eigen::Matrix2d nominal() const {
    Eigen::Matrix2d forces, edges;
    forces << g[3], g[6], g[4], g[7];
    edges << X(0, 1) - X(0, 0), X(0, 2) - X(0, 0), X(1, 1) - X(1, 0), X(1, 2) - X(1, 0);
    return forces * edges.transpose() / volume;
  }
  double density() const { return energy / volume; }
};

}  // namespace coapt
