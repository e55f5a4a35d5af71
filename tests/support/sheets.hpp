// Sheets of the default material: relaxed membrane and bending, and a short way to solve with either solver.
#pragma once

#include "support/equilibrium.hpp"

namespace coapt {

// cst_tension_field on all triangles with rest positions X.
std::unique_ptr<EnergyTerm> tension_field_term(const Points& X, const Triangles& triangles,
                                               const Membrane& membrane);

// The same as cst_stvk or cst_tension_field.
enum class SheetLaw { StVK, TensionField };
std::unique_ptr<EnergyTerm> sheet_term(SheetLaw material, const Points& X, const Triangles& triangles,
                                       const Membrane& membrane);

// Hinges on all inner edges; stiffness D [force x length]. Pre: the mesh is manifold.
std::unique_ptr<EnergyTerm> bending_term(const Points& X, const Triangles& triangles, double stiffness);

// Area [length^2] of the triangles of a tension-field term in each regime: slack, wrinkled, taut.
Eigen::Vector3d regime_areas(const Points& X, const Points& x, const Triangles& triangles,
                             const Membrane& membrane);

// The whole of a way to solve.
struct Method {
  std::string solver = "newton";
  double tolerance = 1e-9;
  int max_iterations = 100000;
  double max_seconds = 120;
  MotionPath motion = {};
  Continuation continuation = {};
  std::function<void(const Points& x)> watch = {};  // sees all nodes at every accepted iterate
  std::function<Vector()> masses = {};              // of each node, for "dynamic"
  DynamicOptions dynamic = {};
};

Equilibrium find_equilibrium(const Points& start, const FixedMask& fixed, Terms terms, const Method& method);

}  // namespace coapt
