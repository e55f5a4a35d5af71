#include "valve/generators/rough_chord_plan.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace coapt {
namespace {

// Half of a leaflet, beside one of its commissures.
struct LeafletHalf {
  int group;
  double from, to;  // u, from the commissure to mid-leaflet
  double length;    // of its margin [mm]
};

std::vector<LeafletHalf> halves(const RoughSurface& surface) {
  std::vector<LeafletHalf> all;
  const int leaflets = static_cast<int>(surface.begins.size());
  for (int k = 0; k < leaflets; ++k) {
    const double begin = surface.begins[k], end = surface.end(k), middle = 0.5 * (begin + end);
    all.push_back({k, begin, middle, 0});
    all.push_back({(k + 1) % leaflets, end, middle, 0});
  }
  for (LeafletHalf& half : all)
    for (int i = 0; i < 40; ++i) {
      auto at = [&](int step) { return surface.open(half.from + (half.to - half.from) * step / 40, 1); };
      half.length += (at(i + 1) - at(i)).norm();
    }
  return all;
}

struct RoughZone {
  const char* name;
  double from, to;   // t
  double on_margin;  // share of insertions at t = 1
  double share;      // of all insertions
  double area;       // of a strand, over that of others
};

std::array<RoughZone, 3> zones(RandomSource& random) {
  const double marginal = random.between(0.35, 0.6), basal = random.between(0.1, 0.25);
  return {{{"marginal", 0.88, 1, 0.5, marginal, 1},
           {"intermediate", 0.55, 0.9, 0, 1 - marginal - basal, 1.5},
           {"basal", 0.25, 0.6, 0, basal, 2.5}}};
}

// `count` insertions beside each other and across their neighbours, about `at` of the half.
RoughFan fan_of(const LeafletHalf& half, const RoughZone& zone, double at, double width, int count,
                RandomSource& random) {
  RoughFan fan;
  for (int i = 0; i < count; ++i) {
    const double place = at + width * ((i + random.between(0.1, 0.9)) / count - 0.5);
    const double u = half.from + (half.to - half.from) * std::clamp(place, 0.01, 1.0);
    const bool is_margin = random.chance(zone.on_margin);
    const double t = random.between(zone.from, zone.to);
    fan.push_back({u, is_margin ? 1 : t});
  }
  return fan;
}

// Fans of one zone of a half, from the commissure on.
std::vector<RoughFan> fans_of(const LeafletHalf& half, const RoughZone& zone, double insertions,
                              double fan_size, RandomSource& random) {
  constexpr double kStrut = 1.0 / 12, kOverlap = 1.4;
  const int fans = std::max(1, static_cast<int>(std::lround(insertions / fan_size)));
  std::vector<RoughFan> all;
  for (int i = 0; i < fans; ++i) {
    const double at = (i + random.between(0.2, 0.8)) / fans;
    const bool is_strut = random.chance(kStrut);
    const int count =
        std::max(2, static_cast<int>(std::lround(insertions / fans * random.between(0.4, 1.6))));
    all.push_back(fan_of(half, zone, at, is_strut ? 0 : kOverlap / fans, is_strut ? 1 : count, random));
  }
  return all;
}

}  // namespace

std::vector<RoughTree> rough_chord_plan(const RoughSurface& surface, RandomSource& random) {
  constexpr double kForked = 0.35;  // share of fans that share a branch point with the next
  const double segments = random.log_between(500, 1800), fan_size = random.between(5, 20);
  const double insertions = segments / (1 + 1.4 / fan_size);
  const double strand = random.between(8, 25) / insertions;  // mean cross-section [mm^2]
  const std::array<RoughZone, 3> all_zones = zones(random);
  const std::vector<LeafletHalf> all_halves = halves(surface);
  double whole = 0;
  for (const LeafletHalf& half : all_halves) whole += half.length;
  std::vector<RoughTree> trees;
  for (const LeafletHalf& half : all_halves)
    for (const RoughZone& zone : all_zones) {
      const std::vector<RoughFan> fans =
          fans_of(half, zone, insertions * zone.share * half.length / whole, fan_size, random);
      for (size_t i = 0; i < fans.size(); ++i) {
        RoughTree tree{half.group, zone.name, strand * zone.area * random.between(0.6, 1.4), {fans[i]}};
        const bool is_forked = random.chance(kForked);
        if (is_forked && i + 1 < fans.size()) tree.fans.push_back(fans[++i]);
        trees.push_back(tree);
      }
    }
  return trees;
}

}  // namespace coapt
