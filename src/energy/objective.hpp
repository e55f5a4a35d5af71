// The potential energy of a scene over its free unknowns: the sum of the terms that were named.
#pragma once

#include "energy/force_scale.hpp"
#include "energy/hessian_pattern.hpp"
#include "energy/normal_motion.hpp"
#include "energy/term.hpp"

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

namespace coapt {

struct EvaluationCounts {
  long value = 0;     // energy alone
  long gradient = 0;  // energy and gradient
  long hessian = 0;   // energy, gradient and Hessian
};

struct TermReport {
  std::string name, type;
  double energy = 0;          // [force x length]
  double greatest_force = 0;  // largest nodal force of this term [force]
  TermCounters counters;
};

// Resultant of the reactions against the loads: both are zero at an equilibrium.
struct Balance {
  double force = 0;   // |sum of loads and reactions| / sum of their magnitudes
  double moment = 0;  // the same for moments about the centre of the mesh
};

// Unknowns q: the three coordinates of every node that is not wholly prescribed, node after node. A
// prescribed coordinate of such a node (a symmetry plane) stays in q, keeps its value, and has zero
// gradient and a unit row in the Hessian. Nodes of films of constant tension move along lines across them
// alone (energy/normal_motion.hpp): of gradient and Hessian only that part is there, and only its force is in
// the residual. One objective serves one thread; several may run side by side.
class Objective {
 public:
  // start: 3 x node_count, the prescribed coordinates among them. terms: at least none; names unique.
  // Pre: fixed has as many columns as start; every stencil's nodes are in range.
  Objective(Points start, FixedMask fixed, std::vector<std::unique_ptr<EnergyTerm>> terms);

  int node_count() const { return static_cast<int>(x_.cols()); }
  int unknown_count() const { return 3 * static_cast<int>(active_.size()); }
  int free_count() const { return free_count_; }  // unknowns that are not prescribed
  const FixedMask& fixed() const { return fixed_; }
  const std::vector<std::unique_ptr<EnergyTerm>>& terms() const { return terms_; }

  Vector unknowns(const Points& x) const;
  Vector unknowns() const { return unknowns(x_); }  // of the last evaluation, or of the start
  Points positions(const Vector& q) const;
  void unknowns(const Points& x, Vector& q) const;  // the same, in place
  void positions(const Vector& q, Points& x) const;
  // Longest side of the box around all nodes [length], whatever the place and the unknowns are.
  double extent(const Vector& q) const;

  // A start from q that films of constant tension can leave along their normals (NormalMotion::smooth_start),
  // and whether the lines along which they move had to be turned for the state q.
  Vector smooth_start(const Vector& q) {
    return normal_motion_.is_empty() ? q : unknowns(normal_motion_.smooth_start(positions(q)));
  }
  bool turn_films(const Vector& q) {
    if (normal_motion_.is_empty() || !normal_motion_.turn_where_needed(positions(q))) return false;
    scale_is_current_ = false;
    return true;
  }

  // Factors on all loads and on all other energies, for continuation; 1 from the start. Load and stiffness
  // scaled alike leave an equilibrium where it is.
  void scale(double load, double stiffness);

  // Holds each unknown by a damper, a force c (q - from) and its potential: one step of implicit Euler along
  // a damped path. coefficients: c of each unknown, >= 0 [force/length]; empty: no dampers, as from the
  // start. Loads, reactions and the force scale do not count them.
  void damp(const Vector& coefficients, const Vector& from);
  bool is_damped() const { return damping_.size() > 0; }

  // Rounds the kinks of all terms, as EnergyTerm::round_kinks() does. Returns whether there are any.
  bool round_kinks(double share);

  // Laws that stiffen without bound go on along their tangent beyond what the loads may be expected to need,
  // as EnergyTerm::limit_stress() says. limit: returns whether there are any; without loads nothing is
  // limited. raise: at q, where the limits follow; returns the greatest excess. release: the laws as they
  // were given.
  bool limit_stress(const Vector& q);
  bool has_stress_limits() const { return has_stress_limits_; }
  double raise_stress_limits(const Vector& q);
  void release_stress_limits();

