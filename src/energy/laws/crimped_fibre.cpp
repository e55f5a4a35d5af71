#include "energy/laws/crimped_fibre.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <numbers>

namespace coapt {
namespace {

using std::numbers::pi;

double squared(double a) { return a * a; }

}  // namespace

CrimpedFibre::CrimpedFibre(double young, double crimp, double slenderness, double window)
    : crimp_(crimp), slenderness_(slenderness) {
  // In units of R0: H0 = crimp, r0 = 1/slenderness.
  const double H0 = crimp, L0 = std::hypot(2 * pi, H0);
  limit_ = L0 / H0;
  const double excess = 1 + 37 / (6 * pi * pi) + 2 * squared(L0 * slenderness / pi);
  secant_ = young * H0 * H0 / (L0 * (H0 + excess * (L0 - H0)));
  at_limit_ = crimped(limit_ - 1);
  at_limit_.energy = crimped_energy(limit_ - 1);
  knee_ = {young / limit_ - at_limit_.stiffness, limit_ - 1, std::min(window, limit_ - 1)};
}

// Stress and slope; the energy is left out. With y = H^2 and q = R^2 = (L0^2 - y)/(2 pi)^2:
// eta = H (q + y) / (L0 d),  d = y + (4 s y + 40/3 + 6 s q) q,  s = 1/r0^2.
CurveValue CrimpedFibre::crimped(double elongation) const {
  const double stretch = 1 + elongation, H = stretch * crimp_, y = H * H, L0 = limit_ * crimp_;
  const double s = squared(slenderness_), quarter = 1 / squared(2 * pi);
  const double q = (L0 * L0 - y) * quarter, dq = -quarter;
  const double d = y + (4 * s * y + 40.0 / 3 + 6 * s * q) * q;
  const double dd = 1 + (4 * s + 6 * s * dq) * q + (4 * s * y + 40.0 / 3 + 6 * s * q) * dq;
  const double eta = H * (q + y) / (L0 * d);
  // d eta / dH = eta (1/H + 2 H ((dq + 1)/(q + y) - dd/d))
  const double slope = eta * (1 / H + 2 * H * ((dq + 1) / (q + y) - dd / d)) * crimp_;
  return {0, secant_ * eta * elongation, secant_ * (eta + slope * elongation)};
}

// Gauss's rule; the stress is analytic on the way.
double CrimpedFibre::crimped_energy(double elongation) const {
  static constexpr double kAt[] = {0.0950125098376374, 0.2816035507792589, 0.4580167776572274,
                                   0.6178762444026438, 0.7554044083550030, 0.8656312023878318,
                                   0.9445750230732326, 0.9894009349916499};
  static constexpr double kWeight[] = {0.1894506104550685, 0.1826034150449236, 0.1691565193950025,
                                       0.1495959888165767, 0.1246289712555339, 0.0951585116824928,
                                       0.0622535239386479, 0.0271524594117541};
  double sum = 0;
  for (int k = 0; k < 8; ++k)
    for (const double side : {-1.0, 1.0})
      sum += kWeight[k] * crimped(0.5 * elongation * (1 + side * kAt[k])).stress;
  return 0.5 * elongation * sum;
}

CurveValue CrimpedFibre::at(double elongation) const {
  if (elongation <= 0) return {};
  const double past = elongation - (limit_ - 1);
  CurveValue value;
  if (past <= 0) {
    value = crimped(elongation);
    value.energy = crimped_energy(elongation);
  } else {
    // The crimped branch goes on along its tangent; the knee adds the straight fibre's stiffness.
    value = {at_limit_.energy + at_limit_.stress * past + 0.5 * at_limit_.stiffness * past * past,
             at_limit_.stress + at_limit_.stiffness * past, at_limit_.stiffness};
  }
  const CurveValue added = knee_.at(elongation);
  return {value.energy + added.energy, value.stress + added.stress, value.stiffness + added.stiffness};
}

}  // namespace coapt
