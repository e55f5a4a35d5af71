// Notices where a path of loads, stiffnesses or prescribed motion leaves its branch of equilibria.
#pragma once

#include "optim/solver.hpp"

#include <functional>
#include <optional>
#include <vector>

namespace coapt {

// What following a path needs. t: place on it, 0 < t <= 1.
struct PathMeans {
  // Sets loads, stiffnesses and prescribed coordinates.
  std::function<void(double t)> pose;

  // The same, with the free coordinates of q taken along from where the objective was posed. Returns false
  // when a collision is in the way.
  std::function<bool(double t, Vector& q)> carry;

  // Improves q to the equilibrium where the objective is posed; false when that does not converge.
  std::function<bool(Vector& q)> solve;
};

// A step in which the shape goes more than three times as far as in the step before may be a snap: the branch
// ends at a limit point and there is none nearby. That is put to the test by undoing the step. A shape that
// does not come back to where it was has changed branches, and the distance between the two equilibria at
// that place of the path is that of the branches. Where the place before was itself beyond the limit point
// (steps of the path are left at a loose tolerance), the one before it is taken. Costs nothing but two
// vectors, and two solves from nearby for each step under suspicion; their iterates count and are observed
// like all others.
class BranchWatch {
 public:
  explicit BranchWatch(PathMeans means) : means_(std::move(means)) {}

  // Call it with the equilibrium of each step, the objective posed at its t; it is posed there again
  // afterwards. step: from 1.
  std::optional<BranchChange> arrive(int step, double t, const Vector& q);

 private:
  struct Place {
    int step;
    double t;
    Vector q;
  };

  std::optional<BranchChange> compare(const Place& now, double travel);

  PathMeans means_;
  std::vector<Place> visited_;  // the last two, the later one last
  double last_travel_ = 0;      // [length]
};

}  // namespace coapt
