// What build() makes of a scene: nodes, terms and motion, and all that a report needs to know of them.
#pragma once

#include "energy/kernels/cst.hpp"
#include "energy/objective.hpp"
#include "formats/valve.hpp"
#include "mesh/triangle_mesh.hpp"
#include "optim/solver.hpp"
#include "registration/wanted_registration.hpp"

#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace coapt {

// One cable or tether of the scene, for reports; indexed as in its term.
struct Line {
  int a = 0, b = 0;                                               // nodes
  double rest_length = 0;                                         // [mm]; 0 for a constant-force cable
  double area = 0;                                                // cross-section [mm2]; 0: not known
  std::string term;                                               // name of the term that it belongs to
  int element = 0;                                                // its element in that term
  double yield_strain = std::numeric_limits<double>::infinity();  // length over rest length, less 1
};

// Plane-stress membrane properties of one triangle; of a nonlinear law those at small strain.
struct MembraneProperties {
  double young = 0;  // [MPa]
  double poisson = 0;
  double thickness = 0;  // [mm]
  double prestress = 0;  // resultant [N/mm]
};

// The triangles of one membrane term, and how its stress is read.
struct MembranePatch {
  std::vector<int> triangles;  // element e of the term covers triangles[e]
  std::function<MembraneState(int element, const CstVector& corners)> state;
  std::string term = {};  // its name
  // Elongation of the element's fibres over that at which they yield, at least 0, and its gradient unless
  // that is null; none where nothing yields.
  std::function<double(int element, const CstVector& corners, CstVector* gradient)> yield_ratio = {};
};

// Nodes are numbered: mesh vertices first, then the points of each network (papillary, then junctions), then
// the vertices of each obstacle. Lengths in mm, forces in N. Positions are kept relative to `origin` (the
// centre of the nodes), so that a mesh far from zero loses no digits; add it back on output.
struct Model {
  Vec3 origin = Vec3::Zero();                    // [mm]
  Points X;                                      // reference positions, 3 x node_count [mm]
  TriangleMesh mesh;                             // its vertices are the first columns of X
  Triangles obstacles = Triangles(3, 0);         // facets of all obstacles, by node number
  std::map<std::string, std::vector<int>> sets;  // named nodes, ordered where the source orders them
  std::vector<Line> lines;
  Points fibres = Points(3, 0);  // unit fibre direction of each triangle, in its plane; the sign means
                                 // nothing; no columns where nothing asks for fibres
  Vector fibre_anisotropy;       // per triangle, see valve/fibre_field.hpp; empty like fibres
  std::vector<MembraneProperties> membrane;  // per triangle; empty without a membrane term
  std::vector<MembranePatch> membrane_patches;
  double film_tension = 0;         // largest of the surface_tension terms [N/mm]
  double applied_pressure = 0;     // largest pressure of the load terms [MPa]
  double contact_range = 0;        // [mm]; 0 without a contact term
  bool wants_first_piola = false;  // stress among the fields
  std::unique_ptr<Objective> objective;
  MotionPath motion;
  Vector q0;
  std::optional<TriangleMesh> closed_reference;    // relative to origin too
  std::optional<WantedRegistration> registration;  // of the closed reference
  std::vector<std::string> warnings;               // whole sentences
};

}  // namespace coapt
