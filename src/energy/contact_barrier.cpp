#include "energy/contact_barrier.hpp"

#include "core/error.hpp"
#include "energy/contact/collision_detection.hpp"
#include "energy/contact/contact_surface.hpp"
#include "mesh/triangle_mesh.hpp"

#include <algorithm>
#include <cmath>

namespace coapt {
namespace {

constexpr double kSkin = 0.25;         // of the gap: candidates are found this much ahead
constexpr double kShareOfRest = 0.5;   // of the distance at rest, which the range never exceeds
constexpr double kParallel = 1e-3;     // sin^2 of the angle below which two edges count as parallel
constexpr double kKeptDistance = 0.2;  // share of its distance that a pair keeps in one step
constexpr double kTooClose = 1e-2;     // of the range: closer than this the barrier is too soft
constexpr double kStiffening = 10;

Triangles side_by_side(const Triangles& a, const Triangles& b) {
  Triangles both(3, a.cols() + b.cols());
  both << a, b;
  return both;
}

class ContactBarrier final : public EnergyTerm {
 public:
  ContactBarrier(std::string name, const Points& X, const Triangles& triangles,
                 const ContactBarrierOptions& options)
      : EnergyTerm(std::move(name)),
        surface_(X, side_by_side(triangles, options.obstacles), static_cast<int>(triangles.cols()),
                 options.excluded),
        gap_(options.gap),
        skin_(kSkin * options.gap),
        pressure_(options.pressure) {
    stencils_.width = 4;
  }

  std::string_view type() const override { return "contact_barrier"; }
  TermRole role() const override { return TermRole::Contact; }
  const Stencils& stencils() const override { return stencils_; }
  TermCounters counters() const override { return {active_pairs_, stencils_.count(), searches_}; }

  bool prepare(const Points& x) override {
    if (is_within_skin(x)) return false;
    search(x);
    return true;
  }

  double evaluate(const Points& x, Sink& sink) const override {
    double energy = 0;
    active_pairs_ = 0;
    PairVector g;
    PairMatrix H;
    PairVector* wanted_g = sink.wants_gradient() ? &g : nullptr;
    PairMatrix* wanted_h = sink.wants_hessian() ? &H : nullptr;
    for (size_t k = 0; k < rest_.size(); ++k) {
      const int* nodes = &stencils_.nodes[4 * k];
      const PairCorners corners = gather(x, nodes);
      const ClosestPair closest = closest_points(rest_[k].kind, corners);
      if (closest.distance >= rest_[k].range) continue;
      ++active_pairs_;
      energy +=
          pressure_ * evaluate_barrier(rest_[k], corners, closest, sink.projection(), wanted_g, wanted_h);
      if (wanted_g == nullptr) continue;
      g *= pressure_;
      for (int a = 0; a < 4; ++a) sink.add_gradient(nodes[a], g.segment<3>(3 * a));
      if (wanted_h == nullptr) continue;
      H *= pressure_;
      for (int a = 0; a < 4; ++a)
        for (int b = 0; b < 4; ++b)
          sink.add_block(16 * static_cast<long>(k), 4, a, b, H.block<3, 3>(3 * a, 3 * b));
    }
    return energy;
  }

  std::vector<BarrierContact> contacts(const Points& x) const {
    std::vector<BarrierContact> found;
    for (size_t k = 0; k < rest_.size(); ++k) {
      const int* nodes = &stencils_.nodes[4 * k];
      const ClosestPair closest = closest_points(rest_[k].kind, gather(x, nodes));
      if (closest.distance >= rest_[k].range) continue;
      BarrierContact contact{{nodes[0], nodes[1], nodes[2], nodes[3]},
                             rest_[k].kind == PairKind::EdgeEdge,
                             0,
                             closest.distance,
                             rest_[k].range};
      for (int a = 0; a < 4; ++a)
        if (closest.weights[a] != 0) contact.inside |= 1 << a;
      found.push_back(contact);
    }
    return found;
  }

  bool limits_steps() const override { return true; }

  double step_limit(const Points& x, const Points& d, double most) const override {
    double limit = most;
    visit_moving(x, d, limit, [&](PairKind kind, const int* nodes) {
      limit = std::min(limit, pair_step(kind, gather(x, nodes), gather(d, nodes), limit));
    });
    return limit;
  }

