#include "stress/energy_checker.hpp"

#include "core/number_text.hpp"
#include "stress/bench.hpp"

#include <algorithm>
#include <cmath>

namespace coapt {

std::string energy_rise(const Result& result, Objective& objective, const Points& start) {
  constexpr double kRunaway = 100;  // times the size at the start
  const double extent = objective.extent(objective.unknowns(start));
  if (!(objective.extent(result.q) < kRunaway * extent)) return "";
  double greatest = 0;
  for (const Iteration& iteration : result.trace) greatest = std::max(greatest, std::abs(iteration.energy));
  const double rounding = 1e-11 * greatest + 1e-13 * objective.largest_force() * extent;
  for (size_t k = 1; k < result.trace.size(); ++k) {
    const Iteration &before = result.trace[k - 1], &now = result.trace[k];
    if (now.outer_iteration != before.outer_iteration || !now.is_descent ||
        now.energy <= before.energy + rounding)
      continue;
    return "in iteration " + std::to_string(now.iteration) + " the energy rises from " +
           number_text(before.energy) + " by " + number_text(now.energy - before.energy) + ", rounding " +
           number_text(rounding) + " mJ";
  }
  return "";
}

}  // namespace coapt
