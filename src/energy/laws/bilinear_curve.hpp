// What a bilinear stress-strain curve has beyond its knee: an additional modulus that sets in over a window.
//   phi'' = 0 for e < e* - w,  D for e > e* + w,  linear in e between;  phi = phi' = 0 below
// D additional modulus [stress], e* transition strain, w half the window. phi is twice continuously
// differentiable for w > 0; beyond the window phi' is that of the sharp knee, D (e - e*). Never throws.
#pragma once

#include <algorithm>

namespace coapt {

struct CurveValue {
  double energy = 0;     // [stress]
  double stress = 0;     // its derivative
  double stiffness = 0;  // its second derivative
};

// Pre: w <= e*, so that the curve is free of stress at rest.
struct BilinearKnee {
  double modulus = 0;     // D
  double transition = 0;  // e*
  double window = 0;      // w

  // The same knee over at least this window, as far as the strain at rest allows.
  BilinearKnee rounded(double least) const {
    return {modulus, transition, std::max(window, std::min(least, transition))};
  }

  CurveValue at(double strain) const {
    const double past = strain - transition;
    if (past <= -window) return {};
    if (past >= window) return {modulus * (past * past / 2 + window * window / 6), modulus * past, modulus};
    const double u = past + window, share = modulus / (2 * window);
    return {share * u * u * u / 6, share * u * u / 2, share * u};
  }
};

}  // namespace coapt
