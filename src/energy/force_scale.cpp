#include "energy/force_scale.hpp"

#include <cmath>

namespace coapt {
namespace {

constexpr double kBalanced = 1e-8;  // out-of-balance force over reaction of a prestressed reference state
constexpr double kGrowth = 1e-3;    // of the body, at which its stiffness is read off: clear of round-off

// The strain whose forces are the scale of a body without loads: of one that is held the least, beside its
// reactions; of one that is free, which has none, a strain as great as a small deformation. A minimiser of
// first order brings a free sheet to some 1e-12 of the force of a strain of 1.
constexpr double kHeldStrain = 1e-6, kFreeStrain = 1e-3;

// Gradient of all terms that are, or are not, loads.
Points gradient_of(const std::vector<std::unique_ptr<EnergyTerm>>& terms, TermRole role, const Points& x) {
  Points gradient = Points::Zero(3, x.cols());
  Sink sink(gradient.data());
  for (const auto& term : terms)
    if (term->role() == role) term->evaluate(x, sink);
  return gradient;
}

bool feels_load(const std::vector<std::unique_ptr<EnergyTerm>>& terms, const Points& X,
                const FixedMask& fixed) {
  Points load = gradient_of(terms, TermRole::Load, X), circulatory = Points::Zero(3, X.cols());
  for (const auto& term : terms) term->add_circulatory_force(X, circulatory);
  load -= circulatory;
  for (Eigen::Index node = 0; node < X.cols(); ++node)
    if (!fixed.col(node).all() && !load.col(node).isZero(0)) return true;
  return false;
}

}  // namespace

double largest_column_norm(const Points& vectors) {
  return vectors.cols() == 0 ? 0 : std::sqrt(vectors.colwise().squaredNorm().maxCoeff());
}

void ForceScale::measure_reference(const std::vector<std::unique_ptr<EnergyTerm>>& terms, const Points& X,
                                   const FixedMask& fixed) {
  prestress_reaction_.resize(3, 0);
  rest_ = 0;
  const Points internal = gradient_of(terms, TermRole::Internal, X), none = Points::Zero(3, X.cols());
  if (!internal.allFinite()) return;
  Points reaction = fixed.select(internal, none);
  const double unbalanced = largest_column_norm(fixed.select(none, internal));
  // Only a prestress that is in equilibrium by itself is no measure of what the loads do.
  if (unbalanced < kBalanced * largest_column_norm(reaction)) prestress_reaction_ = std::move(reaction);

  if (X.cols() == 0 || feels_load(terms, X, fixed)) return;
  const Vec3 centre = X.rowwise().mean();
  const Points grown = ((X.colwise() - centre) * (1 + kGrowth)).colwise() + centre;
  const double force = largest_column_norm(gradient_of(terms, TermRole::Internal, grown) - internal);
  if (std::isfinite(force)) rest_ = (fixed.any() ? kHeldStrain : kFreeStrain) / kGrowth * force;
}

void ForceScale::measure_loads(const Points& gradient, const FixedMask& fixed) {
  double largest = 0;
  for (Eigen::Index node = 0; node < gradient.cols(); ++node)
    if (!fixed.col(node).all()) largest = std::max(largest, gradient.col(node).squaredNorm());
  load_ = std::sqrt(largest);
}

void ForceScale::measure_reactions(const Points& gradient, const FixedMask& fixed, double stiffness) {
  double reaction = 0, whole = 0;
  const bool is_relative = load_ > 0 && prestress_reaction_.cols() != 0;
  for (Eigen::Index node = 0; node < gradient.cols(); ++node) {
    Vec3 held = fixed.col(node).select(gradient.col(node), Vec3::Zero());
    whole = std::max(whole, held.squaredNorm());
    if (is_relative) held -= stiffness * prestress_reaction_.col(node);
    reaction = std::max(reaction, held.squaredNorm());
  }
  reaction_ = std::sqrt(reaction);
  whole_reaction_ = std::sqrt(whole);
  stiffness_ = stiffness;
}

double ForceScale::force() const {
  if (given_ > 0) return given_;
  return std::max(load_ > 0 ? load_ : stiffness_ * rest_, reaction_);
}

}  // namespace coapt
