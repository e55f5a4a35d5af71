#include "energy/kernels/cst_fibrous.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>

namespace coapt {

LeastDirection least_direction(double a, double c, double b) {
  // Scaled where the squares of the entries would overflow.
  const double size = std::max({std::abs(a), std::abs(c), std::abs(b)});
  const double scale = size > 1e150 ? power_of_two(size) : 1;
  const CstPrincipal p = cst_principal({a / scale, c / scale, b / scale});
  const Eigen::Vector2d major = p.direction();
  return {scale * p.minor, {-major[1], major[0]}};
}

double power_of_two(double size) {
  return size > 0 && std::isfinite(size) ? std::ldexp(1.0, std::ilogb(size)) : 1;
}

void make_positive(PlaneEnergy& w) {
  const Symmetric2 stress = clamped({w.stress[0], w.stress[2], w.stress[1]});
  w.stress = {stress.a, stress.c, stress.b};
  // Sylvester's criterion first: hardly any tangent of a relaxed law needs more.
  const Eigen::Matrix3d& t = w.tangent;
  if (t(0, 0) >= 0 && t.topLeftCorner<2, 2>().determinant() >= 0 && t.determinant() >= 0 && t(2, 2) >= 0 &&
      t(1, 1) >= 0)
    return;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(t);
  w.tangent =
      eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0).asDiagonal() * eigen.eigenvectors().transpose();
}

}  // namespace coapt
