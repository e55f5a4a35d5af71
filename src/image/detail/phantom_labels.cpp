#include "image/detail/phantom_labels.hpp"

#include "image/detail/chamber_sides.hpp"
#include "mesh/distance/triangle_distance.hpp"

#include <algorithm>
#include <cmath>

namespace coapt {
namespace {

// Labels the voxels within `reach` of a triangle, or of a line with c = b [mm].
void label_around(Volume& labels, const Vec3& a, const Vec3& b, const Vec3& c, double reach, int label) {
  const Vec3 va = voxels_of(labels, a), vb = voxels_of(labels, b), vc = voxels_of(labels, c);
  const Vec3 around = Vec3::Constant(reach).cwiseQuotient(labels.spacing);
  const Vec3 low = va.cwiseMin(vb).cwiseMin(vc) - around, high = va.cwiseMax(vb).cwiseMax(vc) + around;
  std::array<int, 3> first{}, last{};
  for (int axis = 0; axis < 3; ++axis) {
    const auto n = static_cast<std::size_t>(axis);
    first[n] = std::max(0, static_cast<int>(std::ceil(low[axis])));
    last[n] = std::min(labels.size[n] - 1, static_cast<int>(std::floor(high[axis])));
  }
  for (int k = first[2]; k <= last[2]; ++k)
    for (int j = first[1]; j <= last[1]; ++j)
      for (int i = first[0]; i <= last[0]; ++i)
        if (point_triangle_distance(position_of(labels, Vec3(i, j, k)), a, b, c) <= reach)
          labels.values[labels.voxel(i, j, k)] = static_cast<float>(label);
}

int chamber_label(const Vec3& position, const HeartWalls& walls, const ChamberSides& sides) {
  const Tissue tissue = walls.at(position);
  if (tissue == Tissue::Outside) return kLabelOutside;
  if (tissue == Tissue::Wall) return kLabelWall;
  return sides.is_ventricle(position) ? kLabelVentricle : kLabelAtrium;
}

}  // namespace

Volume phantom_labels(const PhantomValve& valve, const ValveFrame& frame, const HeartWalls& walls,
                      const Volume& grid, double thickness) {
  Volume labels = volume_like(grid, kLabelOutside);
  const ChamberSides sides(frame, valve.surface, valve.annulus, grid.spacing.minCoeff() / 2);
  for (int k = 0; k < labels.size[2]; ++k)
    for (int j = 0; j < labels.size[1]; ++j)
      for (int i = 0; i < labels.size[0]; ++i)
        labels.values[labels.voxel(i, j, k)] =
            static_cast<float>(chamber_label(position_of(labels, Vec3(i, j, k)), walls, sides));
  for (std::size_t line = 0; line < valve.line_radii.size(); ++line) {
    const Vec3 from = valve.line_ends.col(static_cast<Eigen::Index>(2 * line)),
               to = valve.line_ends.col(static_cast<Eigen::Index>(2 * line + 1));
    label_around(labels, from, to, to, valve.line_radii[line], kLabelChord);
  }
  const Points& x = valve.surface.vertices;
  for (const auto& t : valve.surface.triangles.colwise())
    label_around(labels, x.col(t[0]), x.col(t[1]), x.col(t[2]), thickness / 2, kLabelLeaflet);
  return labels;
}

}  // namespace coapt
