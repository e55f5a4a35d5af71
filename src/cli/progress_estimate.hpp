// How long a minimisation still takes, from how far it has got.
#pragma once

#include "optim/solver.hpp"

#include <cstddef>
#include <optional>
#include <string>

namespace coapt::cli {

class ProgressEstimate {
 public:
  // Call it at each accepted iterate.
  void see(const Iteration& now);

  // [s], by the decades that the residual has fallen in this round and has still to fall to `wanted`. Nothing
  // before it has fallen by one.
  std::optional<double> seconds_left(double wanted) const;

 private:
  int round_ = -1;  // of the outer iterations and of the steps of a path
  double start_s_ = 0, now_s_ = 0;
  double first_residual_ = 0, least_residual_ = 0;
};

// "finest mesh, step 3, 1234 nodes, iteration 12, path 45 %, residual 0.0012 (wanted 1e-06), 3.4 s, about 5 s
// left in this step"; of a path of loads or of prescribed motion the share done. The energy is left out: that
// of a step on the way is not the one that is reported. phase: may be empty.
std::string progress_line(const std::string& phase, const Iteration& now, long nodes,
                          std::optional<double> wanted, double elapsed_s, std::optional<double> left_s);

// "2 of 5 points, 14.0 s, about 21 s left": by the mean time of those that have ended.
std::string job_progress_line(const std::string& jobs, std::size_t ended, std::size_t count,
                              double elapsed_s);

}  // namespace coapt::cli
