// Shared by every two-node law whose energy depends on the distance alone.
#pragma once

#include "core/types.hpp"

#include <Eigen/Dense>

namespace coapt {

// Energy and its derivatives with respect to the distance l of the two nodes.
struct AxialLaw {
  double energy = 0;
  double force = 0;      // dW/dl [force]
  double stiffness = 0;  // d2W/dl2 [force/length]
};

// Turns the derivatives by l into those by the six coordinates (first node, second node).
// Pre: l > 0 where force or stiffness is not zero; the direction is undefined at l = 0.
inline void expand_axial(const AxialLaw& law, const Vec3& difference, double l, Eigen::Vector<double, 6>* g,
                         Eigen::Matrix<double, 6, 6>* H) {
  if (g == nullptr) return;
  if (law.force == 0 && law.stiffness == 0) {
    g->setZero();
    if (H != nullptr) H->setZero();
    return;
  }
  const Vec3 n = difference / l;
  g->head<3>() = -law.force * n;
  g->tail<3>() = law.force * n;
  if (H == nullptr) return;
  const Eigen::Matrix3d nn = n * n.transpose();
  const Eigen::Matrix3d block = law.stiffness * nn + law.force / l * (Eigen::Matrix3d::Identity() - nn);
  H->block<3, 3>(0, 0) = block;
  H->block<3, 3>(3, 3) = block;
  H->block<3, 3>(0, 3) = -block;
  H->block<3, 3>(3, 0) = -block;
}

}  // namespace coapt
