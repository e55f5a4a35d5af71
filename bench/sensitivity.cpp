// The generated valve as an inner loop meets it: a chord is shortened by 0.1 mm, solved again from the last
// shape, and the energy differentiated by all chord lengths at once; beside one solve from the open state.
// With contact by a barrier and follower pressure, to a residual of 1e-8.
//   warm       set() and solve(), the check of the branch included; gradient:1 with the derivatives
//   gradient   derivatives() at a solved shape by all chord lengths; numbers:1 by papillary tips, annulus,
//              thickness and pressure too; numbers:2 by the rest position of each vertex too
//   cold_ms    CPU time of the solve from the open state, measured once in the same run
#include "sensitivity/metrics/metrics_state.hpp"
#include "sensitivity/parameters/line_lengths.hpp"
#include "sensitivity/parameters/prescribed_positions.hpp"
#include "sensitivity/parameters/pressure_value.hpp"
#include "sensitivity/parameters/reference_positions.hpp"
#include "sensitivity/parameters/stiffness_factor.hpp"
#include "sensitivity/tracked_equilibrium.hpp"
#include "support/valve_scene.hpp"

#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdlib>
#include <map>
#include <numeric>

namespace {

using namespace coapt;

constexpr double kTolerance = 1e-8;
constexpr double kChange = 0.1;  // mm

struct Solved {
  std::unique_ptr<ValveScene> scene;
  Points x;
  double cold_ms = 0;
};

const Solved& solved(int triangles) {
  static std::map<int, Solved> known;
  Solved& valve = known[triangles];
  if (valve.scene) return valve;
  // The gap goes with the size of the triangles, as the scene's default does.
  const double gap = 0.5 * std::sqrt(625.0 / triangles);
  valve.scene = std::make_unique<ValveScene>(ValveOptions{.triangles = triangles, .contact_gap = gap});
  Equilibrium found = find_equilibrium(valve.scene->X, valve.scene->fixed, valve.scene->terms(),
                                       valve.scene->method(kTolerance));
  valve.x = found.x;
  valve.cold_ms = 1e3 * found.result.cpu_s;
  return valve;
}

struct Tracked {
  explicit Tracked(const Solved& valve)
      : objective(valve.x, valve.scene->fixed, valve.scene->terms()),
        equilibrium(objective, objective.unknowns(valve.x),
                    {.factorisation = make_multifrontal_factorisation, .tolerance = kTolerance}) {
    EnergyTerm& chords = term("cable");
    equilibrium.add(make_line_lengths("lengths", chords, single_lines(chords), LengthMeasure::Length));
  }

  EnergyTerm& term(const std::string& type) const {
    for (const auto& each : objective.terms())
      if (each->type() == type) return *each;
    std::abort();
  }

  void add_the_rest(const Solved& valve) {
    std::vector<int> ring, tips;
    const int first_tip = valve.scene->triangles.maxCoeff() + 1;
    for (int v = 0; v < objective.node_count(); ++v)
      if (objective.fixed().col(v).all()) (v < first_tip ? ring : tips).push_back(v);
    equilibrium.add(make_prescribed_positions("tips", objective, tips, free_positions(),
                                              coordinates(valve.x(Eigen::all, tips))));
    equilibrium.add(make_prescribed_positions(
        "ring", objective, ring, ring_shape(valve.x(Eigen::all, ring), Vec3::UnitZ(), Vec3::UnitX()),
        unchanged_ring()));
    equilibrium.add(make_stiffness_factor("thickness",
                                          {{.term = &term("cst_tension_field"), .is_size = true},
                                           {.term = &term("bending"), .power = 3, .is_size = true}},
                                          0.8));
    equilibrium.add(make_pressure_value("pressure", term("load_pressure")));
  }

  // Three numbers for each vertex of the leaflets.
  void add_rest_shape(const Solved& valve) {
    std::vector<int> all(static_cast<size_t>(valve.scene->triangles.maxCoeff() + 1));
    std::iota(all.begin(), all.end(), 0);
    equilibrium.add(make_reference_positions("rest", objective, valve.scene->X, all));
  }

  Objective objective;
  TrackedEquilibrium equilibrium;
};

void report(benchmark::State& state, const Solved& valve, const Tracked& tracked) {
  state.counters["triangles"] = static_cast<double>(valve.scene->triangles.cols());
  state.counters["numbers"] = tracked.equilibrium.number_count();
  state.counters["cold_ms"] = valve.cold_ms;
}

// Chords one after the other, shortened and let go.
void warm(benchmark::State& state) {
  const Solved& valve = solved(static_cast<int>(state.range(0)));
  Tracked tracked(valve);
  tracked.equilibrium.solve();
  const Vector start = tracked.equilibrium.value();
  const auto energy = make_strain_energy("energy", tracked.objective);
  long solves = 0, steps = 0, slow = 0;
  int chord = 0, most = 0;
  for (auto _ : state) {
    Vector value = start;
    if (solves % 2 == 0) value[chord = (chord + 7) % static_cast<int>(start.size())] -= kChange;
    tracked.equilibrium.set(value);
    const WarmSolve solved = tracked.equilibrium.solve();
    if (solved.status != Status::Converged) state.SkipWithError("not converged");
    if (state.range(1) != 0)
      benchmark::DoNotOptimize(tracked.equilibrium.derivatives(*energy).gradient.data());
    ++solves;
    steps += solved.iterations;
    most = std::max(most, solved.iterations);
    slow += solved.is_quick ? 0 : 1;
  }
  report(state, valve, tracked);
  state.counters["steps"] = static_cast<double>(steps) / static_cast<double>(std::max(1L, solves));
  state.counters["most_steps"] = most;
  state.counters["whole_method"] = static_cast<double>(slow);
}

void gradient(benchmark::State& state) {
  const Solved& valve = solved(static_cast<int>(state.range(0)));
  Tracked tracked(valve);
  if (state.range(1) == 1) tracked.add_the_rest(valve);
  if (state.range(1) == 2) tracked.add_rest_shape(valve);
  tracked.equilibrium.solve();
  const auto energy = make_strain_energy("energy", tracked.objective);
  for (auto _ : state) benchmark::DoNotOptimize(tracked.equilibrium.derivatives(*energy).gradient.data());
  report(state, valve, tracked);
}

void sizes(benchmark::internal::Benchmark* bench, const std::string& option, int most) {
  bench->ArgNames({"triangles", option})->Unit(benchmark::kMillisecond);
  for (const int triangles : {625, 2500, 10000})
    for (int value = 0; value <= most; ++value) bench->Args({triangles, value});
}

BENCHMARK(warm)->Apply([](auto* bench) { sizes(bench, "gradient", 1); });
BENCHMARK(gradient)->Apply([](auto* bench) { sizes(bench, "numbers", 2); });

}  // namespace

BENCHMARK_MAIN();
