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

}  // namespace

Objective::Objective(Points start, FixedMask fixed, std::vector<std::unique_ptr<EnergyTerm>> terms)
    : x_(std::move(start)),
      fixed_(std::move(fixed)),
      terms_(std::move(terms)),
      block_(x_.cols(), -1),
      reference_(x_) {
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
  measure_reference();
}

Vector Objective::unknowns(const Points& x) const {
  Vector q;
  unknowns(x, q);
  return q;
}

void Objective::unknowns(const Points& x, Vector& q) const {
  q.resize(unknown_count());
  for (size_t k = 0; k < active_.size(); ++k) q.segment<3>(3 * k) = x.col(active_[k]);
}

Points Objective::positions(const Vector& q) const {
  Points x;
  positions(q, x);
  return x;
}

void Objective::positions(const Vector& q, Points& x) const {
  x = x_;
  for (size_t k = 0; k < active_.size(); ++k)
    for (int c = 0; c < 3; ++c)
      if (!fixed_(c, active_[k])) x(c, active_[k]) = q[3 * k + c];
}

double Objective::extent(const Vector& q) const {
  const Points x = positions(q);
  return x.cols() == 0 ? 0 : (x.rowwise().maxCoeff() - x.rowwise().minCoeff()).maxCoeff();
}

void Objective::scale(double load, double stiffness) {
  load_factor_ = load;
  stiffness_factor_ = stiffness;
  scale_is_current_ = false;
}

void Objective::damp(const Vector& coefficients, const Vector& from) {
  damping_ = coefficients;
  damped_from_ = from;
  for (size_t k = 0; is_damped() && k < active_.size(); ++k)
    damping_.segment<3>(3 * k) = fixed_.col(active_[k]).select(0, damping_.segment<3>(3 * k).array());
}

// Their energy at q; adds their force and stiffness where asked.
double Objective::add_dampers(const Vector& q, Vector* g, Eigen::SparseMatrix<double>* h) const {
  const Vector moved = q - damped_from_;
  if (g != nullptr) *g += damping_.cwiseProduct(moved);
  for (int block = 0; h != nullptr && 3 * block < damping_.size(); ++block) {
    const BlockSlot slot = pattern_.slot(block, block);
    for (int c = 0; c < 3; ++c) h->valuePtr()[slot.base + c * slot.stride + c] += damping_[3 * block + c];
  }
  return 0.5 * damping_.dot(moved.cwiseAbs2());
}

bool Objective::round_kinks(double share) {
  bool has_kinks = false;
  for (const auto& term : terms_) has_kinks = term->round_kinks(share) || has_kinks;
  scale_is_current_ = false;
  return has_kinks;
}

bool Objective::limit_stress(const Vector& q) {
  has_stress_limits_ = scale_is_current_ = false;
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
  scale_is_current_ = false;
  double excess = 0;
  for (const auto& term : terms_) excess = std::max(excess, term->raise_stress_limits(x_));
  return excess;
}

void Objective::release_stress_limits() {
  if (!has_stress_limits_) return;
  for (const auto& term : terms_) term->release_stress_limits();
  has_stress_limits_ = scale_is_current_ = false;
}

