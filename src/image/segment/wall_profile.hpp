// How thick a sheet is: a blurred top hat laid into the grey values along its normal.
#pragma once

#include "image/segment/grey_scale.hpp"
#include "image/segment/layer_grid.hpp"
#include "image/volume.hpp"

namespace coapt {

// Grey values along the normals of a layer at equal steps on both sides, samples x points; those of a point
// are the mean of those around it, so that speckle averages out.
struct WallProfiles {
  double step = 0.2;       // [mm]
  double scatter = 0;      // standard deviation of the places whose grey values make up one of a profile [mm]
  Eigen::MatrixXd values;  // the middle row is the layer itself

  double offset(Eigen::Index sample) const {
    return step * (static_cast<double>(sample) - 0.5 * static_cast<double>(values.rows() - 1));
  }
};

// Reach to both sides, and half the width of the square that is averaged over [mm]. place_deviation: of the
// points of the layer from where they should lie [mm].
WallProfiles wall_profiles(const Volume& volume, const LayerGrid& grid, double reach, double radius,
                           double place_deviation);

struct WallFit {
  double centre = 0;    // along the normal [mm]
  double width = 0;     // [mm]
  double residual = 0;  // root mean square, over the range of the values
  bool is_found = false;
};

// Between a weaker and a stronger value the signal is that of a sheet of uniform strength, blurred by a
// Gaussian of standard deviation `blur` [mm]. The profile averages grey values, not signals, over its scatter
// (three-point Gauss-Hermite quadrature): a logarithm averaged is no wider sheet. Width, centre and both
// values by least squares (Levenberg-Marquardt). Not found where no sheet is brighter than its sides.
WallFit fit_wall(const WallProfiles& profiles, Eigen::Index point, double blur, const GreyScale& scale);

}  // namespace coapt
