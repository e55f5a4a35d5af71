// One body of xpbd and its state: steps of Verlet's kind, each followed by sweeps over all constraints.
#pragma once

#include "xpbd/contact.hpp"
#include "xpbd/options.hpp"

#include <optional>

namespace coapt {

class XpbdSystem {
 public:
  // Starts at rest at x (3 x node_count). masses: of each node. fixed: prescribed coordinates, as in
  // FixedMask. With XpbdStiffness::Paper all masses are 1 and all constraints, compliances and stiffnesses
  // the paper's.
  // Pre: options have passed check_xpbd_options; masses > 0.
  XpbdSystem(const XpbdBody& body, const Points& x, const Eigen::Array<bool, 3, Eigen::Dynamic>& fixed,
             const Vector& masses, const XpbdOptions& options);

  // x + (1 - damping) (x - x before) + dt^2 f/m, with contact no farther than that can follow
  // (XpbdContact::longest_move), then the sweeps. force: 3 x node_count [force]. prescribed:
  // where the prescribed coordinates go; its others are ignored.
  void step(const Points& force, const Points& prescribed);
  void step(const Points& force) { step(force, Points(x_)); }

  // Puts all nodes at x instead of where the last step led; their velocities change with it.
  void place(const Points& x) { x_ = x; }

  const Points& positions() const { return x_; }
  const Points& positions_before() const { return before_; }
  double largest_move() const;    // of a node in the last step [length]
  double mean_move() const;       // of the nodes in the last step, root mean square [length]
  double kinetic_energy() const;  // of the last step; of what is prescribed none [force x length]
  const InverseMasses& inverse_masses() const { return w_; }

  const ColouredConstraints<StretchConstraint>& tethers() const { return tethers_; }
  const std::optional<XpbdContact>& contact() const { return contact_; }
  size_t constraint_count() const;  // without contact

 private:
  XpbdOptions options_;
  ThreadTeam team_;
  double dt2_;
  InverseMasses w_;
  Points x_, before_;
  ColouredConstraints<StretchConstraint> stretches_;  // edges
  ColouredConstraints<AreaConstraint> areas_;
  ColouredConstraints<SquaredAreaConstraint> squared_areas_;  // the paper's
  ColouredConstraints<FilmConstraint> films_;
  ColouredConstraints<TriangleEnergyConstraint> others_;
  ColouredConstraints<BendingConstraint> bends_;
  ColouredConstraints<StretchConstraint> tethers_;  // of a straight law
  ColouredConstraints<LineConstraint> lines_;       // of any other
  std::optional<XpbdContact> contact_;
};

}  // namespace coapt
