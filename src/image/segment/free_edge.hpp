// Where a layer ends: the free edge of the leaflets.
#pragma once

#include "image/segment/grey_scale.hpp"
#include "image/segment/layer_grid.hpp"
#include "image/segment/sheet_evidence.hpp"

namespace coapt {

struct FreeEdge {
  Vector lengths;        // along each column, from the annulus [mm]
  double deviation = 0;  // standard deviation of a length, before the edge was smoothed [mm]
  double contrast = 0;   // of the layer and what lies on the darker of its sides, in values of the volume
};

// At each point of the layer the contrast is what the value on the layer (the mean of half a millimetre to
// both sides) exceeds that on the darker of its sides (1.5 to 2.5 mm away) by, over the median of what it is
// two to six millimetres from the annulus; at most the evidence of a sheet, so that chords, which are
// bright too but no sheets, do not lengthen the leaflet. The edge is the closed path around the valve that
// parts contrasts above one half from those below with the least sum of contradictions (a change point in
// each column, a path that costs what it climbs): a gap of evidence within the leaflet is passed over. Then
// it is smoothed along the ring. In a logarithmic volume a blurred edge looks longer than it is: its half of
// the contrast lies where the signal has fallen to the share that the decibels say, and the edge is moved
// back to where half the signal is left, by the Gaussian of standard deviation `blur` [mm].
FreeEdge free_edge(const Volume& volume, const SheetEvidence& evidence, const LayerGrid& grid, double blur,
                   const GreyScale& scale);

}  // namespace coapt
