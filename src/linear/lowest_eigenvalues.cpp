#include "linear/lowest_eigenvalues.hpp"

#include "linear/inverse_tangent.hpp"
#include "linear/krylov_basis.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace coapt {
namespace {

constexpr double kChange = 0.05;   // of F, relative
constexpr int kMostVectors = 600;  // of the Krylov space
// Imaginary parts at which F is looked at, in magnitudes of the lowest eigenvalue of K. Far beyond, F is
// -l but for what the space has at once.
constexpr std::array kFrequencies = {0.0, 0.1, 0.3, 1.0, 3.0, 10.0, 30.0, 100.0};

std::vector<Eigen::Index> by_real_part(const Eigen::VectorXcd& values) {
  std::vector<Eigen::Index> order(static_cast<size_t>(values.size()));
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](Eigen::Index a, Eigen::Index b) { return values[a].real() < values[b].real(); });
  return order;
}

// K + W on a Krylov space.
class ProjectedTangent {
 public:
  ProjectedTangent(const SparseMatrix& lower, const SkewProduct& skew, const Eigen::MatrixXd& starts)
      : lower_(lower), skew_(skew), basis_(lower.cols()) {
    append(starts);
    starts_ = basis_.count();
  }

  Eigen::Index count() const { return basis_.count(); }
  auto last() const { return basis_.last(); }
  const Eigen::MatrixXd& matrix() const { return matrix_; }

  // False where the block adds nothing: the space is mapped to itself.
  bool append(const Eigen::MatrixXd& block) {
    const Eigen::Index before = count();
    basis_.append(block);
    const Eigen::Index added = count() - before;
    if (added == 0) return false;
    const Eigen::MatrixXd symmetric = lower_.selfadjointView<Eigen::Lower>() * basis_.last();
    Eigen::MatrixXd skew(symmetric.rows(), added);
    Vector product(symmetric.rows());
    for (Eigen::Index k = 0; k < added; ++k) {
      product.setZero();
      skew_(basis_.last().col(k), product);
      skew.col(k) = product;
    }
    matrix_.conservativeResize(count(), count());
    matrix_.rightCols(added).noalias() = basis_.vectors().transpose() * (symmetric + skew);
    matrix_.bottomLeftCorner(added, before).noalias() =
        (symmetric - skew).transpose() * basis_.vectors().leftCols(before);
    return true;
  }

  Eigen::VectorXcd values() const { return matrix_.eigenvalues(); }

  // Those with real parts up to `most`, one at least.
  LowestEigenvalues eigenvalues(double most) const {
    const Eigen::EigenSolver<Eigen::MatrixXd> solver(matrix_);
    if (solver.info() != Eigen::Success) return {};
    const Eigen::VectorXcd values = solver.eigenvalues();
    std::vector<Eigen::Index> order = by_real_part(values);
    while (order.size() > 1 && values[order.back()].real() > most) order.pop_back();
    return {.values = values(order), .vectors = basis_.vectors() * solver.eigenvectors()(Eigen::all, order)};
  }

  // F(l) on the first `size` vectors: the Schur complement of the starts.
  Eigen::MatrixXcd response(Eigen::Index size, std::complex<double> l) const {
    Eigen::MatrixXcd shifted = matrix_.topLeftCorner(size, size).cast<std::complex<double>>();
    shifted.diagonal().array() -= l;
    const Eigen::Index rest = size - starts_;
    const Eigen::MatrixXcd follows =
        shifted.bottomRightCorner(rest, rest).partialPivLu().solve(shifted.bottomLeftCorner(rest, starts_));
    return shifted.topLeftCorner(starts_, starts_) - shifted.topRightCorner(starts_, rest) * follows;
  }

  // By how much F differs on all vectors from what it is on the first `size`.
  double change(Eigen::Index size, std::complex<double> l) const {
    const Eigen::MatrixXcd ratio = response(count(), l) * response(size, l).partialPivLu().inverse();
    return (ratio - Eigen::MatrixXcd::Identity(starts_, starts_)).norm();
  }

 private:
  const SparseMatrix& lower_;
  const SkewProduct& skew_;
  KrylovBasis basis_;
  Eigen::Index starts_ = 0;
  Eigen::MatrixXd matrix_;
};

bool has_settled(const ProjectedTangent& space, Eigen::Index before, double zero, double magnitude) {
  return std::all_of(kFrequencies.begin(), kFrequencies.end(), [&](double frequency) {
    return space.change(before, {-zero, frequency * magnitude}) <= kChange;  // false for NaN
  });
}

}  // namespace

LowestEigenvalues all_eigenvalues(const SparseMatrix& lower, const SkewProduct& skew, const Vector& start) {
  const Eigen::Index size = lower.cols();
  Eigen::MatrixXd tangent = Eigen::MatrixXd(lower).selfadjointView<Eigen::Lower>();
  Vector product(size);
  for (Eigen::Index k = 0; k < size; ++k) {
    if (start[k] == 0) continue;
    product.setZero();
    skew(Vector::Unit(size, k), product);
    tangent.col(k) += product;
  }
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(tangent);
  if (solver.info() != Eigen::Success) return {};
  const std::vector<Eigen::Index> order = by_real_part(solver.eigenvalues());
  return {true, solver.eigenvalues()(order), solver.eigenvectors()(Eigen::all, order)};
}

LowestEigenvalues lowest_eigenvalues(const SparseMatrix& lower, const SkewProduct& skew, const Vector& start,
                                     const LowestModes& modes, double zero,
                                     const std::shared_ptr<ThreadTeam>& team) {
  InverseTangent inverse(lower, skew, start, modes.shift, team);
  if (!inverse.is_made()) return {};
  ProjectedTangent space(lower, skew, modes.vectors);
  bool is_complete = false;
  double last = kInfinity;
  while (!is_complete && space.count() < kMostVectors) {
    const Eigen::Index before = space.count();
    if (!space.append(inverse.times(space.last()))) {
      is_complete = true;
      break;
    }
    const double lowest = space.values().real().minCoeff();
    is_complete =
        std::abs(lowest - last) <= zero && has_settled(space, before, zero, std::abs(modes.values[0]));
    last = lowest;
  }
  LowestEigenvalues found = space.eigenvalues(zero);
  found.is_complete = is_complete && found.values.size() > 0;
  return found;
}

}  // namespace coapt
