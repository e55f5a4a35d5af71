// How far each place of a layer in ultrasound is leaflet, by a small neural network that
// bench/edge_network.py learns on generated phantoms. It never saw a patient's image. It is not told how far
// from the annulus a place lies: it must not know how long leaflets are.
#pragma once

#include "image/segment/layer_grid.hpp"
#include "image/segment/sheet_evidence.hpp"

namespace coapt {

inline constexpr double kPlaceStep = 0.5;  // between places down a column [mm]

// What the network is given, channels x (places * columns): the place k * columns + c lies (k + 0.5) steps
// down column c. Values at 21 distances along the normal, -4 to 6 mm, with blood 0 and leaflets 1 as near the
// annulus; strength of the sheet over that of leaflets; distance of columns / 0.75 mm; 1. All 0 beyond
// the end of a column.
Eigen::MatrixXf layer_channels(const Volume& volume, const SheetEvidence& evidence, const LayerGrid& grid);

// Logit of leaflet, -4 to 4, places x columns; -4 beyond the end of a column.
Eigen::MatrixXd leaflet_logits(const Eigen::MatrixXf& channels, int columns);

}  // namespace coapt