  // Threads that share assembly and the search for contact, and may share what a solver does besides; 1 from
  // the start. Results have the same bits whatever their number.
  void use_threads(int count);
  const std::shared_ptr<ThreadTeam>& team() const { return team_; }

  // Moves the prescribed coordinates to those of x; free coordinates of x are ignored.
  void prescribe(const Points& x);

  // Energy; with gradient; with gradient and Hessian. +infinity where infeasible.
  // hessian: lower triangle by blocks, unknown_count square; allocated on the first call and written in
  // place afterwards, as long as pattern_version() stays.
  double value(const Vector& q);
  double gradient(const Vector& q, Vector& g);
  double hessian(const Vector& q, Vector& g, Eigen::SparseMatrix<double>& h,
                 Projection projection = Projection::None);
  long pattern_version() const { return pattern_version_; }

  // --- The verdict ------------------------------------------------------------------------------------
  // All that follows belongs to the state q and to the problem as it is now, whatever was evaluated before;
  // at the state of the last gradient evaluation it costs nothing.

  // Largest load or reaction [force]: see ForceScale::force().
  double reference_force(const Vector& q) { return scale_at(q).force(); }

  // Out-of-balance force at q relative to the reference force: largest nodal norm of g over
  // reference_force().
  double relative_residual(const Vector& q, const Vector& g);

  // Sum of the magnitudes of the nodal loads at q, as they are scaled now [force].
  double total_load(const Vector& q);

  // Greatest nodal force along films of constant tension, which the mesh makes and neither gradient nor
  // residual has, over reference_force(); 0 where there is none.
  double sliding_force(const Vector& q) {
    const double scale = reference_force(q);
    return sliding_force_ == 0 ? 0 : sliding_force_ / scale;
  }

  // Residual with the exact load at q, never that of the potential. The final judge of convergence.
  double true_residual(const Vector& q);

  // The terms have other data than before (a parameter was set): what the reference state says is measured
  // anew, with the next gradient.
  void remeasure_reference() { reference_is_current_ = scale_is_current_ = false; }

  // Greatest force of the last gradient evaluation, reactions of a prestress included [force]: what round-off
  // is measured against.
  double largest_force() const { return scale_.largest_force(); }

  // --- Steps that must not be too long ---------------------------------------------------------------
  // The first term that limits steps (EnergyTerm::step_limit), or null.
  const EnergyTerm* step_limiting_term() const;

  // The greatest s <= most for which the path from q to q + s direction is admissible to all terms; the same
  // for nodes, prescribed ones included, from x to x + s d. Pre: q and x are admissible.
  double step_limit(const Vector& q, const Vector& direction, double most);
  double step_limit(const Points& x, const Points& d, double most);

  // Whether a term became stiffer, as the state q shows that it was too soft.
  bool escalate_stiffness(const Vector& q);

  // Takes back what escalate_stiffness() did, so that a solve does not depend on those before it.
  void restore_stiffness();

  // --- Loads without a potential --------------------------------------------------------------------
  bool has_circulatory_force() const;

  // Treats the circulatory force in this way from q on. Pre: has_circulatory_force().
  //   Held dead: the remainder keeps its value at q, and evaluations belong to a true potential. Terms
  //   may choose that potential anew.
  //   Path work: the gradient is the exact out-of-balance force, and the energy counts the work of the
  //   remainder along the path from q (Simpson's rule, exact for pressure along a straight step), so that it
  //   falls along any step that the force drives. It is a merit for a line search from q, not a function of
  //   the position alone. The Hessian is the symmetric part of the exact tangent.
  void lag_circulatory_force(const Vector& q);
  void set_path_anchor(const Vector& q);

