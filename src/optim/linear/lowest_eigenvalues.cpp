#include "optim/linear/lowest_eigenvalues.hpp"

#include "core/bounded_int.hpp"

#include <Eigen/Eigenvalues>

#ifdef COAPT_HAS_SPECTRA
#include <Eigen/SparseLU>

#include <Spectra/GenEigsRealShiftSolver.h>
#endif

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <numeric>

namespace coapt {
namespace {

constexpr int kMostDense = 240;  // unknowns up to which all eigenvalues are found

LowestEigenvalues sorted(const Eigen::VectorXcd& values, const Eigen::MatrixXcd& vectors) {
  std::vector<Eigen::Index> order(static_cast<size_t>(values.size()));
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](Eigen::Index a, Eigen::Index b) { return values[a].real() < values[b].real(); });
  LowestEigenvalues found{.values = values, .vectors = vectors};
  for (size_t k = 0; k < order.size(); ++k) {
    found.values[static_cast<Eigen::Index>(k)] = values[order[k]];
    found.vectors.col(static_cast<Eigen::Index>(k)) = vectors.col(order[k]);
  }
  return found;
}

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
  LowestEigenvalues found = sorted(solver.eigenvalues(), solver.eigenvectors());
  found.is_complete = true;
  return found;
}

}  // namespace

#ifdef COAPT_HAS_SPECTRA
namespace {

constexpr double kShift = 10;  // times the magnitude of the lowest eigenvalue of the symmetric part
constexpr std::array kBoundShifts = {2.0, 4.0};  // likewise, at which imaginary parts are bounded
constexpr int kPowerSteps = 40;                  // towards the greatest imaginary part
constexpr double kMargin = 1.1;                  // on the imaginary part that they find
constexpr double kConverged = 1e-8;              // relative residual of an eigenpair
constexpr int kFirst = 20, kMost = 160;          // eigenvalues that are asked for
constexpr int kSubspace = 60;                    // vectors of the Krylov space, at least
constexpr int kRestarts = 100;                   // of Arnoldi's method
constexpr double kMoreThanNeeded = 1.3;          // asked for, over what the last search lets expect

// K + W + shift. W is not given by its entries: it is applied to each unknown that it couples.
SparseMatrix whole_tangent(const SparseMatrix& lower, const SkewProduct& skew, const Vector& start,
                           double shift) {
  const Eigen::Index size = lower.cols();
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(2 * static_cast<size_t>(lower.nonZeros()));
  for (int column = 0; column < size; ++column)
    for (SparseMatrix::InnerIterator entry(lower, column); entry; ++entry) {
      if (entry.row() < column) continue;
      const double added = entry.row() == column ? shift : 0;
      entries.emplace_back(entry.row(), column, entry.value() + added);
      if (entry.row() > column) entries.emplace_back(column, entry.row(), entry.value());
    }
  Vector coupled = Vector::Zero(size), unit = coupled, product(size);
  skew(start, coupled);
  for (int column = 0; column < size; ++column) {
    if (coupled[column] == 0) continue;
    unit[column] = 1;
    product.setZero();
    skew(unit, product);
    unit[column] = 0;
    for (int row = 0; row < size; ++row)
      if (product[row] != 0) entries.emplace_back(row, column, product[row]);
  }
  SparseMatrix whole(size, size);
  whole.setFromTriplets(entries.begin(), entries.end());
  return whole;
}

// Minimum degree on the pattern, which is symmetric: half the fill that an ordering of columns leaves.
struct SymmetricOrdering {
  template <class Matrix>
  void operator()(const Matrix& matrix,
                  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int>& order) {
    Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> inverse;
    Eigen::AMDOrdering<int>()(matrix, inverse);  // SparseLU wants the other direction
    order = inverse.inverse();
  }
};

// The inverse of a shifted tangent, as Spectra asks for it. Its symmetric part is positive definite, so that
// the diagonal gives the pivots.
class InverseTangent {
 public:
  using Scalar = double;

  explicit InverseTangent(const SparseMatrix& shifted) {
    factor_.isSymmetric(true);
    factor_.setPivotThreshold(0);
    factor_.compute(shifted);
  }
  bool is_made() const { return factor_.info() == Eigen::Success; }
  Eigen::Index rows() const { return factor_.rows(); }
  Eigen::Index cols() const { return factor_.cols(); }
  void set_shift(double) {}  // it is in the factor already
  void perform_op(const double* in, double* out) const {
    b_ = Eigen::Map<const Vector>(in, cols());
    Eigen::Map<Vector>(out, cols()) = factor_.solve(b_);
  }

