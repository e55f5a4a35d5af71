#include "energy/contact_barrier.hpp"

#include "core/error.hpp"
#include "energy/contact/collision_detection.hpp"
#include "energy/contact/contact_surface.hpp"
#include "energy/pour_elements.hpp"
#include "energy/term_access.hpp"
#include "mesh/triangle_mesh.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <optional>

namespace coapt {
namespace {

constexpr size_t kShare = 1024;        // pairs that a thread takes at once in a search
constexpr double kSkin = 0.25;         // of the gap: candidates are found this much ahead
constexpr double kShareOfRest = 0.5;   // of the distance at rest, which the range never exceeds
constexpr double kParallel = 1e-3;     // sin^2 of the angle below which two edges count as parallel
constexpr double kKeptDistance = 0.2;  // share of its distance that a pair keeps in one step
constexpr double kTooClose = 1e-2;     // of the range: closer than this the barrier is too soft
constexpr double kStiffening = 10;     // factor on the strength of a barrier that proves too soft

Triangles side_by_side(const Triangles& a, const Triangles& b) {
  Triangles both(3, a.cols() + b.cols());
  both << a, b;
  return both;
}

PairCorners gather(const Points& x, const int* nodes) {
  PairCorners corners;
  for (int a = 0; a < 4; ++a) corners.col(a) = x.col(nodes[a]);
  return corners;
}

// Whether the boxes around the two features are `range` apart, which costs a fifth of their distance.
template <int kFirst>
bool boxes_are_apart(const PairCorners& x, double range) {
  const auto a = x.leftCols<kFirst>().array();
  const auto b = x.rightCols<4 - kFirst>().array();
  const Eigen::Array3d gap = (b.rowwise().minCoeff() - a.rowwise().maxCoeff())
                                 .max(a.rowwise().minCoeff() - b.rowwise().maxCoeff())
                                 .max(0.0);
  return gap.matrix().squaredNorm() >= range * range;
}

bool are_apart(PairKind kind, const PairCorners& x, double range) {
  return kind == PairKind::PointTriangle ? boxes_are_apart<1>(x, range) : boxes_are_apart<2>(x, range);
}

double pair_step(PairKind kind, const PairCorners& x, const PairCorners& d, double most) {
  return kind == PairKind::PointTriangle ? point_triangle_step(x, d, most, kKeptDistance)
                                         : edge_edge_step(x, d, most, kKeptDistance);
}

// Pairs that may come within range.
struct Candidates {
  Stencils stencils{4, {}};
  std::vector<BarrierRest> rest;  // per unit of pressure

  void add(const FeaturePair& pair, const BarrierRest& data) {
    rest.push_back(data);
    stencils.nodes.insert(stencils.nodes.end(), pair.nodes.begin(), pair.nodes.end());
  }

  // Energy at x; counts the pairs that are within range.
  double evaluate(const Points& x, double pressure, Sink& sink, long& active) const {
    const bool wants_gradient = sink.wants_gradient(), wants_hessian = sink.wants_hessian();
    std::atomic<long> within = 0;
    const double energy = pour_elements<Evaluated>(
        stencils, sink,
        [&](size_t k, Evaluated& out) {
          const PairCorners corners = gather(x, &stencils.nodes[4 * k]);
          out.is_active = false;
          if (are_apart(rest[k].kind, corners, rest[k].range)) return 0.0;
          const ClosestPair closest = closest_points(rest[k].kind, corners);
          if (closest.distance >= rest[k].range) return 0.0;
          out.is_active = true;
          const double own = pressure * evaluate_barrier(rest[k], corners, closest, sink.projection(),
                                                         wants_gradient ? &out.g : nullptr,
                                                         wants_hessian ? &out.h : nullptr);
          if (wants_gradient) out.g *= pressure;
          if (wants_hessian) out.h *= pressure;
          return own;
        },
        [&](size_t k, const Evaluated& in, Sink& to) {
          if (!in.is_active) return;
          const int* nodes = &stencils.nodes[4 * k];
          if (to.has_node(nodes[0])) within.fetch_add(1, std::memory_order_relaxed);
          for (int a = 0; wants_gradient && a < 4; ++a) to.add_gradient(nodes[a], in.g.segment<3>(3 * a));
          for (int a = 0; wants_hessian && a < 4; ++a)
            for (int b = 0; b < 4; ++b)
              to.add_block(16 * static_cast<long>(k), 4, a, b, in.h.block<3, 3>(3 * a, 3 * b));
        });
    active = within;
    return energy;
  }

