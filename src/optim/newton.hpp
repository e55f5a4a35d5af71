// Newton's method on the exact Hessian, made safe by shifts of its diagonal.
#pragma once

#include "optim/factorisation.hpp"
#include "optim/solver.hpp"

namespace coapt {

struct NewtonOptions {
  FactorisationFactory factorisation = make_eigen_factorisation;
};

std::unique_ptr<Solver> make_newton(const NewtonOptions& options = {});

}  // namespace coapt
