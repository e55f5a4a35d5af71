#include "optim/stability/equilibrium_watch.hpp"

#include "core/number_text.hpp"
#include "energy/normal_motion.hpp"
#include "energy/term_access.hpp"
#include "optim/stability/film_size.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace coapt {
namespace {

constexpr double kRoundOff = 1e-9;            // of a resultant, relative to the sum of the forces' magnitudes
constexpr int kInterval = 50;                 // iterates from one look to the next
constexpr double kFarDrift = 100;             // drift, relative to the extent of the start
constexpr double kCollapsed = 1e-2;           // area, relative to the start
constexpr double kPinched = 0.02;             // share of the film that has collapsed
constexpr double kPinchedFacets = 0.01;       // share of its facets, where nodes do not slide
constexpr double kNothing = 0.1;              // of its area is left
constexpr double kFarFromEquilibrium = 1e-2;  // residual above which a film may be pinching off
constexpr int kFilmInterval = 5;              // the same, of films whose nodes do not slide
constexpr int kCollapsedLooks = 4;            // looks in a row that have to see it
constexpr int kFilmLooks = 3;                 // the same, of films whose nodes do not slide

double facet_area(const Points& x, int a, int b, int c) {
  return 0.5 * Vec3(x.col(b) - x.col(a)).cross(Vec3(x.col(c) - x.col(a))).norm();
}

Vec3 centre(const Points& x, const std::vector<int>& nodes) {
  Vec3 sum = Vec3::Zero();
  for (const int node : nodes) sum += x.col(node);
  return sum / static_cast<double>(nodes.size());
}

// Whether nodes of films move along lines across them.
bool has_normal_motion(const Objective& objective, const Points& x) {
  std::vector<int> block;
  int blocks = 0;
  for (Eigen::Index node = 0; node < x.cols(); ++node)
    block.push_back(objective.fixed().col(node).all() ? -1 : blocks++);
  return !NormalMotion(objective.terms(), x, block, objective.fixed()).is_empty();
}

}  // namespace

EquilibriumWatch::EquilibriumWatch(const Objective& objective, const Vector& q)
    : reason_("the shape grows without bound") {
  const Points x = objective.positions(q);
  if (x.cols() == 0) return;
  extent_ = objective.extent(q);
  const std::vector<Part> parts = connected_parts(objective.terms(), x, objective.fixed());
  for (const Part& part : parts)
    if (part.can_shift_at_all()) adrift_.push_back({part.nodes, centre(x, part.nodes), part.description()});
  reason_ += adrift_.empty() ? ", the load is too much for it" : "; " + adrift_.front().name;
  if (!adrift_.empty()) find_obstacle(objective, x, parts);
  for (const auto& term : objective.terms()) {
    if (kind_of(*term) != TermKind::Film) continue;
    const std::vector<int>& nodes = term->stencils().nodes;
    for (size_t k = 0; k + 2 < nodes.size(); k += 3)
      film_.push_back(
          {nodes[k], nodes[k + 1], nodes[k + 2], facet_area(x, nodes[k], nodes[k + 1], nodes[k + 2])});
  }
  if (film_.empty()) return;
  slides_ = !has_normal_motion(objective, x);
  if (const auto films = free_films(objective, x); obstacle_.empty() && films && !films->has_pressure)
    obstacle_ = "nothing holds the film open, and it shrinks to nothing";
}

void EquilibriumWatch::find_obstacle(const Objective& objective, const Points& x,
                                     const std::vector<Part>& parts) {
  Points dead = Points::Zero(3, x.cols()), other = dead;
  for (const auto& term : objective.terms()) {
    if (term->role() == TermRole::Contact) return;
    if (term->role() == TermRole::Load)
      (term->stencils().width <= 1 ? dead : other) += nodal_forces(*term, x);
  }
  if (!dead.allFinite() || !other.allFinite()) return;
  for (const Part& part : parts) {
    Vec3 resultant = Vec3::Zero(), other_resultant = Vec3::Zero();
    double dead_sum = 0, other_sum = 0;
    for (const int node : part.nodes) {
      resultant += dead.col(node);
      other_resultant += other.col(node);
      dead_sum += dead.col(node).norm();
      other_sum += other.col(node).norm();
    }
    // Pressure on a closed surface has no resultant in any shape; on an open one it may balance the rest.
    if (other_resultant.norm() > kRoundOff * other_sum) continue;
    for (int c = 0; c < 3; ++c) {
      if (!part.can_shift[static_cast<size_t>(c)] || std::abs(resultant[c]) <= kRoundOff * dead_sum) continue;
      obstacle_ = part.description() + ", and nothing meets the resultant of its loads, " +
                  number_text(resultant[c]) + " along " + "xyz"[c];
      return;
    }
  }
}

bool EquilibriumWatch::has_drifted(const Points& x) {
  for (const Adrift& part : adrift_) {
    if ((centre(x, part.nodes) - part.start).norm() <= kFarDrift * extent_) continue;
    reason_ = part.name + ", and its loads carry it away";
    return true;
  }
  return false;
}

bool EquilibriumWatch::has_collapsed(const Points& x) {
  int gone = 0;
  double before = 0, now = 0, gone_before = 0;
  const Facet* first = nullptr;
  for (const Facet& f : film_) {
    const double area = facet_area(x, f.a, f.b, f.c);
    before += f.area;
    now += area;
    if (area >= kCollapsed * f.area) continue;
    if (first == nullptr) first = &f;
    ++gone;
    gone_before += f.area;
  }
  // A few facets without area tell of nodes that have slid together, not of the film.
  const bool is_a_waist = !slides_ && gone >= kPinchedFacets * static_cast<double>(film_.size());
  if (first == nullptr || (gone_before < kPinched * before && !is_a_waist)) return false;
  reason_ = now < kNothing * before
                ? "the film shrinks to nothing"
                : "the film pinches off: " + std::to_string(gone) +
                      " of its facets have shrunk to nothing, near node " + std::to_string(first->a);
  return true;
}

bool EquilibriumWatch::has_no_equilibrium(const Objective& objective, const Vector& q, double residual) {
  if (adrift_.empty() && film_.empty()) return false;
  if (!film_.empty() && residual < least_residual_) {
    least_residual_ = residual;
    nearest_ = q;
  }
  ++iterates_;
  const bool looks_at_films = iterates_ % (slides_ ? kInterval : kFilmInterval) == 0;
  if (iterates_ % kInterval != 0 && !looks_at_films) return false;
  const Points x = objective.positions(q);
  if (iterates_ % kInterval == 0 && has_drifted(x)) return true;
  if (!looks_at_films) return false;
  collapsed_ = residual > kFarFromEquilibrium && has_collapsed(x) ? collapsed_ + 1 : 0;
  return collapsed_ >= (slides_ ? kCollapsedLooks : kFilmLooks);
}

}  // namespace coapt
