// The rounded onset of tension of lines that cannot push: what a law is asked for at an elongation e > 0,
//   rho(e) = s0 u^(3/2) (15 - 10 u + 3 u^2)/8,  u = e/s0,  for e < s0,   rho = e beyond
// The force of a law that starts linearly then leaves zero with slope zero, and rho meets e at s0 with its
// first two derivatives. Never throws.
#pragma once

#include <cmath>

namespace coapt {

struct Elongation {
  double value = 0, slope = 1, curvature = 0;
};

// rho with its derivatives. Pre: e > 0. s0 = 0: the sharp onset.
inline Elongation rounded_elongation(double e, double s0) {
  if (e >= s0) return {e, 1, 0};
  const double u = e / s0, root = std::sqrt(u);
  return {e * root * (15 - 10 * u + 3 * u * u) / 8, root * (45 - 50 * u + 21 * u * u) / 16,
          (45 - 150 * u + 105 * u * u) / (32 * s0 * root)};
}

}  // namespace coapt
