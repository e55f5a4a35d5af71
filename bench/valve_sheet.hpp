// The generated valve's leaflets, held at the annulus, for benchmarks.
#pragma once

#include "energy/element_term.hpp"
#include "energy/objective.hpp"
#include "valve/generators/mitral.hpp"

namespace coapt::bench {

struct ValveSheet {
  explicit ValveSheet(int wanted) {
    MitralOptions options;
    options.preset = MitralPreset::Benchmark;
    options.triangles = wanted;
    const Valve valve = mitral_valve(options);
    X = valve.leaflets.vertices;
    triangles = valve.leaflets.triangles;
    pressure = valve.pressure;
    fixed = FixedMask::Constant(3, X.cols(), false);
    for (const int node : valve.annulus) fixed.col(node).setConstant(true);
  }

  std::vector<int> corners() const { return {triangles.data(), triangles.data() + triangles.size()}; }

  // E = 1, nu = 0.45, h = 0.8.
  template <typename Kernel>
  std::unique_ptr<EnergyTerm> membrane() const {
    std::vector<typename Kernel::Rest> rest;
    for (const auto& t : triangles.colwise())
      rest.push_back(Kernel::rest(X.col(t[0]), X.col(t[1]), X.col(t[2]), 1, 0.45, 0.8));
    return std::make_unique<ElementTerm<Kernel>>("membrane", corners(), rest);
  }

  Points X;
  Triangles triangles;
  FixedMask fixed;
  double pressure = 0;  // closing [MPa]
};

}  // namespace coapt::bench
