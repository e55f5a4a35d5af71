// What is doubtful about a valve before it is solved: its chords, its sizes, the side of its pressure.
#pragma once

#include "formats/valve.hpp"

#include <string>
#include <vector>

namespace coapt {

// Chords: strands twice between the same two points, without length, at junctions where nothing goes on, or
// that reach no papillary tip; regions of the leaflets on which none inserts; insertions that lie farther
// from their tip than the strands between them are long, by more than kOverstretched, in the open and in the
// closed position. Where the closed reference has the vertices of the leaflets they are the closed position,
// else these stay where they are and the tips alone go to theirs.
// Each entry is a sentence with the numbers of chords (as in valve.chords.chords), junctions or regions, and
// what to do. Lengths in mm.
std::vector<std::string> chord_doubts(const Valve& valve);
inline constexpr double kOverstretched =
    0.2;  // strain, beyond what the valves at hand were designed for (0.16)

// Leaflets, thickness, chords and pressure of a size that no heart valve has (a unit misread), and normals
// that point away from the papillary tips, which lie on the side of the pressure. Values of 0 are not stated.
// Lengths in mm, pressure in MPa.
std::vector<std::string> size_doubts(const Valve& valve);
std::vector<std::string> pressure_side_doubts(const Valve& valve);

// Neighbouring triangles that lie on each other, with a dihedral angle below one degree. A seam of two flat
// layers is such a fold too, by right; leaflets have none.
std::vector<std::string> fold_doubts(const TriangleMesh& leaflets);

}  // namespace coapt
