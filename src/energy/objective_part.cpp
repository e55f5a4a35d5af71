#include "energy/moving_part.hpp"
#include "energy/objective.hpp"

namespace coapt {

std::unique_ptr<Objective> Objective::part(const Vector& q, const std::vector<int>& blocks, double reach) {
  if (circulatory_ == Circulatory::Lagged || !normal_motion_.is_empty()) return nullptr;
  prepare(q);
  std::vector<int> nodes;
  for (const int block : blocks) nodes.push_back(active_[static_cast<size_t>(block)]);
  MovingPart moving(x_, std::move(nodes), reach);
  std::vector<std::unique_ptr<EnergyTerm>> terms;
  for (const auto& term : terms_) {
    terms.push_back(term->part(moving));
    if (terms.back() == nullptr) return nullptr;
  }
  FixedMask fixed = FixedMask::Constant(3, static_cast<Eigen::Index>(moving.nodes().size()), true);
  for (int k = 0; k < moving.moving_count(); ++k)
    fixed.col(k) = fixed_.col(moving.nodes()[static_cast<size_t>(k)]);
  auto part = std::make_unique<Objective>(x_(Eigen::all, moving.nodes()), std::move(fixed), std::move(terms));
  part->normal_motion_ = {};
  part->load_factor_ = load_factor_;
  part->stiffness_factor_ = stiffness_factor_;
  if (is_damped()) {
    Vector damping(part->unknown_count()), from(part->unknown_count());
    for (size_t k = 0; k < blocks.size(); ++k) {
      damping.segment<3>(3 * k) = damping_.segment<3>(3 * blocks[k]);
      from.segment<3>(3 * k) = damped_from_.segment<3>(3 * blocks[k]);
    }
    part->damp(damping, from);
  }
  part->scale_.give(reference_force(q));
  if (circulatory_ == Circulatory::PathWork) part->set_path_anchor(part->unknowns(part->x_));
  return part;
}

}  // namespace coapt
