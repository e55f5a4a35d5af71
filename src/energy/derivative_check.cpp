#include "energy/derivative_check.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <utility>
#include <vector>

namespace coapt {
namespace {

// What is checked, whether term or objective.
struct Subject {
  std::function<double(const Vector&)> value;
  std::function<Vector(const Vector&)> gradient;
  std::function<Vector(const Vector& at, const Vector& direction)> hessian_times;
};

// Remainders at one step of the ladder.
struct Rung {
  double step = 0, first = 0, second = 0;
};

// Slope over the finest decade whose remainders stand clear of the noise; the better of the two finest
// counts, since the last rung may carry some of the noise.
double finest_slope(const std::vector<Rung>& ladder, double Rung::*remainder, double noise) {
  size_t count = 0;
  while (count < ladder.size() && ladder[count].*remainder > noise) ++count;
  if (count < 3) return kInfinity;
  double slope = -kInfinity;
  for (size_t fine = std::max<size_t>(count - 2, 2); fine < count; ++fine) {
    const Rung &a = ladder[fine - 2], &b = ladder[fine];
    slope = std::max(slope, std::log(a.*remainder / (b.*remainder)) / std::log(a.step / b.step));
  }
  return slope;
}

// Central differences at one step after the other: each as it is, and with the error of second order taken
// out by the one before (Richardson). A barrier whose gap is small beside the step leaves an energy no step
// at which the plain difference is good to seven digits.
template <typename Value>
class Extrapolated {
 public:
  std::vector<Value> next(Value difference, double h) {
    std::vector<Value> all = {difference};
    if (step_ > 0) {
      const double ratio = step_ * step_ / (h * h);
      all.push_back((ratio * difference - last_) / (ratio - 1));
    }
    step_ = h;
    last_ = std::move(difference);
    return all;
  }

 private:
  double step_ = 0;
  Value last_{};
};

std::vector<double> steps(const DerivativeOptions& options) {
  std::vector<double> ladder;
  for (double h = options.largest_step; h >= 0.99 * options.smallest_step; h /= std::sqrt(10.0))
    ladder.push_back(h);
  return ladder;
}

// How much the energy varies without a cause: seen at steps far too small to matter.
double energy_noise(const Subject& subject, const Vector& q, const Vector& d, double energy) {
  double noise = 10 * std::numeric_limits<double>::epsilon() * std::abs(energy);
  for (const double h : {1e-14, -2e-14, 4e-14, -8e-14})
    noise = std::max(noise, std::abs(subject.value(q + h * d) - energy));
  return noise;
}

// What the Hessian is asked again where a direction does not pass: how far its product with the direction
// changes within each step. At a jump, as where a chord comes to pull, the change does not vanish with the
// step; and where the Hessian is right on either side, the remainder and the differences err by no more than
// it.
struct KinkSearch {
  const Subject& subject;
  const Vector& q;
  const Vector& d;
  const Vector& hd;
  double noise;  // of the energy

  Vector change(double h) const {
    return (subject.hessian_times(q + h * d, d) - hd)
        .cwiseAbs()
        .cwiseMax((subject.hessian_times(q - h * d, d) - hd).cwiseAbs());
  }

  // Are the remainders of the finest decade above the noise bounded by what the curvature changes?
  bool explains_slope(const std::vector<Rung>& ladder) const {
    constexpr double kMargin = 1.1;  // on the remainder that the change of curvature explains
    size_t count = 0;
    while (count < ladder.size() && ladder[count].second > noise) ++count;
    double greatest = 0;  // change of curvature within the step so far, from the finest up
    for (size_t i = ladder.size(); i-- > 0 && i + 3 >= count;) {
      const double h = ladder[i].step, curvature = d.dot(hd);
      for (const double side : {h, -h})
        greatest = std::max(greatest, std::abs(d.dot(subject.hessian_times(q + side * d, d)) - curvature));
      if (i < count && ladder[i].second > kMargin * 0.5 * h * h * greatest + noise) return false;
    }
    return true;
  }

