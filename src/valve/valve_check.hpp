// What is doubtful about a valve before it is solved: its chords, its sizes, the side of its pressure.
// Vertices and triangles are named by the given numbering, chords, tips and junctions from 0.
#pragma once

#include "formats/valve.hpp"
#include "mesh/numbering.hpp"

#include <limits>
#include <map>
#include <string>
#include <vector>

namespace coapt {

// At which strain a chord pulls, by its law, with more than kMostChordStress. Infinite where none is known.
struct ChordLimits {
  std::map<std::string, double> by_material;  // Chord::material
  double of_all = std::numeric_limits<double>::infinity();

  double strain(const std::string& material) const;
};

// Nominal; far beyond the 20 to 60 MPa at which chords tear and what sutures bear [MPa].
inline constexpr double kMostChordStress = 1000;

// Chords: none although there are papillary tips; strands twice between the same two points, without length,
// at junctions where nothing goes on, or that reach no papillary tip; regions or pieces of the leaflets, or
// long runs of the free edge, on which none inserts; insertions that lie farther from their tip than the
// strands between them are long: in the open and in the closed position, by more than kOverstretched or so
// far that by their laws some chord must pull with more than kMostChordStress; in the closed position by
// itself, by more than kOverstretchedClosed, or that far where the leaflets' place is known; rest lengths
// with which all hang slack. Where the closed reference has the vertices of the leaflets they are the closed
// position, else these stay where they are and the tips alone go to theirs. Each entry is a sentence with the
// numbers of chords (as in valve.chords.chords), junctions or regions, and what to do. Lengths in mm.
// names_repeated: false leaves out strands between the same two points, which coarse meshes have by right.
std::vector<std::string> chord_doubts(const Valve& valve, const ChordLimits& limits = {},
                                      bool names_repeated = true, Numbering numbering = {});
inline constexpr double kOverstretched =
    0.2;  // strain, beyond what the valves at hand were designed for (0.16)
inline constexpr double kOverstretchedClosed = 0.3;  // strain; chords tear at some 0.2 to 0.4, rough valves
                                                     // have up to 0.2 before their leaflets move

// Leaflets, thickness, chords and pressure of a size that no heart valve has (a unit misread), and a
// thickness that is no membrane's, above a quarter of the largest extent. Values of 0 are not stated. Lengths
// in mm, pressure in MPa.
std::vector<std::string> size_doubts(const Valve& valve);

// Leaflets whose normals point to the lumen: the pressure is on their other side, that of the papillary tips.
// Each piece of the surface is judged by the way in which its triangles run along the annulus, around an axis
// from the annulus to the tips, or without these to the free edges. Nothing where that is not clear.
// is_on_back: the pressure acts on the side that the normals come from, and those are told whose normals do
// not point to the lumen.
std::vector<std::string> pressure_side_doubts(const Valve& valve, Numbering numbering = {},
                                              bool is_on_back = false);

// Neighbouring triangles that lie on each other: with a dihedral angle below one degree, and of those higher
// than 0.6 mean edges with one below 30 degrees. A seam of two flat layers is such a fold too, by right;
// leaflets have none.
std::vector<std::string> fold_doubts(const TriangleMesh& leaflets, Numbering numbering = {});

}  // namespace coapt
