#include "optim/certificate.hpp"

#include "energy/connected_parts.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace coapt {
namespace {

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2g", value);
  return text;
}

std::string counted(int count, const std::string& thing) {
  return std::to_string(count) + " " + thing + (count == 1 ? "" : "s");
}

// For each unknown, in the objective's order.
std::vector<bool> prescribed_unknowns(const FixedMask& fixed) {
  std::vector<bool> prescribed;
  for (Eigen::Index node = 0; node < fixed.cols(); ++node) {
    if (fixed.col(node).all()) continue;
    for (int c = 0; c < 3; ++c) prescribed.push_back(fixed(c, node));
  }
  return prescribed;
}

std::optional<Imbalance> largest_imbalance(const Objective& objective, const Points& x) {
  std::vector<Points> forces;
  Points sum = Points::Zero(3, x.cols());
  for (const auto& term : objective.terms()) {
    forces.push_back(nodal_forces(*term, x));
    sum += forces.back();
  }
  sum = objective.fixed().select(Points::Zero(3, x.cols()), sum);
  if (x.cols() == 0 || !sum.allFinite()) return std::nullopt;
  Imbalance worst;
  Eigen::Index node = 0;
  worst.force = std::sqrt(sum.colwise().squaredNorm().maxCoeff(&node));
  if (worst.force == 0) return std::nullopt;
  worst.node = static_cast<int>(node);
  worst.position = x.col(node);
  const Vec3 direction = sum.col(node) / worst.force;
  for (size_t k = 0; k < forces.size(); ++k) {
    const double share = forces[k].col(node).dot(direction);
    if (share <= worst.share) continue;
    worst.share = share;
    worst.term = objective.terms()[k]->name();
  }
  return worst;
}

// Whether there are loads, or reactions that stand clear of round-off.
bool has_clear_forces(Objective& objective, const Vector& q) {
  for (const auto& term : objective.terms())
    if (term->role() == TermRole::Load) return true;
  const Points reactions = objective.reactions(q);
  return reactions.size() > 0 &&
         std::sqrt(reactions.colwise().squaredNorm().maxCoeff()) > 1e-3 * objective.reference_force();
}

StabilityReport stability_at(Objective& objective, const Vector& q, const StabilityOptions& options) {
  StabilityReport report;
  if (objective.free_count() == 0) {
    report.verdict = Stability::NothingToJudge;
    return report;
  }
  if (objective.has_circulatory_force()) objective.follow_path(q);
  Vector g;
  SparseMatrix h;
  objective.hessian(q, g, h, Projection::None);
  if (!g.allFinite() || !std::isfinite(h.sum())) return report;
  // A rigid turn of a body that is not quite in balance has the stiffness force over length.
  const double extent = objective.extent(q);
  const double noise = extent > 0 ? 10 * g.lpNorm<Eigen::Infinity>() / extent : 0;
  return judge_stability(h, prescribed_unknowns(objective.fixed()), noise, options);
}

std::string modes(int count, const std::string& kind) {
  return count < 0 ? kind + " modes that were not counted" : counted(count, kind + " mode");
}

std::string stability_summary(const Certificate& certificate) {
  const StabilityReport& report = certificate.stability;
  switch (report.verdict) {
    case Stability::NotKnown:
      return "stability not judged";
    case Stability::NothingToJudge:
      return "no free node has any stiffness";
    case Stability::StrictMinimum:
      return report.pivot_ratio > 0
                 ? "strict minimum (smallest pivot ratio " + number(report.pivot_ratio) + ")"
                 : "strict minimum, just";
    case Stability::Flat:
      return "flat, with " + modes(report.zero_modes, "zero-energy");
    case Stability::Saddle:
      return (certificate.is_conservative ? "saddle, with "
                                          : "stability not proven: the symmetric part of the tangent has ") +
             modes(report.negative_modes, "negative");
  }
  return "";
}

}  // namespace

std::vector<FreePart> free_parts(const Objective& objective, const Points& x) {
  std::vector<FreePart> found;
  for (const Part& part : connected_parts(objective.terms(), x, objective.fixed()))
    if (part.free_motions > 0)
      found.push_back({part.nodes.front(), static_cast<int>(part.nodes.size()), part.free_motions});
  return found;
}

Certificate certify(Objective& objective, const Vector& q, double tolerance, const StabilityOptions& options,
                    bool judges_stability) {
  Certificate certificate;
  certificate.is_made = true;
  certificate.is_conservative = !objective.has_circulatory_force();
  certificate.residual = objective.true_residual(q);
  certificate.balance = objective.balance(q);
  const Points x = objective.positions(q);
  certificate.is_balance_clear = has_clear_forces(objective, q);
  certificate.free_parts = free_parts(objective, x);
  if (!(certificate.residual <= tolerance)) certificate.imbalance = largest_imbalance(objective, x);
  if (judges_stability && options.factorisation) {
    StabilityOptions judged = options;
    judged.finds_descent = certificate.is_conservative;  // else there is no energy to descend
    certificate.stability = stability_at(objective, q, judged);
  }
  return certificate;
}

std::string summary(const Certificate& certificate) {
  std::string text = stability_summary(certificate);
  if (certificate.stability.loose_nodes > 0)
    text += ", " + counted(certificate.stability.loose_nodes, "loose node");
  if (certificate.is_balance_clear)
    text +=
        ", reactions balance to " + number(std::max(certificate.balance.force, certificate.balance.moment));
  if (const auto& worst = certificate.imbalance)
    text += ", largest out-of-balance force " + number(worst->force) + " at node " +
            std::to_string(worst->node) + " (most of it by " + worst->term + ")";
  return text;
}

}  // namespace coapt