  // The error of the Hessian in all components but a few at which it jumps.
  double error_beside_kinks(const std::vector<Rung>& ladder, double scale) const {
    constexpr double kMostJumps = 0.05, kJump = 1e-6;  // of the components; of the scale
    double least = kInfinity;
    for (auto rung = ladder.rbegin(); rung != ladder.rend() && least > kMostHessianError; ++rung) {
      const double h = rung->step;
      if (h > 1e-4) break;  // beyond it all components change
      const Vector error =
          ((subject.gradient(q + h * d) - subject.gradient(q - h * d)) / (2 * h) - hd).cwiseAbs();
      const Vector changed = change(h);
      double worst = 0;
      Eigen::Index jumps = 0;
      for (Eigen::Index i = 0; i < error.size(); ++i) {
        const bool is_jump = changed[i] > kJump * scale && changed[i] >= error[i];
        jumps += is_jump;
        if (!is_jump) worst = std::max(worst, error[i]);
      }
      if (static_cast<double>(jumps) <= kMostJumps * static_cast<double>(error.size()))
        least = std::min(least, worst / scale);
    }
    return least;
  }
};

void check_direction(const Subject& subject, const Vector& q, const Vector& g, const Vector& d,
                     const DerivativeOptions& options, DerivativeReport& report) {
  const Vector hd = subject.hessian_times(q, d);
  const double slope = g.dot(d), curvature = d.dot(hd);
  const double noise = 50 * energy_noise(subject, q, d, report.energy);
  // A direction almost at right angles to the gradient has no scale of its own.
  const double slope_scale =
      std::max(std::abs(slope), g.norm() * d.norm() / std::sqrt(static_cast<double>(q.size())));
  const double hd_scale = hd.size() == 0 ? 0 : hd.cwiseAbs().maxCoeff();

  std::vector<Rung> ladder;
  double gradient_error = kInfinity, hessian_error = kInfinity;
  Extrapolated<double> by_energy;
  Extrapolated<Vector> by_gradient;
  for (const double h : steps(options)) {
    const double ahead = subject.value(q + h * d), behind = subject.value(q - h * d);
    if (!std::isfinite(ahead) || !std::isfinite(behind)) continue;  // beyond a barrier
    // The larger of both sides: its orders add in magnitude, where on one side they could cancel.
    const double first = ahead - report.energy - h * slope, first_behind = behind - report.energy + h * slope;
    const double quadratic = 0.5 * h * h * curvature;
    ladder.push_back({h, std::max(std::abs(first), std::abs(first_behind)),
                      std::max(std::abs(first - quadratic), std::abs(first_behind - quadratic))});
    if (slope_scale > 0)
      for (const double difference : by_energy.next((ahead - behind) / (2 * h), h))
        gradient_error = std::min(gradient_error, std::abs(difference - slope) / slope_scale);
    for (const Vector& difference :
         by_gradient.next((subject.gradient(q + h * d) - subject.gradient(q - h * d)) / (2 * h), h)) {
      const double scale = std::max(hd_scale, difference.cwiseAbs().maxCoeff());
      hessian_error =
          std::min(hessian_error, scale > 0 ? (difference - hd).cwiseAbs().maxCoeff() / scale : 0);
    }
  }
  report.gradient_slope = std::min(report.gradient_slope, finest_slope(ladder, &Rung::first, noise));
  if (slope_scale > 0) report.gradient_error = std::max(report.gradient_error, gradient_error);
  double hessian_slope = finest_slope(ladder, &Rung::second, noise);
  if (hd_scale > 0 && (hessian_slope < kLeastHessianSlope || hessian_error > kMostHessianError)) {
    const KinkSearch kinks{subject, q, d, hd, noise};
    const double beside = kinks.error_beside_kinks(ladder, hd_scale);
    if (beside <= kMostHessianError && kinks.explains_slope(ladder)) {
      ++report.kinks;
      hessian_error = beside;
      hessian_slope = kInfinity;  // says nothing here
    }
  }
  report.hessian_slope = std::min(report.hessian_slope, hessian_slope);
  report.hessian_error = std::max(report.hessian_error, hessian_error);
}

DerivativeReport check(const Subject& subject, const Vector& q, const Eigen::MatrixXd& directions,
                       const DerivativeOptions& options) {
  DerivativeReport report;
  report.energy = subject.value(q);
  const Vector g = subject.gradient(q);
  report.gradient_norm = g.norm();
  for (int k = 0; k < directions.cols(); ++k)
    check_direction(subject, q, g, directions.col(k), options, report);
  return report;
}

Points as_points(const Vector& q) { return Eigen::Map<const Points>(q.data(), 3, q.size() / 3); }

// Product with the Hessian of one term, by storing its element blocks side by side: no assembly.
Vector term_hessian_times(EnergyTerm& term, const Vector& at, const Vector& d) {
  const Points x = as_points(at);
  term.prepare(x);
  const Stencils& stencils = term.stencils();
  const int width = stencils.width;
  const size_t block_count = static_cast<size_t>(stencils.count()) * width * width;
  std::vector<BlockSlot> slots(block_count);
  for (size_t k = 0; k < block_count; ++k) slots[k] = {static_cast<int>(9 * k), 3};
  Vector values = Vector::Zero(static_cast<Eigen::Index>(9 * block_count)), g = Vector::Zero(at.size());
  Sink sink(g.data(), values.data(), slots.data(), Projection::None);
  term.evaluate(x, sink);

  Vector product = Vector::Zero(at.size());
  for (size_t k = 0; k < block_count; ++k) {
    const int* nodes = stencils.nodes.data() + k / (width * width) * width;
    const int row = nodes[k / width % width], column = nodes[k % width];
    const Eigen::Map<const Eigen::Matrix3d> block(values.data() + 9 * k);
    product.segment<3>(3 * row) += block * d.segment<3>(3 * column);
  }
  return product;
}

}  // namespace

DerivativeReport check_derivatives(Objective& objective, const Vector& q, const Eigen::MatrixXd& directions,
                                   const DerivativeOptions& options) {
  const Subject subject = {[&](const Vector& at) { return objective.value(at); },
                           [&](const Vector& at) {
                             Vector g;
                             objective.gradient(at, g);
                             return g;
                           },
                           [&](const Vector& at, const Vector& d) {
                             Vector g;
                             Eigen::SparseMatrix<double> h;
                             objective.hessian(at, g, h);
                             return Vector(h.selfadjointView<Eigen::Lower>() * d);
                           }};
  DerivativeReport report = check(subject, q, directions, options);
  report.name = "sum";
  return report;
}

DerivativeReport check_derivatives(EnergyTerm& term, const Points& x, const Eigen::MatrixXd& directions,
                                   const DerivativeOptions& options) {
  const Subject subject = {
      [&](const Vector& at) {
        const Points points = as_points(at);
        term.prepare(points);
        Sink sink;
        return term.evaluate(points, sink);
      },
      [&](const Vector& at) {
        const Points points = as_points(at);
        term.prepare(points);
        Vector g = Vector::Zero(at.size());
        Sink sink(g.data());
        term.evaluate(points, sink);
        return g;
      },
      [&](const Vector& at, const Vector& d) { return term_hessian_times(term, at, d); }};
  const Vector q = Eigen::Map<const Vector>(x.data(), x.size());
  DerivativeReport report = check(subject, q, directions, options);
  report.name = term.name();
  report.type = term.type();
  return report;
}

Eigen::MatrixXd random_directions(const FixedMask& fixed, int count, double step, unsigned seed) {
  std::mt19937 random(seed);
  Eigen::MatrixXd directions(3 * fixed.cols(), count);
  for (int k = 0; k < count; ++k) {
    Points d(3, fixed.cols());
    for (int node = 0; node < d.cols(); ++node)
      for (int c = 0; c < 3; ++c) {
        // Not a <random> distribution: those differ between standard libraries.
        const double uniform = static_cast<double>(random()) / 2147483648.0 - 1;
        d(c, node) = fixed(c, node) ? 0 : uniform;
      }
    const double largest = d.cols() == 0 ? 0 : d.colwise().norm().maxCoeff();
    if (largest > 0) d *= step / largest;
    directions.col(k) = Eigen::Map<const Vector>(d.data(), d.size());
  }
  return directions;
}

}  // namespace coapt
