#include "valve/generators/mitral_chord_plan.hpp"

#include <algorithm>
#include <utility>

namespace coapt {
namespace {

constexpr double kMiddle = 0.5;     // of a leaflet, by fraction of its annulus length
constexpr double kEdgeFrom = 0.05;  // of the free edge that is not the commissural chord's

// The half of the leaflets that belongs to one muscle. Fractions run from the commissure of the muscle along
// either leaflet.
struct LeafletHalves {
  const MitralShape& shape;
  int muscle;

  double coordinate(MitralLeaflet leaflet, double fraction) const {
    if ((leaflet == MitralLeaflet::Posterior) != (muscle == 1)) fraction = 1 - fraction;
    return mitral_coordinate(shape, leaflet, fraction);
  }
  double commissure() const { return muscle == 0 ? 0 : shape.anterior_share; }

  // `count` insertions at equal steps inside (from, to).
  void spread(MitralLeaflet leaflet, double from, double to, double t, int count, ChordFan& fan) const {
    for (int i = 0; i < count; ++i)
      fan.insertions.push_back({coordinate(leaflet, from + (to - from) * (i + 0.5) / count), t});
  }
};

ChordFan commissural(const LeafletHalves& half, ChordFan fan) {
  half.spread(MitralLeaflet::Anterior, 0, kEdgeFrom, 1, 2, fan);
  half.spread(MitralLeaflet::Posterior, 0, kEdgeFrom, 1, 2, fan);
  fan.insertions.push_back({half.commissure(), 1});
  return fan;
}

std::vector<ChordFan> even_plan(const LeafletHalves& half, int branches) {
  const double scale = half.shape.dimensions.chord_area_scale;
  const ChordFan primary = {"primary", 0.4 * scale, {}}, secondary = {"secondary", 0.8 * scale, {}};
  const ChordFan strut = {"strut", 1.2 * scale, {}};
  const MitralLeaflet anterior = MitralLeaflet::Anterior, posterior = MitralLeaflet::Posterior;
  std::vector<ChordFan> fans;
  const auto add = [&](MitralLeaflet leaflet, ChordFan fan, double from, double to, double t) {
    half.spread(leaflet, from, to, t, branches, fan);
    fans.push_back(std::move(fan));
  };
  const auto add_primary = [&](MitralLeaflet leaflet, int chords) {
    const double width = (kMiddle - kEdgeFrom) / chords;
    for (int i = 0; i < chords; ++i)
      add(leaflet, primary, kEdgeFrom + i * width, kEdgeFrom + (i + 1) * width, 1);
  };
  add_primary(anterior, 3);
  add(anterior, secondary, 0.12, 0.28, 0.7);
  add(anterior, strut, 0.26, 0.40, 0.6);
  add_primary(posterior, 4);
  add(posterior, secondary, 0.08, 0.22, 0.65);
  add(posterior, secondary, 0.26, 0.40, 0.65);
  fans.push_back(commissural(half, primary));
  return fans;
}

std::vector<ChordFan> rough_zone_plan(const LeafletHalves& half, int branches) {
  constexpr double kBelowLine = 0.25;  // of the way from the coaptation line to the free edge
  constexpr double kStrutPlace = 0.8, kBasalPlace = 0.7;  // of the way from the annulus to the line
  const double scale = half.shape.dimensions.chord_area_scale;
  const ChordFan primary = {"primary", 0.8 * scale, {}};
  const ChordFan secondary = {"secondary", 0.8 * scale, {}};
  const ChordFan strut = {"strut", 1.2 * scale, {}};
  const MitralLeaflet anterior = MitralLeaflet::Anterior, posterior = MitralLeaflet::Posterior;
  std::vector<ChordFan> fans;
  const auto add_rough_zone = [&](MitralLeaflet leaflet, int chords) {
    const double width = (kMiddle - kEdgeFrom) / chords;
    for (int i = 0; i < chords; ++i) {
      ChordFan fan = primary;
      const double from = kEdgeFrom + i * width, to = from + width;
      half.spread(leaflet, from, to, 1, branches, fan);
      for (int k = 1; k < branches; ++k) {
        const double u = half.coordinate(leaflet, from + (to - from) * k / branches);
        const double line = std::min(1.0, mitral_line_place(half.shape, u));
        fan.insertions.push_back({u, line + kBelowLine * (1 - line)});
      }
      fans.push_back(std::move(fan));
    }
  };
  const auto add_belly = [&](MitralLeaflet leaflet, ChordFan fan, double from, double to, double part) {
    for (int i = 0; i < branches; ++i) {
      const double u = half.coordinate(leaflet, from + (to - from) * (i + 0.5) / branches);
      fan.insertions.push_back({u, part * std::min(1.0, mitral_line_place(half.shape, u))});
    }
    fans.push_back(std::move(fan));
  };
  add_rough_zone(anterior, 4);
  add_belly(anterior, strut, 0.22, 0.38, kStrutPlace);
  add_rough_zone(posterior, 5);
  add_belly(posterior, secondary, 0.18, 0.38, kBasalPlace);
  fans.push_back(commissural(half, primary));
  return fans;
}

}  // namespace

std::vector<ChordFan> mitral_chord_plan(const MitralShape& shape, int muscle, int branches) {
  const LeafletHalves half = {shape, muscle};
  return shape.dimensions.chords == MitralChords::Even ? even_plan(half, branches)
                                                       : rough_zone_plan(half, branches);
}

}  // namespace coapt
