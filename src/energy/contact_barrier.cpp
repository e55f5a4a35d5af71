#include "energy/contact_barrier.hpp"

#include "core/error.hpp"
#include "energy/contact/barrier_candidates.hpp"
#include "energy/contact/contact_surface.hpp"
#include "energy/term_access.hpp"
#include "mesh/triangle_mesh.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace coapt {
namespace {

constexpr double kSkin = 0.1;          // of the gap: candidates are found this much ahead
constexpr double kMoved = 0.25;        // of the skin, by which a node has moved that is searched around anew
constexpr double kShareOfRest = 0.5;   // of the distance at rest, which the range never exceeds
constexpr double kParallel = 1e-3;     // sin^2 of the angle below which two edges count as parallel
constexpr double kKeptDistance = 0.2;  // share of its distance that a pair keeps in one step
constexpr double kTooClose = 1e-2;     // of the range: closer than this the barrier is too soft
constexpr double kAmple = 1 + 1e-9;    // on that distance, where boxes stand for it: beyond round-off
constexpr double kStiffening = 10;     // factor on the strength of a barrier that proves too soft

Triangles side_by_side(const Triangles& a, const Triangles& b) {
  Triangles both(3, a.cols() + b.cols());
  both << a, b;
  return both;
}

// The pairs that a part of the nodes can meet within its reach: the surface is not searched while it moves.
class ContactBarrierPart final : public EnergyTerm {
 public:
  // reachable: found where the nodes that move set out.
  ContactBarrierPart(std::string name, BarrierCandidates reachable, double pressure, double reach,
                     double skin)
      : EnergyTerm(std::move(name)),
        reachable_(std::move(reachable)),
        pressure_(pressure),
        reach_(reach),
        skin_(skin) {}

  std::string_view type() const override { return "contact_barrier"; }
  TermRole role() const override { return TermRole::Contact; }
  const Stencils& stencils() const override { return near_.stencils(); }

  bool prepare(const Points& x) override {
    if (near_.are_within(x, 0.5 * skin_)) return false;
    BarrierCandidates now = reachable_.near(x, skin_);
    std::swap(near_, now);
    return near_.stencils().nodes != now.stencils().nodes;
  }

  double evaluate(const Points& x, Sink& sink) const override {
    long active = 0;
    return near_.evaluate(x, pressure_, sink, active);
  }
  bool limits_steps() const override { return true; }

  // Not beyond the reach either: |x + s d - start| <= reach.
  double step_limit(const Points& x, const Points& d, double most) const override {
    const Points& start = reachable_.found_at();
    double limit = most;
    for (Eigen::Index k = 0; k < start.cols(); ++k) {
      const double a = d.col(k).squaredNorm();
      if (a == 0) continue;
      const Vec3 gone = x.col(k) - start.col(k);
      const double b = gone.dot(d.col(k)), c = gone.squaredNorm() - reach_ * reach_;
      limit = std::min(limit, std::max(0.0, (-b + std::sqrt(std::max(0.0, b * b - a * c))) / a));
    }
    return reachable_.step_limit(x, d, limit, kKeptDistance);
  }

 private:
  BarrierCandidates reachable_, near_;
  double pressure_, reach_, skin_;
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
  const Stencils& stencils() const override { return candidates_.stencils(); }
  TermCounters counters() const override {
    return {active_pairs_, candidates_.stencils().count(), searches_};
  }

  void use_threads(const std::shared_ptr<ThreadTeam>& team) override { team_ = team; }

  bool prepare(const Points& x) override { return !is_within_skin(x) && search(x); }

  double evaluate(const Points& x, Sink& sink) const override {
    return candidates_.evaluate(x, pressure_, sink, active_pairs_);
  }

  std::unique_ptr<EnergyTerm> part(MovingPart& moving) const override {
    Points start(3, moving.moving_count());
    for (int k = 0; k < moving.moving_count(); ++k) start.col(k) = moving.x().col(moving.nodes()[k]);
    BarrierCandidates candidates(std::move(start));
    surface_.visit_near(moving.x(), gap_ + 2 * moving.reach(), moving, [&](const FeaturePair& pair) {
      const double ahead = moving_features(moving, pair) * moving.reach();
      if (ahead == 0) return;
      if (const auto found = candidate(pair, moving.x(), ahead)) candidates.add(*found);
    });
    candidates.renumber(moving);
    return std::make_unique<ContactBarrierPart>(name(), std::move(candidates), pressure_, moving.reach(),
                                                skin_);
  }

