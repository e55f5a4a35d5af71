#include "linear/lowest_eigenvalues.hpp"

#include "linear/inverse_tangent.hpp"
#include "linear/krylov_basis.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numeric>
#include <utility>
#include <vector>

namespace coapt {
namespace {

constexpr double kChange = 0.05;   // of F, relative
constexpr int kTimes = 2;          // in a row that nothing may change
constexpr int kMostVectors = 600;  // of the Krylov space
// Imaginary parts at which F is looked at: zero, and from the first on, in magnitudes of the lowest
// eigenvalue of K, in this ratio up to the greatest of the projection; and those of its eigenvalues near the
// line.
constexpr double kFirstFrequency = 0.1, kRatio = 3;

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

  // False where the block adds nothing: the space is mapped to itself.
  bool append(const Eigen::MatrixXd& block) {
    const Eigen::Index before = count(), added = basis_.append(block);
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

  // Empty where they could not be found.
  Eigen::VectorXcd values() const {
    const Eigen::EigenSolver<Eigen::MatrixXd> solver(matrix_, false);
    return solver.info() == Eigen::Success ? solver.eigenvalues() : Eigen::VectorXcd();
  }

  // Those with real parts up to `most`, one at least.
  LowestEigenvalues eigenvalues(double most) const {
    const Eigen::EigenSolver<Eigen::MatrixXd> solver(matrix_);
    if (solver.info() != Eigen::Success) return {};
    const Eigen::VectorXcd& values = solver.eigenvalues();
    std::vector<Eigen::Index> order = by_real_part(values);
    while (order.size() > 1 && values[order.back()].real() > most) order.pop_back();
    return {true, values(order), basis_.vectors() * solver.eigenvectors()(Eigen::all, order),
            static_cast<int>(count())};
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

// What is looked at of a projection.
struct Look {
  Eigen::Index size = 0;
  Eigen::VectorXcd values;

  double lowest() const { return values.real().minCoeff(); }
  Eigen::Index count_below(double value) const { return (values.real().array() < value).count(); }
};

std::vector<double> frequencies(const Look& before, const Look& now, double magnitude) {
  std::vector<double> chosen{0};
  const double greatest = std::max(now.values.imag().maxCoeff(), magnitude);
  for (double next = kFirstFrequency * magnitude; next < kRatio * greatest; next *= kRatio)
    chosen.push_back(next);
  for (const Look* look : {&before, &now})
    for (const std::complex<double> value : look->values)
      if (value.imag() > 0 && value.real() < magnitude) chosen.push_back(value.imag());
  return chosen;
}

// Whether the last blocks changed nothing that matters; false for NaN.
bool is_unchanged(const ProjectedTangent& space, const Look& before, const Look& now, double zero,
                  double magnitude) {
  if (before.values.size() == 0 || now.values.size() == 0) return false;
  if (!(std::abs(now.lowest() - before.lowest()) <= zero)) return false;
  if (now.count_below(-zero) != before.count_below(-zero)) return false;
  const std::vector<double> chosen = frequencies(before, now, magnitude);
  return std::all_of(chosen.begin(), chosen.end(), [&](double frequency) {
    return space.change(before.size, {-zero, frequency}) <= kChange;
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
  return {true, solver.eigenvalues()(order), solver.eigenvectors()(Eigen::all, order), 0};
}

LowestEigenvalues lowest_eigenvalues(const SparseMatrix& lower, const SkewProduct& skew, const Vector& start,
                                     const LowestModes& modes, double zero,
                                     const std::shared_ptr<ThreadTeam>& team) {
  InverseTangent inverse(lower, skew, start, modes.shift, team);
  if (!inverse.is_made()) return {};
  ProjectedTangent space(lower, skew, modes.vectors);
  const double magnitude = std::abs(modes.values[0]);
  Look before;
  int unchanged = 0;
  while (unchanged < kTimes && space.count() < kMostVectors) {
    const Eigen::Index last = space.count();
    bool grows = true;
    while (grows && (space.count() == last || space.count() < last + last / 10)) {  // a look costs its cube
      const Eigen::MatrixXd block = inverse.times(space.last());
      if (!block.allFinite()) return {};
      grows = space.append(block);
    }
    if (!grows) return space.eigenvalues(zero);  // the space is mapped to itself
    Look now{space.count(), space.values()};
    unchanged = is_unchanged(space, before, now, zero, magnitude) ? unchanged + 1 : 0;
    before = std::move(now);
  }
  return unchanged < kTimes ? LowestEigenvalues{} : space.eigenvalues(zero);
}

}  // namespace coapt
