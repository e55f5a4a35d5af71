#include "support/valve_scene.hpp"

#include "energy/contact_barrier.hpp"
#include "energy/element_term.hpp"
#include "energy/kernels/cable.hpp"
#include "energy/load_pressure.hpp"
#include "support/refined_valve.hpp"
#include "valve/generators/mitral.hpp"

namespace coapt {
namespace {

constexpr double kPoisson = 0.45, kThickness = 0.8;  // mm
constexpr double kPressure = -120 * 133.322e-6;      // 120 mmHg against the normals [MPa]

}  // namespace

ValveScene::ValveScene(const ValveOptions& wanted) : options(wanted) {
  const Valve valve =
      wanted.refinements > 0
          ? refined_mitral_valve(wanted.triangles, wanted.refinements)
          : mitral_valve(
                {.triangles = wanted.triangles, .seed = wanted.seed, .preset = MitralPreset::Benchmark});
  const ChordNetwork& network = valve.chords;
  const int first_tip = valve.leaflets.vertex_count(),
            first_junction = first_tip + static_cast<int>(network.papillary.cols());
  triangles = valve.leaflets.triangles;
  X.resize(3, first_junction + network.junctions.cols());
  X << valve.leaflets.vertices, network.papillary, network.junctions;
  closed = X;
  fixed = FixedMask::Constant(3, X.cols(), false);
  for (size_t k = 0; k < valve.annulus.size(); ++k) {
    fixed.col(valve.annulus[k]).setConstant(true);
    closed.col(valve.annulus[k]) = valve.annulus_closed.col(static_cast<Eigen::Index>(k));
  }
  fixed.middleCols(first_tip, network.papillary.cols()).setConstant(true);
  if (network.papillary_closed.cols() > 0)
    closed.middleCols(first_tip, network.papillary.cols()) = network.papillary_closed;

  const auto node = [&](const ChordEnd& end) {
    if (end.kind == ChordEnd::Kind::Leaflet) return end.index;
    return end.index + (end.kind == ChordEnd::Kind::Papillary ? first_tip : first_junction);
  };
  const auto count = static_cast<Eigen::Index>(network.chords.size());
  chords.resize(2, count);
  chord_lengths.resize(count);
  chord_areas.resize(count);
  for (Eigen::Index k = 0; k < count; ++k) {
    const Chord& chord = network.chords[k];
    chords.col(k) << node(chord.from), node(chord.to);
    chord_lengths[k] = chord.rest_length;
    chord_areas[k] = chord.area;
  }
}

Terms ValveScene::terms(const Frame& frame, bool is_reversed) const {
  const double resultant = frame.force / frame.length, moment = frame.force * frame.length;
  const Points Y = frame.points(X);
  Triangles corners = frame.triangles(triangles);
  if (is_reversed) corners.row(1).swap(corners.row(2));
  const bool is_mirrored = frame.rotation.determinant() < 0;
  std::vector<Cable::Rest> cables;
  std::vector<int> ends;
  for (Eigen::Index k = 0; k < chords.cols(); ++k) {
    cables.push_back({options.chord_young * chord_areas[k] / chord_lengths[k] * resultant,
                      frame.length * chord_lengths[k], options.smoothing * frame.length * chord_lengths[k],
                      0});
    for (const int node : {chords(0, k), chords(1, k)}) ends.push_back(frame.node(node));
  }
  Terms list;
  list.push_back(tension_field_term(Y, corners, {options.young * kThickness * resultant, kPoisson, 0}));
  if (options.bending > 0)
    list.push_back(bending_term(Y, corners,
                                options.bending * options.young * kThickness * kThickness * kThickness / 12 /
                                    (1 - kPoisson * kPoisson) * moment));
  list.push_back(std::make_unique<ElementTerm<Cable>>("chords", std::move(ends), std::move(cables)));
  const double p = kPressure * resultant / frame.length;
  list.push_back(
      make_follower_pressure("pressure", Y, corners, is_reversed != is_mirrored ? -p : p, fixed_in(frame)));
  if (options.contact_gap > 0) {
    ContactBarrierOptions contact;
    contact.gap = options.contact_gap * frame.length;
    contact.pressure = 5 * std::abs(p);
    list.push_back(make_contact_barrier("contact", Y, corners, contact));
  }
  return list;
}

FixedMask ValveScene::fixed_in(const Frame& frame) const {
  FixedMask mask = fixed;
  for (int k = 0; k < X.cols(); ++k) mask.col(frame.node(k)) = fixed.col(k);
  return mask;
}

Method ValveScene::method(double tolerance, const Frame& frame) const {
  Method method;
  method.tolerance = tolerance;
  method.max_iterations = 1000;
  method.max_seconds = 600;
  method.motion.positions = [to = frame.points(closed)](double) { return to; };
  return method;
}

Equilibrium ValveScene::solve_in(const Frame& frame, double tolerance, bool is_reversed) const {
  Equilibrium found =
      find_equilibrium(frame.points(X), fixed_in(frame), terms(frame, is_reversed), method(tolerance, frame));
  Points back(3, X.cols());
  for (int k = 0; k < X.cols(); ++k)
    back.col(k) =
        frame.rotation.transpose() * (found.x.col(frame.node(k)) - frame.translation) / frame.length;
  found.x = back;
  return found;
}

std::vector<int> ValveScene::held_nodes(const Points& x) const {
  std::vector<bool> is_held(X.cols(), false);
  for (const int node : triangles.reshaped()) is_held[node] = true;
  for (Eigen::Index k = 0; k < chords.cols(); ++k) {
    const int a = chords(0, k), b = chords(1, k);
    if ((x.col(a) - x.col(b)).norm() > (1 + 1e-5) * chord_lengths[k]) is_held[a] = is_held[b] = true;
  }
  std::vector<int> nodes;
  for (int k = 0; k < X.cols(); ++k)
    if (is_held[k]) nodes.push_back(k);
  return nodes;
}

TriangleMesh ValveScene::leaflets(const Points& x) const {
  TriangleMesh surface;
  surface.triangles = triangles;
  surface.vertices = x.leftCols(triangles.maxCoeff() + 1);
  return surface;
}

}  // namespace coapt
