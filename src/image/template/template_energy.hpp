// The energy of a template in an image.
#pragma once

#include "energy/objective.hpp"
#include "image/segment/layer_grid.hpp"
#include "image/template/spline_field.hpp"

#include <memory>

namespace coapt {

// Energies are the potential's unit times area [mm^2]. A leaflet has a potential of about -1.
struct TemplateEnergy {
  const SplineField& potential;  // outlives the objective
  double cost = 0;               // of area, beside the potential
  double share = 1;              // of ImageSheet: 0 leaves the size alone
  double membrane = 0;           // modulus against strain from the grid as it is
  double bending = 0;            // plate stiffness; the sheet is flat at rest [mm^2]
  double tension = 0;            // of the free edge [mm]
};

// Image, membrane, bending, tension of the last row, and contact by a barrier, over the triangles of a grid
// whose first row is held where it is.
std::unique_ptr<Objective> template_objective(const LayerGrid& grid, const TemplateEnergy& energy);

}  // namespace coapt
