#include "image/segment/grey_scale.hpp"

#include <cmath>

namespace coapt {

double value_at_share(const GreyScale& scale, double weaker, double stronger, double share) {
  if (!scale.is_logarithmic()) return weaker + share * (stronger - weaker);
  const double ratio = std::pow(10, 0.1 * scale.decibels_per_value * (weaker - stronger));
  return stronger + 10 / scale.decibels_per_value * std::log10(ratio + share * (1 - ratio));
}

}  // namespace coapt
