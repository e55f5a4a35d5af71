// Splits a surface that hangs on an annulus into regions, for properties that differ from place to place.
#pragma once

#include "mesh/triangle_mesh.hpp"

#include <string>
#include <vector>

namespace coapt {

struct LeafletRegions {
  std::vector<int> of_triangle;
  std::vector<std::string> names;  // "anterior/annulus/2": leaflet, zone, sector from 1; all hold a triangle
};

// Splits each leaflet (region of the mesh) into `zones` zones, by the distance along edges from the annulus
// over the sum of that and the distance from the free edge, and each zone into sectors of equal area, by the
// angle around the annulus. wanted / zones sectors are shared out by leaflet area, one at least for each.
// There are fewer regions than wanted where one would hold no triangle. annulus: an ordered loop of vertices.
// Throws InputError where there are no zones, `wanted` is no multiple of them or gives too few for the
// leaflets, and where the annulus names nodes that are no vertices, or leaves none beside it.
LeafletRegions leaflet_regions(const TriangleMesh& mesh, const std::vector<int>& annulus, int wanted,
                               int zones);

}  // namespace coapt
