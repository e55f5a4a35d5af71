// The closest point of a surface, of the sheet that faces the right way. Private to this room.
#pragma once

#include "mesh/distance/triangle_tree.hpp"

#include <array>

namespace coapt {

// Where the closest point lies, and what it follows of a motion of its facet and of the point that seeks it.
struct ClosestPoint {
  std::array<int, 3> corners;  // of the facet
  Vec3 point, weights;         // and its barycentric coordinates
  Eigen::Matrix3d away;        // projection on what it does not follow: the normal of the facet; on an edge
                               // also what is across the edge, at a corner all
  Eigen::Matrix3d slopes;      // columns: gradients of the barycentric coordinates along the facet, the edge
};

// Facets that face away from a direction are left out where others are near: where two sheets lie against
// each other, the nearest point may belong to the wrong one.
class FacingSurface {
 public:
  // Both must outlive this object and stay as they are.
  FacingSurface(const Points& x, const Triangles& triangles);

  ClosestPoint closest(const Vec3& p, const Vec3& direction) const;

  // -1 where most of the surface with this area at its vertices faces against its nearest facets, else 1.
  double orientation_of(const Points& x, const Points& normals, const Vector& areas) const;

 private:
  Vec3 corner(int triangle, int k) const { return x_.col(triangles_(k % 3, triangle)); }
  Vec3 facet_normal(int triangle) const;
  ClosestPoint closest_point(const ClosestOnSurface& at) const;

  const Points& x_;
  const Triangles& triangles_;
  TriangleTree tree_;
  double least_reach_;
};

// Normals at the vertices of a surface, of any length; zero at nodes that no triangle has.
Points vertex_normals(const Points& x, const Triangles& triangles);

}  // namespace coapt
