#include "results/detail/orifice_film.hpp"

#include <Eigen/SparseCholesky>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace coapt {
namespace {

constexpr int kMostSolves = 20;
constexpr double kMostNodes =
    20000;  // of a film; every second, third ... node of the view where there are more
constexpr double kSameArea = 1e-4;  // relative change of the area below which the film stays

// Nodes of one film and their neighbours, in numbers of their own; -1 - k is the k-th height of the rim.
// Beside what has no height, at the annulus, the film is free: the node is its own neighbour.
class Film {
 public:
  Film(const TopView& view, const std::vector<double>& height, const std::vector<int>& nodes) {
    const int stride = static_cast<int>(std::ceil(std::sqrt(static_cast<double>(nodes.size()) / kMostNodes)));
    cell_ = stride * view.cell;
    std::vector<int> number(static_cast<size_t>(view.node_count()), -1), places;
    for (const int node : nodes) {
      const int i = node % view.columns, j = node / view.columns;
      if (i % stride > 0 || j % stride > 0) continue;
      number[static_cast<size_t>(node)] = static_cast<int>(places.size());
      places.push_back(node);
    }
    double sum = 0;
    for (const int node : places) {
      const int i = node % view.columns, j = node / view.columns;
      const auto beside = [&](bool is_there, int next) {
        const int known = is_there ? number[static_cast<size_t>(next)] : -1;
        if (known >= 0) return known;
        if (!is_there || !std::isfinite(height[static_cast<size_t>(next)]))
          return number[static_cast<size_t>(node)];
        rim_.push_back(height[static_cast<size_t>(next)]);
        sum += rim_.back();
        return -static_cast<int>(rim_.size());
      };
      neighbours_.push_back({beside(i >= stride, node - stride),
                             beside(i + stride < view.columns, node + stride),
                             beside(j >= stride, node - stride * view.columns),
                             beside(j + stride < view.rows, node + stride * view.columns)});
    }
    u_ = Vector::Constant(static_cast<Eigen::Index>(places.size()),
                          rim_.empty() ? 0 : sum / static_cast<double>(rim_.size()));
    share_ = static_cast<double>(nodes.size()) / static_cast<double>(std::max<size_t>(1, places.size())) *
             view.cell * view.cell;
  }

  double least_area() {
    double area = kInfinity;
    Vector weights = Vector::Ones(u_.size());
    for (int solve = 0; solve < kMostSolves; ++solve) {
      relax(weights);
      weights = slopes();
      const double last = area;
      area = weights.sum() * share_;
      if (std::abs(area - last) <= kSameArea * area) break;
      weights = weights.cwiseInverse();
    }
    return area;
  }

 private:
  double height(int number) const { return number < 0 ? rim_[static_cast<size_t>(-1 - number)] : u_[number]; }

  // sqrt(1 + |grad u|^2) at each node.
  Vector slopes() const {
    Vector result(u_.size());
    for (Eigen::Index k = 0; k < u_.size(); ++k) {
      const std::array<int, 4>& n = neighbours_[static_cast<size_t>(k)];
      result[k] = std::hypot(1.0, (height(n[1]) - height(n[0])) / (2 * cell_),
                             (height(n[3]) - height(n[2])) / (2 * cell_));
    }
    return result;
  }

  // Each node at the mean of its neighbours, by the weights of the steps to them.
  void relax(const Vector& weights) {
    std::vector<Eigen::Triplet<double>> entries;
    Vector right = Vector::Zero(u_.size());
    for (int k = 0; k < u_.size(); ++k) {
      double diagonal = 0;
      for (const int next : neighbours_[static_cast<size_t>(k)]) {
        if (next == k) continue;
        const double weight = next < 0 ? weights[k] : 0.5 * (weights[k] + weights[next]);
        diagonal += weight;
        if (next < 0)
          right[k] += weight * height(next);
        else if (next < k)
          entries.emplace_back(k, next, -weight);
      }
      entries.emplace_back(k, k, diagonal);
    }
    Eigen::SparseMatrix<double> matrix(u_.size(), u_.size());
    matrix.setFromTriplets(entries.begin(), entries.end());
    Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(matrix);
    if (factor.info() == Eigen::Success) u_ = factor.solve(right);
  }

  double cell_ = 0, share_ = 0;  // spacing [length], and the part of the area of each node [length^2]
  std::vector<std::array<int, 4>> neighbours_;  // before and after along the row, then along the column
  std::vector<double> rim_;
  Vector u_;  // heights
};

}  // namespace

double film_area(const TopView& view, const std::vector<double>& height, const std::vector<int>& nodes) {
  if (nodes.empty()) return 0;
  return Film(view, height, nodes).least_area();
}

}  // namespace coapt
