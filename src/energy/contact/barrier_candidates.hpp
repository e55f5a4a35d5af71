// The pairs of a barrier that may come within range, and which of them are still too far apart to be looked
// at.
#pragma once

#include "energy/contact/contact_surface.hpp"
#include "energy/contact/pair_barrier.hpp"
#include "energy/term.hpp"

#include <vector>

namespace coapt {

PairCorners pair_corners(const Points& x, const int* nodes);

// How far a pair may move from x along d, at most `most` times, to keep the share `kept` of its distance.
double pair_step(PairKind kind, const PairCorners& x, const PairCorners& d, double most, double kept);

// Whether the boxes around the two features are `range` apart, which costs a fifth of their distance.
bool boxes_are_apart(PairKind kind, const PairCorners& x, double range);

// The distance of a pair changes by no more than the displacements of its nodes. So the pairs that stay out
// of range, or cannot close up in a step, are told by those displacements, without their distance.
class BarrierCandidates {
 public:
  BarrierCandidates() = default;

  // found_at: positions of the first nodes when the pairs were found; all other nodes stay where they are.
  explicit BarrierCandidates(Points found_at);

  // distance: of the pair when it was found.
  void add(const FeaturePair& pair, const BarrierRest& rest, double distance);

  // For a part of a scene: numbers the nodes anew.
  void renumber(MovingPart& moving);

  size_t size() const { return rest_.size(); }
  const BarrierRest& rest(size_t k) const { return rest_[k]; }
  const int* nodes(size_t k) const { return &stencils_.nodes[4 * k]; }
  const Stencils& stencils() const { return stencils_; }
  const Points& found_at() const { return found_at_; }

  // Whether none of the first nodes has moved by more than `most`; false before any search.
  bool are_within(const Points& x, double most) const;

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
  std::vector<BarrierRest> rest_;  // per unit of pressure
  std::vector<double> distance_;   // no greater than that at which each was found
  double round_off_ = 0;           // of a distance [length]
};

}  // namespace coapt
