#include "optim/harmonic_extension.hpp"

#include <Eigen/Geometry>
#include <Eigen/SparseCholesky>

#include <algorithm>
#include <optional>
#include <vector>

namespace coapt {
namespace {

using Laplacian = Eigen::SparseMatrix<double>;
using LaplacianFactor = Eigen::SimplicialLDLT<Laplacian>;

constexpr double kLeastCotangent = 1e-3;  // obtuse and degenerate triangles: weights stay positive
constexpr double kMostCotangent = 1e9;    // slivers are carried along whole, as far as the factor is exact

struct WeightedEdge {
  int a, b;
  double weight;
};

std::vector<WeightedEdge> weighted_edges(const Objective& objective, const Points& x) {
  std::vector<WeightedEdge> edges;
  for (const auto& term : objective.terms()) {
    const Stencils& stencils = term->stencils();
    const std::vector<int>& nodes = stencils.nodes;
    if (term->role() != TermRole::Internal) continue;
    if (stencils.width == 3)
      for (size_t first = 0; first < nodes.size(); first += 3)
        for (size_t k = 0; k < 3; ++k) {
          const int apex = nodes[first + k], a = nodes[first + (k + 1) % 3], b = nodes[first + (k + 2) % 3];
          const Vec3 u = x.col(a) - x.col(apex), v = x.col(b) - x.col(apex);
          const double twice_area = u.cross(v).norm();
          const double cotangent = twice_area > 0 ? u.dot(v) / twice_area : kMostCotangent;
          edges.push_back({a, b, 0.5 * std::clamp(cotangent, kLeastCotangent, kMostCotangent)});
        }
    else if (stencils.width == 2)
      for (size_t first = 0; first < nodes.size(); first += 2)
        edges.push_back({nodes[first], nodes[first + 1], 1});
  }
  return edges;
}

}  // namespace

Vector extended_harmonically(const Objective& objective, const Vector& q, const Points& x) {
  const Points from = objective.positions(q);
  const int n = objective.node_count();
  Points displacement = objective.fixed().select(x - from, Points::Zero(3, n));
  const std::vector<WeightedEdge> edges = weighted_edges(objective, from);
  std::vector<int> row(static_cast<size_t>(n), -1);
  LaplacianFactor factor;
  for (int c = 0; c < 3; ++c) {
    const auto held = objective.fixed().row(c);
    if (displacement.row(c).isZero(0)) continue;
    const bool is_factored = c > 0 && factor.rows() > 0 && (held == objective.fixed().row(c - 1)).all();
    if (!is_factored) {
      int free_count = 0;
      for (int node = 0; node < n; ++node) row[static_cast<size_t>(node)] = held[node] ? -1 : free_count++;
      std::vector<Eigen::Triplet<double>> entries;
      for (const WeightedEdge& edge : edges) {
        const int a = row[static_cast<size_t>(edge.a)], b = row[static_cast<size_t>(edge.b)];
        if (a >= 0) entries.emplace_back(a, a, edge.weight);
        if (b >= 0) entries.emplace_back(b, b, edge.weight);
        if (a >= 0 && b >= 0) entries.emplace_back(std::max(a, b), std::min(a, b), -edge.weight);
      }
      // What hangs on nothing gets a weak hold, so that it stays.
      for (int k = 0; k < free_count; ++k) entries.emplace_back(k, k, 1e-9);
      Laplacian matrix(free_count, free_count);
      matrix.setFromTriplets(entries.begin(), entries.end());
      factor.compute(matrix);
    }
    Vector rhs = Vector::Zero(factor.rows());
    for (const WeightedEdge& edge : edges) {
      const int a = row[static_cast<size_t>(edge.a)], b = row[static_cast<size_t>(edge.b)];
      if (a >= 0 && b < 0) rhs[a] += edge.weight * displacement(c, edge.b);
      if (b >= 0 && a < 0) rhs[b] += edge.weight * displacement(c, edge.a);
    }
    const Vector solution = factor.solve(rhs);
    for (int node = 0; node < n; ++node)
      if (row[static_cast<size_t>(node)] >= 0)
        displacement(c, node) = solution[row[static_cast<size_t>(node)]];
  }
  return q + objective.unknowns(displacement);
}

}  // namespace coapt
