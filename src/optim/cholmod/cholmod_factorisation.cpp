#include "optim/cholmod/cholmod_factorisation.hpp"

#include "linear/permuted_matrix.hpp"
#include "linear/pivots.hpp"
#include "optim/cholmod/detail/blas_threads.hpp"
#include "optim/cholmod/detail/node_analysis.hpp"

#include <algorithm>
#include <cholmod.h>
#include <cmath>
#include <new>
#include <optional>

namespace coapt {
namespace {

constexpr double kMostFill = 1.1;  // of an order that is kept, over that of the pattern it was made for

class Session {
 public:
  Session() {
    cholmod_start(&common);
    common.print = 0;
    common.supernodal = CHOLMOD_SUPERNODAL;
    common.final_ll = 1;
    common.quick_return_if_not_posdef = 1;
  }
  ~Session() { cholmod_finish(&common); }
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  cholmod_common common;
};

cholmod_sparse view(const SparseMatrix& lower) {
  return detail::lower_view(lower.cols(), lower.nonZeros(), lower.outerIndexPtr(), lower.innerIndexPtr(),
                            lower.valuePtr());
}

cholmod_dense view(Vector& values) {
  cholmod_dense column{};
  column.nrow = column.nzmax = column.d = values.size();
  column.ncol = 1;
  column.x = values.data();
  column.xtype = CHOLMOD_REAL;
  column.dtype = CHOLMOD_DOUBLE;
  return column;
}

class CholmodFactorisation final : public Factorisation {
 public:
  explicit CholmodFactorisation(const CholmodOptions& options) : options_(options) {}
  ~CholmodFactorisation() override { cholmod_free_factor(&factor_, common()); }
  CholmodFactorisation(const CholmodFactorisation&) = delete;
  CholmodFactorisation& operator=(const CholmodFactorisation&) = delete;

  std::string_view name() const override { return "cholmod"; }

  void analyse(const SparseMatrix& lower) override {
    cholmod_free_factor(&factor_, common());
    upper_.reset();
    graph_ = node_graph(lower);
    std::vector<int> order = permuted_.order();
    if (graph_.size() > 0 && !analyse_in_order(order)) {
      factor_ = detail::analyse_nodes(graph_, ordering(), order, session_.common);
      fill_ = factor_->xsize;
    }
    permuted_ = PermutedMatrix(graph_, std::move(order), Triangle::Lower);
    work_.resize(lower.cols());
    below_.resize(factor_ == nullptr ? 0 : std::max<size_t>(1, factor_->maxesize));
  }

  bool factorise(const SparseMatrix& lower) override {
    pivot_ratio_ = 1;
    if (factor_ == nullptr) return true;
    permuted_.take_values(lower);
    cholmod_sparse matrix = view(permuted_.matrix());
    double shift[2] = {0, 0};
    const detail::BlasThreads threads(options_.blas_threads);
    cholmod_super_numeric(&matrix, nullptr, shift, factor_, common());
    if (common()->status < CHOLMOD_OK) throw std::bad_alloc();
    if (common()->status == CHOLMOD_NOT_POSDEF || factor_->minor < factor_->n) return false;
    return measure_pivots();
  }

  void solve(const Vector& b, Vector& x) override {
    permuted_.permute(b, work_);
    if (factor_ != nullptr) {
      cholmod_dense column = view(work_), below = view(below_);
      const detail::BlasThreads threads(options_.blas_threads);
      cholmod_super_lsolve(factor_, &column, &below, common());
      cholmod_super_ltsolve(factor_, &column, &below, common());
    }
    permuted_.restore(work_, x);
  }

  double pivot_ratio() const override { return pivot_ratio_; }

  Inertia inertia(const SparseMatrix& lower) override {
    // The supernodal factorisation decides the usual case far sooner than a simplicial one.
    if (factorise(lower)) return {0, 0, static_cast<int>(lower.cols())};
    if (!upper_) upper_.emplace(graph_, permuted_.order(), Triangle::Upper);
    upper_->take_values(lower);
    return inertia_of(*upper_);
  }

 private:
  cholmod_common* common() { return &session_.common; }

  // By the order of the last pattern, as most differ by a few pairs in contact: an ordering takes longer than
  // the rest of an analysis. False, leaving no factor, where that order is none of this graph or fills more.
  bool analyse_in_order(std::vector<int>& order) {
    if (order.size() != static_cast<size_t>(graph_.size())) return false;
    factor_ = detail::analyse_nodes(graph_, CHOLMOD_GIVEN, order, session_.common);
    if (static_cast<double>(factor_->xsize) <= kMostFill * static_cast<double>(fill_)) return true;
    cholmod_free_factor(&factor_, common());
    return false;
  }

  int ordering() const {
    // Measured: with bending, nested dissection pays for itself within fifteen factorisations from here on.
    constexpr int kNestedDissectionFrom = 1000;
    switch (options_.ordering) {
      case CholmodOptions::Ordering::MinimumDegree:
        return CHOLMOD_AMD;
      case CholmodOptions::Ordering::NestedDissection:
        return CHOLMOD_METIS;
      case CholmodOptions::Ordering::Automatic:
        break;
    }
    return graph_.size() < kNestedDissectionFrom ? CHOLMOD_AMD : CHOLMOD_METIS;
  }

  // False when a pivot is not a number.
  bool measure_pivots() {
    const int* super = static_cast<const int*>(factor_->super);
    const int* pi = static_cast<const int*>(factor_->pi);
    const int* px = static_cast<const int*>(factor_->px);
    const double* values = static_cast<const double*>(factor_->x);
    double least = kInfinity, greatest = 0;
    for (size_t s = 0; s < factor_->nsuper; ++s) {
      const long rows = pi[s + 1] - pi[s];
      for (int c = 0; c < super[s + 1] - super[s]; ++c) {
        const double pivot = values[px[s] + c * (rows + 1)];
        if (!std::isfinite(pivot)) return false;
        least = std::min(least, pivot);
        greatest = std::max(greatest, pivot);
      }
    }
    pivot_ratio_ = (least / greatest) * (least / greatest);
    return true;
  }

  CholmodOptions options_;
  Session session_;
  NodeGraph graph_;
  PermutedMatrix permuted_;
  std::optional<PermutedMatrix> upper_;  // for L D L^T, made when wanted
  cholmod_factor* factor_ = nullptr;     // null for the empty matrix
  size_t fill_ = 0;                      // of the factor of the pattern that was ordered last
  Vector work_, below_;
  double pivot_ratio_ = 1;
};

}  // namespace

std::unique_ptr<Factorisation> make_cholmod_factorisation(const CholmodOptions& options) {
  return std::make_unique<CholmodFactorisation>(options);
}

}  // namespace coapt
