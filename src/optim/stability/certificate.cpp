#include "optim/stability/certificate.hpp"

#include "core/number_text.hpp"
#include "energy/connected_parts.hpp"

#include <algorithm>
#include <cmath>

namespace coapt {
namespace {

constexpr double kNegligible = 1e-6;  // stiffness, relative to reference force over extent

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
         std::sqrt(reactions.colwise().squaredNorm().maxCoeff()) > 1e-3 * objective.reference_force(q);
}

// Numbers of the nodes of blocks of three unknowns.
std::vector<int> nodes_of(const std::vector<int>& blocks, const FixedMask& fixed) {
  std::vector<int> active, nodes;
  for (int node = 0; node < fixed.cols(); ++node)
    if (!fixed.col(node).all()) active.push_back(node);
  for (const int block : blocks) nodes.push_back(active[static_cast<size_t>(block)]);
  return nodes;
}

// What resists less, costs nothing beside the scene [force/length].
double negligible_stiffness(Objective& objective, const Vector& q, double tolerance) {
  const double extent = objective.extent(q);
  return extent > 0 ? std::max(kNegligible, 10 * tolerance) * objective.reference_force(q) / extent : 0;
}

StabilityReport stability_at(Objective& objective, const Vector& q, double tolerance,
                             const StabilityOptions& options) {
  StabilityReport report;
  if (objective.free_count() == 0) {
    report.verdict = Stability::NothingToCheck;
    return report;
  }
  if (objective.has_circulatory_force()) objective.set_path_anchor(q);
  Vector g;
  SparseMatrix h;
  objective.hessian(q, g, h, Projection::None);
  if (!g.allFinite() || !std::isfinite(h.sum())) return report;
  SkewProduct skew;
  if (objective.has_skew_tangent())
    skew = [&](const Vector& v, Vector& product) { objective.add_skew_product(v, product); };
  return classify_stability(h, skew, prescribed_unknowns(objective.fixed()),
                            negligible_stiffness(objective, q, tolerance), options);
}

std::string modes(int count, const std::string& kind) {
  return count < 0 ? kind + " modes that were not counted" : counted(count, kind + " mode");
}

std::string lowest_text(const StabilityReport& report) {
  std::string text = number_text(report.lowest.real(), 2);
  if (report.lowest.imag() != 0) text += " +- " + number_text(std::abs(report.lowest.imag()), 2) + " i";
  return text;
}

std::string stability_summary(const StabilityReport& report) {
  switch (report.verdict) {
    case Stability::NotKnown:
      return "stability not checked";
    case Stability::NothingToCheck:
      return "no free node has any stiffness";
    case Stability::StrictMinimum:
      return report.pivot_ratio > 0
                 ? "strict minimum (smallest pivot ratio " + number_text(report.pivot_ratio, 2) + ")"
                 : "strict minimum, just";
    case Stability::Stable:
      return "stable (lowest eigenvalue of the unsymmetric tangent " + lowest_text(report) + ")";
    case Stability::Flat:
      return "flat, with " + modes(report.zero_modes, "zero-energy");
    case Stability::Saddle:
      return "saddle, with " + modes(report.negative_modes, "negative");
    case Stability::Divergence:
      return "unstable by divergence (lowest eigenvalue of the unsymmetric tangent " + lowest_text(report) +
             ")";
    case Stability::Flutter:
      return "unstable by flutter (lowest eigenvalue of the unsymmetric tangent " + lowest_text(report) + ")";
    case Stability::NotDecided:
      return "stability not decided: the symmetric part of the tangent has " +
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
                    bool checks_stability) {
  Certificate certificate;
  certificate.is_made = true;
  certificate.is_conservative = !objective.has_circulatory_force();
  certificate.residual = objective.true_residual(q);
  certificate.balance = objective.balance(q);
  const Points x = objective.positions(q);
  certificate.is_balance_clear = has_clear_forces(objective, q);
  certificate.free_parts = free_parts(objective, x);
  const bool is_equilibrium = certificate.residual <= tolerance;
  if (!is_equilibrium) certificate.imbalance = largest_imbalance(objective, x);
  if (is_equilibrium && checks_stability && options.factorisation) {
    if (options.begins) options.begins();
    certificate.stability = stability_at(objective, q, tolerance, options);
    certificate.free_nodes = nodes_of(certificate.stability.free_blocks, objective.fixed());
  }
  return certificate;
}

std::string summary(const Certificate& certificate) {
  std::string text = stability_summary(certificate.stability);
  if (!certificate.free_nodes.empty())
    text += ", " + counted(static_cast<int>(certificate.free_nodes.size()), "free node");
  if (const double rest = std::max(certificate.balance.force, certificate.balance.moment);
      certificate.is_balance_clear && std::isfinite(rest))
    text += ", reactions balance to " + number_text(rest, 2);
  if (const auto& worst = certificate.imbalance; worst && !std::isfinite(worst->force))
    text += ", out-of-balance force not finite at node " + std::to_string(worst->node);
  else if (worst)
    text += ", largest out-of-balance force " + number_text(worst->force, 2) + " at node " +
            std::to_string(worst->node) + " (most of it by " + worst->term + ")";
  return text;
}

std::string stability_doubt(const Certificate& certificate) {
  const StabilityReport& report = certificate.stability;
  switch (report.verdict) {
    case Stability::NotKnown:
      return certificate.is_made ? "its Hessian is not finite" : "";
    case Stability::Saddle:
      return "a saddle of the energy, with " + modes(report.negative_modes, "negative");
    case Stability::Divergence:
      return "the follower load drives it away along " + modes(report.unstable_modes, "unstable");
    case Stability::Flutter:
      return "the follower load makes it flutter in " + modes(report.unstable_modes, "unstable");
    case Stability::NotDecided:
      return "the symmetric part of the tangent has " + modes(report.negative_modes, "negative") +
             ", and the lowest eigenvalues of the whole could not be found";
    default:
      return "";
  }
}

}  // namespace coapt
