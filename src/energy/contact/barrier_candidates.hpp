// The pairs of a barrier that may come within range, and which of them are still too far apart to be looked
// at.
#pragma once

#include "energy/contact/contact_surface.hpp"
#include "energy/contact/pair_barrier.hpp"
#include "energy/term.hpp"

#include <span>
#include <vector>

namespace coapt {

PairCorners pair_corners(const Points& x, const int* nodes);

// How far a pair may move from x along d, at most `most` times, to keep the share `kept` of its distance.
double pair_step(PairKind kind, const PairCorners& x, const PairCorners& d, double most, double kept);

// Whether the boxes around the two features are `range` apart, which costs a fifth of their distance.
bool boxes_are_apart(PairKind kind, const PairCorners& x, double range);

// A pair that a search has found, and how far apart the two were there.
struct BarrierCandidate {
  FeaturePair pair;
  BarrierRest rest;
  double distance;
};

// The distance of a pair changes by no more than the displacements of its nodes. So the pairs that stay out
// of range, or cannot close up in a step, are told by those displacements, without their distance.
class BarrierCandidates {
 public:
  BarrierCandidates() = default;

  // found_at: positions of the first nodes when the pairs were found; all other nodes stay where they are.
  explicit BarrierCandidates(Points found_at);

  void add(const BarrierCandidate& found);

  // After a search around some nodes at x, where all others are as in found_at(): what it found, in several
  // shares, takes the place of all pairs with such a node. The order of pairs is that of their features, by
  // whichever search they were found. Returns whether they are others than before.
  bool renew(const Points& x, const NodeMask& searched, std::span<const std::vector<BarrierCandidate>> found);

  // For a part of a scene: numbers the nodes anew.
  void renumber(MovingPart& moving);

  // Those that at x are less than `ahead` from their range.
  BarrierCandidates near(const Points& x, double ahead) const;

  size_t size() const { return rest_.size(); }
  const BarrierRest& rest(size_t k) const { return rest_[k]; }
  const int* nodes(size_t k) const { return &stencils_.nodes[4 * k]; }
  const Stencils& stencils() const { return stencils_; }
  const Points& found_at() const { return found_at_; }

  // Whether none of the first nodes has moved by more than `most`; false before any search.
  bool are_within(const Points& x, double most) const;

  // Those that have; all of them before any search.
  NodeMask beyond(const Points& x, double most) const;

  // Energy at x, per unit of pressure times `pressure`; counts the pairs that are within range.
  double evaluate(const Points& x, double pressure, Sink& sink, long& active) const;

  // How far x may move along d, at most `most` times, so that every pair keeps the share `kept` of its
  // distance.
  double step_limit(const Points& x, const Points& d, double most, double kept) const;

 private:
  // Derivatives of a pair, between its evaluation and its scatter.
  struct Evaluated {
    bool is_active;
    PairVector g;
    PairMatrix h;
  };

  Vector displacements(const Points& x) const;

  // The most that the two features have come nearer, by the displacements of their nodes.
  double approach(size_t k, const Vector& moved) const;

  Points found_at_;
  Stencils stencils_{4, {}};
  std::vector<FeaturePair> pairs_;
  std::vector<BarrierRest> rest_;  // per unit of pressure
  std::vector<double> distance_;   // no greater than that at which each was found
  double round_off_ = 0;           // of a distance [length]
};

}  // namespace coapt
