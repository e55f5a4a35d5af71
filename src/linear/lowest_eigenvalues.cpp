#include "linear/lowest_eigenvalues.hpp"

#include "core/bounded_int.hpp"
#include "linear/inverse_tangent.hpp"

#include <Eigen/Eigenvalues>

#ifdef COAPT_HAS_SPECTRA
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
constexpr int kFewest = 10, kMost = 160;         // eigenvalues that are asked for
constexpr int kSpare = 40;                       // vectors of the Krylov space beyond two for each of them
constexpr int kRestarts = 100;                   // of Arnoldi's method
constexpr double kMoreThanNeeded = 1.3;          // asked for, over what is expected

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
                          double magnitude, Factorisation& factor) {
  double least = kInfinity;
  SparseMatrix shifted = lower;
  for (const double multiple : kBoundShifts) {
    const double shift = multiple * magnitude;
    shifted.diagonal() = lower.diagonal().array() + shift;
    if (factor.factorise(shifted))
      least = std::min(least, kMargin * greatest_ratio(factor, skew, start) * shift);
  }
  return least;
}

// How many eigenvalues of the symmetric part lie below a value: about as many as of the tangent lie as near
// to the shift.
int count_below(const SparseMatrix& lower, double value, Factorisation& factor) {
  SparseMatrix shifted = lower;
  shifted.diagonal().array() -= value;
  return factor.inertia(shifted).negative;
}

// How many values to ask for where the `last` reach to `far` from the shift and not to `reach`, as if they
// lay evenly.
int more_values(int last, double shift, double far, double reach) {
  const double share = far > shift ? (reach - shift) / (far - shift) : kInfinity;
  return bounded_int(std::max(kMoreThanNeeded * share, 2.0) * last, 1, kMost);
}

}  // namespace

LowestEigenvalues lowest_eigenvalues(const SparseMatrix& lower, const SkewProduct& skew, const Vector& start,
                                     double least_value, double unstable, Factorisation& factor) {
  if (lower.cols() <= kMostDense) return all_eigenvalues(lower, skew, start);
  const double shift = kShift * std::abs(least_value);
  LowestEigenvalues found;
  found.factorisations = 2 + static_cast<int>(kBoundShifts.size());
  const double reach =
      std::hypot(shift, greatest_imaginary(lower, skew, start, std::abs(least_value), factor));
  if (!std::isfinite(reach)) return found;
  InverseTangent inverse(lower, skew, start, shift, factor.team());
  if (!inverse.is_made()) return found;

  const auto free = static_cast<int>((start.array() != 0).count());
  const int expected = count_below(lower, reach - shift, factor);
  for (int wanted = bounded_int(kMoreThanNeeded * expected, kFewest, kMost);;) {
    const int subspace = std::min(free, 2 * wanted + kSpare);
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
                                     double, double, Factorisation&) {
  if (lower.cols() <= kMostDense) return all_eigenvalues(lower, skew, start);
  return {};
}

#endif

}  // namespace coapt
