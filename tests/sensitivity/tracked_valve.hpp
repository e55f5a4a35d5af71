// The generated valve of some 300 triangles, closed, with contact and follower pressure, as an equilibrium
// that is followed; and differences of fourth order to hold derivatives against.
#pragma once

#include "energy/load_dead.hpp"
#include "sensitivity/parameters/dead_load.hpp"
#include "sensitivity/parameters/joint_parameter.hpp"
#include "sensitivity/parameters/line_lengths.hpp"
#include "sensitivity/parameters/prescribed_positions.hpp"
#include "sensitivity/parameters/pressure_value.hpp"
#include "sensitivity/parameters/reference_positions.hpp"
#include "sensitivity/parameters/stiffness_factor.hpp"
#include "sensitivity/parameters/term_number.hpp"
#include "sensitivity/tracked_equilibrium.hpp"
#include "support/tissue_laws.hpp"
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

// Chords of Ogden's law with another first exponent.
inline std::unique_ptr<EnergyTerm> ogden_chords(double exponent) {
  const ValveScene& scene = small_valve();
  const Eigen::VectorXi ends = scene.chords.reshaped();
  OgdenLine law = laws::OgdenChord::law(2);
  law.alpha[0] = exponent;
  return chord_term({ends.begin(), ends.end()}, scene.chord_lengths, scene.chord_areas, 0.002, law);
}

// The same valve of exponential tissue, stiff enough to leave an orifice, on chords of Ogden's law; it weighs
// something, and two vertices are
// pulled at.
inline Terms tissue_valve_terms() {
  const ValveScene& scene = small_valve();
  const TriangleMesh leaflets = scene.leaflets(scene.X);
  Terms terms = scene.terms();
  const auto replace = [&](const std::string& name, std::unique_ptr<EnergyTerm> by) {
    for (auto& term : terms)
      if (term->name() == name) term = std::move(by);
  };
  replace("membrane",
          tissue_term(leaflets, laws::Exponential::law(25), 0.8, Points::Zero(3, leaflets.triangle_count())));
  replace("chords", ogden_chords(laws::OgdenChord::law(2).alpha[0]));
  Points weight = Points::Zero(3, scene.X.cols()), pull = weight;
  weight.leftCols(leaflets.vertex_count()).row(2).setConstant(-1e-3);
  int pulled = 0;
  for (int v = 0; pulled < 2; ++v)
    if (!scene.fixed.col(v).any()) pull.col(v) = Vec3(0.01, -0.02, 0.01 * ++pulled);
  terms.push_back(std::make_unique<LoadDead>("weight", "load_field", weight, scene.X));
  terms.push_back(std::make_unique<LoadDead>("pull", "load_field", pull, scene.X));
  return terms;
}

// Closed by the whole method, from the open state.
inline Points closed_by(Terms terms) {
  const ValveScene& scene = small_valve();
  return find_equilibrium(scene.X, scene.fixed, std::move(terms), scene.method(1e-9)).x;
}

inline const Points& closed_small_valve() {
  static const Points x = closed_by(small_valve().terms());
  return x;
}

struct TrackedValve {
  const ValveScene& scene = small_valve();
  Objective objective;
  TrackedEquilibrium equilibrium;

  explicit TrackedValve(TrackingOptions options = {.tolerance = kTrackingTolerance})
      : TrackedValve(small_valve().terms(), closed_small_valve(), options) {}
  TrackedValve(Terms terms, const Points& closed, TrackingOptions options = {.tolerance = kTrackingTolerance})
      : objective(closed, small_valve().fixed, std::move(terms)),
        equilibrium(objective, objective.unknowns(closed), options) {}

  EnergyTerm& term(const std::string& name) const {
    for (const auto& term : objective.terms())
      if (term->name() == name) return *term;
    throw std::runtime_error("no term " + name);
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

  // What a scene mostly asks for. Chords with an even number by themselves, the others in two groups.
  void add_common() {
    EnergyTerm& chords = term("chords");
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
    EnergyTerm& membrane = term("membrane");
    for (int t = 0; t < membrane.stencils().count() / 2; ++t) region.push_back(t);
    equilibrium.add(make_stiffness_factor("young", {{.term = &membrane, .elements = region}}, 1));
    equilibrium.add(make_stiffness_factor(
        "thickness",
        {{.term = &membrane, .is_size = true}, {.term = &term("bending"), .power = 3, .is_size = true}},
        0.8));
    equilibrium.add(make_pressure_value("pressure", term("pressure")));
    std::vector<int> rest_nodes;
    for (int v = 0; v <= scene.triangles.maxCoeff(); v += 7) rest_nodes.push_back(v);
    equilibrium.add(make_reference_positions("rest", objective, scene.X, rest_nodes));
  }

  // All other kinds of parameters. Pre: made of tissue_valve_terms().
  void add_others() {
    EnergyTerm& chords = term("chords");
    std::vector<std::vector<int>> groups(3);  // of taut ones: junctions of slack ones have no place
    const Points x = equilibrium.positions();
    for (int e = 0; e < chords.stencils().count(); ++e)
      if (line_access(chords)->at(e, line_length(chords, e, x)).law.force > 0.01)
        groups[static_cast<size_t>(e % 3)].push_back(e);
    equilibrium.add(make_line_lengths("elongations", chords, groups, LengthMeasure::Change));
    TermNumber exponent;
    exponent.value = exponent.scale = laws::OgdenChord::law(2).alpha[0];
    exponent.terms = {&chords};
    exponent.terms_at = [](double value) { return terms_of(ogden_chords(value)); };
    exponent.defect = [](double value) { return value > 0 ? "" : "must be positive"; };
    equilibrium.add(make_term_number("exponent", exponent));
    const Points tip = x(Eigen::all, tips());
    equilibrium.add(make_prescribed_positions("shift", objective, tips(), shifted(tip), Vec3::Zero()));
    equilibrium.add(make_load_factor("weight", term("weight")));
    equilibrium.add(make_nodal_forces("pull", term("pull")));
    std::vector<JointPart> parts;
    for (const std::string name : {"tissue", "bending"})
      parts.push_back({make_stiffness_factor(name, {{.term = &term(name)}}, 1), {0}});
    equilibrium.add(make_joint_parameter("sheet", 1, std::move(parts)));
  }

  // A direction in the numbers of one parameter, zero in the others, with entries of a size that suits it.
  Vector direction(size_t parameter, unsigned seed) const {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(0.5, 1);
    Vector all = Vector::Zero(equilibrium.number_count());
    const Vector value = equilibrium.parameter(parameter).value();
    const double greatest = value.cwiseAbs().maxCoeff(), scale = greatest > 0 ? greatest : 1;
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
