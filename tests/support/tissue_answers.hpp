// What each membrane law must answer to a uniform strain, from its published formula and with its numbers
// written down again:
//   density()   the energy per volume as an oracle for automatic differentiation
//   nominal(F)  the first Piola-Kirchhoff stress P = dW/dF in closed form, resisting compression; the first
//               axis lies along the fibre. The change of volume and the splay are found by numbers.
#pragma once

#include "support/tissue_laws.hpp"
#include "support/tissue_oracles.hpp"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>

namespace coapt {

template <typename Entry>
struct Answer;

namespace answers {

using Matrix = Eigen::Matrix2d;

// det(C)^-1 = l3^2 at constant volume, and F^-T.
inline double thin(const Matrix& F) { return 1 / (F.determinant() * F.determinant()); }
inline Matrix dual(const Matrix& F) { return F.inverse().transpose(); }

// dI1/dF at constant volume, of I1 = tr C + 1/det C; and I1 - 3.
inline Matrix spread(const Matrix& F) { return 2 * (F - thin(F) * dual(F)); }
inline double distortion(const Matrix& F) { return F.squaredNorm() + thin(F) - 3; }

// Stress of a modulus that sets in at a strain, over a window to either side of it.
inline double past_knee(double strain, double modulus, double transition, double window) {
  if (strain <= transition - window) return 0;
  if (strain >= transition + window) return modulus * (strain - transition);
  return modulus / (4 * window) * std::pow(strain - transition + window, 2);
}

// 2 psi'(I) dI/dF of I = J^(-2/3) (tr C + J^2/det C), with the J at which the law's slope by J vanishes; it
// lies between 1 and the J that leaves no distortion to either side.
template <typename Invariant>
Matrix compressible(const oracle::Compressible<Invariant>& law, const Matrix& F) {
  const double in_plane = F.squaredNorm(), least = std::sqrt(0.5 * in_plane / thin(F));
  double low = std::min(1.0, least), high = std::max(1.0, least);
  for (int k = 0; k < 200; ++k) {
    const double middle = 0.5 * (low + high);
    (law.slope_at(in_plane, thin(F), middle) < 0 ? low : high) = middle;
  }
  const double scale = std::pow(low, -2.0 / 3), thick = low * low * thin(F);
  const double slope = law.part.slope(scale * (in_plane + thick) - 3);
  return 2 * slope * scale * (F - thick * dual(F));
}

}  // namespace answers

template <>
struct Answer<laws::Bilinear> {
  static oracle::Bilinear density() { return {0.1, 6, 0.25, 0.05, 0.4}; }
  static Eigen::Matrix2d nominal(const Eigen::Matrix2d& F) {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> spectrum(F.transpose() * F);
    const Eigen::Vector2d stretch = spectrum.eigenvalues().cwiseSqrt(), e = stretch.array() - 1;
    Eigen::Vector2d stress;
    for (int k = 0; k < 2; ++k)
      stress[k] = 0.1 / (1 - 0.4 * 0.4) * (e[k] + 0.4 * e[1 - k]) + answers::past_knee(e[k], 5.9, 0.25, 0.05);
    const Eigen::Matrix2d& axes = spectrum.eigenvectors();
    return F * axes * stress.cwiseQuotient(stretch).asDiagonal() * axes.transpose();
  }
};

template <>
struct Answer<laws::NeoHookean> {
  static oracle::NeoHookean density() { return {0.3}; }
  static Eigen::Matrix2d nominal(const Eigen::Matrix2d& F) { return 0.15 * answers::spread(F); }
};

template <>
struct Answer<laws::SoftNeoHookean> {
  static oracle::Compressible<oracle::NeoHookean> density() { return {{0.3}, 2}; }
  static Eigen::Matrix2d nominal(const Eigen::Matrix2d& F) { return answers::compressible(density(), F); }
};

template <>
struct Answer<laws::Exponential> {
  static oracle::Exponential density() { return {0.05, 0.02, 3}; }
  static Eigen::Matrix2d nominal(const Eigen::Matrix2d& F) {
    const double j = answers::distortion(F);
    return (0.025 + 0.06 * j * std::exp(3 * j * j)) * answers::spread(F);
  }
};

template <>
struct Answer<laws::SoftExponential> {
  static oracle::Compressible<oracle::Exponential> density() { return {{0.05, 0.02, 3}, 0.6}; }
  static Eigen::Matrix2d nominal(const Eigen::Matrix2d& F) { return answers::compressible(density(), F); }
};

template <>
struct Answer<laws::Orthotropic> {
  static oracle::Orthotropic density() { return {0.2, 4.2, 0.15, 0.08, 1.08, 0.3, 0.04, 0.3, 0.05}; }
  // P = F S with the stresses along and across over their stretches, and G C12 beside them.
  static Eigen::Matrix2d nominal(const Eigen::Matrix2d& F) {
    const double along = F.col(0).norm(), across = F.col(1).norm(), ef = along - 1, ec = across - 1;
    const double coupling = 0.3 * std::sqrt(0.2 * 0.08), share = 1 / 0.91;
    Eigen::Matrix2d S;
    S(0, 0) = (share * (0.2 * ef + coupling * ec) + answers::past_knee(ef, 4, 0.15, 0.04)) / along;
    S(1, 1) = (share * (0.08 * ec + coupling * ef) + answers::past_knee(ec, 1, 0.3, 0.04)) / across;
    S(0, 1) = S(1, 0) = 0.05 * F.col(0).dot(F.col(1));
    return F * S;
  }
};

template <>
struct Answer<laws::MayNewmanYin> {
  static oracle::MayNewmanYin density() { return {0.02, 1.5, 20}; }
  static Eigen::Matrix2d nominal(const Eigen::Matrix2d& F) {
    const double j = answers::distortion(F), l = F.col(0).norm(), e = l - 1;
    Eigen::Matrix2d fibre = Eigen::Matrix2d::Zero();
    fibre.col(0) = F.col(0) / l;
    return 0.02 * std::exp(1.5 * j * j + 20 * std::pow(e, 4)) *
           (3 * j * answers::spread(F) + 80 * std::pow(e, 3) * fibre);
  }
};

template <>
struct Answer<laws::Crimped> {
  static oracle::Crimped density() { return {0.05, {8, 9, 1.6, 0.02}, 0.3}; }
  static Eigen::Matrix2d nominal(const Eigen::Matrix2d& F) {
    const oracle::Crimped law = density();
    const double share = oracle::mean_square_cosine(0.3);
    const Eigen::Vector2d spread(share, 1 - share);
    const double l = std::sqrt(spread.dot(F.colwise().squaredNorm()));
    return 0.025 * answers::spread(F) + law.fibre.stress(l) / l * F * spread.asDiagonal();
  }
};

template <>
struct Answer<laws::CrimpedPopulations> {
  static oracle::CrimpedPopulations density() {
    return {0.05, {8, 9, 1.6, 0.02, 0.06, 0.5}, 0.3, 0.25, 0.4, 0.5 * std::numbers::pi, 0.1};
  }
  static Eigen::Matrix2d nominal(const Eigen::Matrix2d& F) {
    const oracle::CrimpedPopulations law = density();
    Eigen::Matrix2d sum = 0.025 * answers::spread(F);
    const auto add = [&](double angle, double share, double active) {
      const Eigen::Matrix3d K = law.dispersion(angle);
      const Eigen::Matrix2d in_plane = K.topLeftCorner<2, 2>();
      const double l = std::sqrt((in_plane * F.transpose() * F).trace() + K(2, 2) * answers::thin(F));
      const double pull = l > 1 ? active * -std::expm1(-(l - 1) / law.kReach) : 0;
      sum += (share * law.fibre.stress(l) + pull) / l *
             (F * in_plane - K(2, 2) * answers::thin(F) * answers::dual(F));
    };
    add(0, 1, law.active);
    add(law.angle, law.share, 0);
    return sum;
  }
};

// The same where the fibre lies at an angle to the first axis.
template <typename Entry>
Eigen::Matrix2d nominal_stress(const Eigen::Matrix2d& F, double fibre_angle) {
  const Eigen::Matrix2d Q = Eigen::Rotation2Dd(fibre_angle).toRotationMatrix();
  return Q * Answer<Entry>::nominal(Q.transpose() * F * Q) * Q.transpose();
}

template <typename Entry>
double energy_density(const Eigen::Matrix2d& F, double fibre_angle) {
  const Eigen::Matrix2d Q = Eigen::Rotation2Dd(fibre_angle).toRotationMatrix();
  const Eigen::Matrix2d C = Q.transpose() * F.transpose() * F * Q;
  return Answer<Entry>::density()(oracle::PlaneMetric<double>{C(0, 0), C(1, 1), C(0, 1)});
}

}  // namespace coapt
