// Contact of xpbd (Walczak et al. 2019, section 3.3): vertices keep a distance h from triangles, edges from
// edges, on the side on which they were when the step began.
//   C = +-d - h >= 0,   d the distance of the two features, - once they have passed through each other
// Features of one sheet that are near each other at rest keep half their distance at rest, where that is
// less; those that are joined by an edge, or held together, do not meet. Edges are our addition, which
// options may leave out: vertices alone let coarse sheets cross between their nodes.
#pragma once

#include "energy/contact/contact_surface.hpp"
#include "xpbd/body.hpp"
#include "xpbd/options.hpp"
#include "xpbd/projection.hpp"

#include <memory>

namespace coapt {

struct ContactConstraint {
  static constexpr int kNodes = 4;
  PairKind kind = PairKind::PointTriangle;
  std::array<int, 4> nodes{};
  double thickness = 0;       // h [length]
  Vec3 side = Vec3::UnitZ();  // from the second feature to the first when the step began, unit
  double alpha = 0;           // [length/force]
  double stiffness = 1;
  static constexpr ConstraintSense sense = ConstraintSense::PushesOnly;

  double compliance(double /*value*/) const { return alpha; }
  ConstraintValue<4> at(const Points& x) const;
};

struct ContactOptions {
  double thickness = 0;  // h [length]
  XpbdContactFeatures features = XpbdContactFeatures::VerticesAndEdges;
  double alpha = 0, stiffness = 1;  // of each constraint
  // Pairs of nodes held nearer than h, as by a clip, which the paper calls an additional edge (section 3.8).
  std::vector<std::array<int, 2>> held_together = {};
};

class XpbdContact {
 public:
  XpbdContact(const XpbdBody& body, const ContactOptions& options);

  // Finds the pairs that may meet in a step from x to about `predicted`, and the side of each at x. Pre: no
  // node is predicted to go farther than longest_move().
  void begin_step(const Points& x, const Points& predicted);

  void sweep(double dt2, const InverseMasses& w, Points& x, ThreadTeam& team) {
    active_.sweep(dt2, w, x, team);
  }

  // The longest move that a step may predict for a node: what goes farther may have passed through a sheet
  // before the search has found it [length].
  double longest_move() const { return longest_; }

  const std::vector<double>& multipliers() const { return active_.multipliers(); }
  size_t active_count() const { return active_.size(); }

 private:
  bool is_joined(const FeaturePair& pair) const;
  bool are_joined(int s, int t) const;
  void find_joined_triangles();

  ContactSurface surface_;
  std::vector<std::vector<int>> neighbours_;  // of each node: by an edge, or held together; ascending
  std::vector<std::vector<int>> joined_;  // of each triangle those of which it meets no feature, ascending
  ContactOptions options_;
  double longest_;
  ColouredConstraints<ContactConstraint> active_;
};

}  // namespace coapt
