#include "results/neighbour_check.hpp"

#include "results/branch_report.hpp"

#include <algorithm>

namespace coapt {
namespace {

// Iterations from which others are suspected: of 28 valves those with more have others in 9 of 11 cases,
// those with fewer in 6 of 17.
constexpr int kLongPath = 40;

// Unstable steps of a damped path from which others are suspected: of 48 valves those with more have others
// in 16 of 26 cases, those with fewer in 3 of 22.
constexpr int kUnstableSteps = 2;

}  // namespace

NeighbourCheck check_neighbours(const std::string& solver, const Result& result,
                                const std::vector<CascadeLevel>& levels) {
  NeighbourCheck check;
  if (result.status != Status::Converged) return check;
  if (result.damped_steps > 0) {
    check.is_made = result.unstable_steps >= 0;
    check.unstable_steps = std::max(result.unstable_steps, 0);
    check.is_suspected = check.unstable_steps >= kUnstableSteps;
    return check;
  }
  if (solver != "newton") return check;
  check.is_made = true;
  check.iterates = result.iterations;
  for (const CascadeLevel& level : levels)
    if (level.damped_steps == 0) check.iterates = std::max(check.iterates, level.iterations);
  check.is_suspected = check.iterates >= kLongPath;
  return check;
}

std::string neighbour_warning(const NeighbourCheck& check) {
  if (!check.is_suspected) return "";
  const std::string why = check.unstable_steps >= kUnstableSteps
                              ? "its damped path is unstable in " + std::to_string(check.unstable_steps) +
                                    " steps from half of the loads on"
                              : "the solve took " + std::to_string(check.iterates) +
                                    " iterations, and most valves that take so many have other equilibria "
                                    "near by, with other figures";
  return "The shape may be one of several: " + why + ". Look for others with --branches " +
         std::to_string(kUsualStarts) + ".";
}

}  // namespace coapt
