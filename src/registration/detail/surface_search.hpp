// One surface sought on another. Private to this room.
#pragma once

#include "mesh/distance/triangle_tree.hpp"
#include "registration/registration.hpp"

#include <array>
#include <vector>

namespace coapt::registration {

// A surface as the search sees it.
struct SearchedSurface {
  explicit SearchedSurface(const TriangleMesh& mesh);

  TriangleTree tree;
  Points normals;                            // of the triangles, of length 1 (0 where they have no area)
  std::vector<std::array<bool, 3>> borders;  // whether the edge across from each corner ends the surface
  std::vector<bool> border_vertices;
  Triangles triangles;
  Points points;         // the vertices on triangles, in an order that spreads them over the surface
  Vec3 middle;           // median of each coordinate: outliers do not move it [length]
  double size = 0;       // twice the median distance from the middle [length]
  double roughness = 0;  // mean of 1 - cosine between neighbours
};

struct SearchSettings {
  int points = 0;  // that are sought: the first of the list; 0: all
  int most_iterations = 1;
  double point_share = 0;  // weight of point to point beside point to plane
  bool leaves_border_out = true;
  RegistrationOptions options = {};
};

struct SearchResult {
  RigidMotion motion;         // of the points that are sought
  double score = 0;           // mean distance, none counted for more than a tenth of the size [length]
  double rms = 0;             // of the pairs kept, by their weights, point to plane [length]
  double overlap = 0;         // share of the points that lie close to the surface
  double standard_error = 0;  // of the places of the points (rms), with all points only [length]
  int pairs = 0, iterations = 0, free_directions = 0;
};

// From a start by Gauss-Newton steps until nothing moves or the iterations are used up.
// Score, overlap and rms are those of the last pairs, before the step that follows from them.
SearchResult search(const SearchedSurface& sought, const SearchedSurface& on, const RigidMotion& start,
                    const SearchSettings& settings);

}  // namespace coapt::registration