  // Adds the product of v with the skew part of the exact tangent at the last Hessian evaluation, which that
  // Hessian lacks. Nothing to add unless the path is followed.
  bool has_skew_tangent() const { return !skew_.empty(); }
  void add_skew_product(const Vector& v, Vector& product) const;

  // Goes on from q: call it at each accepted iterate. The energy is continuous there. Does nothing unless
  // the path is followed.
  void advance(const Vector& q);

  // These blocks of unknowns by themselves, all others held where q has them: an objective whose energy
  // differs by a constant, in the same order of unknowns, whose residual is measured against this one's
  // reference force at q and whose laws are as they are now. Contact keeps each node within `reach` [length]
  // of where it is. Null where a term cannot be divided, or the circulatory force is lagged.
  std::unique_ptr<Objective> part(const Vector& q, const std::vector<int>& blocks, double reach);

  std::vector<TermReport> breakdown(const Vector& q);
  // Reactions of the supports, 3 x node_count [force], zero where free; of fixed rims see docs/theory.md.
  Points reactions(const Vector& q);
  Balance balance(const Vector& q);

  const EvaluationCounts& counts() const { return counts_; }

 private:
  Points nodal(const Vector& direction) const;
  double evaluate(const Vector& q, Vector* g, Eigen::SparseMatrix<double>* h, Projection projection);
  void prepare(const Vector& q);
  double factor(const EnergyTerm& term) const {
    return term.role() == TermRole::Load ? load_factor_ : stiffness_factor_;
  }
  double pour(const EnergyTerm& term, Sink sink) const;  // scaled energy and derivatives at x_
  void update_pattern();
  void split(const Points& nodal, Vector& free);
  void circulatory_force(const Points& x, Points& force) const;
  double path_work();  // from anchor_ to x_; leaves the force at x_ in force_
  void add_circulatory_tangent(Eigen::SparseMatrix<double>& h);
  Points exact_circulatory_force() const;  // at x_, as the gradient, whatever potential was chosen
  Points exact_gradient(const Points& circulatory) const;
  Points exact_load() const;  // at x_
  double add_dampers(const Vector& q, Vector* g, Eigen::SparseMatrix<double>* h) const;
  const ForceScale& scale_at(const Vector& q);
  void measure_reference();
  void part_sink();

  Points x_;  // work space: prescribed coordinates stay, free ones follow q
  FixedMask fixed_;
  std::vector<std::unique_ptr<EnergyTerm>> terms_;  // loads first, then as given
  std::vector<int> active_;                         // node of each block of unknowns
  std::vector<int> block_;                          // block of each node, -1 = wholly prescribed
  int free_count_ = 0;
  double load_factor_ = 1, stiffness_factor_ = 1;
  Vector damping_, damped_from_;  // of each unknown; empty: no dampers
  std::shared_ptr<ThreadTeam> team_ = std::make_shared<ThreadTeam>();
  std::vector<SinkPart> sink_parts_;  // of each thread
  bool has_stress_limits_ = false;

  enum class Circulatory { None, Lagged, PathWork };
  Circulatory circulatory_ = Circulatory::None;
  Points remainder_;                // circulatory force, 3 x node_count: lagged, or at the anchor of the path
  Points anchor_;                   // where the path has got to
  Points force_, middle_;           // work space
  std::vector<TangentBlock> skew_;  // half the tangent of the gradient, by blocks of unknowns
  double work_ = 0;                 // of the circulatory force along the path so far
  Points nodal_gradient_;           // work space

  NormalMotion normal_motion_;

  const Points reference_;         // the start
  ForceScale scale_;               // of the last gradient evaluation
  double sliding_force_ = 0;       // left out there [force]
  Vector scale_at_;                // its unknowns
  bool scale_is_current_ = false;  // nothing else has changed since
  bool reference_is_current_ = false;

  HessianPattern pattern_;
  bool pattern_is_current_ = false;  // but for pairs in contact
  bool pairs_are_current_ = false;   // those in the pattern
  long pattern_version_ = 0;
  EvaluationCounts counts_;
};

}  // namespace coapt