  bool stiffen(const Points& x) override {
    prepare(x);
    bool is_too_soft = false;
    for (size_t k = 0; k < rest_.size() && !is_too_soft; ++k)
      is_too_soft = closest_points(rest_[k].kind, gather(x, &stencils_.nodes[4 * k])).distance <
                    kTooClose * rest_[k].range;
    if (is_too_soft) pressure_ *= kStiffening;
    return is_too_soft;
  }

 private:
  static PairCorners gather(const Points& x, const int* nodes) {
    PairCorners corners;
    for (int a = 0; a < 4; ++a) corners.col(a) = x.col(nodes[a]);
    return corners;
  }

  static double pair_step(PairKind kind, const PairCorners& x, const PairCorners& d, double most) {
    return kind == PairKind::PointTriangle ? point_triangle_step(x, d, most, kKeptDistance)
                                           : edge_edge_step(x, d, most, kKeptDistance);
  }

  // Visits the pairs that may collide while x moves to x + s d, 0 <= s <= most; `most` may fall meanwhile.
  template <class Visit>
  void visit_moving(const Points& x, const Points& d, const double& most, const Visit& visit) const {
    if (is_within_skin(x) && is_within_skin(x + most * d)) {
      for (size_t k = 0; k < rest_.size(); ++k) visit(rest_[k].kind, &stencils_.nodes[4 * k]);
    } else {
      surface_.visit_swept(x, d, 0, most,
                           [&](const FeaturePair& pair) { visit(pair.kind, pair.nodes.data()); });
    }
  }

  // A pair can come within range only after its nodes have moved by half the skin each.
  bool is_within_skin(const Points& x) const {
    return searched_at_.size() != 0 &&
           (x - searched_at_).colwise().squaredNorm().maxCoeff() <= 0.25 * skin_ * skin_;
  }

  void search(const Points& x) {
    ++searches_;
    searched_at_ = x;
    rest_.clear();
    stencils_.nodes.clear();
    surface_.visit_near(x, gap_ + skin_, [&](const FeaturePair& pair) {
      const double distance = closest_points(pair.kind, gather(x, pair.nodes.data())).distance;
      if (distance >= gap_ + skin_) return;
      const PairCorners at_rest = gather(surface_.rest(), pair.nodes.data());
      const double range = std::min(gap_, kShareOfRest * closest_points(pair.kind, at_rest).distance);
      if (distance >= range + skin_) return;
      const double lengths =
          (at_rest.col(1) - at_rest.col(0)).squaredNorm() * (at_rest.col(3) - at_rest.col(2)).squaredNorm();
      rest_.push_back({pair.kind, range, surface_.area(pair) * range, kParallel * lengths});
      stencils_.nodes.insert(stencils_.nodes.end(), pair.nodes.begin(), pair.nodes.end());
    });
  }

  ContactSurface surface_;
  double gap_, skin_;
  double pressure_;
  Stencils stencils_;              // the candidates' nodes
  std::vector<BarrierRest> rest_;  // of the candidates, per unit of pressure
  Points searched_at_;
  long searches_ = 0;
  mutable long active_pairs_ = 0;  // a counter for reports, never read by an evaluation
};

}  // namespace

std::vector<BarrierContact> barrier_contacts(const EnergyTerm& term, const Points& x) {
  const auto* barrier = dynamic_cast<const ContactBarrier*>(&term);
  return barrier == nullptr ? std::vector<BarrierContact>{} : barrier->contacts(x);
}

std::unique_ptr<EnergyTerm> make_contact_barrier(std::string name, const Points& X,
                                                 const Triangles& triangles,
                                                 const ContactBarrierOptions& options) {
  std::vector<std::string> defects;
  const auto require = [&](bool condition, const std::string& what) {
    if (!condition) defects.push_back("term \"" + name + "\": " + what);
  };
  require(options.gap > 0 && std::isfinite(options.gap), "gap must be positive");
  require(options.pressure > 0 && std::isfinite(options.pressure), "pressure must be positive");
  if (!defects.empty()) throw InputError(defects);
  return std::make_unique<ContactBarrier>(std::move(name), X, triangles, options);
}

}  // namespace coapt
