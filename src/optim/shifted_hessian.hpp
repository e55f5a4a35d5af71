// The Hessian of an objective, shifted until it is positive definite, and its factor.
#pragma once

#include "linear/factorisation.hpp"
#include "optim/monitor.hpp"

#include <vector>

namespace coapt {

class ShiftedHessian {
 public:
  // weights: of the unknowns in the shift, such as masses; null: all 1. They must outlive the Hessian.
  explicit ShiftedHessian(const FactorisationFactory& make, const Vector* weights = nullptr)
      : factor_(make()), weights_(weights) {}

  // Evaluates the Hessian at q and factorises it with `shift` times the weights [force/length] added to its
  // diagonal: the exact one if that is positive definite, else that of projected elements with a shift that
  // is raised until it is one. g: gradient at q. Returns false when no shift helps: the Hessian is not
  // finite, or a term cannot be evaluated with it. tries_exact: false leaves the exact one out.
  bool factorise(Objective& objective, Monitor& monitor, const Vector& q, Vector& g, double& shift,
                 bool tries_exact = true);

  // The same Hessian with a greater shift.
  bool raise(Monitor& monitor, double& shift);

  // x = (K + shift)^-1 b. Pre: the last factorisation succeeded.
  void solve(const Vector& b, Vector& x) { factor_->solve(b, x); }

  // Lower triangle, as it was factorised last.
  const SparseMatrix& matrix() const { return h_; }

  bool is_exact() const { return is_exact_; }

  // product += K v with the exact Hessian of the last evaluation, unshifted.
  // Pre: it was tried, and !is_exact().
  void add_exact_product(const Vector& v, Vector& product) const;

 private:
  void analyse(Monitor& monitor);
  bool factorise_shifted(Monitor& monitor, double shift);
  void keep_diagonal();
  void keep_exact();

  std::unique_ptr<Factorisation> factor_;
  const Vector* weights_;
  SparseMatrix h_;
  Vector exact_;               // values of the exact Hessian, where it was not positive definite
  Vector unshifted_;           // the diagonal of the last evaluation
  std::vector<int> diagonal_;  // places of the diagonal among the values
  long pattern_version_ = -1;  // that was analysed
  double shift_ = 0;           // that the diagonal carries now
  double least_shift_ = 0;     // keeps what has no stiffness at all, such as slack chords' junctions
  bool is_exact_ = true;
};

}  // namespace coapt
