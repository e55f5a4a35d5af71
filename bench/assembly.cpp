// Time of one assembly (energy, gradient and Hessian in place) by term, projection and threads: per
// triangle of the generated valve, and for bending per hinge.
#include "energy/kernels/bending.hpp"
#include "energy/kernels/cst_tension_field.hpp"
#include "energy/load_pressure.hpp"
#include "valve_sheet.hpp"

#include <benchmark/benchmark.h>

#include <cmath>

namespace {

using namespace coapt;

enum class Law { StVK, TensionField, Bending, TensionFieldAndPressure };

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
  const bench::ValveSheet sheet(static_cast<int>(state.range(0)));
  const Points& X = sheet.X;
  const Triangles& t = sheet.triangles;
  std::vector<std::unique_ptr<EnergyTerm>> terms;
  if (law == Law::StVK) terms.push_back(sheet.membrane<CstStVK>());
  if (law == Law::TensionField || law == Law::TensionFieldAndPressure)
    terms.push_back(sheet.membrane<CstTensionField>());
  if (law == Law::Bending) terms.push_back(bending(X, t));
  if (law == Law::TensionFieldAndPressure)
    terms.push_back(make_follower_pressure("pressure", X, t, -sheet.pressure, sheet.fixed));
  Objective objective(X, sheet.fixed, std::move(terms));
  objective.use_threads(static_cast<int>(state.range(1)));
  if (objective.has_circulatory_force()) objective.set_path_anchor(objective.unknowns(X));

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
  bench->ArgNames({"triangles", "threads"})->Unit(benchmark::kMicrosecond);
  for (const int threads : {1, 2})
    for (const int triangles : {10000, 40000}) bench->Args({triangles, threads});
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
