// A truss that snaps through when its span grows.
#pragma once

#include "energy/kernels/spring.hpp"
#include "energy/load_dead.hpp"
#include "sensitivity/parameters/prescribed_positions.hpp"
#include "sensitivity/tracked_equilibrium.hpp"
#include "support/sheets.hpp"

namespace coapt {

// An apex between two supports, on springs that resist compression, under a dead load: von Mises' truss. Node
// 3 hangs by a spring of its own on a support, and slides along x.
struct Truss {
  explicit Truss(double load, TrackingOptions options = {})
      : objective(positions(), fixed(), terms(load)),
        equilibrium(objective, objective.unknowns(positions()), with_tolerance(std::move(options))) {
    const Points supports = positions().leftCols(2);
    equilibrium.add(make_prescribed_positions(
        "span", objective, {0, 1},
        [supports](const Vector& value, std::vector<Points>* slopes) {
          const Vec3 scale(1, 0, 0);
          Points by = scale.asDiagonal() * supports;
          if (slopes != nullptr) *slopes = {by};
          return Points(supports + (value[0] - 1) * by);
        },
        Vector::Ones(1)));
  }
  static TrackingOptions with_tolerance(TrackingOptions options) {
    options.tolerance = 1e-12;
    return options;
  }
  static FixedMask fixed() {
    FixedMask mask = fixed_nodes(4, {0, 1});
    mask(1, 2) = mask(1, 3) = mask(2, 3) = true;  // or the compressed springs would swing sideways
    return mask;
  }
  static Points positions() {
    Points x(3, 4);
    x << -1, 1, 0, 2, 0, 0, 0, 0, 0, 0, 0.2, 0;
    return x;
  }
  static Terms terms(double load) {
    Points forces = Points::Zero(3, 4);
    forces(2, 2) = -load;
    BlendedLine law;
    law.young = 1;
    const double length = std::sqrt(1.04);
    std::vector<Spring::Rest> springs(2, Spring::Rest{length, 1, 0, true, law});
    springs.push_back({1, 1, 0, true, law});
    return terms_of(
        std::make_unique<ElementTerm<Spring>>("arms", std::vector<int>{0, 2, 1, 2, 1, 3}, springs),
        std::make_unique<LoadDead>("load", "load_field", forces, positions()));
  }
  Objective objective;
  TrackedEquilibrium equilibrium;
};

}  // namespace coapt
