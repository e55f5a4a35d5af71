#include "cli/progress_estimate.hpp"

#include "core/number_text.hpp"

#include <algorithm>
#include <cmath>

namespace coapt::cli {

void ProgressEstimate::see(const Iteration& now) {
  if (now.outer_iteration != round_ || now.seconds < now_s_) {  // another step, or another solve
    round_ = now.outer_iteration;
    start_s_ = now.seconds;
    first_residual_ = least_residual_ = now.residual;
  }
  least_residual_ = std::min(least_residual_, now.residual);
  now_s_ = now.seconds;
}

std::optional<double> ProgressEstimate::seconds_left(double wanted) const {
  constexpr double kLeastDecades = 1;
  const double fallen = std::log10(first_residual_ / least_residual_),
               open = std::log10(least_residual_ / wanted);
  if (!(fallen >= kLeastDecades) || !std::isfinite(open)) return std::nullopt;
  return std::max(0.0, (now_s_ - start_s_) * open / fallen);
}

std::string progress_line(const Iteration& now, long nodes, std::optional<double> wanted, double elapsed_s,
                          std::optional<double> left_s) {
  return "step " + std::to_string(now.outer_iteration) + ", " + std::to_string(nodes) + " nodes, iteration " +
         std::to_string(now.iteration) +
         (std::isnan(now.path) ? "" : ", path " + fixed_text(100 * now.path, 0) + " %") + ", residual " +
         number_text(now.residual, 2) + (wanted ? " (wanted " + number_text(*wanted, 2) + ")" : "") + ", " +
         fixed_text(elapsed_s, 1) + " s" +
         (left_s ? ", about " + number_text(std::max(*left_s, 0.1), 1) + " s left in this step" : "");
}

}  // namespace coapt::cli
