// A mixture of two bilinear lines that are strained alike:
//   s(e) = E e + phi_1'(e) + phi_2'(e)   (energy/laws/bilinear_curve.hpp)
// of the line along a fibre by the share c and of the one across it by 1 - c. Of one curve alone the second
// knee is nothing, of a linear line both are. Compressed (e < 0) the line is linear with E, as no knee
// reaches down to the strain at rest. Never throws.
#pragma once

#include "energy/laws/line_laws.hpp"

namespace coapt {

struct BlendedLine {
  double young = 0;            // E [stress]
  BilinearKnee first, second;  // their moduli are shares of what the curves gain

  // Energy per volume, nominal stress and its slope at the elongation e.
  CurveValue at(double e) const {
    const CurveValue a = first.at(e), b = second.at(e);
    return {0.5 * young * e * e + a.energy + b.energy, young * e + a.stress + b.stress,
            young + a.stiffness + b.stiffness};
  }
};

// share: of the first line, 0 to 1.
inline BlendedLine blended(const BilinearLine& first, const BilinearLine& second, double share) {
  const auto part = [](const BilinearKnee& knee, double of) {
    return BilinearKnee{of * knee.modulus, knee.transition, knee.window};
  };
  return {share * first.young + (1 - share) * second.young, part(first.knee, share),
          part(second.knee, 1 - share)};
}

}  // namespace coapt
