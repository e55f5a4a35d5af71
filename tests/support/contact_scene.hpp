// Sheets that meet obstacles or themselves, solved with a judge at every accepted iterate.
#pragma once

#include "support/meshes.hpp"
#include "support/sheets.hpp"

namespace coapt {

// What an independent judge (exact predicates, mesh/distance/intersections.hpp) saw of a run.
struct Judged {
  Equilibrium found;
  long iterates = 0;       // accepted, the start and those of intermediate steps included
  long intersections = 0;  // most pairs of facets that passed through each other at one of them
};

// facets: those of the membrane, then, from membrane_count on, those of obstacles, which are not judged among
// themselves.
Judged solve_judged(const Points& start, const FixedMask& fixed, Terms terms, const Triangles& facets,
                    Eigen::Index membrane_count, Method method);

// Pairs of facets that pass through each other, those of obstacles among themselves left out.
long judged_intersections(const Points& x, const Triangles& facets, Eigen::Index membrane_count);

// An elastic sheet (tension field, bending) and obstacles below it. Stiffness E h = 1, nu = 0.3.
struct ContactScene {
  TriangleMesh sheet;
  TriangleMesh obstacle = {};         // its nodes follow those of the sheet and are prescribed
  std::vector<int> held = {};         // nodes of the sheet that are prescribed
  Vec3 traction = Vec3(0, 0, -0.02);  // dead load per rest area
  double gap = 0.02;                  // of the barrier; 0: no contact
  double bending = 1e-5;
  std::function<Points(double t, const Points& start)> motion = {};  // of all nodes; prescribed ones count
  int motion_steps = 1;

  Triangles facets() const;
  Points start() const;
  Judged solve(const std::string& solver = "newton", double tolerance = 1e-8) const;
};

// A pyramid without a bottom: its apex, and a square of the given half width around the foot.
TriangleMesh spike(const Vec3& apex, double height, double half_width);

// Vertices on the boundary of a mesh.
std::vector<int> rim_of(const TriangleMesh& mesh);

}  // namespace coapt
