#include "support/equilibrium.hpp"

#include "energy/element_term.hpp"
#include "energy/kernels/cable.hpp"
#include "energy/kernels/cst_stvk.hpp"
#include "support/meshes.hpp"

#include <cmath>

namespace coapt {

std::unique_ptr<EnergyTerm> membrane_term(const Points& X, const Triangles& triangles,
                                          const Membrane& membrane) {
  std::vector<CstStVK::Rest> rest;
  for (Eigen::Index t = 0; t < triangles.cols(); ++t)
    rest.push_back(CstStVK::rest(X.col(triangles(0, t)), X.col(triangles(1, t)), X.col(triangles(2, t)),
                                 membrane.stiffness, membrane.poisson, 1, membrane.prestress));
  return std::make_unique<ElementTerm<CstStVK>>("membrane", triangle_nodes(triangles), std::move(rest));
}

double membrane_energy(const EnergyTerm& term, const Points& x) {
  Sink sink;
  return term.evaluate(x, sink);
}

std::unique_ptr<EnergyTerm> cable_term(const Segments& segments, double axial_stiffness,
                                       const Vector& rest_lengths) {
  std::vector<Cable::Rest> rest;
  for (const double length : rest_lengths) rest.push_back({axial_stiffness / length, length, 0, 0});
  return std::make_unique<ElementTerm<Cable>>(
      "cables", std::vector<int>(segments.data(), segments.data() + segments.size()), std::move(rest));
}

FixedMask fixed_nodes(Eigen::Index node_count, const std::vector<int>& nodes) {
  FixedMask fixed = FixedMask::Constant(3, node_count, false);
  for (const int node : nodes) fixed.col(node).setConstant(true);
  return fixed;
}

Equilibrium find_equilibrium(const Points& start, const FixedMask& fixed, Terms terms, double tolerance,
                             const std::string& solver) {
  Objective objective(start, fixed, std::move(terms));
  StopRule stop;
  stop.tolerance = tolerance;
  stop.max_seconds = 120;
  Equilibrium found;
  found.result = solve(*built_in_solvers().at(solver)({}), {objective, objective.unknowns(start), {}}, stop);
  found.x = objective.positions(found.result.q);
  return found;
}

double observed_order(double coarse_error, double fine_error, double ratio) {
  return std::log(std::abs(coarse_error / fine_error)) / std::log(ratio);
}

}  // namespace coapt
