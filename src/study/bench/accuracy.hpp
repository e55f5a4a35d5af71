// Solves a scene on the mesh and to the tolerance that a wanted accuracy needs.
#pragma once

#include "run/run.hpp"

#include <functional>
#include <string>

namespace coapt {

// The mesh is cut into four until the estimate of the discretisation error (estimate_discretisation, from the
// distances between the closed surfaces, for 95 % of them) leaves room for the rest; the coarsest mesh that
// does is taken. It counts only where two refinements in a row agree in their order (orders_agree), which
// takes four meshes; else the accuracy is not reached, and the message says what is known. The tolerance is
// tightened until the algebraic error, the way that newton still goes from there to a hundredth of the
// residual, is at most a tenth of wanted_mm. The result is that of a solve of that mesh to that tolerance
// from the scene's own start, as run() writes it, with Report::accuracy; its folder and time limit (of all
// solves together) are those of the options. No mesh of more than kMostTriangles is made: what cannot be
// reached with fewer is said. Errors of the model, such as wrong tissue, are not known to it. Throws
// InputError for bad input as run() does: a wanted accuracy that is no positive number, a scene without a
// mesh, options that choose a tolerance or frames. observer: told of each mesh once it is solved and compared
// with those before; may be empty.
using AccuracyObserver = std::function<void(const AccuracyEstimate&)>;
RunReport run_to_accuracy(const Scene& scene, const SolverTable& solvers, double wanted_mm,
                          const RunOptions& options, const AccuracyObserver& observer = {},
                          int most_triangles = 200000);

// Of the mesh that was solved last: how long it took, how far it moved the surface of the mesh before, and
// the error that is estimated since. One line.
std::string last_mesh(const AccuracyEstimate& estimate);

}  // namespace coapt
