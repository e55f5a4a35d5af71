// Time of one step of xpbd on the generated valve as it closes: membrane, bending and chords, with and
// without contact and by the model of Walczak et al. 2019, by sweeps per step and threads. The first 200
// steps of a closure, again and again.
#include "energy/load_pressure.hpp"
#include "support/xpbd_bodies.hpp"
#include "valve/generators/mitral.hpp"
#include "xpbd/heart_forces.hpp"

#include <benchmark/benchmark.h>

namespace {

using namespace coapt;

constexpr double kYoung = 1, kThickness = 0.8, kDensity = 1.06e-9;  // MPa, mm, t/mm3
constexpr double kBending = 0.05;                                   // hinge [N mm]
constexpr int kSteps = 200;

struct ClosingValve {
  explicit ClosingValve(int triangles, bool has_contact) {
    const Valve valve = mitral_valve({.triangles = triangles, .preset = MitralPreset::Benchmark});
    const ChordNetwork& network = valve.chords;
    const int first_tip = valve.leaflets.vertex_count(),
              first_junction = first_tip + static_cast<int>(network.papillary.cols());
    body = sheet_body(valve.leaflets, kYoung * kThickness, 0.1, kBending);
    for (XpbdEdge& edge : body.edges) edge.only_tension = true;
    for (XpbdArea& area : body.areas) area.only_growth = true;
    body.rest.resize(3, first_junction + network.junctions.cols());
    body.rest << valve.leaflets.vertices, network.papillary, network.junctions;
    const auto node = [&](const ChordEnd& end) {
      if (end.kind == ChordEnd::Kind::Leaflet) return end.index;
      return end.index + (end.kind == ChordEnd::Kind::Papillary ? first_tip : first_junction);
    };
    for (const Chord& chord : network.chords) {
      XpbdTether tether;
      tether.a = node(chord.from);
      tether.b = node(chord.to);
      tether.length = chord.rest_length;
      tether.stiffness = 40 * chord.area / chord.rest_length;
      body.tethers.push_back(tether);
    }
    body.has_contact = has_contact;
    body.annulus = valve.annulus;
    fixed = FixedMask::Constant(3, body.rest.cols(), false);
    for (const int k : valve.annulus) fixed.col(k).setConstant(true);
    fixed.middleCols(first_tip, network.papillary.cols()).setConstant(true);
    masses = nodal_areas(body.rest, body.triangles) * kThickness * kDensity;
    masses = masses.cwiseMax(0.01 * masses.maxCoeff());
    pressure = valve.pressure;
  }

  XpbdBody body;
  FixedMask fixed;
  Vector masses;
  double pressure = 0;
};

// The pressure, or the paper's forces, at full size from the first step on, as in a solve.
void step(benchmark::State& state, bool has_contact, bool is_paper) {
  const ClosingValve valve(static_cast<int>(state.range(0)), has_contact);
  XpbdOptions options = is_paper ? walczak_2019() : XpbdOptions{};
  options.iterations = static_cast<int>(state.range(1));
  options.threads = static_cast<int>(state.range(2));
  std::optional<XpbdSystem> system;
  int steps = 0;
  for (auto _ : state) {
    if (steps++ % kSteps == 0) {
      state.PauseTiming();
      system.emplace(valve.body, valve.body.rest, valve.fixed, valve.masses, options);
      state.ResumeTiming();
    }
    const Points& x = system->positions();
    system->step(is_paper ? heart_forces(valve.body, x, options.paper, HeartPhase::Systole)
                          : follower_pressure_forces(x, valve.body.triangles, -valve.pressure));
  }
  state.counters["triangles"] = static_cast<double>(valve.body.triangles.cols());
  state.counters["constraints"] = static_cast<double>(system->constraint_count());
  if (has_contact) state.counters["active"] = static_cast<double>(system->contact()->active_count());
}

void sizes(benchmark::internal::Benchmark* bench) {
  bench->ArgNames({"triangles", "iterations", "threads"})->Unit(benchmark::kMillisecond)->Iterations(kSteps);
  bench->Args({5770, 3, 1})
      ->Args({5770, 20, 1})
      ->Args({5770, 20, 2})
      ->Args({625, 20, 1})
      ->Args({2500, 20, 1});
}

BENCHMARK_CAPTURE(step, no_contact, false, false)->Apply(sizes);
BENCHMARK_CAPTURE(step, contact, true, false)->Apply(sizes);
BENCHMARK_CAPTURE(step, walczak_2019, true, true)->Apply(sizes);

}  // namespace

BENCHMARK_MAIN();
