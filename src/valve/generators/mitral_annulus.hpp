// A measured mitral annulus in the frame of the generated valve.
#pragma once

#include "core/types.hpp"

#include <optional>
#include <string>
#include <vector>

namespace coapt {

// What a curve alone may not tell: positions somewhere on the anterior (aortic) side of the annulus and on
// the side of the ventricle, in the frame of the curve.
struct AnnulusSides {
  std::optional<Vec3> anterior = std::nullopt, ventricle = std::nullopt;
};

// The frame of mitral_shape.hpp laid into a closed curve:
//  - z: normal of the plane on which the curve encloses the greatest area (its vector area), to the atrium
//  - y: short principal axis of that area, to the anterior side; or the direction to `anterior`
//  - x: completes a right-handed frame
// and the origin where the generator has it: half-way between the highest and the lowest point, half-way
// across along x, and along y behind the area's centroid by half of what the posterior end is farther from it
// than the anterior one.
struct MitralAnnulus {
  Points curve = Points(3, 0);  // closed polygon in that frame, anticlockwise seen from the atrium [mm]. It
                                // begins at the commissure of positive x and has the other one as a corner.
  int second_commissure = 0;    // that corner
  std::vector<double> lengths;  // along the polygon from the first corner to each, and once around [mm]
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  // columns x, y, z in the frame of the points
  Vec3 origin = Vec3::Zero();                          // in the frame of the points [mm]
  double commissural_diameter = 0, anteroposterior_diameter = 0, height = 0;  // extents along x, y, z [mm]
  double flatness = 0;  // of the anterior side, as in MitralDimensions

  // The polygon at a fraction of the length of its anterior (or posterior) part, both counted along the
  // curve.
  Vec3 point(bool is_anterior, double fraction) const;
};

// The closed polygon through `points` (3 x n, in order, either way round; the last may repeat the first)
// [mm]. Sides that are not given are found: the anterior one is the flattened one, whose end of the short
// axis lies nearer to the centroid; the atrium is where the saddle rises at the ends of the short axis. The
// commissures are where rays from the origin leave the curve at `commissure_angle` [degrees] of
// MitralDimensions. Throws InputError, each defect naming `name`: positions that are not finite, fewer than 8
// points or more than 20,000, extents in the plane beyond 10 to 80 mm, a curve that crosses itself in its
// plane or does not run around its origin, a side that cannot be told.
MitralAnnulus fit_mitral_annulus(const Points& points, const AnnulusSides& sides, double commissure_angle,
                                 const std::string& name);

}  // namespace coapt
