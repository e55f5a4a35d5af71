#include "image/segment/annulus_region.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace coapt {
namespace {

constexpr double kMargin = 6;  // around what is looked at [mm]
constexpr double kMostWandering =
    0.25;  // of a full turn, by which a curve that is drawn by hand goes back and forth

}  // namespace

AnnulusPlane plane_of(const Points& annulus) {
  AnnulusPlane plane;
  plane.middle = annulus.rowwise().mean();
  Vec3 area = Vec3::Zero();
  double length = 0;
  for (Eigen::Index i = 0; i < annulus.cols(); ++i) {
    const Vec3 a = annulus.col(i), b = annulus.col((i + 1) % annulus.cols());
    area += (a - plane.middle).cross(b - plane.middle);
    length += (b - a).norm();
  }
  plane.normal = area.normalized();
  plane.diameter = length / std::numbers::pi;
  return plane;
}

bool goes_round_once(const Points& annulus) {
  const AnnulusPlane plane = plane_of(annulus);
  const Vec3 right = plane.normal.unitOrthogonal(), up = plane.normal.cross(right);
  double turn = 0, way = 0;
  for (Eigen::Index i = 0; i < annulus.cols(); ++i) {
    const Vec3 a = annulus.col(i) - plane.middle, b = annulus.col((i + 1) % annulus.cols()) - plane.middle;
    const double x = a.dot(right) * b.dot(right) + a.dot(up) * b.dot(up);
    const double y = a.dot(right) * b.dot(up) - a.dot(up) * b.dot(right);
    const double angle = std::atan2(y, x);
    turn += angle;
    way += std::abs(angle);
  }
  const double full = 2 * std::numbers::pi;
  return std::abs(std::abs(turn) - full) < 0.01 * full && way < (1 + 2 * kMostWandering) * full;
}

Volume around_annulus(const Volume& volume, const Points& annulus, const std::optional<Vec3>& ventricle) {
  const AnnulusPlane plane = plane_of(annulus);
  const double reach = kGreatestShare * plane.diameter;
  const double side = ventricle ? (*ventricle - plane.middle).dot(plane.normal) : 0;
  Vec3 low = Vec3::Constant(kInfinity), high = Vec3::Constant(-kInfinity);
  for (Eigen::Index i = 0; i < annulus.cols(); ++i)
    for (const double offset : {side > 0 ? 0.0 : -reach, side < 0 ? 0.0 : reach}) {
      const Vec3 at = voxels_of(volume, annulus.col(i) + offset * plane.normal);
      low = low.cwiseMin(at - kMargin * volume.spacing.cwiseInverse());
      high = high.cwiseMax(at + kMargin * volume.spacing.cwiseInverse());
    }
  Volume part = volume;
  std::array<int, 3> first;
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<size_t>(axis);
    first[a] = static_cast<int>(std::clamp(std::floor(low[axis]), 0.0, volume.size[a] - 1.0));
    part.size[a] =
        static_cast<int>(std::clamp(std::ceil(high[axis]), 0.0, volume.size[a] - 1.0)) - first[a] + 1;
    part.size[a] = std::max(part.size[a], 1);
  }
  part.origin = position_of(volume, Vec3(first[0], first[1], first[2]));
  part.values.resize(static_cast<size_t>(part.size[0]) * static_cast<size_t>(part.size[1]) *
                     static_cast<size_t>(part.size[2]));
  for (int k = 0; k < part.size[2]; ++k)
    for (int j = 0; j < part.size[1]; ++j)
      for (int i = 0; i < part.size[0]; ++i)
        part.values[part.voxel(i, j, k)] =
            volume.values[volume.voxel(i + first[0], j + first[1], k + first[2])];
  return part;
}

}  // namespace coapt