 private:
  // Derivatives of a pair, between its evaluation and its scatter.
  struct Evaluated {
    bool is_active;
    PairVector g;
    PairMatrix h;
  };
};

// The pairs that a part of the nodes can meet within its reach: no search while it moves.
class ContactBarrierPart final : public EnergyTerm {
 public:
  ContactBarrierPart(std::string name, Candidates candidates, double pressure, Points start, double reach)
      : EnergyTerm(std::move(name)),
        candidates_(std::move(candidates)),
        pressure_(pressure),
        start_(std::move(start)),
        reach_(reach) {}

  std::string_view type() const override { return "contact_barrier"; }
  TermRole role() const override { return TermRole::Contact; }
  const Stencils& stencils() const override { return candidates_.stencils; }
  double evaluate(const Points& x, Sink& sink) const override {
    long active = 0;
    return candidates_.evaluate(x, pressure_, sink, active);
  }
  bool limits_steps() const override { return true; }

  // Not beyond the reach either: |x + s d - start| <= reach.
  double step_limit(const Points& x, const Points& d, double most) const override {
    double limit = most;
    for (Eigen::Index k = 0; k < start_.cols(); ++k) {
      const double a = d.col(k).squaredNorm();
      if (a == 0) continue;
      const Vec3 gone = x.col(k) - start_.col(k);
      const double b = gone.dot(d.col(k)), c = gone.squaredNorm() - reach_ * reach_;
      limit = std::min(limit, std::max(0.0, (-b + std::sqrt(std::max(0.0, b * b - a * c))) / a));
    }
    for (size_t k = 0; k < candidates_.rest.size(); ++k) {
      const int* nodes = &candidates_.stencils.nodes[4 * k];
      limit = std::min(limit, pair_step(candidates_.rest[k].kind, gather(x, nodes), gather(d, nodes), limit));
    }
    return limit;
  }

 private:
  Candidates candidates_;
  double pressure_;
  Points start_;  // of the nodes that move, which are the first
  double reach_;
};

class ContactBarrier final : public EnergyTerm, public TermAccess {
 public:
  ContactBarrier(std::string name, const Points& X, const Triangles& triangles,
                 const ContactBarrierOptions& options)
      : EnergyTerm(std::move(name)),
        surface_(X, side_by_side(triangles, options.obstacles), static_cast<int>(triangles.cols()),
                 options.excluded),
        gap_(options.gap),
        skin_(kSkin * options.gap),
        given_pressure_(options.pressure),
        pressure_(options.pressure) {}

  std::string_view type() const override { return "contact_barrier"; }
  TermKind kind() const override { return TermKind::Contact; }
  TermRole role() const override { return TermRole::Contact; }
  const Stencils& stencils() const override { return candidates_.stencils; }
  TermCounters counters() const override { return {active_pairs_, candidates_.stencils.count(), searches_}; }

  void use_threads(const std::shared_ptr<ThreadTeam>& team) override { team_ = team; }

  bool prepare(const Points& x) override {
    if (is_within_skin(x)) return false;
    search(x);
    return true;
  }

  double evaluate(const Points& x, Sink& sink) const override {
    return candidates_.evaluate(x, pressure_, sink, active_pairs_);
  }

  std::unique_ptr<EnergyTerm> part(MovingPart& moving) const override {
    Candidates candidates;
    const double ahead = 2 * moving.reach();
    surface_.visit_near(moving.x(), gap_ + ahead, moving, [&](const FeaturePair& pair) {
      if (!moving.moves_any(pair.nodes)) return;
      if (const auto rest = candidate(pair, moving.x(), ahead)) candidates.add(pair, *rest);
    });
    for (int& node : candidates.stencils.nodes) node = moving.number(node);
    Points start(3, moving.moving_count());
    for (int k = 0; k < moving.moving_count(); ++k) start.col(k) = moving.x().col(moving.nodes()[k]);
    return std::make_unique<ContactBarrierPart>(name(), std::move(candidates), pressure_, std::move(start),
                                                moving.reach());
  }

