#include "image/segment/ridge_points.hpp"

#include "image/segment/annulus_region.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace coapt {
namespace {

constexpr double kLeastRidge = 0.4;  // of the median strength of sheets, from which a ridge is counted

}  // namespace

Points ridge_points(const SheetEvidence& evidence, double least) {
  const Volume& strength = evidence.strength;
  const double step = strength.spacing.minCoeff();
  std::vector<Vec3> found;
  for (int k = 0; k < strength.size[2]; ++k)
    for (int j = 0; j < strength.size[1]; ++j)
      for (int i = 0; i < strength.size[0]; ++i) {
        const size_t voxel = strength.voxel(i, j, k);
        const double here = strength.values[voxel];
        if (here < least) continue;
        const Vec3 x = position_of(strength, Vec3(i, j, k)), normal = evidence.normals[voxel].cast<double>();
        const double before = sample(strength, x - step * normal, 0);
        const double after = sample(strength, x + step * normal, 0);
        const double bend = before - 2 * here + after;
        if (before > here || after > here || bend >= 0) continue;
        found.push_back(x + std::clamp(0.5 * (before - after) / bend, -0.5, 0.5) * step * normal);
      }
  Points points(3, static_cast<Eigen::Index>(found.size()));
  for (size_t n = 0; n < found.size(); ++n) points.col(static_cast<Eigen::Index>(n)) = found[n];
  return points;
}

Points ridge_points_in(const Volume& volume) {
  return ridge_points(sheet_evidence(volume, sheet_scales(volume)), kLeastRidge);
}

Points ridge_points_around(const Volume& volume, const Points& annulus) {
  return ridge_points_in(around_annulus(volume, annulus, {}));
}

}  // namespace coapt
