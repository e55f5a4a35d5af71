#include "optim/shifted_hessian.hpp"

#include <algorithm>
#include <cmath>

namespace coapt {
namespace {

constexpr double kLeastShift = 1e-11;  // relative to the mean of the diagonal
constexpr double kMostShift = 1e12;    // times the first one: beyond it no factor is sought
constexpr double kRaise = 10;          // factor on a shift without a factor

}  // namespace

void ShiftedHessian::analyse(Monitor& monitor) {
  PhaseTimer timer(monitor.phases(), "analyse");
  factor_->analyse(h_);
  diagonal_.clear();
  const int* outer = h_.outerIndexPtr();
  const int* inner = h_.innerIndexPtr();
  for (int c = 0; c < static_cast<int>(h_.cols()); ++c)
    diagonal_.push_back(
        static_cast<int>(std::lower_bound(inner + outer[c], inner + outer[c + 1], c) - inner));
}

bool ShiftedHessian::factorise_shifted(Monitor& monitor, double shift) {
  PhaseTimer timer(monitor.phases(), "factorise");
  const double wanted = std::max(shift, least_shift_);
  for (size_t i = 0; i < diagonal_.size(); ++i)
    h_.valuePtr()[diagonal_[i]] += (wanted - shift_) * (weights_ ? (*weights_)[static_cast<int>(i)] : 1);
  shift_ = wanted;
  monitor.count_factorisation();
  return factor_->factorise(h_);
}

bool ShiftedHessian::factorise(Objective& objective, Monitor& monitor, const Vector& q, Vector& g,
                               double& shift, bool tries_exact) {
  for (const Projection projection : {Projection::None, Projection::PositiveSemidefinite}) {
    if (projection == Projection::None && !tries_exact) continue;
    if (!std::isfinite(monitor.hessian(q, g, h_, projection))) return false;
    is_exact_ = projection == Projection::None;
    if (objective.pattern_version() != pattern_version_) analyse(monitor);
    pattern_version_ = objective.pattern_version();
    double mean = 0;
    for (const int k : diagonal_) mean += h_.valuePtr()[k] / static_cast<double>(diagonal_.size());
    if (!std::isfinite(mean)) return false;
    shift_ = 0;
    least_shift_ = kLeastShift * std::abs(mean) / (weights_ ? weights_->mean() : 1);
    keep_diagonal();
    if (factorise_shifted(monitor, shift)) return true;
    if (is_exact_) keep_exact();
  }
  return raise(monitor, shift);
}

void ShiftedHessian::keep_diagonal() {
  unshifted_.resize(static_cast<Eigen::Index>(diagonal_.size()));
  for (size_t i = 0; i < diagonal_.size(); ++i) unshifted_[static_cast<int>(i)] = h_.valuePtr()[diagonal_[i]];
}

void ShiftedHessian::keep_exact() {
  exact_ = Eigen::Map<const Vector>(h_.valuePtr(), h_.nonZeros());
  for (size_t i = 0; i < diagonal_.size(); ++i) exact_[diagonal_[i]] = unshifted_[static_cast<int>(i)];
}

void ShiftedHessian::add_exact_product(const Vector& v, Vector& product) const {
  const Eigen::Map<const SparseMatrix> exact(h_.rows(), h_.cols(), h_.nonZeros(), h_.outerIndexPtr(),
                                             h_.innerIndexPtr(), exact_.data());
  product.noalias() += exact.selfadjointView<Eigen::Lower>() * v;
}

bool ShiftedHessian::raise(Monitor& monitor, double& shift) {
  const double most = kMostShift * std::max(least_shift_, shift);
  do {
    shift = kRaise * std::max(shift, least_shift_);
    if (factorise_shifted(monitor, shift)) return true;
  } while (shift < most && !monitor.is_out_of_time());
  return false;
}

}  // namespace coapt
