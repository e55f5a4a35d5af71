// Rough valves, as people have them: for tests of methods that must not be made for smooth ones. Units: mm,
// N, MPa.
#pragma once

#include "formats/valve.hpp"
#include "valve/generators/rough_surface.hpp"

namespace coapt {

struct RoughOptions {
  RoughKind kind = RoughKind::Mitral;
  unsigned seed = 1;
  int triangles = 0;  // wanted; the result has within 5 % of it. 0: 300 to 20,000, drawn by the seed
};

// A valve whose every property is drawn by the seed; the same seed gives the same valve.
//   leaflets   two or three with scalloped margins, see rough_surface.hpp, uneven triangles with slivers, see
//              rough_mesh.hpp; open, stress-free, normals to the ventricle; nothing intersects
//   annulus, free_edge, commissures; annulus_closed and chords.papillary_closed: up to 5 mm away
//   chords     see rough_chords.hpp
//   membranes, cables, thickness  see rough_tissue.hpp
//   pressure   60 to 150 mmHg, of a tricuspid valve 15 to 45
// Shape, chords' plan, tissue and pressure do not depend on the number of triangles.
// Throws InputError for 1 to 249 triangles.
Valve rough_valve(const RoughOptions& options);

}  // namespace coapt
