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
  double from = 0, left = limit_ - 1, energy = 0;
  for (int k = 0; k < kPieces; ++k, left *= 0.5) {
    const double to = k + 1 < kPieces ? limit_ - 1 - 0.5 * left : limit_ - 1;
    energy_[k] = energy += work(from, to);
    from = to;
  }
  at_limit_ = crimped(limit_ - 1);
  at_limit_.energy = energy;
  knee_ = {young / limit_ - at_limit_.stiffness, limit_ - 1, std::min(window, limit_ - 1)};
}

CrimpedFibre CrimpedFibre::yielding(double strain, double failure) const {
  CrimpedFibre fibre = *this;
  fibre.yield_elongation_ = limit_ * (1 + strain) - 1;
  const double straight = knee_.modulus + at_limit_.stiffness;
  fibre.yield_ = {-failure * straight, fibre.yield_elongation_, std::min(knee_.window, limit_ * strain)};
  return fibre;
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

// Gauss's rule with eight points.
double CrimpedFibre::work(double from, double to) const {
  static constexpr double kAt[] = {0.1834346424956498, 0.5255324099163290, 0.7966664774136267,
                                   0.9602898564975363};
  static constexpr double kWeight[] = {0.3626837833783620, 0.3137066458778873, 0.2223810344533745,
                                       0.1012285362903763};
  const double middle = 0.5 * (from + to), half = 0.5 * (to - from);
  double sum = 0;
  for (int k = 0; k < 4; ++k)
    for (const double side : {-1.0, 1.0}) sum += kWeight[k] * crimped(middle + half * side * kAt[k]).stress;
  return half * sum;
}

double CrimpedFibre::crimped_energy(double elongation) const {
  const double end = limit_ - 1;
  double energy = 0, from = 0, left = end;  // of the way to the limit
  for (int k = 0; k + 1 < kPieces; ++k) {
    const double to = end - 0.5 * left;
    if (elongation <= to) break;
    energy = energy_[k];
    from = to;
    left *= 0.5;
  }
  return energy + work(from, elongation);
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
  CurveValue added = knee_.at(elongation);
  if (yield_.modulus < 0) {
    const CurveValue lost = yield_.at(elongation);
    added = {added.energy + lost.energy, added.stress + lost.stress, added.stiffness + lost.stiffness};
  }
  return {value.energy + added.energy, value.stress + added.stress, value.stiffness + added.stiffness};
}

}  // namespace coapt
