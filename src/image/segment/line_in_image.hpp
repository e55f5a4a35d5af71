// Where a volume of the closed valve shows the coaptation line that a solve predicts.
#pragma once

#include "image/volume.hpp"
#include "mesh/triangle_mesh.hpp"

#include <vector>

namespace coapt {

// One piece of the line, at steps of half a millimetre along it.
struct LineInImage {
  Points predicted, found;  // 3 x n [mm]
  Vector likeness;  // correlation of the image there with the leaflets as they were predicted, -1 to 1
  std::vector<char> is_shown;
};

// Across each place of the line the predicted leaflets are drawn as sheets with a Gaussian profile of 0.7 mm
// and laid over the image, which is averaged over 2 mm along the line; the shift of up to 4 mm in that plane
// by which they correlate best is where the line is found (normalised cross-correlation; as for 2 mm to both
// sides of it along the line). It is shown where the correlation is 0.7 or more and no greatest shift is
// needed: what the image shows there looks like these leaflets. The line goes no farther than the predicted
// one, and leaflets that meet in another way than predicted are not recognised.
//
// line: its pieces, 3 x n each [mm]; up: unit vector to the atrium. All in the frame of the volume.
// Pieces shorter than 3 mm are left out.
std::vector<LineInImage> line_in_image(const Volume& closed, const TriangleMesh& leaflets,
                                       const std::vector<Points>& line, const Vec3& up);

}  // namespace coapt
