#include "cli/progress_estimate.hpp"

#include "core/number_text.hpp"

#include <algorithm>
#include <cmath>

namespace coapt::cli {
namespace {

// ", about 30 s left"; number_text() of one digit would say 3e+01.
std::string left_text(double seconds) {
  return ", about " + fixed_text(std::max(seconds, 0.1), seconds < 1 ? 1 : 0) + " s left";
}

}  // namespace

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

std::string progress_line(const std::string& phase, const Iteration& now, long nodes,
                          std::optional<double> wanted, double elapsed_s, std::optional<double> left_s) {
  return phase + (phase.empty() ? "" : ", ") + "step " + std::to_string(now.outer_iteration) + ", " +
         std::to_string(nodes) + " nodes, iteration " + std::to_string(now.iteration) +
         (std::isnan(now.path) ? "" : ", path " + fixed_text(100 * now.path, 0) + " %") + ", residual " +
         number_text(now.residual, 2) + (wanted ? " (wanted " + number_text(*wanted, 2) + ")" : "") + ", " +
         fixed_text(elapsed_s, 1) + " s" + (left_s ? left_text(*left_s) + " in this step" : "");
}

std::string job_progress_line(const std::string& jobs, std::size_t ended, std::size_t count,
                              double elapsed_s) {
  const double left_s =
      ended == 0 ? 0 : elapsed_s * static_cast<double>(count - ended) / static_cast<double>(ended);
  return std::to_string(ended) + " of " + std::to_string(count) + " " + jobs + ", " +
         fixed_text(elapsed_s, 1) + " s" + (ended == 0 ? "" : left_text(left_s));
}

}  // namespace coapt::cli
