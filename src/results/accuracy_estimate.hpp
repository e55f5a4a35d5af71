// What a solve to a wanted accuracy knows of its error.
#pragma once

#include "optim/solver.hpp"
#include "results/reference/reference_distance.hpp"

#include <optional>
#include <string>
#include <vector>

namespace coapt {

// A mesh that was solved on the way.
struct AccuracyLevel {
  int triangles = 0;
  double tolerance = 0;  // on the residual
  Status status = Status::Stalled;
  int iterations = 0;
  double wall_s = 0, cpu_s = 0;
  std::optional<DistanceFigures> to_previous = {};  // of the closed surfaces, from the mesh before
};

struct AccuracyEstimate {
  double wanted_mm = 0;
  std::optional<double> discretisation_mm;  // for 95 % of the surface; empty: not known
  std::optional<double> farthest_mm;        // the same of its farthest point
  std::optional<double> algebraic_mm;       // of the farthest vertex; empty: not known
  std::optional<double> order;              // observed from mesh to mesh; needs three meshes
  double tolerance = 0;                     // that was chosen
  int cuts = 0;                             // of the scene's own mesh into four
  bool is_reached = false;
  std::string message;                // one sentence
  std::vector<AccuracyLevel> levels;  // every solve, in the order in which they were made

  // Empty where a part is not known [mm].
  std::optional<double> total_mm() const {
    if (!discretisation_mm || !algebraic_mm) return std::nullopt;
    return *discretisation_mm + *algebraic_mm;
  }
  // The same of the farthest point.
  std::optional<double> greatest_mm() const {
    if (!farthest_mm || !algebraic_mm) return std::nullopt;
    return *farthest_mm + *algebraic_mm;
  }
};

}  // namespace coapt
