// A heart valve, or any membrane held by cables, as plain data: leaflets, annulus, anchors, chords.
#pragma once

#include "mesh/triangle_mesh.hpp"

#include <array>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace coapt {

// Of a position that is read or written: beyond it nothing is a valve, and squares soon overflow [mm].
inline constexpr double kGreatestCoordinate = 1e9;

// One end of a chord: an anchor (papillary tip), a junction (free branch point) or a leaflet vertex.
struct ChordEnd {
  enum class Kind { Papillary, Junction, Leaflet };
  Kind kind = Kind::Leaflet;
  int index = 0;  // 0-based within its kind
};

struct Chord {
  ChordEnd from, to;
  double rest_length = 0;  // [length]
  double area = 0;         // cross-section [length^2]
  std::string material;    // group name, may be empty
  int level = 0;           // 1 = at the papillary muscle; 0 = not stated
};

// A branching network of tension-only lines.
struct ChordNetwork {
  Points papillary = Points(3, 0);         // anchors, 3 x papillary_count [length]
  Points papillary_closed = Points(3, 0);  // where the anchors go; empty: they stay
  Points junctions = Points(3, 0);         // free branch points at the start, 3 x junction_count [length]
  std::vector<Chord> chords;
};

// A law as the scene writes it: the type of a term, and its keys with their values as JSON text, units
// included: {"young", "\"1 MPa\""}, {"c2", "4.57"}.
struct Material {
  std::string type;
  std::vector<std::pair<std::string, std::string>> keys;
};

// Vertices that are held or moved and are no annulus: a clamped rim, a symmetry plane.
struct Support {
  std::string name;                               // a set of vertices; unique
  std::vector<int> vertices;                      // of the leaflets
  std::array<bool, 3> axes = {true, true, true};  // prescribed coordinates
  Points closed = Points(3, 0);                   // where they go; empty: they stay [length]
};

struct Valve {
  std::string name;
  TriangleMesh leaflets;  // start shape, normals point to the high-pressure side
  std::optional<TriangleMesh> closed_reference;
  std::vector<int> annulus;              // ordered closed loop of vertices
  Points annulus_closed = Points(3, 0);  // where the annulus goes; empty: it stays
  std::vector<int> free_edge;            // ordered closed loop of vertices, may be empty
  std::vector<int> commissures;          // vertices where the leaflets meet at the annulus, may be empty
  ChordNetwork chords;
  double pressure = 0;                           // [force/length^2]; 0 = not stated
  double thickness = 0;                          // [length]; 0 = not stated
  std::map<std::string, Material> membranes;     // by region of the leaflets; may be empty
  std::map<std::string, Material> cables;        // by Chord::material; may be empty
  std::map<std::string, std::vector<int>> sets;  // other named vertices
  std::vector<Support> supports;
};

}  // namespace coapt
