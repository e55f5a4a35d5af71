// Newton's method on the exact Hessian, made safe by a shift of its diagonal that vanishes towards the
// solution.
#pragma once

#include "optim/solver.hpp"

namespace coapt {

// Each step solves (K + mu I) d = -g. K is the exact tangent where Cholesky's method accepts its symmetric
// part, the sum of the elements' projected ones otherwise; conjugate gradients then take back what the
// projection adds, as far as the curvature is positive (Steihaug 1983). The skew part, from pressure on free
// edges, is taken into account by GMRES preconditioned with the factor of the symmetric one; near an
// equilibrium whose symmetric part is indefinite GMRES solves with the exact tangent. The shift mu
// (pseudo-transient continuation; Kelley & Keyes 1998) starts at five times force over length of the scene,
// falls five- or twenty-fivefold with each full step that keeps what the quadratic model promised, and rises
// where a step has to be shortened. Forty iterates in a row below a residual of 1e-6 that better neither
// the energy, beyond its round-off, nor the residual by a tenth end it as stalled, with a remark that says
// so. Of the options: globalisation, factorisation.
std::unique_ptr<Solver> make_newton(const SolverOptions& options = {});

}  // namespace coapt
