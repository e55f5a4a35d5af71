// How well a fitted template is known.
#pragma once

#include "energy/objective.hpp"
#include "image/segment/fit_layer.hpp"
#include "image/template/spline_field.hpp"

namespace coapt {

struct TemplateDeviation {
  LayerFit fit;          // of each point of the grid
  double free_edge = 0;  // of the edge along the leaflet, standard deviation [mm]
};

// The energy is taken for minus the logarithm of a posterior, in a unit that the image's noise says: how far
// the ridge of the potential lies beside each point (a Newton step along the normal), its variance times the
// area over which it goes together times the mean curvature of the potential. The variance of a point along
// its normal is that unit times the entry of the inverse of the energy's Hessian at the minimum, elements'
// negative curvatures left out; of the free edge, along its columns. In gaps of the evidence that of a bend
// which nothing shows is added (gap_deviation.hpp). evidence: of each point, 0 to 1. Pre: the objective is
// that of the grid (template_energy.hpp).
TemplateDeviation template_deviation(const LayerGrid& grid, Objective& objective,
                                     const SplineField& potential, Vector evidence);

}  // namespace coapt
