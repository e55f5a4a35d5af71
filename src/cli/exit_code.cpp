#include "cli/exit_code.hpp"

#include "results/result_warnings.hpp"

#include <algorithm>

namespace coapt::cli {

int exit_code_of(bool has_converged, const std::vector<std::vector<std::string>>& doubts) {
  if (!has_converged) return kNotConverged;
  return std::any_of(doubts.begin(), doubts.end(), are_about_stability) ? kInDoubt : kConverged;
}

}  // namespace coapt::cli
