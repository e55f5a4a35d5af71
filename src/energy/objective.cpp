#include "energy/objective.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace coapt {
namespace {

// Limits of stress: a hundred times the tension of a membrane that carries all loads along its width, and of
// a line that carries a tenth of them. From ten to three thousand times the iterations on four valves with
// moved tips scatter by a quarter; at once it sheets are too soft, and travel too far.
constexpr double kStressLimit = 100, kLineShare = 0.1;

constexpr double kBalanced = 1e-8;  // out-of-balance force over reaction of a prestressed reference state

double largest_column_norm(const Points& vectors) {
  return vectors.cols() == 0 ? 0 : std::sqrt(vectors.colwise().squaredNorm().maxCoeff());
}

}  // namespace

Objective::Objective(Points start, FixedMask fixed, std::vector<std::unique_ptr<EnergyTerm>> terms)
    : x_(std::move(start)), fixed_(std::move(fixed)), terms_(std::move(terms)), block_(x_.cols(), -1) {
  // Loads first: their nodal forces can then be read off before the internal forces join them.
  std::stable_partition(terms_.begin(), terms_.end(),
                        [](const auto& term) { return term->role() == TermRole::Load; });
  for (int node = 0; node < node_count(); ++node)
    if (!fixed_.col(node).all()) {
      block_[node] = static_cast<int>(active_.size());
      active_.push_back(node);
      free_count_ += 3 - static_cast<int>(fixed_.col(node).count());
    }
  nodal_gradient_.resize(3, x_.cols());
  normal_motion_ = NormalMotion(terms_, x_, block_, fixed_);
  keep_prestress_reaction();
}

void Objective::keep_prestress_reaction() {
  Points reaction = Points::Zero(3, node_count());
  Sink sink(reaction.data());
  for (const auto& term : terms_)
    if (term->role() == TermRole::Internal) term->evaluate(x_, sink);
  if (!reaction.allFinite()) return;
  const Points none = Points::Zero(3, node_count());
  const double unbalanced = largest_column_norm(fixed_.select(none, reaction));
  reaction = fixed_.select(reaction, none);
  // Only a prestress that is in equilibrium by itself is no measure of what the loads do.
  if (unbalanced < kBalanced * largest_column_norm(reaction)) prestress_reaction_ = std::move(reaction);
}

Vector Objective::unknowns(const Points& x) const {
  Vector q(unknown_count());
  for (size_t k = 0; k < active_.size(); ++k) q.segment<3>(3 * k) = x.col(active_[k]);
  return q;
}

Points Objective::positions(const Vector& q) const {
  Points x = x_;
  for (size_t k = 0; k < active_.size(); ++k)
    for (int c = 0; c < 3; ++c)
      if (!fixed_(c, active_[k])) x(c, active_[k]) = q[3 * k + c];
  return x;
}

double Objective::extent(const Vector& q) const {
  const Points x = positions(q);
  return x.cols() == 0 ? 0 : (x.rowwise().maxCoeff() - x.rowwise().minCoeff()).maxCoeff();
}

void Objective::scale(double load, double stiffness) {
  load_factor_ = load;
  stiffness_factor_ = stiffness;
}

bool Objective::round_kinks(double share) {
  bool has_kinks = false;
  for (const auto& term : terms_) has_kinks = term->round_kinks(share) || has_kinks;
  return has_kinks;
}

bool Objective::limit_stress(const Vector& q) {
  has_stress_limits_ = false;
  bool has_laws = false;
  for (const auto& term : terms_) has_laws = term->limit_stress({kInfinity, kInfinity}) || has_laws;
  if (!has_laws) return false;
  prepare(q);
  Points load = Points::Zero(3, node_count());
  for (const auto& term : terms_)
    if (term->role() == TermRole::Load) pour(*term, Sink(load.data()));
  const double force = load.colwise().norm().sum(), size = extent(q);
  if (!(force > 0 && size > 0 && std::isfinite(force))) return false;
  const TensionScale scale{kStressLimit * force / size, kStressLimit * kLineShare * force};
  for (const auto& term : terms_) term->limit_stress(scale);
  return has_stress_limits_ = true;
}

double Objective::raise_stress_limits(const Vector& q) {
  prepare(q);
  double excess = 0;
  for (const auto& term : terms_) excess = std::max(excess, term->raise_stress_limits(x_));
  return excess;
}

