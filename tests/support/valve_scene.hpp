// The generated mitral valve as a problem: relaxed membrane, bending, chords, follower pressure on the front,
// and the annulus and papillary tips moved from the open to the closed position in one step. mm, N, MPa.
#pragma once

#include "formats/valve.hpp"
#include "support/frame.hpp"
#include "support/sheets.hpp"

namespace coapt {

struct ValveOptions {
  int triangles = 625;
  int refinements = 0;                 // each triangle cut into four so often, with the same chords
  double young = 1, chord_young = 40;  // [MPa]
  double bending = 1;                  // times the physical stiffness E h^3 / 12 (1 - nu^2)
  double contact_gap = 0;              // of a barrier [mm]; 0: no contact
  unsigned seed = 0;                   // of the dimensions, 0: the mean valve
  double smoothing = 0.002;            // of the chords' kinks, over their length
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

  // As seen from another frame; `is_reversed` turns the triangles over, and with them the sign of the
  // pressure. A frame that mirrors does so too.
  Terms terms(const Frame& frame = {}, bool is_reversed = false) const;
  FixedMask fixed_in(const Frame& frame) const;
  Method method(double tolerance = 1e-8, const Frame& frame = {}) const;
  // Positions are given back in the scene's own frame.
  Equilibrium solve_in(const Frame& frame, double tolerance, bool is_reversed = false) const;

  // Nodes that a force holds at x: those of the leaflets, and the ends of taut chords. A junction between
  // slack chords lies anywhere within their reach, without energy, and has no place that a test could ask
  // for. (A chord on the border, stretched by 1e-7 of its length, pulls with less than the tolerance.)
  std::vector<int> held_nodes(const Points& x) const;

  // Leaflets of a state as a surface.
  TriangleMesh leaflets(const Points& x) const;
};

}  // namespace coapt