void Objective::use_threads(int count) {
  team_ = std::make_shared<ThreadTeam>(count);
  pattern_is_current_ = false;
  sink_parts_.clear();  // come with the pattern
  for (const auto& term : terms_) term->use_threads(team_);
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

bool Objective::escalate_stiffness(const Vector& q) {
  prepare(q);
  bool is_stiffer = false;
  for (const auto& term : terms_) is_stiffer = term->escalate_stiffness(x_) || is_stiffer;
  if (is_stiffer) pattern_is_current_ = scale_is_current_ = false;
  return is_stiffer;
}

void Objective::restore_stiffness() {
  for (const auto& term : terms_)
    if (term->restore_stiffness()) pattern_is_current_ = scale_is_current_ = false;
}

void Objective::prescribe(const Points& x) {
  x_ = fixed_.select(x, x_);
  scale_is_current_ = false;
}

void Objective::prepare(const Vector& q) {
  for (size_t k = 0; k < active_.size(); ++k)
    for (int c = 0; c < 3; ++c)
      if (!fixed_(c, active_[k])) x_(c, active_[k]) = q[3 * k + c];
  for (const auto& term : terms_)
    if (term->prepare(x_))
      (term->role() == TermRole::Contact ? pairs_are_current_ : pattern_is_current_) = false;
}

void Objective::update_pattern() {
  if (pattern_is_current_ && pairs_are_current_) return;
  if (pattern_is_current_)
    pattern_.renew_pairs(terms_);
  else
    pattern_ = HessianPattern(terms_, block_, static_cast<int>(active_.size()), fixed_);
  pattern_is_current_ = pairs_are_current_ = true;
  ++pattern_version_;
  part_sink();
}

// One part for each thread, with alike numbers of values.
void Objective::part_sink() {
  const int* outer = pattern_.zero_matrix().outerIndexPtr();
  const auto values = static_cast<double>(pattern_.zero_matrix().nonZeros());
  sink_parts_.assign(static_cast<size_t>(team_->size()), {});
  unsigned first_node = 0, first_value = 0;
  for (int k = 0; k < team_->size(); ++k) {
    size_t block = active_.size();
    if (k + 1 < team_->size())
      for (block = 0; block < active_.size() && outer[3 * block] < values * (k + 1) / team_->size();) ++block;
    const bool is_last = block == active_.size();
    const auto end_node = static_cast<unsigned>(is_last ? node_count() : active_[block]);
    const auto end_value = static_cast<unsigned>(outer[3 * block]);
    sink_parts_[static_cast<size_t>(k)] = {first_node, end_node - first_node, first_value,
                                           end_value - first_value};
    first_node = end_node;
    first_value = end_value;
  }
}

// The free part of a nodal gradient becomes the unknowns' gradient; the rest is the reactions.
void Objective::split(const Points& nodal, Vector& free) {
  free.resize(unknown_count());
  for (size_t k = 0; k < active_.size(); ++k)
    free.segment<3>(3 * k) = fixed_.col(active_[k]).select(0, nodal.col(active_[k]).array());
  sliding_force_ = normal_motion_.restrict_gradient(free);
  scale_.measure_reactions(nodal, fixed_, stiffness_factor_);
}

double Objective::evaluate(const Vector& q, Vector* g, Eigen::SparseMatrix<double>* h,
                           Projection projection) {
  prepare(q);
  if (h != nullptr) {
    update_pattern();
    if (h->nonZeros() != pattern_.zero_matrix().nonZeros() || h->rows() != unknown_count() ||
        !std::equal(h->innerIndexPtr(), h->innerIndexPtr() + h->nonZeros(),
                    pattern_.zero_matrix().innerIndexPtr()))
      *h = pattern_.zero_matrix();
    else
      std::fill_n(h->valuePtr(), h->nonZeros(), 0.0);
  }
  double* gradient = g == nullptr ? nullptr : nodal_gradient_.data();
  if (gradient != nullptr) {
    measure_reference();
    nodal_gradient_.setZero();
    scale_is_current_ = false;
  }

  double energy = 0;
  if (circulatory_ == Circulatory::Lagged) {
    energy = -remainder_.cwiseProduct(x_).sum();
    if (gradient != nullptr) nodal_gradient_ = -remainder_;
  } else if (circulatory_ == Circulatory::PathWork) {
    energy = -work_ - path_work();
    if (gradient != nullptr) nodal_gradient_ = -force_;
  }
  bool loads_are_complete = false;
  const auto read_off_loads = [&] {
    if (gradient != nullptr && !loads_are_complete) scale_.measure_loads(nodal_gradient_, fixed_);
    loads_are_complete = true;
  };
  for (size_t k = 0; k < terms_.size(); ++k) {
    if (terms_[k]->role() != TermRole::Load) read_off_loads();
    Sink sink = h != nullptr ? Sink(gradient, h->valuePtr(), pattern_.slots(k), projection) : Sink(gradient);
    if (!sink_parts_.empty()) sink.share(team_.get(), &sink_parts_);
    energy += pour(*terms_[k], sink);
  }
  read_off_loads();
  if (h != nullptr) {
    skew_.clear();
    if (circulatory_ == Circulatory::PathWork) add_circulatory_tangent(*h);
    pattern_.mask(*h);
    if (!normal_motion_.is_empty()) normal_motion_.restrict_hessian(*h);
  }
  if (gradient != nullptr) split(nodal_gradient_, *g);
  if (is_damped()) energy += add_dampers(q, g, h);
  if (gradient == nullptr) return energy;

  scale_at_ = q;
  scale_is_current_ = true;
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

void Objective::lag_circulatory_force(const Vector& q) {
  prepare(q);
  for (const auto& term : terms_)
    if (term->has_circulatory_force() && term->rebuild_potential(x_)) pattern_is_current_ = false;
  scale_is_current_ = false;
  circulatory_ = Circulatory::Lagged;
  circulatory_force(x_, remainder_);
}

void Objective::set_path_anchor(const Vector& q) {
  prepare(q);
  for (const auto& term : terms_)
    if (term->simplify()) pattern_is_current_ = false;
  scale_is_current_ = false;
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

}  // namespace coapt