void Objective::release_stress_limits() {
  if (!has_stress_limits_) return;
  for (const auto& term : terms_) term->release_stress_limits();
  has_stress_limits_ = false;
}

double Objective::pour(const EnergyTerm& term, Sink sink) const {
  sink.set_factor(factor(term));
  return factor(term) * term.evaluate(x_, sink);
}

const EnergyTerm* Objective::step_limiting_term() const {
  const auto found =
      std::find_if(terms_.begin(), terms_.end(), [](const auto& term) { return term->limits_steps(); });
  return found == terms_.end() ? nullptr : found->get();
}

double Objective::step_limit(const Vector& q, const Vector& direction, double most) {
  if (step_limiting_term() == nullptr) return most;
  prepare(q);
  return step_limit(x_, nodal(direction), most);
}

Points Objective::nodal(const Vector& direction) const {
  Points d = Points::Zero(3, node_count());
  for (size_t k = 0; k < active_.size(); ++k)
    d.col(active_[k]) = fixed_.col(active_[k]).select(0, direction.segment<3>(3 * k).array());
  return d;
}

double Objective::step_limit(const Points& x, const Points& d, double most) {
  for (const auto& term : terms_)
    if (term->limits_steps()) most = std::min(most, term->step_limit(x, d, most));
  return most;
}

bool Objective::stiffen(const Vector& q) {
  prepare(q);
  bool is_stiffer = false;
  for (const auto& term : terms_) is_stiffer = term->stiffen(x_) || is_stiffer;
  if (is_stiffer) pattern_is_current_ = false;
  return is_stiffer;
}

void Objective::prescribe(const Points& x) { x_ = fixed_.select(x, x_); }

void Objective::prepare(const Vector& q) {
  for (size_t k = 0; k < active_.size(); ++k)
    for (int c = 0; c < 3; ++c)
      if (!fixed_(c, active_[k])) x_(c, active_[k]) = q[3 * k + c];
  for (const auto& term : terms_)
    if (term->prepare(x_)) pattern_is_current_ = false;
}

void Objective::renew_pattern() {
  if (pattern_is_current_) return;
  pattern_ = HessianPattern(terms_, block_, static_cast<int>(active_.size()), fixed_);
  pattern_is_current_ = true;
  ++pattern_version_;
}

// The free part of a nodal gradient becomes the unknowns' gradient; the rest is the reactions.
void Objective::split(const Points& nodal, Vector& free_part) {
  free_part.resize(unknown_count());
  double reaction = 0, whole_reaction = 0;
  const bool is_relative = load_scale_ > 0 && prestress_reaction_.size() != 0;
  for (int node = 0; node < node_count(); ++node) {
    Vec3 free = nodal.col(node), held = Vec3::Zero();
    for (int c = 0; c < 3; ++c)
      if (fixed_(c, node)) std::swap(free[c], held[c]);
    whole_reaction = std::max(whole_reaction, held.squaredNorm());
    if (is_relative) held -= stiffness_factor_ * prestress_reaction_.col(node);
    reaction = std::max(reaction, held.squaredNorm());
    if (block_[node] >= 0) free_part.segment<3>(3 * block_[node]) = free;
  }
  sliding_force_ = normal_motion_.restrict_gradient(free_part);
  reaction_scale_ = std::sqrt(reaction);
  whole_reaction_scale_ = std::sqrt(whole_reaction);
}

