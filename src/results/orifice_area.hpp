// What the leaflets leave open of the annulus, seen along its normal.
#pragma once

#include "scene/build/model.hpp"

#include <optional>

namespace coapt {

struct OrificeArea {
  double open = 0;     // [mm2]
  double annulus = 0;  // projected on its plane [mm2]
};

// x: 3 x node_count. Empty for a model without an annulus, or one on a line, that encloses nothing.
// refinement: of the rows, at most, see uncovered_area().
std::optional<OrificeArea> orifice_area(const Model& model, const Points& x, int refinement = 32);

// Pre: orifice_area() is not empty. Derivative of the open area by the nodes, 3 x node_count [mm], with the
// view held: it is, where the annulus is prescribed.
Points orifice_area_gradient(const Model& model, const Points& x);

}  // namespace coapt
