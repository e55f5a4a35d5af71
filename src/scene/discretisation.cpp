#include "scene/discretisation.hpp"

#include <algorithm>
#include <cmath>

namespace coapt {

DiscretisationEstimate estimate_discretisation(const std::vector<DistanceFigures>& to_next) {
  DiscretisationEstimate estimate;
  const size_t count = to_next.size();
  if (count > 1 && to_next[count - 1].mean > 0 && to_next[count - 2].mean > 0) {
    estimate.order = std::log2(to_next[count - 2].mean / to_next[count - 1].mean);
    estimate.assumed_order = std::clamp(*estimate.order, 0.5, 2.0);
  }
  double error = to_next.back().p95 / (std::exp2(estimate.assumed_order) - 1);
  estimate.error_mm.assign(count + 1, error);
  for (size_t k = count; k-- > 0;) estimate.error_mm[k] = error += to_next[k].p95;
  return estimate;
}

}  // namespace coapt
