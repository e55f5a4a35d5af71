#include "valve/generators/chord_junctions.hpp"

namespace coapt {

Vec3 place_junction(Vec3 start, const JunctionLimits& limits) {
  constexpr int kSweeps = 200;
  constexpr double kClearance = 0.8;  // [mm]
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    for (const Plane& plane : limits.planes) {
      const double distance = (start - plane.centre).dot(plane.normal);
      if (distance < kClearance) start += (kClearance - distance) * plane.normal;
    }
    for (int i = 0; i < limits.ends.cols(); ++i) {
      const Vec3 end = limits.ends.col(i), from_end = start - end;
      const double length = limits.rest_lengths[static_cast<size_t>(i)];
      if (from_end.norm() > length) start = end + length * from_end.normalized();
    }
  }
  return start;
}

int nearest_tip(const Points& tips, int first, int last, const Vec3& point) {
  int best = first;
  for (int i = first; i < last; ++i)
    if ((tips.col(i) - point).squaredNorm() < (tips.col(best) - point).squaredNorm()) best = i;
  return best;
}

}  // namespace coapt
