// Bodies of xpbd for tests: a sheet with all kinds of constraints, a hanging mass, a chain.
#pragma once

#include "energy/objective.hpp"
#include "mesh/triangle_mesh.hpp"
#include "xpbd/options.hpp"
#include "xpbd/system.hpp"

#include <memory>
#include <random>

namespace coapt {

// Options of xpbd that may be changed: a copy, which takes the place of those that are shared.
inline XpbdOptions& editable(std::shared_ptr<const XpbdOptions>& options) {
  const auto copy = std::make_shared<XpbdOptions>(options ? *options : XpbdOptions{});
  options = copy;
  return *copy;
}

// Edges, areas, hinges and a film of a sheet; stiffness of each kind.
inline XpbdBody sheet_body(const TriangleMesh& mesh, double stretch, double area, double bending,
                           double film = 0) {
  XpbdBody body;
  const Points& X = mesh.vertices;
  body.rest = X;
  body.triangles = mesh.triangles;
  for (const auto& t : mesh.triangles.colwise()) {
    body.areas.push_back({{t[0], t[1], t[2]}, area_vector(X, t).norm(), area, false});
    if (film > 0) body.films.push_back({{t[0], t[1], t[2]}, film});
  }
  for (const Edge& edge : edges(mesh.triangles)) {
    body.edges.push_back({edge.a, edge.b, (X.col(edge.a) - X.col(edge.b)).norm(), stretch, false});
    if (edge.triangles.size() != 2) continue;
    const int c = mesh.triangles.col(edge.triangles[0]).sum() - edge.a - edge.b,
              d = mesh.triangles.col(edge.triangles[1]).sum() - edge.a - edge.b;
    body.hinges.push_back({{edge.a, edge.b, c, d},
                           BendingHinge::angle(X.col(edge.a), X.col(edge.b), X.col(c), X.col(d)),
                           bending});
  }
  return body;
}

// Nodes 0 ... n in a row, node k tied to node k + 1 by a tether.
inline XpbdBody chain_body(const Points& rest, double length, double stiffness) {
  XpbdBody body;
  body.rest = rest;
  for (int k = 0; k + 1 < rest.cols(); ++k) {
    XpbdTether link;
    link.a = k;
    link.b = k + 1;
    link.length = length;
    link.stiffness = stiffness;
    body.tethers.push_back(link);
  }
  return body;
}

// 3 x count numbers in [-1, 1] from a fixed seed.
inline Points random_points(Eigen::Index count, unsigned seed) {
  std::mt19937 random(seed);
  Points p(3, count);
  for (double& value : p.reshaped()) value = 2 * (random() / 4294967295.0) - 1;
  return p;
}

inline FixedMask none_fixed(Eigen::Index count) { return FixedMask::Constant(3, count, false); }

}  // namespace coapt
