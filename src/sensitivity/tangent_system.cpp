#include "sensitivity/tangent_system.hpp"

#include "linear/skew_part.hpp"

#include <algorithm>
#include <cmath>

namespace coapt {
namespace {

constexpr double kLeastShift = 1e-11;  // of the mean of the diagonal: holds what has no stiffness at all
constexpr double kMostShift = 1e-3;    // beyond it there is no factor
constexpr int kRefinements = 8;        // of a solution by GMRES
constexpr double kInner = 0.1;         // of the tolerance, which GMRES is asked for behind the factor
constexpr double kLeastInner = 3e-12;  // below it GMRES loses its residual to round-off

void shift_diagonal(SparseMatrix& h, double shift) {
  for (int c = 0; c < h.outerSize(); ++c)
    for (SparseMatrix::InnerIterator entry(h, c); entry; ++entry)
      if (entry.row() == c) entry.valueRef() += shift;
}

void set_diagonal(SparseMatrix& h, const Vector& diagonal) {
  for (int c = 0; c < h.outerSize(); ++c)
    for (SparseMatrix::InnerIterator entry(h, c); entry; ++entry)
      if (entry.row() == c) entry.valueRef() = diagonal[c];
}

}  // namespace

bool TangentSystem::assemble(Objective& objective, const Vector& q, Vector& g) {
  if (objective_ != &objective) has_factor_ = false;
  is_fresh_ = false;
  objective_ = &objective;
  const double energy = objective.hessian(q, g, h_, Projection::None);
  return std::isfinite(energy) && g.allFinite() && std::isfinite(h_.sum());
}

double TangentSystem::mean_stiffness() const { return h_.rows() == 0 ? 1 : h_.diagonal().cwiseAbs().mean(); }

bool TangentSystem::factorise_definite() {
  if (objective_->pattern_version() != analysed_) {
    factor_->analyse(h_);
    analysed_ = objective_->pattern_version();
  }
  const Vector diagonal = h_.diagonal();
  shift_diagonal(h_, kLeastShift * mean_stiffness());
  negative_modes_ = 0;
  is_bordered_ = false;
  has_factor_ = factor_->factorise(h_);
  set_diagonal(h_, diagonal);
  return has_factor_;
}

bool TangentSystem::factorise_exactly() {
  is_fresh_ = true;
  return factorise_bordered() || factorise_definite();
}

bool TangentSystem::factorise(Objective& objective, const Vector& q) {
  if (factorise_exactly()) return true;
  const double mean = mean_stiffness();
  SparseMatrix shifted = h_;
  shift_diagonal(shifted, kLeastShift * mean);
  const std::unique_ptr<Factorisation> counter = make_();
  counter->analyse(shifted);
  negative_modes_ = counter->inertia(shifted).negative;
  Vector g;
  shifted = h_;
  const double energy = objective.hessian(q, g, shifted, Projection::PositiveSemidefinite);
  if (!std::isfinite(energy)) return false;
  for (double shift = kLeastShift; shift <= kMostShift && !has_factor_; shift *= 100) {
    shift_diagonal(shifted, shift * mean);
    has_factor_ = factor_->factorise(shifted);
  }
  return has_factor_;
}

// What W couples last: the negative eigenvalues of H at a stable equilibrium lie there too.
bool TangentSystem::factorise_bordered() {
  if (!objective_->has_skew_tangent()) return false;
  const SkewProduct skew = [this](const Vector& v, Vector& product) {
    objective_->add_skew_product(v, product);
  };
  std::vector<int> border = coupled_nodes(skew, Vector::LinSpaced(h_.rows(), 1, 2));
  if (border.size() > kMostBorder) return false;
  if (objective_->pattern_version() != bordered_analysed_ || border != border_) {
    border_ = std::move(border);
    bordered_.use_threads(factor_->team());
    bordered_.analyse(h_, border_);
    bordered_analysed_ = objective_->pattern_version();
  }
  const Vector diagonal = h_.diagonal();
  shift_diagonal(h_, kLeastShift * mean_stiffness());
  has_factor_ = bordered_.factorise(h_, skew_entries(skew, border_, h_.rows()));
  set_diagonal(h_, diagonal);
  if (has_factor_) negative_modes_ = bordered_.negative_eigenvalues();
  has_factor_ = is_bordered_ = has_factor_ && negative_modes_ >= 0;
  return has_factor_;
}

void TangentSystem::apply_factor(const Vector& b, Vector& x, double skew_sign) {
  if (!is_bordered_)
    factor_->solve(b, x);
  else if (skew_sign > 0)
    bordered_.solve(b, x);
  else
    bordered_.solve_transposed(b, x);
}

void TangentSystem::multiply(const Vector& v, double skew_sign, Vector& product) {
  product.noalias() = h_.selfadjointView<Eigen::Lower>() * v;
  if (!objective_->has_skew_tangent()) return;
  skew_.setZero(v.size());
  objective_->add_skew_product(v, skew_);
  product += skew_sign * skew_;
}

double TangentSystem::solve(const Vector& b, Vector& x, double tolerance, double skew_sign, int most) {
  x = Vector::Zero(b.size());
  applications_ = 0;
  const double size = b.norm();
  if (size == 0) return 0;
  left_ = b;
  double residual = 1;
  for (int k = 0; k < kRefinements && residual > tolerance && applications_ < most; ++k) {
    apply_factor(left_, start_, skew_sign);
    applications_ += 1 + gmres_.solve(
                             [&](const Vector& v, Vector& out) {
                               multiply(v, skew_sign, work_);
                               apply_factor(work_, out, skew_sign);
                               out -= v;
                             },
                             start_, std::max(kInner * tolerance / residual, kLeastInner), correction_,
                             most - applications_ - 1);
    x += correction_;
    multiply(x, skew_sign, work_);
    left_ = b - work_;
    const double now = left_.norm() / size;
    if (!(now < 0.5 * residual)) return std::min(now, residual);
    residual = now;
  }
  return residual;
}

}  // namespace coapt
