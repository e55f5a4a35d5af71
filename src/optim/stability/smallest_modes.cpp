#include "optim/stability/smallest_modes.hpp"

#ifdef COAPT_HAS_SPECTRA
#include <Spectra/SymEigsShiftSolver.h>
#endif

#include <algorithm>
#include <cmath>

namespace coapt {

#ifdef COAPT_HAS_SPECTRA
namespace {

// What Spectra asks of the inverse of a shifted matrix.
class ShiftedInverse {
 public:
  using Scalar = double;

  explicit ShiftedInverse(Factorisation& factor, Eigen::Index size) : factor_(factor), size_(size) {}
  Eigen::Index rows() const { return size_; }
  Eigen::Index cols() const { return size_; }
  void set_shift(double) {}  // it is in the factor already
  void perform_op(const double* in, double* out) const {
    b_ = Eigen::Map<const Vector>(in, size_);
    factor_.solve(b_, x_);
    Eigen::Map<Vector>(out, size_) = x_;
  }

 private:
  Factorisation& factor_;
  Eigen::Index size_;
  mutable Vector b_, x_;
};

// Ones, alternating in sign with no symmetry of a mesh, and zero at unit rows: what starts at zero there
// stays so.
Vector start_vector(const SparseMatrix& lower) {
  Vector off_diagonal = Vector::Zero(lower.cols()), start(lower.cols());
  for (int column = 0; column < lower.cols(); ++column)
    for (SparseMatrix::InnerIterator entry(lower, column); entry; ++entry)
      if (entry.row() > column) {
        off_diagonal[column] += std::abs(entry.value());
        off_diagonal[entry.row()] += std::abs(entry.value());
      }
  const Vector diagonal = lower.diagonal();
  for (int k = 0; k < start.size(); ++k)
    start[k] = off_diagonal[k] == 0 && diagonal[k] == 1 ? 0 : 1 + 0.5 * std::sin(1.7 * k * k);
  return start;
}

}  // namespace

bool has_smallest_modes() { return true; }

std::optional<Modes> smallest_modes(const SparseMatrix& lower, int count, const FactorisationFactory& factory,
                                    double tolerance) {
  const auto size = static_cast<int>(lower.cols());
  const Vector start = start_vector(lower);
  const int free = static_cast<int>((start.array() != 0).count());
  count = std::min(count, free - 1);
  if (count < 1) return Modes{Vector(0), Eigen::MatrixXd(size, 0), 0, true};

  const double scale = lower.diagonal().cwiseAbs().maxCoeff();
  const auto factor = factory();
  factor->analyse(lower);
  Modes modes;
  SparseMatrix shifted = lower;
  // Just below zero is best for a minimum; a saddle needs to be lifted further.
  for (modes.shift = 1e-10 * scale;; modes.shift *= 10) {
    if (modes.shift > 100 * scale || !std::isfinite(scale)) return std::nullopt;
    shifted.diagonal() = lower.diagonal().array() + modes.shift;
    if (factor->factorise(shifted)) break;
  }

  ShiftedInverse inverse(*factor, size);
  const int subspace = std::min(free, std::max(2 * count + 1, 20));
  Spectra::SymEigsShiftSolver<ShiftedInverse> solver(inverse, count, subspace, -modes.shift);
  solver.init(start.data());
  solver.compute(Spectra::SortRule::LargestMagn, 1000, tolerance, Spectra::SortRule::SmallestAlge);
  modes.has_converged = solver.info() == Spectra::CompInfo::Successful;
  modes.values = solver.eigenvalues();
  modes.vectors = solver.eigenvectors();
  return modes;
}

#else

bool has_smallest_modes() { return false; }

std::optional<Modes> smallest_modes(const SparseMatrix&, int, const FactorisationFactory&, double) {
  return std::nullopt;
}

#endif

}  // namespace coapt
