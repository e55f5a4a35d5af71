// The generated valve of some 300 triangles, closed, with contact and follower pressure, as an equilibrium
// that is followed; and differences of fourth order to hold derivatives against.
#pragma once

#include "energy/kernels/bending.hpp"
#include "sensitivity/line_lengths.hpp"
#include "sensitivity/prescribed_positions.hpp"
#include "sensitivity/pressure_value.hpp"
#include "sensitivity/reference_positions.hpp"
#include "sensitivity/stiffness_factor.hpp"
#include "sensitivity/tracked_equilibrium.hpp"
#include "support/valve_scene.hpp"

#include <memory>
#include <random>
#include <string>
#include <vector>

namespace coapt {

inline constexpr double kTrackingTolerance = 2e-11;

inline const ValveScene& small_valve() {
  static const ValveScene scene({.triangles = 300, .contact_gap = 0.5});
  return scene;
}

// Closed by the whole method once, from the open state.
inline const Points& closed_small_valve() {
  static const Points x = [] {
    const ValveScene& scene = small_valve();
    return find_equilibrium(scene.X, scene.fixed, scene.terms(), scene.method(1e-9)).x;
  }();
  return x;
}

struct TrackedValve {
  const ValveScene& scene = small_valve();
  Objective objective;
  TrackedEquilibrium equilibrium;

  explicit TrackedValve(TrackingOptions options = {.tolerance = kTrackingTolerance})
      : objective(closed_small_valve(), scene.fixed, scene.terms()),
        equilibrium(objective, objective.unknowns(closed_small_valve()), options) {}

  EnergyTerm& term(const std::string& type) const {
    for (const auto& term : objective.terms())
      if (term->type() == type) return *term;
    throw std::runtime_error("no term of type " + type);
  }

  std::vector<int> annulus() const {
    std::vector<int> nodes;
    for (int v = 0; v <= scene.triangles.maxCoeff(); ++v)
      if (scene.fixed.col(v).all()) nodes.push_back(v);
    return nodes;
  }
  std::vector<int> tips() const {
    std::vector<int> nodes;
    for (int v = scene.triangles.maxCoeff() + 1; v < scene.X.cols(); ++v)
      if (scene.fixed.col(v).all()) nodes.push_back(v);
    return nodes;
  }

  // Every kind of parameter. Chords with an even number by themselves, the others in two groups.
  void add_all() {
    EnergyTerm& chords = term("cable");
    std::vector<std::vector<int>> single, groups(2);
    for (int e = 0; e < chords.stencils().count(); ++e) {
      if (e % 2 == 0)
        single.push_back({e});
      else
        groups[static_cast<size_t>(e / 2 % 2)].push_back(e);
    }
    const Points x = equilibrium.positions();
    const Points ring = x(Eigen::all, annulus()), tip = x(Eigen::all, tips());
    equilibrium.add(make_line_lengths("lengths", chords, single, LengthMeasure::Length));
    equilibrium.add(make_line_lengths("groups", chords, groups, LengthMeasure::Factor));
    equilibrium.add(make_prescribed_positions("tips", objective, tips(), free_positions(), coordinates(tip)));
    equilibrium.add(make_prescribed_positions(
        "ring", objective, annulus(), ring_shape(ring, Vec3::UnitZ(), Vec3::UnitX()), unchanged_ring()));
    std::vector<int> region;  // half of the triangles
    EnergyTerm& membrane = term("cst_tension_field");
    for (int t = 0; t < membrane.stencils().count() / 2; ++t) region.push_back(t);
    equilibrium.add(make_stiffness_factor("young", {{.term = &membrane, .elements = region}}, 1));
    equilibrium.add(make_stiffness_factor(
        "thickness",
        {{.term = &membrane, .is_size = true}, {.term = &term("bending"), .power = 3, .is_size = true}},
        0.8));
    equilibrium.add(make_pressure_value("pressure", term("load_pressure")));
    std::vector<int> rest_nodes;
    for (int v = 0; v <= scene.triangles.maxCoeff(); v += 7) rest_nodes.push_back(v);
    equilibrium.add(make_reference_positions("rest", objective, scene.X, rest_nodes));
  }

  // A direction in the numbers of one parameter, zero in the others, with entries of a size that suits it.
  Vector direction(size_t parameter, unsigned seed) const {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(0.5, 1);
    Vector all = Vector::Zero(equilibrium.number_count());
    const Vector value = equilibrium.parameter(parameter).value();
    const double scale = value.cwiseAbs().maxCoeff();
    for (Eigen::Index i = 0; i < value.size(); ++i)
      all[equilibrium.first_number(parameter) + i] =
          (random() % 2 == 0 ? 1 : -1) * uniform(random) * std::min(scale, 1.0);
    return all;
  }
};

// Derivative of f at 0, by steps of h.
template <typename Function>
double fourth_order_slope(const Function& f, double h) {
  return (8 * (f(h) - f(-h)) - (f(2 * h) - f(-2 * h))) / (12 * h);
}

}  // namespace coapt
