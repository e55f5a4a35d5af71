// Supernodal Cholesky factorisation by CHOLMOD of SuiteSparse on OpenBLAS. GPL-2.0-or-later when linked,
// hence a library of its own.
#pragma once

#include "linear/factorisation.hpp"

#include <string>

namespace coapt {

struct CholmodOptions {
  // Of the graph of nodes. Automatic: whichever is faster over a whole solve, by the number of nodes.
  enum class Ordering { Automatic, MinimumDegree, NestedDissection } ordering = Ordering::Automatic;

  // Threads of the dense kernels. With more than one the answers differ in their last bits. OpenBLAS knows
  // one number for the whole process: it is set for the length of a factorisation or solve and put back, so
  // that two at the same time should want the same number.
  int blas_threads = 1;
};

// After the first call for a pattern CHOLMOD still allocates, and frees, its update matrix in every
// factorisation; a solve allocates nothing.
std::unique_ptr<Factorisation> make_cholmod_factorisation(const CholmodOptions& options = {});

// File name of the shared library that the dense kernels of this process come from: OpenBLAS, unless the link
// order has put another BLAS in front (that of Debian's Ceres is 2.4 times slower).
std::string blas_library();

}  // namespace coapt
