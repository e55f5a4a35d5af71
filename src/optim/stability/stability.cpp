#include "optim/stability/stability.hpp"

#include "linear/lowest_eigenvalues.hpp"
#include "optim/stability/smallest_modes.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

namespace coapt {
namespace {

constexpr double kRoundOff = 1e-14;  // of an eigenvalue, relative to the greatest diagonal entry
constexpr double kFree = 10;         // force of a free direction, times zero: chords pass it on to both ends
constexpr int kInverseIterations = 60;  // towards the softest mode

// Nodes that zero modes move: probes through a filter that damps the others.
constexpr int kProbes = 6, kFilterSteps = 4;
constexpr double kMoved = 0.01;  // of the greatest square

class Judgement {
 public:
  Judgement(const SparseMatrix& lower, const SkewProduct& skew, const std::vector<bool>& is_prescribed,
            double zero, const StabilityOptions& options)
      : h_(lower), skew_(skew), is_prescribed_(is_prescribed), options_(options) {
    measure(zero);
    if (std::isfinite(report_.scale)) set_free_apart();
  }

  StabilityReport report() {
    if (checked_ == 0 || !std::isfinite(report_.scale)) {
      report_.verdict = checked_ == 0 ? Stability::NothingToCheck : Stability::NotKnown;
      return report_;
    }
    find_smallest();
    resist(report_.scale);
    factor_ = options_.factorisation();
    factor_->analyse(h_);
    if (factorise(-zero_)) {
      report_.verdict = Stability::StrictMinimum;
      report_.pivot_ratio = factor_->pivot_ratio();
    } else if (factorise(zero_)) {
      count(0);
      report_.verdict = report_.zero_modes == 0 ? Stability::StrictMinimum : Stability::Flat;
      if (report_.verdict == Stability::Flat) find_moved_blocks();
    } else {
      classify_indefinite();
    }
    report_.free_blocks.assign(free_blocks_.begin(), free_blocks_.end());
    return report_;
  }

 private:
  void measure(double zero) {
    double sum = 0, greatest = 0;
    for (int c = 0; c < h_.cols(); ++c) {
      if (is_prescribed_[static_cast<size_t>(c)]) continue;
      const double entry = std::abs(h_.coeff(c, c));
      greatest = std::max(greatest, entry);
      sum += entry;
      ++checked_;
    }
    report_.scale = checked_ > 0 ? sum / checked_ : 0;
    zero_ = std::max(zero, kRoundOff * greatest);
  }

  void set_free_apart() {
    free_ = free_directions(h_, skew_, is_prescribed_, kFree * zero_);
    for (const FreeDirections& free : free_) {
      const auto directions = static_cast<int>(free.axes.cols());
      const auto first = is_prescribed_.begin() + 3 * free.block;
      if (directions == std::count(first, first + 3, false)) ++report_.loose_nodes;
      report_.free_directions += directions;
      checked_ -= directions;
      free_blocks_.insert(free.block);
    }
  }

  // Gives what is not checked a stiffness of its own.
  void resist(double stiffness) {
    for (int c = 0; c < h_.cols(); ++c)
      if (is_prescribed_[static_cast<size_t>(c)]) h_.coeffRef(c, c) = stiffness;
    for (const FreeDirections& free : free_) {
      const Eigen::Matrix3d added = (stiffness - resisted_) * free.axes * free.axes.transpose();
      const bool is_loose = free.axes.cols() == 3;
      for (int c = 0; c < 3; ++c)
        for (int r = 0; r < 3; ++r) {
          double& entry = h_.coeffRef(3 * free.block + r, 3 * free.block + c);
          entry = is_loose ? (r == c ? stiffness : 0) : entry + added(r, c);
        }
    }
    resisted_ = stiffness;
  }

