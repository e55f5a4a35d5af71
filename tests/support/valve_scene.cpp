#include "support/valve_scene.hpp"

#include "energy/load_pressure.hpp"
#include "mesh/generators/mitral.hpp"

namespace coapt {
namespace {

constexpr double kYoung = 1, kPoisson = 0.45, kThickness = 0.8, kChordYoung = 40;  // MPa, mm
constexpr double kPressure = -120 * 133.322e-6;  // 120 mmHg against the normals [MPa]

}  // namespace

ValveScene::ValveScene(const ValveOptions& wanted) : options(wanted) {
  MitralOptions mitral;
  mitral.triangles = wanted.triangles;
  const Valve valve = mitral_valve(mitral);
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

Terms ValveScene::terms() const {
  std::vector<Cable::Rest> cables;
  for (Eigen::Index k = 0; k < chords.cols(); ++k)
    cables.push_back({kChordYoung * chord_areas[k] / chord_lengths[k], chord_lengths[k],
                      options.smoothing * chord_lengths[k], 0});
  Terms list;
  list.push_back(tension_field_term(X, triangles, {kYoung * kThickness, kPoisson, 0}));
  if (options.bending > 0)
    list.push_back(bending_term(
        X, triangles,
        options.bending * kYoung * kThickness * kThickness * kThickness / 12 / (1 - kPoisson * kPoisson)));
  list.push_back(std::make_unique<ElementTerm<Cable>>(
      "chords", std::vector<int>(chords.data(), chords.data() + chords.size()), std::move(cables)));
  list.push_back(make_follower_pressure("pressure", X, triangles, kPressure, fixed));
  return list;
}

Method ValveScene::method(double tolerance) const {
  Method method;
  method.tolerance = tolerance;
  method.max_iterations = 1000;
  method.max_seconds = 600;
  method.motion.positions = [to = closed](double) { return to; };
  return method;
}

TriangleMesh ValveScene::leaflets(const Points& x) const {
  TriangleMesh surface;
  surface.triangles = triangles;
  surface.vertices = x.leftCols(triangles.maxCoeff() + 1);
  return surface;
}

}  // namespace coapt
