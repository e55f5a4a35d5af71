// Another way to the layer of the leaflets than following it from the annulus.
#pragma once

#include "image/segment/fit_layer.hpp"
#include "image/segment/free_edge.hpp"

#include <functional>

namespace coapt {

// What there is to go by. The references are good while the layer is looked for.
struct LayerImage {
  const Volume& volume;
  const SheetEvidence& evidence;  // of all scales
  const SheetEvidence& ridge;     // of the finest
  const Points& annulus;          // as it was given, 3 x n [mm]
  Vec3 ventricle;                 // unit vector from the plane of the annulus to the ventricle
  double smoothing = 1.2;         // below which shapes are taken for noise [mm]
};

// The grid goes on beyond the edge by a row or more.
struct FoundLayer {
  LayerGrid grid;
  LayerFit fit;
  FreeEdge edge;
};

using LayerFinder = std::function<FoundLayer(const LayerImage&)>;

}  // namespace coapt
