// Where a layer ends: the free edge of the leaflets.
#pragma once

#include "image/segment/layer_grid.hpp"
#include "image/segment/sheet_evidence.hpp"

namespace coapt {

// By what a place of the layer is taken for leaflet. Contrast: as said below. Learnt: by a neural network
// (edge_network.hpp), which knows the brightness of ultrasound alone.
enum class EdgeRule { Contrast, Learnt };

struct FreeEdge {
  Vector lengths;        // along each column, from the annulus [mm]
  double deviation = 0;  // standard deviation of a length, before the edge was smoothed [mm]
  double contrast = 0;   // of the layer and what lies on the darker of its sides, in values of the volume
  // Of Learnt: where Contrast ends each column, because chords begin beside it [mm]; blur and thickness are
  // read above. Else empty: they are read to the edge.
  Vector clear = {};
};

// At each point of the layer the evidence is two thirds that of a sheet and one third the contrast (half and
// half where blood follows the edge all around, and no chords): what the value on the layer (the mean of half
// a millimetre to both sides) exceeds that on the darker of its sides (1.5 to 2.5 mm away) by; both over
// their medians two to six millimetres from the annulus. The brighter side is not asked: chords of the rough
// zone run along it long before the leaflet ends. What a leaflet has speaks for it, what bundles of chords
// have against it, and what is dark hardly at all, because echoes drop out within leaflets. The edge is the
// closed polygon (closed_polygon.hpp) that these contradict least, moved on by up to 1.5 mm where blood
// follows and no chords, and smoothed along the ring. `evidence` is that of all scales.
// Learnt: the polygon that the network's logits contradict least, smoothed.
FreeEdge free_edge(const Volume& volume, const SheetEvidence& evidence, const LayerGrid& grid,
                   EdgeRule rule = EdgeRule::Contrast);

}  // namespace coapt
