// Inflates a disc with the installed library: the program of docs/library.md.
#include "energy/element_term.hpp"
#include "energy/kernels/cst_stvk.hpp"
#include "energy/load_pressure.hpp"
#include "mesh/shapes.hpp"
#include "optim/solver.hpp"

#include <cmath>
#include <cstdio>

int main() {
  using namespace coapt;
  const TriangleMesh mesh = disc(1, 600);
  const Points& X = mesh.vertices;
  const Triangles& t = mesh.triangles;

  FixedMask fixed = FixedMask::Constant(3, X.cols(), false);
  const std::vector<std::vector<int>> rims = boundary_loops(t);
  for (int node : rims[0]) fixed.col(node).setConstant(true);

  std::vector<CstStVK::Rest> rest;
  for (int k = 0; k < t.cols(); ++k)
    rest.push_back(CstStVK::rest(X.col(t(0, k)), X.col(t(1, k)), X.col(t(2, k)), 1, 0.3, 1));

  std::vector<std::unique_ptr<EnergyTerm>> terms;
  terms.push_back(std::make_unique<ElementTerm<CstStVK>>(
      "membrane", std::vector<int>(t.data(), t.data() + t.size()), rest));
  terms.push_back(make_follower_pressure("pressure", X, t, 0.01, fixed));
  Objective objective(X, fixed, std::move(terms));

  Points start = X;
  start.row(2) = (0.1 * (1 - X.colwise().squaredNorm().array())).matrix();
  const auto solver = built_in_solvers().at("lbfgs")({});
  const Result result = solve(*solver, {objective, objective.unknowns(start), {}}, {.tolerance = 1e-8});

  const double height = objective.positions(result.q).row(2).maxCoeff();
  std::printf("%s: centre at %.5f (theory 0.14138)\n", result.message.c_str(), height);
  return result.status == Status::Converged && std::abs(height - 0.14138) < 2e-3 ? 0 : 1;
}
