#include "support/sheets.hpp"

#include "energy/element_term.hpp"
#include "energy/kernels/bending.hpp"
#include "energy/kernels/cst_tension_field.hpp"
#include "support/meshes.hpp"

namespace coapt {
namespace {

std::vector<CstTensionField::Rest> rest_states(const Points& X, const Triangles& triangles,
                                               const Membrane& membrane) {
  std::vector<CstTensionField::Rest> rest;
  for (const auto& t : triangles.colwise())
    rest.push_back(CstTensionField::rest(X.col(t[0]), X.col(t[1]), X.col(t[2]), membrane.stiffness,
                                         membrane.poisson, 1, membrane.prestress));
  return rest;
}

// The corner of a triangle that is on neither end of an edge.
int opposite(const Eigen::Vector3i& triangle, const Edge& edge) { return triangle.sum() - edge.a - edge.b; }

}  // namespace

std::unique_ptr<EnergyTerm> tension_field_term(const Points& X, const Triangles& triangles,
                                               const Membrane& membrane) {
  return std::make_unique<ElementTerm<CstTensionField>>("membrane", triangle_nodes(triangles),
                                                        rest_states(X, triangles, membrane));
}

std::unique_ptr<EnergyTerm> sheet_term(SheetLaw material, const Points& X, const Triangles& triangles,
                                       const Membrane& membrane) {
  if (material == SheetLaw::TensionField) return tension_field_term(X, triangles, membrane);
  return membrane_term(X, triangles, membrane);
}

std::unique_ptr<EnergyTerm> bending_term(const Points& X, const Triangles& triangles, double stiffness) {
  std::vector<int> nodes;
  std::vector<BendingHinge::Rest> rest;
  for (const Edge& edge : edges(triangles)) {
    if (edge.triangles.size() != 2) continue;
    const int c = opposite(triangles.col(edge.triangles[0]), edge),
              d = opposite(triangles.col(edge.triangles[1]), edge);
    nodes.insert(nodes.end(), {edge.a, edge.b, c, d});
    rest.push_back(BendingHinge::rest(X.col(edge.a), X.col(edge.b), X.col(c), X.col(d), stiffness));
  }
  return std::make_unique<ElementTerm<BendingHinge>>("bending", std::move(nodes), std::move(rest));
}

Eigen::Vector3d regime_areas(const Points& X, const Points& x, const Triangles& triangles,
                             const Membrane& membrane) {
  const std::vector<CstTensionField::Rest> rest = rest_states(X, triangles, membrane);
  Eigen::Vector3d areas = Eigen::Vector3d::Zero();
  for (Eigen::Index t = 0; t < triangles.cols(); ++t) {
    CstVector corners;
    for (int a = 0; a < 3; ++a) corners.segment<3>(3 * a) = x.col(triangles(a, t));
    areas[static_cast<int>(CstTensionField::regime(rest[t], corners))] +=
        area_vector(X, triangles.col(t)).norm();
  }
  return areas;
}

Equilibrium find_equilibrium(const Points& start, const FixedMask& fixed, Terms terms, const Method& method) {
  Objective objective(start, fixed, std::move(terms));
  StopRule stop;
  stop.tolerance = method.tolerance;
  stop.max_iterations = method.max_iterations;
  stop.max_seconds = method.max_seconds;
  SolverOptions options;
  options.factorisation = make_multifrontal_factorisation;
  options.masses = method.masses;
  options.dynamic = method.dynamic;
  const auto watch = [&](const Iteration&, const Vector& q) {
    if (method.watch) method.watch(objective.positions(q));
    return true;
  };
  Equilibrium found;
  found.result =
      solve(*built_in_solvers().at(method.solver)(options),
            {objective, objective.unknowns(start), method.motion, method.continuation}, stop, watch);
  found.x = objective.positions(found.result.q);
  return found;
}

}  // namespace coapt