 private:
  Eigen::SparseLU<SparseMatrix, SymmetricOrdering> factor_;
  mutable Vector b_;
};

// An estimate from below of the greatest |v^* W v| / (v^* M v), by the power method from v: M^-1 W is normal
// in the scalar product of M, which has been factorised.
double greatest_ratio(Factorisation& factor, const SkewProduct& skew, Vector v) {
  Vector image, force = v;
  double ratio = 0;
  for (int k = 0; k <= kPowerSteps; ++k) {
    factor.solve(force, image);
    ratio = std::sqrt(std::max(0.0, force.dot(image)));
    if (ratio == 0) return 0;
    v = image / ratio;
    force.setZero();
    skew(v, force);
  }
  return ratio;
}

// Of eigenvalues with a negative real part. Their vectors v, of length 1, have v^* K v < 0, so that s times
// the greatest |v^* W v| / (v^* (K + s) v) is a bound for every s that makes K + s positive definite: the
// least of some. Infinity where none of them does.
double greatest_imaginary(const SparseMatrix& lower, const SkewProduct& skew, const Vector& start,
                          double magnitude, const FactorisationFactory& factory) {
  double least = kInfinity;
  SparseMatrix shifted = lower;
  for (const double multiple : kBoundShifts) {
    const double shift = multiple * magnitude;
    shifted.diagonal() = lower.diagonal().array() + shift;
    const auto factor = factory();
    factor->analyse(shifted);
    if (factor->factorise(shifted))
      least = std::min(least, kMargin * greatest_ratio(*factor, skew, start) * shift);
  }
  return least;
}

// How many values to ask for where the `last` reach to `far` from the shift and not to `reach`, as if they
// lay evenly.
int more_values(int last, double shift, double far, double reach) {
  const double share = far > shift ? (reach - shift) / (far - shift) : kInfinity;
  return bounded_int(std::max(kMoreThanNeeded * share, 2.0) * last, 1, kMost);
}

}  // namespace

LowestEigenvalues lowest_eigenvalues(const SparseMatrix& lower, const SkewProduct& skew, const Vector& start,
                                     double least_value, double unstable,
                                     const FactorisationFactory& factory) {
  if (lower.cols() <= kMostDense) return all_eigenvalues(lower, skew, start);
  const double shift = kShift * std::abs(least_value);
  LowestEigenvalues found;
  found.factorisations = 1 + static_cast<int>(kBoundShifts.size());
  const double reach =
      std::hypot(shift, greatest_imaginary(lower, skew, start, std::abs(least_value), factory));
  if (!std::isfinite(reach)) return found;
  InverseTangent inverse(whole_tangent(lower, skew, start, shift));
  if (!inverse.is_made()) return found;

  const auto free = static_cast<int>((start.array() != 0).count());
  for (int wanted = kFirst;;) {
    const int subspace = std::min(free, std::max(2 * wanted + kFirst, kSubspace));
    if (wanted + 2 > subspace) break;
    Spectra::GenEigsRealShiftSolver<InverseTangent> solver(inverse, wanted, subspace, -shift);
    try {
      solver.init(start.data());
      solver.compute(Spectra::SortRule::LargestMagn, kRestarts, kConverged, Spectra::SortRule::SmallestReal);
    } catch (const std::exception&) {  // its dense eigenvalue method did not converge
      break;
    }
    LowestEigenvalues more = sorted(solver.eigenvalues(), solver.eigenvectors());
    more.factorisations = found.factorisations;
    found = std::move(more);
    if (solver.info() != Spectra::CompInfo::Successful) break;
    const double far = (found.values.array() + shift).abs().maxCoeff();
    found.is_complete = far > reach;
    if (found.is_complete || wanted == kMost || found.values[0].real() < unstable) break;
    wanted = more_values(wanted, shift, far, reach);
  }
  return found;
}

#else

LowestEigenvalues lowest_eigenvalues(const SparseMatrix& lower, const SkewProduct& skew, const Vector& start,
                                     double, double, const FactorisationFactory&) {
  if (lower.cols() <= kMostDense) return all_eigenvalues(lower, skew, start);
  return {};
}

#endif

}  // namespace coapt
