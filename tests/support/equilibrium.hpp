// Short ways to pose and solve small problems. Kernels are not seen here, so that a change of one recompiles
// only the tests that name it.
#pragma once

#include "energy/term.hpp"
#include "mesh/triangle_mesh.hpp"
#include "optim/solver.hpp"

#include <memory>
#include <string>
#include <vector>

namespace coapt {

using Terms = std::vector<std::unique_ptr<EnergyTerm>>;

// A list of terms from temporaries.
template <typename... Term>
Terms terms_of(std::unique_ptr<Term>... term) {
  Terms terms;
  (terms.push_back(std::move(term)), ...);
  return terms;
}

struct Membrane {
  double stiffness = 1;  // E h [force/length], thickness 1
  double poisson = 0.3;
  double prestress = 0;  // resultant [force/length]
};

// cst_stvk on all triangles with rest positions X.
std::unique_ptr<EnergyTerm> membrane_term(const Points& X, const Triangles& triangles,
                                          const Membrane& membrane);

// Elastic energy of a membrane at x [force x length].
double membrane_energy(const EnergyTerm& term, const Points& x);

// Cables along `segments`, all with the same axial stiffness EA; rest lengths given.
std::unique_ptr<EnergyTerm> cable_term(const Segments& segments, double axial_stiffness,
                                       const Vector& rest_lengths);

// Mask in which the listed nodes are fixed in all coordinates.
FixedMask fixed_nodes(Eigen::Index node_count, const std::vector<int>& nodes);

struct Equilibrium {
  Points x;       // 3 x node_count
  Result result;  // as solve() gave it
};

// Solves from `start` with a solver of the built-in table; prescribed coordinates are those of `start`.
Equilibrium find_equilibrium(const Points& start, const FixedMask& fixed, Terms terms,
                             double tolerance = 1e-9, const std::string& solver = "lbfgs");

// Order of convergence from errors on two meshes, the second `ratio` times finer.
double observed_order(double coarse_error, double fine_error, double ratio = 2);

}  // namespace coapt