  std::vector<BarrierContact> contacts(const Points& x) const {
    std::vector<BarrierContact> found;
    for (size_t k = 0; k < candidates_.rest.size(); ++k) {
      const int* nodes = &candidates_.stencils.nodes[4 * k];
      const ClosestPair closest = closest_points(candidates_.rest[k].kind, gather(x, nodes));
      if (closest.distance >= candidates_.rest[k].range) continue;
      BarrierContact contact{{nodes[0], nodes[1], nodes[2], nodes[3]},
                             candidates_.rest[k].kind == PairKind::EdgeEdge,
                             0,
                             {},
                             closest.distance,
                             candidates_.rest[k].range};
      for (int a = 0; a < 4; ++a) {
        contact.weights[static_cast<size_t>(a)] = closest.weights[a];
        if (closest.weights[a] != 0) contact.inside |= 1 << a;
      }
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

  bool escalate_stiffness(const Points& x) override {
    prepare(x);
    bool is_too_soft = false;
    for (size_t k = 0; k < candidates_.rest.size() && !is_too_soft; ++k)
      is_too_soft =
          closest_points(candidates_.rest[k].kind, gather(x, &candidates_.stencils.nodes[4 * k])).distance <
          kTooClose * candidates_.rest[k].range;
    if (is_too_soft) pressure_ *= kStiffening;
    return is_too_soft;
  }

  bool restore_stiffness() override { return std::exchange(pressure_, given_pressure_) != given_pressure_; }

 private:
  // Visits the pairs that may collide while x moves to x + s d, 0 <= s <= most; `most` may fall meanwhile.
  template <class Visit>
  void visit_moving(const Points& x, const Points& d, const double& most, const Visit& visit) const {
    if (is_within_skin(x) && is_within_skin(x + most * d)) {
      for (size_t k = 0; k < candidates_.rest.size(); ++k)
        visit(candidates_.rest[k].kind, &candidates_.stencils.nodes[4 * k]);
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
    const std::vector<FeaturePair> pairs = surface_.near_pairs(x, gap_ + skin_, *team_);
    std::vector<std::optional<BarrierRest>> found(pairs.size());
    team_->run_ranges(pairs.size(), kShare, [&](size_t first, size_t last) {
      for (size_t k = first; k < last; ++k) found[k] = candidate(pairs[k], x, skin_);
    });
    candidates_ = {};
    for (size_t k = 0; k < pairs.size(); ++k)
      if (found[k]) candidates_.add(pairs[k], *found[k]);
  }

  // Of a pair that at x is less than `ahead` from its range; nothing of any other.
  std::optional<BarrierRest> candidate(const FeaturePair& pair, const Points& x, double ahead) const {
    const PairCorners corners = gather(x, pair.nodes.data());
    if (are_apart(pair.kind, corners, gap_ + ahead)) return {};
    const double distance = closest_points(pair.kind, corners).distance;
    if (distance >= gap_ + ahead) return {};
    const PairCorners at_rest = gather(surface_.rest(), pair.nodes.data());
    const double range = std::min(gap_, kShareOfRest * closest_points(pair.kind, at_rest).distance);
    if (distance >= range + ahead) return {};
    const double lengths =
        (at_rest.col(1) - at_rest.col(0)).squaredNorm() * (at_rest.col(3) - at_rest.col(2)).squaredNorm();
    return BarrierRest{pair.kind, range, surface_.area(pair) * range, kParallel * lengths};
  }

  ContactSurface surface_;
  std::shared_ptr<ThreadTeam> team_ = std::make_shared<ThreadTeam>();
  double gap_, skin_;
  double given_pressure_, pressure_;
  Candidates candidates_;
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
