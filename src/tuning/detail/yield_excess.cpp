#include "tuning/detail/yield_excess.hpp"

#include "results/orifice_area.hpp"

#include <algorithm>

namespace coapt {
namespace {

constexpr double kMargin = 0.01;  // below the limits, of these

}  // namespace

YieldExcess::YieldExcess(const Model& model, double yield_strain, std::optional<double> orifice_limit_mm2)
    : model_(model), yield_strain_(yield_strain), limit_(orifice_limit_mm2) {
  for (size_t k = 0; k < model.lines.size(); ++k)
    if (model.lines[k].rest_length > 0) lines_.push_back(k);
}

double YieldExcess::enough() { return kMargin * kMargin; }

YieldExcess::Excess YieldExcess::excess(const Points& x, bool wants_derivatives) const {
  const auto count = static_cast<Eigen::Index>(lines_.size());
  Excess found{Vector::Zero(count + (limit_ ? 1 : 0)), Points::Zero(3, count), Points::Zero(3, x.cols())};
  for (Eigen::Index k = 0; k < count; ++k) {
    const Line& line = model_.lines[lines_[static_cast<size_t>(k)]];
    const double beyond = *line_strain(line, x) / yield_strain_ - 1 + kMargin;
    if (!(beyond > 0)) continue;
    found.values[k] = beyond;
    found.of_line.col(k) = (x.col(line.a) - x.col(line.b)).normalized() / (line.rest_length * yield_strain_);
  }
  if (!limit_) return found;
  const std::optional<OrificeArea> area = orifice_area(model_, x);
  const double beyond = area ? area->open / *limit_ - 1 + kMargin : 0;
  if (!(beyond > 0)) return found;
  found.values[count] = beyond;
  if (wants_derivatives) found.of_orifice = orifice_area_gradient(model_, x) / *limit_;
  return found;
}

Vector YieldExcess::values(const Points& x) const { return excess(x, false).values; }

Eigen::MatrixXd YieldExcess::derivatives(const Points& x, const std::vector<Points>& motions) const {
  const Excess at = excess(x, true);
  Eigen::MatrixXd rows(at.values.size(), static_cast<Eigen::Index>(motions.size()));
  for (Eigen::Index m = 0; m < rows.cols(); ++m) {
    const Points& motion = motions[static_cast<size_t>(m)];
    for (Eigen::Index k = 0; k < at.of_line.cols(); ++k) {
      const Line& line = model_.lines[lines_[static_cast<size_t>(k)]];
      rows(k, m) = at.of_line.col(k).dot(motion.col(line.a) - motion.col(line.b));
    }
    if (limit_) rows(at.of_line.cols(), m) = at.of_orifice.cwiseProduct(motion).sum();
  }
  return rows;
}

Points YieldExcess::pull_back(const Points& x, const Vector& weights) const {
  const Excess at = excess(x, true);
  Points sum = Points::Zero(3, x.cols());
  for (Eigen::Index k = 0; k < at.of_line.cols(); ++k) {
    const Line& line = model_.lines[lines_[static_cast<size_t>(k)]];
    sum.col(line.a) += weights[k] * at.of_line.col(k);
    sum.col(line.b) -= weights[k] * at.of_line.col(k);
  }
  if (limit_) sum += weights[at.of_line.cols()] * at.of_orifice;
  return sum;
}

TuningState tuning_state(const Model& model, const Points& x, double yield_strain) {
  TuningState state;
  for (const Line& line : model.lines) {
    const std::optional<double> strain = line_strain(line, x);
    if (!strain) continue;
    state.max_chord_strain = std::max(state.max_chord_strain, *strain);
    if (*strain > yield_strain) ++state.strained_chords;
  }
  if (const std::optional<OrificeArea> area = orifice_area(model, x)) state.orifice_area_mm2 = area->open;
  return state;
}

}  // namespace coapt
