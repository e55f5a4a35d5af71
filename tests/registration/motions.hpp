// Surfaces and motions that the tests of registration share.
#pragma once

#include "mesh/shapes.hpp"
#include "registration/rigid_motion.hpp"

#include <Eigen/Geometry>

#include <numbers>
#include <random>

namespace coapt {

// A sheet of 40 mm without any symmetry, bent like three leaflets of unequal size.
inline TriangleMesh valve_like(int triangles) {
  TriangleMesh mesh = disc(20, triangles);
  for (auto p : mesh.vertices.colwise()) {
    const double r = p.head<2>().norm() / 20, angle = std::atan2(p[1], p[0]);
    p[2] = 8 * r * (1 - r) * (1 + 0.6 * std::cos(3 * angle)) + 3 * r * r * std::cos(2 * angle + 0.4) +
           2 * r * std::cos(angle) +
           4 * std::exp(-((p.head<2>() - Eigen::Vector2d(8, 5)).squaredNorm()) / 30);
    p[2] *= 1.6;
  }
  return mesh;
}

// Each component in its turn: the order in which arguments are evaluated is the compiler's.
inline Vec3 random_vector(std::mt19937& random, std::normal_distribution<double>& normal) {
  Vec3 vector;
  for (double& component : vector) component = normal(random);
  return vector;
}

// 30 degrees about a random axis through the middle of the vertices and 10 mm in a random direction.
inline RigidMotion random_motion(const Points& about, std::mt19937& random) {
  std::normal_distribution<double> normal;
  const auto direction = [&] { return random_vector(random, normal).normalized(); };
  const Vec3 middle = about.rowwise().mean();
  RigidMotion motion;
  motion.rotation = Eigen::AngleAxisd(std::numbers::pi / 6, direction()).toRotationMatrix();
  motion.translation = middle - motion.rotation * middle + 10 * direction();
  return motion;
}

inline double greatest_distance(const Points& a, const Points& b) {
  return (a - b).colwise().norm().maxCoeff();
}

}  // namespace coapt
