#include "linear/node_ordering.hpp"
#include "linear/permuted_matrix.hpp"
#include "linear/pivots.hpp"

#include <Eigen/SparseCholesky>

#include <cmath>
#include <string_view>

namespace coapt {
namespace {

// factorise() of the base class would first make, and throw away, an array as long as the matrix.
class Cholesky final : public Eigen::SimplicialLLT<SparseMatrix, Eigen::Upper, Eigen::NaturalOrdering<int>> {
 public:
  bool refactorise(const SparseMatrix& upper) {
    this->template factorize_preordered<false>(upper);
    return info() == Eigen::Success;
  }
  // Each column starts with its diagonal entry.
  double diagonal(int column) const { return m_matrix.valuePtr()[m_matrix.outerIndexPtr()[column]]; }
  void solve_in_place(Vector& x) const {
    matrixL().solveInPlace(x);
    matrixU().solveInPlace(x);
  }
};

class EigenFactorisation final : public Factorisation {
 public:
  std::string_view name() const override { return "eigen"; }

  void analyse(const SparseMatrix& lower) override {
    const NodeGraph graph = node_graph(lower);
    permuted_ = PermutedMatrix(graph, minimum_degree_order(graph), Triangle::Upper);
    cholesky_.analyzePattern(permuted_.matrix());
  }

  bool factorise(const SparseMatrix& lower) override {
    permuted_.take_values(lower);
    if (!cholesky_.refactorise(permuted_.matrix())) return false;
    double least = kInfinity, greatest = 0;
    for (int column = 0; column < lower.cols(); ++column) {
      const double pivot = cholesky_.diagonal(column);
      if (!std::isfinite(pivot)) return false;
      least = std::min(least, pivot);
      greatest = std::max(greatest, pivot);
    }
    pivot_ratio_ = lower.cols() == 0 ? 1 : (least / greatest) * (least / greatest);
    return true;
  }

  void solve(const Vector& b, Vector& x) override {
    permuted_.permute(b, work_);
    cholesky_.solve_in_place(work_);
    permuted_.restore(work_, x);
  }

  double pivot_ratio() const override { return pivot_ratio_; }

  Inertia inertia(const SparseMatrix& lower) override {
    permuted_.take_values(lower);
    return inertia_of(permuted_);
  }

 private:
  PermutedMatrix permuted_;
  Cholesky cholesky_;
  Vector work_;
  double pivot_ratio_ = 0;
};

}  // namespace

std::unique_ptr<Factorisation> make_eigen_factorisation() { return std::make_unique<EigenFactorisation>(); }

}  // namespace coapt