  void find_smallest() {
    if (options_.modes == 0) return;
    resist(1);  // which smallest_modes() knows as unit rows
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

  // Without the symmetry of any mesh, zero at what is not checked.
  Vector start_vector(double phase = 0) const {
    Vector v(h_.cols());
    for (int k = 0; k < v.size(); ++k)
      v[k] = is_prescribed_[static_cast<size_t>(k)] ? 0 : 1 + 0.5 * std::sin(1.7 * k * k + phase);
    for (const FreeDirections& free : free_) {
      auto part = v.segment<3>(3 * free.block);
      if (free.axes.cols() == 3)
        part.setZero();
      else
        part -= Vec3(free.axes * (free.axes.transpose() * part));
    }
    return v;
  }

  void classify_indefinite() {
    if (!skew_) {
      report_.verdict = Stability::Saddle;
      Vector mode;
      if (options_.finds_descent && find_lowest(mode) < 0) report_.descent = mode;
    } else {
      report_.verdict = Stability::NotDecided;
      classify_tangent();
    }
    const std::optional<int> negative = below(-zero_);
    report_.negative_modes = negative.value_or(-1);
    if (!skew_) count(report_.negative_modes);
  }

  // Factorises with the first shift that makes the matrix definite; false where none does.
  bool lift() {
    double lift = 10 * zero_;
    while (!factorise(lift)) {
      lift *= 10;
      if (lift > 1e4 * report_.scale) return false;
    }
    return true;
  }

  // The lowest mode, roughly, by inverse iteration. Zero where no shift makes the matrix definite.
  double find_lowest(Vector& v) {
    if (!lift()) return 0;
    v = start_vector().normalized();
    Vector next;
    for (int k = 0; k < kInverseIterations; ++k) {
      factor_->solve(v, next);
      v = next.normalized();
    }
    return v.dot(h_.selfadjointView<Eigen::Lower>() * v) - shift_;
  }

  LowestEigenvalues lowest_of_tangent() {
    const Vector start = start_vector();
    if (h_.cols() <= kMostDense) {
      shift(0);
      return all_eigenvalues(h_, skew_, start);
    }
    if (!lift()) return {};
    const double lifted = shift_;
    shift(0);
    Eigen::MatrixXd starts(h_.cols(), 2);
    starts << start, start_vector(2);
    const LowestModes modes = lowest_modes(h_, zero_, lifted, starts, *factor_);
    report_.factorisations += modes.factorisations;
    if (!modes.is_complete) return {};
    ++report_.factorisations;
    return lowest_eigenvalues(h_, skew_, start, modes, zero_, factor_->team());
  }

  void classify_tangent() {
    const LowestEigenvalues found = lowest_of_tangent();
    if (!found.is_complete) return;
    report_.is_tangent_checked = true;
    report_.lowest = found.values[0];
    report_.zero_modes = 0;
    Eigen::Index real = -1;
    for (Eigen::Index k = 0; k < found.values.size(); ++k) {
      if (std::abs(found.values[k].real()) <= zero_) {
        ++report_.zero_modes;
        add_moved_blocks(found.vectors.col(k).cwiseAbs2());
      }
      if (found.values[k].real() >= -zero_) continue;
      ++report_.unstable_modes;
      if (real < 0 && found.values[k].imag() == 0) real = k;
    }
    if (report_.unstable_modes > 0)
      report_.verdict = real < 0 ? Stability::Flutter : Stability::Divergence;
    else
      report_.verdict = report_.zero_modes > 0 ? Stability::Flat : Stability::Stable;
    if (real >= 0 && options_.finds_descent) report_.descent = found.vectors.col(real).real().normalized();
  }

  void find_moved_blocks() {
    if (!factorise(2 * zero_)) return;
    Vector squares = Vector::Zero(h_.cols()), next;
    for (int probe = 0; probe < kProbes; ++probe) {
      Vector v = start_vector(1.3 * probe) - start_vector(1.3 * probe + 2);
      for (int k = 0; k < kFilterSteps; ++k) {
        factor_->solve(v, next);
        v = 3 * zero_ * next;
      }
      squares += v.cwiseAbs2();
    }
    add_moved_blocks(squares);
  }

  // Blocks whose squares of displacement are not small beside the greatest.
  void add_moved_blocks(const Vector& squares) {
    const Vector of_block = squares.reshaped(3, squares.size() / 3).colwise().sum().transpose();
    const double least = kMoved * of_block.maxCoeff();
    for (int b = 0; b < of_block.size(); ++b)
      if (of_block[b] > least) free_blocks_.insert(b);
  }

  SparseMatrix h_;
  const SkewProduct& skew_;
  const std::vector<bool>& is_prescribed_;
  const StabilityOptions& options_;
  std::vector<FreeDirections> free_;
  std::set<int> free_blocks_;
  int checked_ = 0;  // unknowns, less the free directions
  double zero_ = 0, shift_ = 0, resisted_ = 0;
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
    case Stability::Stable:
      return "stable";
    case Stability::Flat:
      return "flat";
    case Stability::Saddle:
      return "saddle";
    case Stability::Divergence:
      return "divergence";
    case Stability::Flutter:
      return "flutter";
    case Stability::NotDecided:
      return "not_decided";
    case Stability::NothingToCheck:
      return "nothing_to_judge";
  }
  return "";
}

bool is_unstable(Stability stability) {
  return stability == Stability::Saddle || stability == Stability::Divergence ||
         stability == Stability::Flutter;
}

StabilityReport classify_stability(const SparseMatrix& lower, const SkewProduct& skew,
                                   const std::vector<bool>& is_prescribed, double zero,
                                   const StabilityOptions& options) {
  return Judgement(lower, skew, is_prescribed, zero, options).report();
}

}  // namespace coapt
