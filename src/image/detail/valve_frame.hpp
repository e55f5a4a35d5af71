// Coordinates of the annulus: x and y in its plane, z upstream.
#pragma once

#include "core/types.hpp"

#include <vector>

namespace coapt {

struct ValveFrame {
  Vec3 centre = Vec3::Zero();                          // mean of the annulus [mm]
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  // columns: x, y, z; z upstream
  Points annulus;                                      // in these coordinates, counter-clockwise about z [mm]

  Vec3 local(const Vec3& position) const { return axes.transpose() * (position - centre); }
};

// Vector area of a closed polygon in space, twice over.
Vec3 polygon_normal(const Points& polygon);

// Throws InputError where the annulus has no area.
ValveFrame valve_frame(const Points& vertices, const std::vector<int>& annulus, const Vec3& upstream);

}  // namespace coapt
