// Valves of simple shape, whose volumes are known.
#pragma once

#include "image/phantom.hpp"

#include <cmath>
#include <numbers>

namespace coapt {

// Rings of 64 vertices at these radii and heights, joined by triangles; the first ring is the annulus.
// Normals point inwards and upwards.
inline PhantomValve ring_valve(const std::vector<std::array<double, 2>>& rings) {
  constexpr int kAround = 64;
  PhantomValve valve;
  const auto count = static_cast<int>(rings.size());
  valve.surface.vertices.resize(3, kAround * count);
  valve.surface.triangles.resize(3, 2 * kAround * (count - 1));
  int t = 0;
  for (int ring = 0; ring < count; ++ring)
    for (int k = 0; k < kAround; ++k) {
      const double angle = 2 * std::numbers::pi * k / kAround,
                   radius = rings[static_cast<std::size_t>(ring)][0];
      const int v = kAround * ring + k, next = kAround * ring + (k + 1) % kAround;
      valve.surface.vertices.col(v) << radius * std::cos(angle), radius * std::sin(angle),
          rings[static_cast<std::size_t>(ring)][1];
      if (ring == 0) valve.annulus.push_back(v);
      if (ring + 1 == count) continue;
      valve.surface.triangles.col(t++) << v, next, v + kAround;
      valve.surface.triangles.col(t++) << next, next + kAround, v + kAround;
    }
  valve.upstream = upstream_direction(valve.surface, valve.annulus);
  return valve;
}

// Closed but for a hole of 0.2 mm: a plane of radius 15 at z = 0.
inline PhantomValve flat_valve() {
  std::vector<std::array<double, 2>> rings;
  for (int k = 0; k <= 10; ++k) rings.push_back({15 - 1.48 * k, 0});
  return ring_valve(rings);
}

// Open: from radius 15 at z = 0 down to radius 8 at z = -14.
inline PhantomValve funnel_valve() {
  std::vector<std::array<double, 2>> rings;
  for (int k = 0; k <= 10; ++k) rings.push_back({15 - 0.7 * k, -1.4 * k});
  return ring_valve(rings);
}

}  // namespace coapt
