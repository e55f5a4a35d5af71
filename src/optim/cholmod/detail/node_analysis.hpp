// Symbolic factorisation on the graph of nodes, a ninth of the matrix, carried over to the unknowns.
#pragma once

#include "linear/permuted_matrix.hpp"

#include <cholmod.h>
#include <vector>

namespace coapt::detail {

// The lower triangle of a square matrix in compressed, sorted columns, as CHOLMOD sees it; nothing is copied.
// values: null for a pattern. CHOLMOD does not write into a matrix that it analyses or factorises.
cholmod_sparse lower_view(size_t size, size_t entries, const int* start, const int* row,
                          const double* values);

// ordering: CHOLMOD's method; with CHOLMOD_GIVEN that of `order`.
// order: to be filled with the node that comes k-th; postordered, so that supernodes are contiguous.
// Returns a supernodal factor without values for the matrix of unknowns in that order. Throws InputError if
// it has more entries than CHOLMOD's 32-bit indices can count.
cholmod_factor* analyse_nodes(NodeGraph& graph, int ordering, std::vector<int>& order,
                              cholmod_common& common);

}  // namespace coapt::detail
