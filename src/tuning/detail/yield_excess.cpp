#include "tuning/detail/yield_excess.hpp"

#include "results/orifice_area.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace coapt {
namespace {

constexpr double kMargin = 0.01;  // below the limits, of these

// Of a line with a rest length; infinite where it has none.
double yield_of(const Line& line, const std::optional<double>& of_all) {
  return line.rest_length > 0 ? of_all.value_or(line.yield_strain) : std::numeric_limits<double>::infinity();
}

CstVector corners(const Model& model, const Points& x, int triangle) {
  const Eigen::Vector3i c = model.mesh.triangles.col(triangle);
  CstVector all;
  all << x.col(c[0]), x.col(c[1]), x.col(c[2]);
  return all;
}

}  // namespace

YieldExcess::YieldExcess(const Model& model, std::optional<double> yield_strain,
                         std::optional<double> orifice_limit_mm2)
    : model_(model), yield_strain_(yield_strain), limit_(orifice_limit_mm2) {
  for (size_t k = 0; k < model.lines.size(); ++k)
    if (std::isfinite(yield_of(model.lines[k], yield_strain))) lines_.push_back(k);
  if (yield_strain) return;
  for (const MembranePatch& patch : model.membrane_patches)
    for (size_t e = 0; patch.yield_ratio && e < patch.triangles.size(); ++e)
      facets_.push_back({&patch, static_cast<int>(e)});
}

double YieldExcess::enough() { return kMargin * kMargin; }

YieldExcess::Excess YieldExcess::excess(const Points& x, bool wants_derivatives) const {
  const auto count = std::ssize(lines_), facets = std::ssize(facets_);
  Excess found{Vector::Zero(count + facets + (limit_ ? 1 : 0)), Points::Zero(3, count),
               Eigen::Matrix<double, 9, Eigen::Dynamic>::Zero(9, facets), Points::Zero(3, x.cols())};
  for (Eigen::Index k = 0; k < count; ++k) {
    const Line& line = model_.lines[lines_[static_cast<size_t>(k)]];
    const double yield = yield_of(line, yield_strain_), beyond = *line_strain(line, x) / yield - 1 + kMargin;
    if (!(beyond > 0)) continue;
    found.values[k] = beyond;
    found.of_line.col(k) = (x.col(line.a) - x.col(line.b)).normalized() / (line.rest_length * yield);
  }
  for (Eigen::Index k = 0; k < facets; ++k) {
    const auto& [patch, element] = facets_[static_cast<size_t>(k)];
    const CstVector at = corners(model_, x, patch->triangles[static_cast<size_t>(element)]);
    const double beyond = patch->yield_ratio(element, at, nullptr) - 1 + kMargin;
    if (!(beyond > 0)) continue;
    found.values[count + k] = beyond;
    CstVector gradient;
    patch->yield_ratio(element, at, &gradient);
    found.of_facet.col(k) = gradient;
  }
  if (!limit_) return found;
  const std::optional<OrificeArea> area = orifice_area(model_, x);
  const double beyond = area ? area->open / *limit_ - 1 + kMargin : 0;
  if (!(beyond > 0)) return found;
  found.values[count + facets] = beyond;
  if (wants_derivatives) found.of_orifice = orifice_area_gradient(model_, x) / *limit_;
  return found;
}

Vector YieldExcess::values(const Points& x) const { return excess(x, false).values; }

Eigen::MatrixXd YieldExcess::derivatives(const Points& x, const std::vector<Points>& motions) const {
  const Excess at = excess(x, true);
  const Eigen::Index count = at.of_line.cols(), facets = at.of_facet.cols();
  Eigen::MatrixXd rows(at.values.size(), std::ssize(motions));
  for (Eigen::Index m = 0; m < rows.cols(); ++m) {
    const Points& motion = motions[static_cast<size_t>(m)];
    for (Eigen::Index k = 0; k < count; ++k) {
      const Line& line = model_.lines[lines_[static_cast<size_t>(k)]];
      rows(k, m) = at.of_line.col(k).dot(motion.col(line.a) - motion.col(line.b));
    }
    for (Eigen::Index k = 0; k < facets; ++k) {
      const auto& [patch, element] = facets_[static_cast<size_t>(k)];
      rows(count + k, m) =
          at.of_facet.col(k).dot(corners(model_, motion, patch->triangles[static_cast<size_t>(element)]));
    }
    if (limit_) rows(count + facets, m) = at.of_orifice.cwiseProduct(motion).sum();
  }
  return rows;
}

Points YieldExcess::pull_back(const Points& x, const Vector& weights) const {
  const Excess at = excess(x, true);
  const Eigen::Index count = at.of_line.cols(), facets = at.of_facet.cols();
  Points sum = Points::Zero(3, x.cols());
  for (Eigen::Index k = 0; k < count; ++k) {
    const Line& line = model_.lines[lines_[static_cast<size_t>(k)]];
    sum.col(line.a) += weights[k] * at.of_line.col(k);
    sum.col(line.b) -= weights[k] * at.of_line.col(k);
  }
  for (Eigen::Index k = 0; k < facets; ++k) {
    const auto& [patch, element] = facets_[static_cast<size_t>(k)];
    const Eigen::Vector3i c = model_.mesh.triangles.col(patch->triangles[static_cast<size_t>(element)]);
    for (int a = 0; a < 3; ++a) sum.col(c[a]) += weights[count + k] * at.of_facet.col(k).segment<3>(3 * a);
  }
  if (limit_) sum += weights[count + facets] * at.of_orifice;
  return sum;
}

TuningState tuning_state(const Model& model, const Points& x, std::optional<double> yield_strain) {
  TuningState state;
  const auto note = [&state](double ratio, int& beyond) {
    state.max_yield_ratio = std::max(state.max_yield_ratio, ratio);
    if (ratio > 1) ++beyond;
  };
  for (const Line& line : model.lines) {
    const std::optional<double> strain = line_strain(line, x);
    if (!strain) continue;
    state.max_chord_strain = std::max(state.max_chord_strain, *strain);
    note(*strain / yield_of(line, yield_strain), state.strained_chords);
  }
  if (!yield_strain)
    for (const MembranePatch& patch : model.membrane_patches)
      for (size_t e = 0; patch.yield_ratio && e < patch.triangles.size(); ++e)
        note(patch.yield_ratio(static_cast<int>(e), corners(model, x, patch.triangles[e]), nullptr),
             state.strained_facets);
  if (const std::optional<OrificeArea> area = orifice_area(model, x)) state.orifice_area_mm2 = area->open;
  return state;
}

}  // namespace coapt
