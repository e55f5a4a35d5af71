// Places on a leaflet by its free edge: how far along it, and how far from it.
#pragma once

#include "core/types.hpp"
#include "mesh/triangle_mesh.hpp"

#include <string>
#include <vector>

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

// The longest stretch of the closed loop whose vertices are all members, in the order of the loop.
std::vector<int> longest_run(const std::vector<int>& loop, const std::vector<bool>& is_member);

// The free edge along these vertices of x (3 x n) [mm]; without rim and root.
FreeEdge free_edge_of(std::string leaflet, std::vector<int> vertices, const Points& x);

// Of two leaflets that share one commissure: both edges begin there. Pre: edges has two.
void begin_where_they_meet(std::vector<FreeEdge>& edges, const Points& x);

// Sets rim and root, beginning at the same end; leaves them empty where the leaflet has fewer than two
// vertices on the annulus.
void lay_side_by_side(FreeEdge& edge, std::vector<int> annulus, const Points& x);

// The place of a position, on the straight lines from each point of the free edge to the point of the annulus
// at the same part of its length: that on the nearest one, and how far from its beginning. Where the leaflet
// reaches no annulus that the scene names: along and depth of the nearest point of the free edge. vertex is
// left 0. O(samples).
LeafletPoint place_on(const FreeEdge& edge, const Points& vertices, const Vec3& position);

// Every vertex of the leaflet. Time O(vertices x edge length).
std::vector<LeafletPoint> leaflet_points(const FreeEdge& edge, const TriangleMesh& mesh);

// Numbers of the triangles of a region.
std::vector<int> leaflet_triangles(const std::string& region, const TriangleMesh& mesh);

}  // namespace coapt
