#include "image/support/valve_image.hpp"

#include <cmath>
#include <numbers>

namespace coapt::testing {

Volume image_with_chords(const Valve& valve, const coapt::PhantomOptions& options) {
  PhantomValve state;
  state.surface = valve.leaflets;
  state.annulus = valve.annulus;
  state.upstream = upstream_direction(valve.leaflets, valve.annulus);
  const ChordNetwork& network = valve.chords;
  const auto place = [&](const ChordEnd& end) -> Vec3 {
    if (end.kind == ChordEnd::Kind::Papillary) return network.papillary.col(end.index);
    if (end.kind == ChordEnd::Kind::Junction) return network.junctions.col(end.index);
    return valve.leaflets.vertices.col(end.index);
  };
  state.line_ends.resize(3, 2 * static_cast<Eigen::Index>(network.chords.size()));
  for (size_t k = 0; k < network.chords.size(); ++k) {
    state.line_ends.col(static_cast<Eigen::Index>(2 * k)) = place(network.chords[k].from);
    state.line_ends.col(static_cast<Eigen::Index>(2 * k + 1)) = place(network.chords[k].to);
    state.line_radii.push_back(std::sqrt(network.chords[k].area / std::numbers::pi));
  }
  return make_phantom(state, phantom_pattern(state.surface, options), phantom_grid({state}, options), options)
      .image;
}

coapt::PhantomOptions clear_phantom(unsigned seed) {
  coapt::PhantomOptions options;
  options.axial = options.lateral = 0.5;
  options.dropout = 0;
  options.shadows = 0;
  options.seed = seed;
  return options;
}

}  // namespace coapt::testing
