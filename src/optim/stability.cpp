#include "optim/stability.hpp"

#include "optim/smallest_modes.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace coapt {
namespace {

constexpr double kLoose = 1e-12;       // relative to the mean of the diagonal
constexpr double kZero = 1e-11;        // likewise
constexpr double kSafePivots = 1e-13;  // a singular matrix that round-off lets pass stays below
constexpr int kInverseIterations = 60;

class Judgement {
 public:
  Judgement(const SparseMatrix& lower, const std::vector<bool>& is_prescribed, double noise,
            const StabilityOptions& options)
      : h_(lower), is_prescribed_(is_prescribed), options_(options) {
    measure();
    zero_ = std::max(noise, kZero * report_.scale);
  }

  StabilityReport report() {
    if (judged_ == 0 || !std::isfinite(report_.scale)) {
      report_.verdict = judged_ == 0 ? Stability::NothingToJudge : Stability::NotKnown;
      return report_;
    }
    find_smallest();
    set_apart(report_.scale);
    factor_ = options_.factorisation();
    factor_->analyse(h_);
    if (factorise(0) && factor_->pivot_ratio() > kSafePivots) {
      report_.verdict = Stability::StrictMinimum;
      report_.pivot_ratio = factor_->pivot_ratio();
      return report_;
    }
    if (factorise(zero_)) {
      count(0);
      report_.verdict = report_.zero_modes == 0 ? Stability::StrictMinimum : Stability::Flat;
    } else {
      report_.verdict = Stability::Saddle;
      if (options_.finds_descent) find_descent();
      const std::optional<int> negative = below(-zero_);
      report_.negative_modes = negative.value_or(-1);
      count(report_.negative_modes);
    }
    return report_;
  }

 private:
  // Scale, loose nodes, and how many unknowns are left to judge.
  void measure() {
    const auto size = static_cast<size_t>(h_.cols());
    std::vector<double> greatest(size / 3, 0.0);  // entry in the rows of each node
    double sum = 0;
    for (int c = 0; c < h_.cols(); ++c)
      for (SparseMatrix::InnerIterator entry(h_, c); entry; ++entry) {
        const auto r = static_cast<size_t>(entry.row()), column = static_cast<size_t>(c);
        if (is_prescribed_[r] || is_prescribed_[column]) continue;
        for (const size_t node : {r / 3, column / 3})
          greatest[node] = std::max(greatest[node], std::abs(entry.value()));
        if (r != column) continue;
        sum += std::abs(entry.value());
        ++judged_;
      }
    report_.scale = judged_ > 0 ? sum / judged_ : 0;
    is_apart_ = is_prescribed_;
    for (size_t node = 0; node < greatest.size(); ++node) {
      const auto first = is_apart_.begin() + static_cast<std::ptrdiff_t>(3 * node);
      const auto free = std::count(first, first + 3, false);
      if (free == 0 || greatest[node] > kLoose * report_.scale) continue;
      std::fill(first, first + 3, true);
      judged_ -= static_cast<int>(free);
      ++report_.loose_nodes;
    }
  }

  // Gives what is not judged a diagonal of its own.
  void set_apart(double diagonal) {
    for (int c = 0; c < h_.cols(); ++c)
      if (is_apart_[static_cast<size_t>(c)]) h_.coeffRef(c, c) = diagonal;
  }

  void find_smallest() {
    if (options_.modes == 0) return;
    set_apart(1);  // which smallest_modes() knows as unit rows
    if (const auto modes = smallest_modes(h_, options_.modes, options_.factorisation))
      report_.smallest = modes->values;
  }

  void shift(double wanted) {
    for (int c = 0; c < h_.cols(); ++c) h_.coeffRef(c, c) += wanted - shift_;
    shift_ = wanted;
  }

  bool factorise(double wanted) {
    shift(wanted);
    ++report_.factorisations;
    return factor_->factorise(h_);
  }

  // Number of eigenvalues below a value; nothing where it was not counted.
  std::optional<int> below(double value) {
    if (h_.cols() > options_.most_unknowns && options_.modes == 0) return std::nullopt;
    for (const double nudge : {1.0, 1.37, 0.71}) {  // a pivot that vanishes is an accident of the shift
      shift(-nudge * value);
      ++report_.factorisations;
      const Inertia inertia = factor_->inertia(h_);
      if (inertia.zero == 0) return inertia.negative;
    }
    return std::nullopt;
  }

  void count(int negative) {
    const std::optional<int> small = negative < 0 ? std::nullopt : below(zero_);
    report_.zero_modes = small ? *small - negative : -1;
  }

  // The lowest mode, roughly, by inverse iteration with the first shift that makes the matrix definite.
  void find_descent() {
    double lift = zero_;
    while (!factorise(lift)) {
      lift *= 10;
      if (lift > 1e4 * report_.scale) return;
    }
    Vector v(h_.cols()), next;
    for (int k = 0; k < v.size(); ++k)  // no symmetry of a mesh
      v[k] = is_apart_[static_cast<size_t>(k)] ? 0 : 1 + 0.5 * std::sin(1.7 * k * k);
    v.normalize();
    for (int k = 0; k < kInverseIterations; ++k) {
      factor_->solve(v, next);
      v = next.normalized();
    }
    const double curvature = v.dot(h_.selfadjointView<Eigen::Lower>() * v) - shift_;
    if (curvature < 0) report_.descent = v;
  }

  SparseMatrix h_;
  const std::vector<bool>& is_prescribed_;
  const StabilityOptions& options_;
  std::vector<bool> is_apart_;  // prescribed, or of a loose node
  int judged_ = 0;              // unknowns
  double zero_ = 0, shift_ = 0;
  std::unique_ptr<Factorisation> factor_;
  StabilityReport report_;
};

}  // namespace

std::string_view stability_name(Stability stability) {
  switch (stability) {
    case Stability::NotKnown:
      return "not_known";
    case Stability::StrictMinimum:
      return "strict_minimum";
    case Stability::Flat:
      return "flat";
    case Stability::Saddle:
      return "saddle";
    case Stability::NothingToJudge:
      return "nothing_to_judge";
  }
  return "";
}

StabilityReport judge_stability(const SparseMatrix& lower, const std::vector<bool>& is_prescribed,
                                double noise, const StabilityOptions& options) {
  return Judgement(lower, is_prescribed, noise, options).report();
}

}  // namespace coapt