  std::vector<BarrierContact> contacts(const Points& x) const {
    std::vector<BarrierContact> found;
    for (size_t k = 0; k < candidates_.size(); ++k) {
      const int* nodes = candidates_.nodes(k);
      const BarrierRest& rest = candidates_.rest(k);
      const ClosestPair closest = closest_points(rest.kind, pair_corners(x, nodes));
      if (closest.distance >= rest.range) continue;
      BarrierContact contact{{nodes[0], nodes[1], nodes[2], nodes[3]},
                             rest.kind == PairKind::EdgeEdge,
                             0,
                             {},
                             closest.distance,
                             rest.range};
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
    double limit = candidates_.step_limit(x, d, most, kKeptDistance);
    const Points end = x + limit * d;
    if (is_within_skin(x) && is_within_skin(end)) return limit;
    // Candidates are all that nodes within the skin can meet among themselves.
    NodeMask far = candidates_.beyond(x, 0.5 * skin_);
    const NodeMask far_at_end = candidates_.beyond(end, 0.5 * skin_);
    for (size_t node = 0; node < far.size(); ++node) far[node] = far[node] || far_at_end[node];
    const auto shorten = [&](const FeaturePair& pair) {
      if (!has_any(far, pair.nodes)) return;
      limit = std::min(limit, pair_step(pair.kind, pair_corners(x, pair.nodes.data()),
                                        pair_corners(d, pair.nodes.data()), limit, kKeptDistance));
    };
    surface_.visit_swept(x, d, 0, limit, shorten, {.all_but_around = &far});
    return limit;
  }

  bool escalate_stiffness(const Points& x) override {
    prepare(x);
    bool is_too_soft = false;
    for (size_t k = 0; k < candidates_.size() && !is_too_soft; ++k)
      is_too_soft = pair_distance(candidates_.rest(k).kind, pair_corners(x, candidates_.nodes(k))) <
                    kTooClose * candidates_.rest(k).range;
    if (is_too_soft) pressure_ *= kStiffening;
    return is_too_soft;
  }

  bool restore_stiffness() override { return std::exchange(pressure_, given_pressure_) != given_pressure_; }

 private:
  // How many of the two have a node that moves.
  static int moving_features(const MovingPart& moving, const FeaturePair& pair) {
    const auto first = pair.nodes.begin(), second = first + (pair.kind == PairKind::PointTriangle ? 1 : 2);
    const auto moves = [&](int node) { return moving.moves(node); };
    return std::any_of(first, second, moves) + std::any_of(second, pair.nodes.end(), moves);
  }

  // A pair can come within range only after its nodes have moved by half the skin each.
  bool is_within_skin(const Points& x) const { return candidates_.are_within(x, 0.5 * skin_); }

  // Around the nodes that have moved: pairs of all others are known, where these were found. Returns whether
  // the pairs are others than before.
  bool search(const Points& x) {
    ++searches_;
    const NodeMask moved = candidates_.beyond(x, kMoved * skin_);
    Points at = x;
    for (Eigen::Index node = 0; node < at.cols(); ++node)
      if (!moved[static_cast<size_t>(node)]) at.col(node) = candidates_.found_at().col(node);
    std::array<std::vector<BarrierCandidate>, ContactSurface::kShares> found;
    surface_.visit_near(at, gap_ + skin_, moved, *team_, [&](int share, const FeaturePair& pair) {
      if (const auto one = candidate(pair, at, skin_)) found[static_cast<size_t>(share)].push_back(*one);
    });
    return candidates_.renew(at, moved, found);
  }

  // Of a pair that at x is less than `ahead` from its range; nothing of any other.
  std::optional<BarrierCandidate> candidate(const FeaturePair& pair, const Points& x, double ahead) const {
    const PairCorners corners = pair_corners(x, pair.nodes.data());
    if (boxes_are_apart(pair.kind, corners, gap_ + ahead)) return {};
    const double distance = pair_distance(pair.kind, corners);
    if (distance >= gap_ + ahead) return {};
    const PairCorners at_rest = pair_corners(surface_.rest(), pair.nodes.data());
    double range = gap_;
    if (!boxes_are_apart(pair.kind, at_rest, kAmple * gap_ / kShareOfRest))
      range = std::min(gap_, kShareOfRest * pair_distance(pair.kind, at_rest));
    if (distance >= range + ahead) return {};
    const double lengths =
        (at_rest.col(1) - at_rest.col(0)).squaredNorm() * (at_rest.col(3) - at_rest.col(2)).squaredNorm();
    return BarrierCandidate{
        pair, {pair.kind, range, surface_.area(pair) * range, kParallel * lengths}, distance};
  }

  ContactSurface surface_;
  std::shared_ptr<ThreadTeam> team_ = std::make_shared<ThreadTeam>();
  double gap_, skin_;
  double given_pressure_, pressure_;
  BarrierCandidates candidates_;
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
