#include "linear/node_ordering.hpp"

#include <Eigen/OrderingMethods>

#include <algorithm>
#include <csignal>

#ifdef COAPT_HAS_METIS
#include <metis.h>
#endif

namespace coapt {
namespace {

#ifdef COAPT_HAS_METIS
// Measured with CHOLMOD (decision 014): from here on nested dissection pays for itself within fifteen
// factorisations.
constexpr int kNestedDissectionFrom = 1000;  // nodes

std::vector<int> nested_dissection_order(const NodeGraph& graph) {
  const int count = graph.size();
  std::vector<idx_t> start(count + 1, 0);
  const auto visit_pairs = [&](const auto& visit) {
    for (int j = 0; j < count; ++j)
      for (int k = graph.start[j]; k < graph.start[j + 1]; ++k)
        if (graph.row[k] != j) visit(graph.row[k], j);
  };
  visit_pairs([&](int i, int j) {
    ++start[i + 1];
    ++start[j + 1];
  });
  for (int j = 0; j < count; ++j) start[j + 1] += start[j];
  std::vector<idx_t> next(start.begin(), start.end() - 1), neighbour(start.back()), order(count),
      place(count);
  visit_pairs([&](int i, int j) {
    neighbour[next[i]++] = j;
    neighbour[next[j]++] = i;
  });
  idx_t size = count, options[METIS_NOPTIONS];
  METIS_SetDefaultOptions(options);
  options[METIS_OPTION_NITER] = 1;  // more refinements take a fifth more time, for the same fill within 1 %
  // METIS catches SIGTERM meanwhile and then returns METIS_ERROR: it is sent again to whom it was meant for.
  const int status =
      METIS_NodeND(&size, start.data(), neighbour.data(), nullptr, options, order.data(), place.data());
  if (status == METIS_ERROR) std::raise(SIGTERM);
  if (status != METIS_OK) return minimum_degree_order(graph);
  return {order.begin(), order.end()};
}
#endif

}  // namespace

std::vector<int> minimum_degree_order(const NodeGraph& graph) {
  SparseMatrix pattern(graph.size(), graph.size());
  pattern.resizeNonZeros(static_cast<Eigen::Index>(graph.row.size()));
  std::copy(graph.start.begin(), graph.start.end(), pattern.outerIndexPtr());
  std::copy(graph.row.begin(), graph.row.end(), pattern.innerIndexPtr());
  std::fill_n(pattern.valuePtr(), pattern.nonZeros(), 1.0);
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> permutation;
  Eigen::AMDOrdering<int>()(pattern.selfadjointView<Eigen::Lower>(), permutation);
  return {permutation.indices().data(), permutation.indices().data() + permutation.size()};
}

std::vector<int> node_order(const NodeGraph& graph) {
#ifdef COAPT_HAS_METIS
  if (graph.size() >= kNestedDissectionFrom) return nested_dissection_order(graph);
#endif
  return minimum_degree_order(graph);
}

}  // namespace coapt
