#include "optim/harmonic_extension.hpp"

#include "energy/contact_barrier.hpp"

#include <Eigen/Geometry>
#include <Eigen/SparseCholesky>

#include <algorithm>
#include <array>
#include <vector>

namespace coapt {
namespace {

using Laplacian = Eigen::SparseMatrix<double>;
using LaplacianFactor = Eigen::SimplicialLDLT<Laplacian>;

constexpr double kLeastCotangent = 1e-3;  // obtuse and degenerate triangles: weights stay positive
constexpr double kMostCotangent = 1e9;    // slivers are carried along whole, as far as the factor is exact
constexpr double kContactWeight = 100;    // of a pair in contact beside those of edges, which are about 1

struct WeightedEdge {
  int a, b;
  double weight;
};

// What is kept small: differences along edges, and changes of the vector between two features in contact,
// each a weighted sum of displacements.
struct Couplings {
  std::vector<WeightedEdge> edges;
  std::vector<BarrierContact> contacts;

  // visit(nodes, weights, count, stiffness)
  template <class Visit>
  void for_each(const Visit& visit) const {
    const std::array difference = {1.0, -1.0};
    for (const WeightedEdge& edge : edges)
      visit(std::array{edge.a, edge.b}.data(), difference.data(), 2, edge.weight);
    for (const BarrierContact& contact : contacts)
      visit(contact.nodes.data(), contact.weights.data(), 4, kContactWeight);
  }
};

void add_elements(const Stencils& stencils, const Points& x, std::vector<WeightedEdge>& edges) {
  const std::vector<int>& nodes = stencils.nodes;
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

// Of a prescribed feature with a free one: a sheet goes along with the obstacle that is pressed into it.
void add_contacts(const EnergyTerm& term, const FixedMask& fixed, const Points& x,
                  std::vector<BarrierContact>& contacts) {
  for (const BarrierContact& contact : barrier_contacts(term, x)) {
    const size_t first_count = contact.is_edge_edge ? 2 : 1;
    bool is_held[2] = {true, true};
    for (size_t a = 0; a < 4; ++a)
      if (!fixed.col(contact.nodes[a]).all()) is_held[a < first_count ? 0 : 1] = false;
    if (is_held[0] != is_held[1]) contacts.push_back(contact);
  }
}

Couplings couplings_at(const Objective& objective, const Points& x) {
  Couplings couplings;
  for (const auto& term : objective.terms())
    if (term->role() == TermRole::Internal)
      add_elements(term->stencils(), x, couplings.edges);
    else if (term->limits_steps())
      add_contacts(*term, objective.fixed(), x, couplings.contacts);
  return couplings;
}

// The matrix of the free nodes; row: the number of each, -1 for others.
Laplacian laplacian(const Couplings& couplings, const std::vector<int>& row, int free_count) {
  std::vector<Eigen::Triplet<double>> entries;
  couplings.for_each([&](const int* nodes, const double* weights, int count, double stiffness) {
    for (int i = 0; i < count; ++i)
      for (int j = 0; j < count; ++j) {
        const int a = row[static_cast<size_t>(nodes[i])], b = row[static_cast<size_t>(nodes[j])];
        if (b >= 0 && a >= b) entries.emplace_back(a, b, stiffness * weights[i] * weights[j]);
      }
  });
  // What hangs on nothing gets a weak hold, so that it stays.
  for (int k = 0; k < free_count; ++k) entries.emplace_back(k, k, 1e-9);
  Laplacian matrix(free_count, free_count);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

// What the displacements of prescribed nodes draw the free ones by.
Vector drawn(const Couplings& couplings, const std::vector<int>& row, Eigen::Index free_count,
             const Eigen::RowVectorXd& displacement) {
  Vector rhs = Vector::Zero(free_count);
  couplings.for_each([&](const int* nodes, const double* weights, int count, double stiffness) {
    for (int i = 0; i < count; ++i)
      for (int j = 0; j < count; ++j) {
        const int a = row[static_cast<size_t>(nodes[i])];
        if (a >= 0 && row[static_cast<size_t>(nodes[j])] < 0)
          rhs[a] -= stiffness * weights[i] * weights[j] * displacement[nodes[j]];
      }
  });
  return rhs;
}

}  // namespace

Vector extended_harmonically(const Objective& objective, const Vector& q, const Points& x) {
  const Points from = objective.positions(q);
  const int n = objective.node_count();
  Points displacement = objective.fixed().select(x - from, Points::Zero(3, n));
  const Couplings couplings = couplings_at(objective, from);
  std::vector<int> row;
  LaplacianFactor factor;
  for (int c = 0; c < 3; ++c) {
    if (displacement.row(c).isZero(0)) continue;
    int free_count = 0;
    std::vector<int> free_row(static_cast<size_t>(n), -1);
    for (int node = 0; node < n; ++node)
      if (!objective.fixed()(c, node)) free_row[static_cast<size_t>(node)] = free_count++;
    if (free_row != row) {
      row = free_row;
      factor.compute(laplacian(couplings, row, free_count));
    }
    const Vector rhs = drawn(couplings, row, factor.rows(), displacement.row(c));
    const Vector solution = factor.solve(rhs);
    for (int node = 0; node < n; ++node)
      if (row[static_cast<size_t>(node)] >= 0)
        displacement(c, node) = solution[row[static_cast<size_t>(node)]];
  }
  return q + objective.unknowns(displacement);
}

}  // namespace coapt
