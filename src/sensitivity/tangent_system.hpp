// Linear systems with the exact tangent of an objective and with its transpose.
#pragma once

#include "energy/objective.hpp"
#include "linear/bordered_factor.hpp"
#include "linear/factorisation.hpp"
#include "linear/gmres.hpp"

#include <limits>
#include <vector>

namespace coapt {

// K = H + W, H the exact Hessian (symmetric part), W its skew rest from loads without a potential, which
// couples few nodes. Where H is positive definite but for these K is factorised, with these last; without
// such loads H by Cholesky where it is positive definite; else the sum of its projected elements. GMRES with
// that factor solves with K itself: also one of a state nearby will do.
class TangentSystem {
 public:
  static constexpr int kUnlimited = std::numeric_limits<int>::max();  // applications of the factor

  explicit TangentSystem(const FactorisationFactory& make) : make_(make), factor_(make()), gmres_(kVectors) {}

  // Evaluates K at q. g: gradient there. Returns false when it is not finite. Pre: an objective with loads
  // without a potential follows its path.
  bool assemble(Objective& objective, const Vector& q, Vector& g);

  // Makes a factor for the last K. Returns false when that fails. Evaluates projected elements where needed.
  bool factorise(Objective& objective, const Vector& q);

  // The same without projected elements, which cost a second assembly: returns false where it would take
  // them.
  bool factorise_exactly();

  // b by the inverse of the factor alone. Pre: has_factor().
  void apply_factor(const Vector& b, Vector& x) { apply_factor(b, x, 1); }

  // Whether there is a factor, and whether it is of the last K, not of an earlier one.
  bool has_factor() const { return has_factor_; }
  bool is_fresh() const { return has_factor_ && is_fresh_; }

  // Whether that is of all of K, and not of its symmetric part.
  bool is_of_all() const { return is_bordered_ || !objective_->has_skew_tangent(); }

  // x = K^-1 b or K^-T b, to a residual of `tolerance` relative to |b|, as far as round-off and `most`
  // applications of the factor let it. Returns that residual. Pre: has_factor().
  double solve(const Vector& b, Vector& x, double tolerance, int most = kUnlimited) {
    return solve(b, x, tolerance, 1, most);
  }
  double solve_transposed(const Vector& b, Vector& x, double tolerance, int most = kUnlimited) {
    return solve(b, x, tolerance, -1, most);
  }

  // Applications of the factor in the last solve: few, unless it belongs to a state far away, or to projected
  // elements.
  int applications() const { return applications_; }

  // Of H at the last assembly: zero where an unknown has no stiffness.
  Vector diagonal() const { return h_.diagonal(); }

  // Negative eigenvalues of H at the last factorise(): none where it was positive definite.
  int negative_modes() const { return negative_modes_; }

 private:
  static constexpr int kVectors = 40;  // of GMRES

  double solve(const Vector& b, Vector& x, double tolerance, double skew_sign, int most);
  void apply_factor(const Vector& b, Vector& x, double skew_sign);
  bool factorise_definite();
  bool factorise_bordered();
  double mean_stiffness() const;
  void multiply(const Vector& v, double skew_sign, Vector& product);

  FactorisationFactory make_;
  std::unique_ptr<Factorisation> factor_;
  BorderedFactor bordered_;  // of K, in its place
  std::vector<int> border_;  // of the pattern that was analysed for it last
  long bordered_analysed_ = -1;
  bool is_bordered_ = false;
  Gmres gmres_;
  SparseMatrix h_;
  Objective* objective_ = nullptr;  // of the last assembly: holds the skew part
  long analysed_ = -1;              // version of the pattern
  bool has_factor_ = false, is_fresh_ = false;
  int negative_modes_ = 0;
  int applications_ = 0;
  Vector work_, skew_, left_, correction_, start_;
};

}  // namespace coapt
