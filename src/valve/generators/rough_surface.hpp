// The surface behind a rough valve: leaflets with scalloped margins on an uneven annulus, open and closed,
// and the papillary tips that hold them.
#pragma once

#include "core/random_source.hpp"
#include "core/types.hpp"

#include <functional>
#include <string>
#include <vector>

namespace coapt {

enum class RoughKind { Mitral, Tricuspid };

// Two coordinates as in MitralShape and tricuspid_shape.hpp: u in [0, 1) once around, anticlockwise seen from
// the atrium (+z), t in [0, 1] from the annulus to the free margin. Lengths in mm.
struct RoughSurface {
  std::vector<std::string> leaflets;  // in order of u
  std::vector<double> begins;         // u at which each leaflet begins, at a commissure; the first is 0
  std::function<Vec3(double u, double t)> open;    // stress-free
  std::function<Vec3(double u, double t)> closed;  // by construction, not by equilibrium
  Points tips = Points(3, 0), tips_closed = Points(3, 0);
  std::vector<int> tip_group;  // the commissure below which each tip lies

  size_t leaflet_at(double u) const;
  double end(size_t leaflet) const { return leaflet + 1 < begins.size() ? begins[leaflet + 1] : 1; }
};

// Annulus and tips move by up to 5 mm between open and closed.
RoughSurface rough_surface(RoughKind kind, RandomSource& random);

}  // namespace coapt
