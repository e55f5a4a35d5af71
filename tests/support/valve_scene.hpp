// The generated mitral valve as a problem: relaxed membrane, bending, chords, follower pressure on the front,
// and the annulus and papillary tips moved from the open to the closed position in one step. mm, N, MPa.
#pragma once

#include "mesh/valve.hpp"
#include "support/sheets.hpp"

namespace coapt {

struct ValveOptions {
  int triangles = 625;
  double bending = 1;        // times the physical stiffness E h^3 / 12 (1 - nu^2)
  double smoothing = 0.002;  // of the chords' kinks, over their length
};

struct ValveScene {
  explicit ValveScene(const ValveOptions& options);

  Triangles triangles;
  Points X;       // leaflets, papillary tips, junctions, open
  Points closed;  // the same, with the prescribed nodes where they go
  FixedMask fixed;
  Segments chords;  // by node
  Vector chord_lengths, chord_areas;
  ValveOptions options;

  Terms terms() const;
  Method method(double tolerance = 1e-8) const;

  // Leaflets of a state as a surface.
  TriangleMesh leaflets(const Points& x) const;
};

}  // namespace coapt
