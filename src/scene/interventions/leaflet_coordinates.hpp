// Places on a leaflet by its free edge: how far along it, and how far from it. Private to this room.
#pragma once

#include "scene/interventions/intervention.hpp"

#include <optional>

namespace coapt {

// The free edge of a leaflet from commissure to commissure, in the start shape.
struct FreeEdge {
  std::string leaflet;        // region
  std::vector<int> vertices;  // in order
  std::vector<double> along;  // length up to each [mm]
  Points rim, root;  // edge and annulus of the leaflet at equal parts of their lengths; root may be empty
  double length() const { return along.back(); }
};

struct LeafletPoint {
  int vertex = 0;
  double along = 0;  // on the free edge, from its beginning [mm]
  double depth = 0;  // distance from there [mm]
};

// The free edges of the leaflets that the key `leaflets` or `leaflet` names, or of all regions with one where
// it is absent. All begin at the same commissure: the first of the set "commissures", or where the first free
// edge begins in its loop; two of three or more leaflets where they meet. The set "free_edge" orders them;
// without it, the one boundary loop away from the set "annulus". Throws InputError, naming the entry, where
// these are missing or a region does not reach the free edge.
std::vector<FreeEdge> free_edges(const InterventionSpec& spec, const ValveEdit& edit);

// The place of a position, on the straight lines from each point of the free edge to the point of the annulus
// at the same part of its length: that on the nearest one, and how far from its beginning. Where the leaflet
// reaches no annulus that the scene names: along and depth of the nearest point of the free edge. vertex is
// left 0. O(samples).
LeafletPoint place_on(const FreeEdge& edge, const Points& vertices, const Vec3& position);

// Every vertex of the leaflet. Time O(vertices x edge length).
std::vector<LeafletPoint> leaflet_points(const FreeEdge& edge, const TriangleMesh& mesh);

// Numbers of the triangles of a region.
std::vector<int> triangles_of(const std::string& region, const TriangleMesh& mesh);

}  // namespace coapt
