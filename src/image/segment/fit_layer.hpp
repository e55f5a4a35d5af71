// A tracked layer moved onto the ridge of the sheet, smoothly, and how well its place is known.
#pragma once

#include "image/segment/layer_grid.hpp"
#include "image/segment/sheet_evidence.hpp"

#include <functional>

namespace coapt {

struct LayerFit {
  Vector deviation;       // standard deviation of each point along its normal [mm]
  double noise = 0;       // of the ridge at one point, standard deviation [mm]
  double noise_area = 0;  // over which the noise of neighbours is the same [mm^2]
  Vector evidence;        // of each point, 0 to 1: how far the image says where it lies
  Points measured;        // where each point was measured [mm]
};

// Where the sheet lies along the normals of the points of a layer [mm], NaN where that is not told.
using PlacesAcross = std::function<Vector(const LayerGrid&)>;

// Each point is measured: the greatest evidence along its normal, or what `places` says. The layer is the
// smoothing spline through these: the sum over the area of squared evidence times squared distance from the
// measured place, and of the fourth power of `smoothing` times squared curvature, is least (thin plate; the
// evidence is lowered for places that lie far from the layer, after Cauchy). Measured and fitted again from
// where it moved to, `rounds` times. The first row is held near the annulus, one place for each column.
//
// The deviation is that of the Gaussian posterior of the last fit (Wahba 1983, Bayesian confidence intervals
// for the cross-validated smoothing spline): noise variance times noise area times the diagonal of the
// inverse matrix, by samples with a fixed seed. Noise and the area over which it is correlated come from what
// the fit leaves over. In gaps of the evidence that of the unknown curvature is added (gap_deviation.hpp). It
// knows nothing of what is wrong everywhere in the same way.
LayerFit fit_layer(LayerGrid& grid, const Points& annulus, const SheetEvidence& evidence, double smoothing,
                   int rounds, const PlacesAcross& places = {});

}  // namespace coapt
