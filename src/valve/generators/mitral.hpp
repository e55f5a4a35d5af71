// A parametric mitral valve, complete for a closing simulation. Units: mm, N, MPa.
#pragma once

#include "formats/valve.hpp"
#include "valve/generators/mitral_shape.hpp"

#include <string>

namespace coapt {

// "closed", "benchmark". Throws InputError for another name.
MitralPreset mitral_preset(const std::string& name);

struct MitralOptions {
  int triangles = 2500;  // wanted; the result has within 5 % of it
  unsigned seed = 0;     // 0: the mean valve; any other: dimensions drawn from published ranges
  int branches = 3;      // insertions of a chord on the free edge (five at the commissures), 2 to 5
  MitralPreset preset = MitralPreset::Closed;
};

// The valve in its open, stress-free, end-diastolic shape:
//   leaflets        one surface between annulus and free edge, regions "anterior" and "posterior", normals
//                   to the ventricle (the outside of the funnel, the high-pressure side when closed)
//   annulus, free_edge, commissures (anterolateral, posteromedial), annulus_closed: the systolic annulus
//   chords          two papillary muscles with four tips each, see mitral_chords.hpp
//   membranes       linear ones that wrinkle, of the preset `Closed`; none of the other
//   pressure        120 mmHg, the systolic pressure of a healthy adult
// The chords, their tips, insertions and start shape are the same at every mesh size, up to the distance from
// an insertion to the nearest vertex. The dimensions and their sources: MitralDimensions and
// docs/generators.md.
// Throws InputError for fewer than 100 triangles or branches out of range.
Valve mitral_valve(const MitralOptions& options);

// What was measured of a valve, in any frame [mm].
struct MeasuredMitral {
  std::string name;                 // of the file, for messages
  Points annulus = Points(3, 0);    // closed polygon at end of diastole, 3 x n in order
  AnnulusSides sides = {};          // where the curve does not tell them; tips tell that of the ventricle
  Points papillary = Points(3, 0);  // tips, 3 x n; none: the generator's
};

// The generated valve on a measured annulus, in the frame of the measurement. The vertices of the annulus lie
// on the polygon. The valve's own diameters and flatness are replaced by the curve's (fit_mitral_annulus),
// and what is a length, the tenting and the places of the papillary muscles, grows with the commissural
// diameter; the thickness does not. The systolic annulus is the measured one, contracted and with a higher
// saddle. Throws InputError for what fit_mitral_annulus refuses, for tips that lie on one side of the valve
// alone or above its annulus, and where leaflets on that curve would pass through each other.
Valve mitral_valve(const MitralOptions& options, const MeasuredMitral& measured);

// The same for dimensions of one's own. Pre: those of mitral_shape.
Valve mitral_valve(const MitralDimensions& dimensions, int triangles, int branches = 3);

}  // namespace coapt
