// The papillary muscles and chords of the generated mitral valve.
#pragma once

#include "formats/valve.hpp"
#include "valve/generators/mitral_mesh.hpp"

namespace coapt {

// Each of the two papillary muscles carries twelve chords: three primary ones, a secondary one and a strut
// to its half of the anterior leaflet, four primary and two secondary ones to its half of the posterior
// leaflet, and one to its commissure. A chord is a trunk (level 1) from one of the muscle's four tips to a
// junction and a fan of branches (level 2) to `branches` leaflet vertices, five at the commissure.
//
// The insertions are points of the smooth shape and do not depend on the mesh; a branch ends at the nearest
// vertex (of the free edge for primary chords, not of the boundary for the others). The rest length
// of a branch is its length in the closed shape, with the vertex at mitral_closed_point, but at least its
// length at the start, so that no chord is stretched in the open valve; trunks do not depend on the mesh
// unless this last rule applies. Of RoughZone no segment passes through a leaflet in the open shape where
// there is a place of the junction for that (clear_junctions.hpp). Materials "primary", "secondary", "strut".
// Papillary points 0-3 and junctions 0-11 belong to the anterolateral muscle, the others to the posteromedial
// one.
//
// Given `tips` (3 x n, in the frame of the shape) take the place of those eight: the anterolateral muscle has
// those of positive x. They are numbered muscle by muscle, else in their order.
// Pre: 2 <= branches <= 5; no tips, or some on both sides.
ChordNetwork mitral_chords(const MitralShape& shape, const MitralMesh& mesh, int branches,
                           const Points& tips = Points(3, 0));

}  // namespace coapt
