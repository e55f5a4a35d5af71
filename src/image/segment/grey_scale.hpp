// What the values of a volume mean.
#pragma once

#include "core/types.hpp"

namespace coapt {

// Values grow with the strength of the signal itself (CT, MR, a mask), or with its logarithm (ultrasound).
struct GreyScale {
  double decibels_per_value = 0;  // of power; 0: linear

  bool is_logarithmic() const { return decibels_per_value > 0; }
};

// The value between two others where the signal is this share of the way from the weaker to the stronger. 0 <
// share.
double value_at_share(const GreyScale& scale, double weaker, double stronger, double share);

}  // namespace coapt
