#include "image/segment/sheet_evidence.hpp"

#include <algorithm>
#include <cmath>

namespace coapt {
namespace {

// Standard deviations at which leaflets are looked for [mm], and the least one, in voxels.
constexpr double kScales[] = {0.7, 1.0, 1.4};
constexpr double kLeastScale = 0.8;

}  // namespace

std::vector<double> sheet_scales(const Volume& volume) {
  std::vector<double> scales;
  for (const double scale : kScales) {
    const double possible = std::max(scale, kLeastScale * volume.spacing.maxCoeff());
    if (scales.empty() || possible > scales.back()) scales.push_back(possible);
  }
  return scales;
}

double sheet_strength(const SheetEvidence& evidence, const Vec3& position, const Vec3& normal) {
  const double strength = sample(evidence.strength, position, 0);
  if (strength <= 0) return 0;
  const Vec3 at = voxels_of(evidence.strength, position);
  const auto nearest = [&](int axis) { return static_cast<int>(std::lround(at[axis])); };
  const size_t voxel = evidence.strength.voxel(nearest(0), nearest(1), nearest(2));
  const double cosine = normal.dot(evidence.normals[voxel].cast<double>());
  return strength * cosine * cosine;
}

}  // namespace coapt
