// Time of one gradient of membrane and pressure, per triangle, on one core. The baseline in the same run is
// the bare loop: the same gathers and scatters with next to no mathematics in between.
#include "energy/kernels/cst_stvk.hpp"
#include "energy/load_dead.hpp"
#include "energy/load_pressure.hpp"
#include "valve_sheet.hpp"

#include <benchmark/benchmark.h>

namespace {

using namespace coapt;

// Energy |x|^2/2 of each triangle's corners: the least that an element loop can do.
struct BareLoop {
  static constexpr int kNodes = 3;
  static constexpr std::string_view kType = "bare_loop";
  static constexpr TermRole kRole = TermRole::Internal;
  struct Rest {
    double factor = 1;
  };
  static double evaluate(const Rest& rest, const Eigen::Vector<double, 9>& x, Eigen::Vector<double, 9>* g,
                         Eigen::Matrix<double, 9, 9>*) {
    if (g != nullptr) *g = rest.factor * x;
    return 0.5 * rest.factor * x.squaredNorm();
  }
};

enum class Load { None, Frozen, Follower };

std::unique_ptr<Objective> valve_objective(int triangles, bool bare, Load load) {
  const bench::ValveSheet sheet(triangles);
  const Points& X = sheet.X;
  const Triangles& t = sheet.triangles;
  std::vector<std::unique_ptr<EnergyTerm>> terms;
  if (bare)
    terms.push_back(std::make_unique<ElementTerm<BareLoop>>("bare", sheet.corners(),
                                                            std::vector<BareLoop::Rest>(t.cols())));
  else
    terms.push_back(sheet.membrane<CstStVK>());
  if (load == Load::Frozen)
    terms.push_back(std::make_unique<LoadDead>("pressure", "load_pressure",
                                               frozen_pressure_forces(X, t, -sheet.pressure), X));
  if (load == Load::Follower)
    terms.push_back(make_follower_pressure("pressure", X, t, -sheet.pressure, sheet.fixed));
  auto objective = std::make_unique<Objective>(X, sheet.fixed, std::move(terms));
  if (objective->has_circulatory_force()) objective->set_path_anchor(objective->unknowns(X));
  return objective;
}

void gradient(benchmark::State& state, bool bare, Load load) {
  const auto objective = valve_objective(static_cast<int>(state.range(0)), bare, load);
  Vector q = objective->unknowns(objective->positions(Vector::Zero(objective->unknown_count()))), g;
  q.setLinSpaced(-20, 20);
  for (auto _ : state) benchmark::DoNotOptimize(objective->gradient(q, g));
  const double triangles = static_cast<double>(objective->terms().back()->stencils().count());
  state.counters["ns_per_triangle"] = benchmark::Counter(
      triangles * 1e-9, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void sizes(benchmark::internal::Benchmark* bench) {
  for (int triangles : {625, 2500, 10000, 40000, 160000}) bench->Arg(triangles);
  bench->Unit(benchmark::kMicrosecond);
}

BENCHMARK_CAPTURE(gradient, bare_loop_as_baseline, true, Load::None)->Apply(sizes);
BENCHMARK_CAPTURE(gradient, stvk, false, Load::None)->Apply(sizes);
BENCHMARK_CAPTURE(gradient, stvk_and_frozen_pressure, false, Load::Frozen)->Apply(sizes);
BENCHMARK_CAPTURE(gradient, stvk_and_follower_pressure, false, Load::Follower)->Apply(sizes);

}  // namespace

BENCHMARK_MAIN();
