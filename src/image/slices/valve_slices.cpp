#include "image/slices/valve_slices.hpp"

#include "image/segment/annulus_region.hpp"

#include <Eigen/Geometry>

#include <algorithm>

namespace coapt {
namespace {

constexpr double kSeenDiameters = 1.6;  // width of what is seen of a valve
constexpr double kLowered = 0.25;       // of the pictures towards the leaflets, in diameters
constexpr double kFewestPixels = 120, kMostPixels = 480;  // of the greatest width of a picture

}  // namespace

std::vector<SlicePlane> valve_planes(const Points& annulus, const std::optional<Vec3>& ventricle) {
  const AnnulusPlane plane = plane_of(annulus);
  Vec3 up = plane.normal;
  if (ventricle && up.dot(*ventricle - plane.middle) > 0) up = -up;
  // The longest diameter, seen along the axis.
  const Points flat =
      (annulus.colwise() - plane.middle) - up * (up.transpose() * (annulus.colwise() - plane.middle));
  Vec3 along = Vec3::Zero();
  for (Eigen::Index a = 0; a < flat.cols(); ++a)
    for (Eigen::Index b = a + 1; b < flat.cols(); ++b)
      if ((flat.col(b) - flat.col(a)).norm() > along.norm()) along = flat.col(b) - flat.col(a);
  const double length = along.norm();
  along.normalize();
  const Vec3 across = up.cross(along).normalized();
  const double seen = kSeenDiameters * plane.diameter;
  const Vec3 below = ventricle ? Vec3(-kLowered * plane.diameter * up) : Vec3(Vec3::Zero());
  return {{plane.middle + below - length / 6 * along, across, up, seen, seen},
          {plane.middle + below + length / 6 * along, across, up, seen, seen},
          {plane.middle + below, along, up, seen, seen}};
}

std::vector<SlicePlane> middle_planes(const Volume& volume) {
  Vec3 extent;
  for (Eigen::Index axis = 0; axis < 3; ++axis)
    extent[axis] = volume.size[static_cast<std::size_t>(axis)] * volume.spacing[axis];
  const Vec3 middle =
      position_of(volume, 0.5 * Vec3(volume.size[0] - 1, volume.size[1] - 1, volume.size[2] - 1));
  const auto plane = [&](int right, int up) {
    return SlicePlane{middle, volume.direction.col(right), volume.direction.col(up), extent[right],
                      extent[up]};
  };
  return {plane(0, 1), plane(0, 2), plane(1, 2)};
}

Picture valve_slices(const Volume& volume, const std::vector<SlicePlane>& planes,
                     const std::vector<DrawnSurface>& surfaces, const std::vector<DrawnPoints>& points) {
  double widest = 0;
  for (const SlicePlane& plane : planes) widest = std::max({widest, plane.width, plane.height});
  const double voxel = volume.spacing.maxCoeff();
  const double pixel = std::clamp(voxel / 2, widest / kMostPixels, widest / kFewestPixels);
  const GreyRange range = grey_range(volume);
  std::vector<Picture> pictures;
  for (const SlicePlane& plane : planes) {
    Picture& picture = pictures.emplace_back(slice_picture(volume, plane, pixel, range));
    for (const DrawnPoints& drawn : points)
      draw_points(picture, plane, pixel, drawn.points, voxel, drawn.colour);
    for (const DrawnSurface& drawn : surfaces)
      draw_section(picture, plane, pixel, drawn.surface, drawn.colour);
  }
  return side_by_side(pictures);
}

}  // namespace coapt