double Objective::evaluate(const Vector& q, Vector* g, Eigen::SparseMatrix<double>* h,
                           Projection projection) {
  prepare(q);
  if (h != nullptr) {
    renew_pattern();
    if (h->nonZeros() != pattern_.zero_matrix().nonZeros() || h->rows() != unknown_count() ||
        !std::equal(h->innerIndexPtr(), h->innerIndexPtr() + h->nonZeros(),
                    pattern_.zero_matrix().innerIndexPtr()))
      *h = pattern_.zero_matrix();
    else
      std::fill_n(h->valuePtr(), h->nonZeros(), 0.0);
  }
  double* gradient = g == nullptr ? nullptr : nodal_gradient_.data();
  if (gradient != nullptr) nodal_gradient_.setZero();

  double energy = 0;
  if (circulatory_ == Circulatory::HeldDead) {
    energy = -remainder_.cwiseProduct(x_).sum();
    if (gradient != nullptr) nodal_gradient_ = -remainder_;
  } else if (circulatory_ == Circulatory::PathWork) {
    energy = -work_ - path_work();
    if (gradient != nullptr) nodal_gradient_ = -force_;
  }
  bool loads_are_complete = false;
  const auto read_off_loads = [&] {
    if (gradient != nullptr && !loads_are_complete) {
      double largest = 0;
      for (int node : active_) largest = std::max(largest, nodal_gradient_.col(node).squaredNorm());
      load_scale_ = std::sqrt(largest);
    }
    loads_are_complete = true;
  };
  for (size_t k = 0; k < terms_.size(); ++k) {
    if (terms_[k]->role() != TermRole::Load) read_off_loads();
    energy +=
        pour(*terms_[k], h != nullptr ? Sink(gradient, h->valuePtr(), pattern_.slots(k), projection, threads_)
                                      : Sink(gradient));
  }
  read_off_loads();
  if (h != nullptr) {
    skew_.clear();
    if (circulatory_ == Circulatory::PathWork) add_circulatory_tangent(*h);
    pattern_.mask(*h);
    if (!normal_motion_.is_empty()) normal_motion_.restrict_hessian(*h);
  }
  if (gradient == nullptr) return energy;

  split(nodal_gradient_, *g);
  if (counts_.gradient + counts_.hessian == 0) {
    first_scale_ = largest_column_norm(nodal_gradient_);
    if (load_scale_ == 0) strained_scale_ = strained_force();
  }
  return energy;
}

double Objective::value(const Vector& q) {
  const double energy = evaluate(q, nullptr, nullptr, Projection::None);
  ++counts_.value;
  return energy;
}

double Objective::gradient(const Vector& q, Vector& g) {
  const double energy = evaluate(q, &g, nullptr, Projection::None);
  ++counts_.gradient;
  return energy;
}

double Objective::hessian(const Vector& q, Vector& g, Eigen::SparseMatrix<double>& h, Projection projection) {
  const double energy = evaluate(q, &g, &h, projection);
  ++counts_.hessian;
  return energy;
}

// Largest change of the internal forces when the body grows by one part in a million.
double Objective::strained_force() const {
  if (x_.cols() == 0) return 0;
  const Vec3 centre = x_.rowwise().mean();
  const Points grown = ((x_.colwise() - centre) * (1 + 1e-3)).colwise() + centre;
  Points change = Points::Zero(3, x_.cols());
  Points before = change;
  Sink after_sink(change.data()), before_sink(before.data());
  for (const auto& term : terms_) {
    if (term->role() != TermRole::Internal) continue;
    term->evaluate(grown, after_sink);
    term->evaluate(x_, before_sink);
  }
  const double force = largest_column_norm(change - before);
  return std::isfinite(force) ? 1e-3 * force : 0;  // the growth by 1e-3 stands clear of round-off
}

double Objective::reference_force() const {
  if (given_scale_ > 0) return given_scale_;
  if (load_scale_ > 0) return std::max(load_scale_, reaction_scale_);
  return std::max({strained_scale_, reaction_scale_, reaction_scale_ > 0 ? 0 : first_scale_});
}

double Objective::relative_residual(const Vector& g) const {
  if (!g.allFinite()) return kInfinity;
  double largest = 0;
  for (Eigen::Index k = 0; k < g.size(); k += 3) largest = std::max(largest, g.segment<3>(k).squaredNorm());
  if (largest == 0) return 0;
  return std::sqrt(largest) / reference_force();
}

bool Objective::has_circulatory_force() const {
  return std::any_of(terms_.begin(), terms_.end(),
                     [](const auto& term) { return term->has_circulatory_force(); });
}

void Objective::circulatory_force(const Points& x, Points& force) const {
  force.setZero(3, node_count());
  for (const auto& term : terms_) term->add_circulatory_force(x, force);
  force *= load_factor_;
}

double Objective::path_work() {
  middle_ = 0.5 * (anchor_ + x_);
  circulatory_force(middle_, force_);
  double work = 4 * force_.cwiseProduct(x_ - anchor_).sum();
  circulatory_force(x_, force_);
  work += (remainder_ + force_).cwiseProduct(x_ - anchor_).sum();
  return work / 6;
}

