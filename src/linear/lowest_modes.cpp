#include "linear/lowest_modes.hpp"

#include "linear/krylov_basis.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace coapt {
namespace {

constexpr double kShift = 2;       // wanted, in magnitudes of the lowest eigenvalue
constexpr double kFarther = 1.5;   // than wanted: a shift that is replaced
constexpr double kSteady = 0.1;    // change of the lowest eigenvalue, relative, that lets it be judged
constexpr int kLooks = 8;          // vectors, or a tenth of those before, between two looks
constexpr int kMostLanczos = 600;  // vectors of the Krylov space
constexpr int kMostModes = 200;    // that are looked for
constexpr int kBeyond = 2;         // modes kept beyond those below zero
constexpr double kRest = 0.5;      // of zero: what the other directions may be lower by
constexpr std::array kNudges = {1.0, 1.37, 0.71};  // a pivot that vanishes is an accident of the value

SparseMatrix shifted(const SparseMatrix& lower, double shift) {
  SparseMatrix matrix = lower;
  matrix.diagonal().array() += shift;
  return matrix;
}

Eigen::MatrixXd inverse_times(const Eigen::MatrixXd& block, Factorisation& factor) {
  Eigen::MatrixXd result(block.rows(), block.cols());
  Vector b, x;
  for (Eigen::Index k = 0; k < block.cols(); ++k) {
    b = block.col(k);
    factor.solve(b, x);
    result.col(k) = x;
  }
  return result;
}

// Others than those from which `number` vectors came, which span all that they lead to; scaled node by node,
// so that what rests stays at rest.
Eigen::MatrixXd other_starts(const Eigen::MatrixXd& starts, Eigen::Index number) {
  Eigen::MatrixXd others = starts;
  for (Eigen::Index k = 0; k < others.rows(); ++k) {
    const Eigen::Index node = k / 3;
    others.row(k) *= std::sin(0.3 * static_cast<double>(node) * static_cast<double>(number + node));
  }
  return others;
}

// The matrix on a Krylov space.
class ProjectedMatrix {
 public:
  explicit ProjectedMatrix(const SparseMatrix& lower) : lower_(lower), basis_(lower.cols()) {}

  Eigen::Index count() const { return basis_.count(); }
  auto last() const { return basis_.last(); }

  // False where the block adds nothing.
  bool append(const Eigen::MatrixXd& block) {
    const Eigen::Index before = count(), added = basis_.append(block);
    if (added == 0) return false;
    const Eigen::MatrixXd images = lower_.selfadjointView<Eigen::Lower>() * basis_.last();
    matrix_.conservativeResize(count(), count());
    matrix_.rightCols(added).noalias() = basis_.vectors().transpose() * images;
    matrix_.bottomLeftCorner(added, before) = matrix_.topRightCorner(before, added).transpose();
    return true;
  }

  void solve() { solver_.compute(matrix_); }
  const Eigen::VectorXd& values() const { return solver_.eigenvalues(); }
  Eigen::MatrixXd vectors(Eigen::Index wanted) const {
    return basis_.vectors() * solver_.eigenvectors().leftCols(wanted);
  }

  // By how much the matrix may be below `value` on what is orthogonal to the first `found` vectors v, which
  // are all that its inertia says lie below: in the basis of these and the others it is [T, R^T; R, D], T
  // below the value, so that by Sylvester's law D - value - R (T - value)^-1 R^T has no negative eigenvalue.
  double uncertainty(Eigen::Index found, double value) const {
    const Eigen::MatrixXd v = vectors(found);
    const Eigen::MatrixXd residuals =
        lower_.selfadjointView<Eigen::Lower>() * v - v * values().head(found).asDiagonal();
    const Eigen::ArrayXd gaps = value - values().head(found).array();
    return (residuals.colwise().squaredNorm().transpose().array() / gaps).sum();
  }

 private:
  const SparseMatrix& lower_;
  KrylovBasis basis_;
  Eigen::MatrixXd matrix_;
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver_;
};

struct Counted {
  double value;  // near the one that was asked for
  int number;    // of eigenvalues below it
};

std::optional<Counted> count_below(double value, const SparseMatrix& lower, Factorisation& factor,
                                   LowestModes& modes) {
  for (const double nudge : kNudges) {
    ++modes.factorisations;
    const Inertia inertia = factor.inertia(shifted(lower, -nudge * value));
    if (inertia.zero == 0) return Counted{nudge * value, inertia.negative};
  }
  return std::nullopt;
}

// Replaces a shift that is much farther than wanted, as nearer ones tell modes apart sooner. False where
// there is no factor afterwards.
bool approach(double wanted, const SparseMatrix& lower, Factorisation& factor, LowestModes& modes) {
  if (modes.shift <= kFarther * wanted) return true;
  ++modes.factorisations;
  if (factor.factorise(shifted(lower, wanted))) {
    modes.shift = wanted;
    return true;
  }
  ++modes.factorisations;
  return factor.factorise(shifted(lower, modes.shift));
}

}  // namespace

LowestModes lowest_modes(const SparseMatrix& lower, double zero, double shift, const Eigen::MatrixXd& starts,
                         Factorisation& factor) {
  LowestModes modes;
  modes.shift = shift;
  const std::optional<Counted> counted = count_below(zero, lower, factor, modes);
  if (!counted || counted->number > kMostModes) return modes;
  ++modes.factorisations;
  if (!factor.factorise(shifted(lower, shift))) return modes;

  ProjectedMatrix space(lower);
  space.append(starts);
  bool is_near = false;
  double last = kInfinity;
  for (Eigen::Index next = kLooks; space.count() < kMostLanczos;
       next = space.count() + std::max<Eigen::Index>(kLooks, space.count() / 10)) {
    bool grows = true;
    while (grows && space.count() < next) grows = space.append(inverse_times(space.last(), factor));
    space.solve();
    const double lowest = space.values()[0];
    if (!is_near && lowest < 0 && std::abs(lowest - last) < kSteady * std::abs(lowest)) {
      is_near = true;
      if (!approach(-kShift * lowest, lower, factor, modes)) return modes;
    }
    last = lowest;
    const Eigen::Index found = (space.values().array() < counted->value).count();
    if (found > counted->number) return modes;  // pivots that are all but zero have miscounted
    if (found < counted->number || !(space.uncertainty(found, counted->value) <= kRest * zero)) {
      if (!grows && !space.append(other_starts(starts, space.count()))) break;
      continue;
    }
    const Eigen::Index kept = std::min<Eigen::Index>(found + kBeyond, space.count());
    modes.values = space.values().head(kept);
    modes.vectors = space.vectors(kept);
    modes.shift = std::min(modes.shift, -kShift * modes.values[0]);
    modes.krylov_vectors = static_cast<int>(space.count());
    modes.is_complete = true;
    return modes;
  }
  return modes;
}

}  // namespace coapt
