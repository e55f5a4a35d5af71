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

// What is to be known of one line beside its energy, a function of the distance of its nodes.
struct LineTraits {
  double length = 0;           // at rest, at which it begins to pull; 0: of constant force [length]
  double onset = 0;            // elongation over which its onset is rounded [length]
  bool begins_softly = false;  // its stiffness is continuous where its tension begins
  bool is_one_law = false;     // it is never slack: it resists being shortened, or its force is constant
  bool resists = false;        // being shortened
  bool is_straight = false;    // its force is stiffness times elongation
  double stiffness = 0;        // then [force/length]
};

// Derivatives by the rest length r at a fixed distance l: dW/dr [force] and d2W/dl dr [force/length].
struct RestSlope {
  double energy = 0, force = 0;
};

// Of W = r w(l/r), and a constant tension times l: homogeneous of degree one in both lengths, so that Euler's
// theorem gives the derivatives by r.
inline RestSlope homogeneous_slope(const AxialLaw& law, double l, double r) {
  if (r <= 0) return {};
  return {(law.energy - l * law.force) / r, -l / r * law.stiffness};
}

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