// The tangent K of the gradient is split in halves: (K + K^T) / 2 goes into the Hessian, the skew rest is
// kept.
void Objective::add_circulatory_tangent(Eigen::SparseMatrix<double>& h) {
  for (const auto& term : terms_) term->add_circulatory_tangent(x_, skew_);
  std::erase_if(skew_, [&](TangentBlock& block) {
    block.row = block_[block.row];
    block.column = block_[block.column];
    block.value *= -0.5 * load_factor_;  // the gradient is minus the force
    return block.row < 0 || block.column < 0;
  });
  const auto add = [&](int row, int column, const Eigen::Matrix3d& value) {
    const BlockSlot slot = pattern_.slot(row, column);
    if (slot.base < 0) return;
    for (int c = 0; c < 3; ++c)
      for (int r = 0; r < 3; ++r) h.valuePtr()[slot.base + c * slot.stride + r] += value(r, c);
  };
  for (const TangentBlock& block : skew_) {
    add(block.row, block.column, block.value);
    add(block.column, block.row, block.value.transpose());
  }
}

void Objective::add_skew_product(const Vector& v, Vector& product) const {
  for (const TangentBlock& block : skew_) {
    product.segment<3>(3 * block.row) += block.value * v.segment<3>(3 * block.column);
    product.segment<3>(3 * block.column) -= block.value.transpose() * v.segment<3>(3 * block.row);
  }
  for (const int unknown : pattern_.masked()) product[unknown] = 0;
}

void Objective::hold_dead(const Vector& q) {
  prepare(q);
  for (const auto& term : terms_)
    if (term->has_circulatory_force() && term->renew(x_)) pattern_is_current_ = false;
  circulatory_ = Circulatory::HeldDead;
  circulatory_force(x_, remainder_);
}

void Objective::follow_path(const Vector& q) {
  prepare(q);
  for (const auto& term : terms_)
    if (term->simplify()) pattern_is_current_ = false;
  circulatory_ = Circulatory::PathWork;
  circulatory_force(x_, remainder_);
  anchor_ = x_;
  work_ = 0;
}

void Objective::advance(const Vector& q) {
  if (circulatory_ != Circulatory::PathWork) return;
  prepare(q);
  work_ += path_work();
  std::swap(remainder_, force_);
  anchor_ = x_;
}

Points Objective::exact_gradient(const Vector& q) {
  prepare(q);
  Points g = Points::Zero(3, node_count());
  for (const auto& term : terms_) pour(*term, Sink(g.data()));
  Points force;
  circulatory_force(x_, force);
  return g - force;
}

double Objective::true_residual(const Vector& q) {
  Vector g;
  gradient(q, g);  // sets the reference force
  if (!has_circulatory_force()) return relative_residual(g);
  split(exact_gradient(q), g);
  return relative_residual(g);
}

std::vector<TermReport> Objective::breakdown(const Vector& q) {
  prepare(q);
  std::vector<TermReport> reports;
  for (const auto& term : terms_) {
    nodal_gradient_.setZero();
    const double energy = pour(*term, Sink(nodal_gradient_.data()));
    if (term->has_circulatory_force()) {
      Points force = Points::Zero(3, node_count());
      term->add_circulatory_force(x_, force);
      nodal_gradient_ -= load_factor_ * force;
    }
    reports.push_back({term->name(), std::string(term->type()), energy, largest_column_norm(nodal_gradient_),
                       term->counters()});
  }
  return reports;
}

Points Objective::reactions(const Vector& q) {
  const Points g = exact_gradient(q);
  return fixed_.select(g, Points::Zero(3, node_count()));
}

Balance Objective::balance(const Vector& q) {
  const Points support = reactions(q);
  Points load = Points::Zero(3, node_count());
  for (const auto& term : terms_)
    if (term->role() == TermRole::Load) pour(*term, Sink(load.data()));
  Points circulatory;
  circulatory_force(x_, circulatory);
  load -= circulatory;
  load = -load;  // the force on the nodes is minus the gradient of the potential
  const Vec3 centre = x_.cols() == 0 ? Vec3::Zero() : Vec3(x_.rowwise().mean());
  Vec3 force = Vec3::Zero(), moment = Vec3::Zero();
  double force_sum = 0, moment_sum = 0;
  for (int node = 0; node < node_count(); ++node) {
    const Vec3 arm = x_.col(node) - centre, f = load.col(node) + support.col(node);
    force += f;
    moment += arm.cross(f);
    force_sum += load.col(node).norm() + support.col(node).norm();
    moment_sum += arm.norm() * (load.col(node).norm() + support.col(node).norm());
  }
  return {force_sum > 0 ? force.norm() / force_sum : 0, moment_sum > 0 ? moment.norm() / moment_sum : 0};
}

}  // namespace coapt
