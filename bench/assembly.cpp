// Time of one assembly (energy, gradient and Hessian in place) on one core, by term and projection: per
// triangle of the generated valve, and for bending per hinge.
#include "energy/element_term.hpp"
#include "energy/kernels/bending.hpp"
#include "energy/kernels/cst_tension_field.hpp"
#include "energy/load_pressure.hpp"
#include "mesh/generators/mitral.hpp"

#include <benchmark/benchmark.h>

#include <cmath>

namespace {

using namespace coapt;

enum class Law { StVK, TensionField, Bending, TensionFieldAndPressure };

template <typename Kernel>
std::unique_ptr<EnergyTerm> membrane(const Points& X, const Triangles& t) {
  std::vector<typename Kernel::Rest> rest;
  for (int k = 0; k < t.cols(); ++k)
    rest.push_back(Kernel::rest(X.col(t(0, k)), X.col(t(1, k)), X.col(t(2, k)), 1, 0.45, 0.8));
  return std::make_unique<ElementTerm<Kernel>>("membrane", std::vector<int>(t.data(), t.data() + t.size()),
                                               rest);
}

std::unique_ptr<EnergyTerm> bending(const Points& X, const Triangles& t) {
  std::vector<int> nodes;
  std::vector<BendingHinge::Rest> rest;
  for (const Edge& edge : edges(t)) {
    if (edge.triangles.size() != 2) continue;
    const int c = t.col(edge.triangles[0]).sum() - edge.a - edge.b,
              d = t.col(edge.triangles[1]).sum() - edge.a - edge.b;
    nodes.insert(nodes.end(), {edge.a, edge.b, c, d});
    rest.push_back(BendingHinge::rest(X.col(edge.a), X.col(edge.b), X.col(c), X.col(d), 0.05));
  }
  return std::make_unique<ElementTerm<BendingHinge>>("bending", nodes, rest);
}

void assembly(benchmark::State& state, Law law, Projection projection) {
  MitralOptions options;
  options.triangles = static_cast<int>(state.range(0));
  const Valve valve = mitral_valve(options);
  const Points& X = valve.leaflets.vertices;
  const Triangles& t = valve.leaflets.triangles;
  FixedMask fixed = FixedMask::Constant(3, X.cols(), false);
  for (const int node : valve.annulus) fixed.col(node).setConstant(true);
  std::vector<std::unique_ptr<EnergyTerm>> terms;
  if (law == Law::StVK) terms.push_back(membrane<CstStVK>(X, t));
  if (law == Law::TensionField || law == Law::TensionFieldAndPressure)
    terms.push_back(membrane<CstTensionField>(X, t));
  if (law == Law::Bending) terms.push_back(bending(X, t));
  if (law == Law::TensionFieldAndPressure)
    terms.push_back(make_follower_pressure("pressure", X, t, -valve.pressure, fixed));
  Objective objective(X, fixed, std::move(terms));
  if (objective.has_circulatory_force()) objective.follow_path(objective.unknowns(X));

  // Waves along and across, so that all regimes occur side by side.
  Points x = X;
  for (Eigen::Index k = 0; k < x.cols(); ++k)
    x.col(k) += 0.4 * Vec3(std::sin(X(1, k)), std::sin(0.7 * X(2, k)), std::sin(0.9 * X(0, k)));
  const Vector q = objective.unknowns(x);
  Vector g;
  Eigen::SparseMatrix<double> h;
  objective.hessian(q, g, h, projection);
  for (auto _ : state) benchmark::DoNotOptimize(objective.hessian(q, g, h, projection));
  const double elements =
      law == Law::Bending ? objective.terms()[0]->stencils().count() : static_cast<double>(t.cols());
  state.counters["ns_per_element"] = benchmark::Counter(
      elements * 1e-9, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void sizes(benchmark::internal::Benchmark* bench) {
  for (int triangles : {10000, 40000}) bench->Arg(triangles);
  bench->Unit(benchmark::kMicrosecond);
}

constexpr Projection kExact = Projection::None, kProjected = Projection::PositiveSemidefinite;
BENCHMARK_CAPTURE(assembly, stvk_exact, Law::StVK, kExact)->Apply(sizes);
BENCHMARK_CAPTURE(assembly, stvk_projected, Law::StVK, kProjected)->Apply(sizes);
BENCHMARK_CAPTURE(assembly, tension_field_exact, Law::TensionField, kExact)->Apply(sizes);
BENCHMARK_CAPTURE(assembly, tension_field_projected, Law::TensionField, kProjected)->Apply(sizes);
BENCHMARK_CAPTURE(assembly, tension_field_and_pressure, Law::TensionFieldAndPressure, kExact)->Apply(sizes);
BENCHMARK_CAPTURE(assembly, bending_exact, Law::Bending, kExact)->Apply(sizes);
BENCHMARK_CAPTURE(assembly, bending_projected, Law::Bending, kProjected)->Apply(sizes);

}  // namespace

BENCHMARK_MAIN();
