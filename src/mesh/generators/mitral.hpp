// A parametric mitral valve, complete for a closing simulation. Units: mm, N, MPa.
#pragma once

#include "mesh/generators/mitral_shape.hpp"
#include "mesh/valve.hpp"

namespace coapt {

struct MitralOptions {
  int triangles = 2500;  // wanted; the result has within 5 % of it
  unsigned seed = 0;     // 0: the mean valve; any other: dimensions drawn from published ranges
  int branches = 3;      // leaflet insertions of a chord (five at the commissures), 2 to 5
};

// The valve in its open, stress-free, end-diastolic shape:
//   leaflets        one surface between annulus and free edge, regions "anterior" and "posterior", normals
//                   to the ventricle (the outside of the funnel, the high-pressure side when closed)
//   annulus, free_edge, commissures (anterolateral, posteromedial), annulus_closed: the systolic annulus
//   chords          two papillary muscles with four tips each, see mitral_chords.hpp
//   pressure        120 mmHg, the systolic pressure of a healthy adult
// The chords, their tips, insertions and start shape are the same at every mesh size, up to the distance from
// an insertion to the nearest vertex. The dimensions and their sources: MitralDimensions and
// docs/generators.md.
// Throws InputError for fewer than 100 triangles or branches out of range.
Valve mitral_valve(const MitralOptions& options);

// The same for dimensions of one's own. Pre: those of mitral_shape.
Valve mitral_valve(const MitralDimensions& dimensions, int triangles, int branches = 3);

}  // namespace coapt
