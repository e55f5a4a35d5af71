// A term: one physical contribution to the potential energy, summed over many elements.
#pragma once

#include "core/types.hpp"
#include "energy/sink.hpp"

#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace coapt {

// Which nodes each element of a term couples: known before any evaluation, so that the Hessian's
// pattern and the place of every block are computed once.
struct Stencils {
  int width = 0;           // nodes per element
  std::vector<int> nodes;  // element e couples nodes[e * width .. (e + 1) * width)

  int count() const { return width == 0 ? 0 : static_cast<int>(nodes.size()) / width; }
};

enum class TermRole {
  Internal,  // elastic: membrane, chord
  Load,      // applied: pressure, gravity; sets the force that residuals are measured against
  Contact
};

// What a term did: proof that a scene pays for nothing that it does not use.
struct TermCounters {
  long elements = 0;    // elements of the term (contact: active pairs at the last evaluation)
  long candidates = 0;  // contact: pairs in the candidate list
  long searches = 0;    // contact: how often the list was updated
};

// One 3x3 block of the derivative of nodal forces: how the force on node `row` changes with node `column`.
struct TangentBlock {
  int row = 0, column = 0;
  Eigen::Matrix3d value;  // [force/length]
};

// What the loads of a scene may be expected to stretch elements with.
struct TensionScale {
  double membrane = 0;  // [force/length]
  double line = 0;      // [force]
};

class MovingPart;

class EnergyTerm {
 public:
  explicit EnergyTerm(std::string name) : name_(std::move(name)) {}
  virtual ~EnergyTerm() = default;
  EnergyTerm(const EnergyTerm&) = delete;
  EnergyTerm& operator=(const EnergyTerm&) = delete;

  const std::string& name() const { return name_; }  // unique within a scene
  virtual std::string_view type() const = 0;         // as in the scene file
  virtual TermRole role() const = 0;
  virtual const Stencils& stencils() const = 0;

  // The energy [force x length] at node positions x (3 x node_count); pours the derivatives that the
  // sink wants into it. A pure function of x: calling it never changes what a later call returns.
  // Infeasible positions give +infinity.
  virtual double evaluate(const Points& x, Sink& sink) const = 0;

  // Makes ready for an evaluation at x (contact renews its list of candidates). Returns whether the
  // stencils changed. Never changes a value: what is not in the list contributes exactly zero.
  virtual bool prepare(const Points& /*x*/) { return false; }

  // Threads that may share what prepare() does; what it does is the same whatever their number.
  virtual void use_threads(const std::shared_ptr<ThreadTeam>& /*team*/) {}

  // Rounds the kinks of the law over at least this share of the length of each element, for continuation;
  // 0: as the law was given. Returns whether it has any.
  virtual bool round_kinks(double /*share*/) { return false; }

  // --- Laws that stiffen without bound ----------------------------------------------------------------
  // For continuation: the law of an element goes on along its tangent beyond a limit of its strain, which
  // rises until nothing lies beyond it (docs/decisions/009-stress-limits.md).

  // Sets the limits where the tension is that of `scale`. Returns whether the term has laws that stiffen so.
  virtual bool limit_stress(const TensionScale& /*scale*/) { return false; }

  // Moves the limit of each element that lies beyond its own at x to the strain at which the law has the
  // stress that the tangent has at x. Returns the greatest ln(stress of the law over that of the tangent)
  // before; 0 where no element lies beyond its limit.
  virtual double raise_stress_limits(const Points& /*x*/) { return 0; }

  // Takes the limits away.
  virtual void release_stress_limits() {}

  // --- Loads without a potential -------------------------------------------------------------------
  // A circulatory force depends on the positions and is no gradient (pressure on a free edge). Such a
  // term splits its load in two: evaluate() gives a potential whose force is close to the true one,
  // add_circulatory_force() the exact remainder.
  virtual bool has_circulatory_force() const { return false; }

  // Adds the exact force minus the force of the potential to `force` (3 x node_count).
  virtual void add_circulatory_force(const Points& /*x*/, Points& /*force*/) const {}

  // Appends the blocks of the derivative of add_circulatory_force() with respect to x. Every block couples
  // nodes that share an element of stencils().
  virtual void add_circulatory_tangent(const Points& /*x*/, std::vector<TangentBlock>& /*blocks*/) const {}

  // Chooses the potential anew. Both return whether the stencils changed.
  //   rebuild_potential: for positions near x, to make the remainder vary as little as possible (for solvers
  //          that hold the remainder)
  //   simplify: the one with the fewest elements (for solvers that take the remainder as it is)
  virtual bool rebuild_potential(const Points& /*x*/) { return false; }
  virtual bool simplify() { return false; }

  // The same load with the potential that simplify() chooses: for what may not depend on the choice, not even
  // by round-off.
  virtual const EnergyTerm& simplest() const { return *this; }

  // --- Steps that must not be too long ---------------------------------------------------------------
  // Whether step_limit() may be less than it was asked for. A solver that uses such a term asks before every
  // step; what is evaluated anywhere else may be an infinite energy.
  virtual bool limits_steps() const { return false; }

  // The greatest admissible s <= most for a move from x to x + s d (3 x node_count): all of the way there is
  // admissible. Pre: x is.
  virtual double step_limit(const Points& /*x*/, const Points& /*d*/, double most) const { return most; }

  // Makes the term stiffer where the state at x shows that it is too soft to be trusted. Returns whether it
  // did: then the energy is another one.
  virtual bool escalate_stiffness(const Points& /*x*/) { return false; }

  // Takes back what escalate_stiffness() did. Returns whether it had done anything.
  virtual bool restore_stiffness() { return false; }

  // The elements that touch a node which moves, as a term of its own in the numbers of the part: its
  // derivatives by these nodes are those of this term as it is now (rounded, limited) as long as only they
  // move, and none farther than the part's reach. Null: this cannot be had.
  virtual std::unique_ptr<EnergyTerm> part(MovingPart& /*moving*/) const { return nullptr; }

  virtual TermCounters counters() const { return {stencils().count(), 0, 0}; }

 private:
  std::string name_;
};

}  // namespace coapt
