// The layer of the leaflets, followed through the image from the annulus.
#pragma once

#include "image/segment/layer_grid.hpp"
#include "image/segment/sheet_evidence.hpp"

namespace coapt {

struct TrackOptions {
  double step = 0.5;              // between rows [mm]
  double greatest_length = 36;    // of a column [mm]
  Vec3 ventricle = Vec3::Zero();  // unit vector from the plane of the annulus to the ventricle
};

// Points at equal steps of about `step` along the smooth closed curve through those of the annulus (3 x n, in
// order, either way round), anticlockwise seen from the atrium. 3 x count [mm].
Points annulus_ring(const Points& annulus, const Vec3& ventricle, double step);

// Row by row: from each point of a ring the direction in which the sheet goes on, in the plane across the
// ring, is that along which the evidence of the next millimetres is greatest; the directions of all columns
// are found together, as the cheapest closed path around the ring, so that where evidence is missing the
// layer goes on as it went and as its neighbours do. At the annulus all directions from the middle of the
// ring to its outside through the ventricle are tried. Ends where eight millimetres brought no evidence, or
// at the greatest length. Whether the layer ends before is not asked here (free_edge.hpp).
LayerGrid track_layer(const SheetEvidence& evidence, const Points& ring, const TrackOptions& options);

// Mean evidence on the first millimetres of a layer tracked to one side: says on which side the leaflets
// hang.
double evidence_on_side(const SheetEvidence& evidence, const Points& ring, const TrackOptions& options);

}  // namespace coapt
