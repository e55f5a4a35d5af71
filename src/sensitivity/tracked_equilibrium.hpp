// An equilibrium that is followed while parameters change: solved again from where it is, with exact
// derivatives of figures of merit by the parameters.
//
//   TrackedEquilibrium equilibrium(objective, q);                    // q: unknowns at or near an equilibrium
//   equilibrium.add(make_line_lengths("chords", term, groups, LengthMeasure::Length));
//   WarmSolve first = equilibrium.solve();                           // judged by the objective's residual
//   equilibrium.set(equilibrium.value() + change);
//   WarmSolve again = equilibrium.solve();                           // warm: a few Newton steps
//   Derivatives d = equilibrium.derivatives(metric);                 // value and dJ/d(every number)
//
// All numbers of all parameters stand in one vector, parameter after parameter in the order of add(). x is
// 3 x node_count positions; units are those of the model (mm, N, MPa).
//
// Derivatives hold where the energy is twice differentiable at the equilibrium: not where a chord without
// smoothing becomes taut, a membrane leaves a regime of its tension field, or the closest features of a
// contact change. solve() says what has done so, derivatives() what stands there, switches() what is about
// to. The exact tangent is used, not symmetric under pressure on free edges, contact included. Contact by a
// barrier keeps its stiffness and ranges.
//
// An object serves one thread, and has no state outside itself and its objective: several may run side by
// side, each with an objective of its own, and give the same bits.
#pragma once

#include "optim/solver.hpp"
#include "sensitivity/metrics/metric.hpp"
#include "sensitivity/nodal_tangent.hpp"
#include "sensitivity/switches.hpp"
#include "sensitivity/tangent_system.hpp"

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace coapt {

struct TrackingOptions {
  FactorisationFactory factorisation = make_multifrontal_factorisation;
  double tolerance = 1e-10;   // on the relative residual
  int quick_steps = 15;       // Newton steps from the predicted shape before the whole method is called
  int max_iterations = 2000;  // of the whole method (newton, with all its safeguards)
  double max_seconds = kInfinity;
  bool checks_branch = true;
  int anchor_steps = 20;   // warm steps from one comparison with the anchor to the next; 0: none is made
  Observer observer = {};  // sees the shape at every step; returning false ends solve() with Cancelled, and
                           // jacobian() with an InputError
};

// That the shape is on another branch of equilibria than before the change: it did not come back when the
// change was undone.
struct LostBranch {
  double distance = 0;  // of the shape that came back from the one before, greatest of a node [length]
  double jump = 0;      // of the new shape from the linear prediction, likewise
  int negative_before = 0, negative_after = 0;  // eigenvalues of the symmetric part of the tangent
};

// The present numbers and those of the anchor by two ways: step by step, as they were solved, and all at
// once. Where the shapes differ, steps that each looked harmless have led to another branch of equilibria.
struct AnchorCheck {
  Status status = Status::Stalled;  // Converged: both ways could be gone at once
  bool is_same_branch = false;      // false also where nothing could be compared
  double back = 0;    // of the anchor's shape from where undoing all changes at once leads [length]
  double here = 0;    // of the present shape from where all changes at once lead from the anchor [length]
  double travel = 0;  // of the present shape from the anchor's [length]; each the greatest of a held node
  std::string message;
};

struct WarmSolve {
  Status status = Status::Stalled;  // Converged: the objective's exact residual is below the tolerance
  std::string message;              // one sentence
  double residual = 0;
  int iterations = 0;    // Newton steps after the prediction, or those of the whole method
  bool is_quick = true;  // false: the whole method was called
  double predicted = 0;  // greatest displacement of a node by the linear prediction [length]
  double travel = 0;     // greatest displacement of a node [length]
  double jump = 0;       // greatest distance of a node from the linear prediction [length]
  std::optional<LostBranch> lost_branch;
  std::optional<AnchorCheck> anchor;  // where it was time for one
  // What has another state than in the shape that was solved before: on the way between the two derivatives
  // have a kink. Empty for the first shape, and for one that did not converge.
  std::vector<Switch> switched;
  double seconds = 0;  // wall time, the check of the branch included
};

// Where a solve for other numbers would end, as TrackedEquilibrium::corrected() finds it.
struct CorrectedShape {
  bool is_found = false;  // the corrections shrank until what is left of them is below what was asked
  Points x;               // as far as they went
  double distance = 0;    // from where they began, greatest of the nodes that count [length]
  double left = 0;        // estimate of the distance from the equilibrium, likewise
  int steps = 0;          // each one evaluation of the forces and one linear system
};

struct Derivatives {
  double value = 0;
  Vector gradient;      // by every number
  double residual = 0;  // of the adjoint system, relative
  // What stands at a kink (switches.hpp): of it the derivative holds on one side at best.
  std::vector<Switch> kinks;
};

class TrackedEquilibrium {
 public:
  static constexpr double kExactResponse = 1e-10;  // relative residual of linear systems of derivatives

  // objective: must outlive this object; prescribed coordinates where they are to be held. Where a load has
  // no potential the objective follows its path from now on. q: see above.
  TrackedEquilibrium(Objective& objective, Vector q, TrackingOptions options = {});

  // The parameter must have been made for terms of this objective. Returns its index. One that moves
  // prescribed nodes must have them where they are now. Throws InputError for a name that is taken, and for
  // one that changes what another parameter changes, or the same twice (written_datum.hpp).
  size_t add(std::unique_ptr<Parameter> parameter);

  size_t parameter_count() const { return parameters_.size(); }
  const Parameter& parameter(size_t index) const { return *parameters_[index]; }
  int first_number(size_t index) const { return first_[index]; }  // of a parameter, in value()
  int number_count() const { return number_count_; }

  Vector value() const;
  // Changes the terms; prescribed nodes move with the next solve(). Throws InputError for a wrong size and
  // with the defects of all parameters; then nothing has changed.
  void set(const Vector& value);

  // Solves for the present values: linear prediction, then Newton's method with the exact tangent and steps
  // that contact admits; where that does not converge, the whole method from the shape before. A shape that
  // did not converge is kept, and status says so; also one at which a term threw.
  WarmSolve solve();

  // Numbers, and unknowns at or near their equilibrium, in place of the present ones: as an object that goes
  // on where another one of the same scene was left. solve() then goes from there; derivatives need it first.
  // Throws InputError for wrong sizes and as set() does, and nothing has changed then.
  void resume_at(const Vector& value, const Vector& q);

  // The anchor: the shape that was solved first, or this one from now on. Pre: solved.
  void anchor_here();
  // Another one: numbers, and unknowns at or near their equilibrium. Throws InputError for wrong sizes.
  void anchor_at(const Vector& value, const Vector& q);
  // Two warm solves; the shape is then what it was. Pre: solved.
  AnchorCheck check_anchor();

  const Vector& unknowns() const { return q_; }
  Points positions() const { return objective_.positions(q_); }

  // --- derivatives at the last solved shape: Pre of all: solve() gave Converged, and no set() since. Each
  // throws InputError where that is not so, or where the tangent is singular (no factor, or a linear system
  // that does not solve to 1e-6). -----------------------------------------------------------------------
  Derivatives derivatives(const Metric& metric);

  // dx/d(numbers) change, 3 x node_count, and its transpose: the derivative of any function of the shape
  // whose derivative by x is `weights`.
  // tolerance: on the relative residual of the linear system.
  Points response(const Vector& change, double tolerance = kExactResponse);

  // The shape of other numbers, from a start near it, without a solve: Newton steps with the tangent of the
  // start as long as they close in on something, and with one more where they do not. They end once two in
  // turn say, each with its predecessor, that less than `until` is left, or once the shape is `most` from
  // the start.
  // Not found: also where a tangent has another number of negative eigenvalues than that of the solved shape.
  // Lengths are of `nodes`. start: 3 x node_count, the prescribed nodes as they are now: they go where the
  // numbers want them. Neither shape nor numbers of this object change. look: called where the shape was
  // found, while the terms have the numbers. Throws InputError as set() does.
  CorrectedShape corrected(const Vector& numbers, const Points& start, const std::vector<int>& nodes,
                           double until, double most = kInfinity,
                           const std::function<void(const CorrectedShape&)>& look = {});

  // How far a first such step would go, by the factor of the solved shape: no new one, and a first guess
  // where stiffness hardly changes on the way. Infinity where forces are not finite. Throws as corrected().
  double step_by_solved_factor(const Vector& numbers, const Points& start, const std::vector<int>& nodes);
  Vector pull_back(const Eigen::Ref<const Points>& weights);

  // One row for each metric, by as many linear systems as there are metrics or numbers, whichever are fewer.
  // Asks the observer before each, and throws InputError where it says no.
  Eigen::MatrixXd jacobian(const std::vector<const Metric*>& metrics);

  // Product of sum_k grad r_k grad r_k^T with `change`, for residuals r_k of a least-squares problem: one
  // forward and one adjoint system whatever their number.
  Vector gauss_newton_product(const std::vector<const Metric*>& residuals, const Vector& change);

  // First-order covariance of metrics from that of the numbers (covariance.hpp).
  Eigen::MatrixXd metric_covariance(const std::vector<const Metric*>& metrics,
                                    const Eigen::MatrixXd& covariance);

  // What stands at a kink. Looked for once for each shape.
  const std::vector<Switch>& kinks();

  // What switches between the shapes that the linear prediction gives for value() - change and + change:
  // derivatives along it have a kink there. A change as small as the accuracy of the numbers tells whether
  // the present shape is at a kink. Throws InputError where set() would, for either of them.
  std::vector<Switch> switches(const Vector& change);

 private:
  struct Place {  // where a solved shape is
    Vector q;
    Points x;
    Vector value;
    int negative = 0;
  };

  Vector numbers_of(const Parameter& parameter, size_t index, const Vector& all) const;
  void assign(const Vector& value);
  void assign_numbers(const Vector& value);  // and nothing else
  template <typename Work>
  void with_numbers(const Vector& numbers, Points& start, const Work& work);
  Points prescribed() const;  // positions with prescribed nodes where the parameters want them
  void ready_tangent();       // assembled at q_, with a factor of it or of a state nearby
  void factorise_tangent();   // the same with a factor of it
  double solve_tangent(const Vector& b, Vector& x, double tolerance, bool is_transposed);
  void require_sound(const Vector& value) const;
  void require_solved() const;
  void require_wanted() const;
  void check_solved(double residual, double tolerance) const;
  Vector partial(const Metric& metric, const Points& x) const;
  Points force_change(const Points& x, const Vector& change);  // -(dg), prescribed motion included
  Points predict(const Vector& change, double tolerance);      // to this residual of the linear system
  WarmSolve solve_at(const Vector& now);
  WarmSolve move_to(const Place& from, const Points& predicted);
  bool move_quickly(const Points& predicted, WarmSolve& report);
  void close_in(CorrectedShape& found, const std::vector<int>& nodes, double until, double most);
  bool close_in_by_one_tangent(CorrectedShape& found, const Points& start, const std::vector<int>& nodes,
                               double until, double most);
  std::optional<LostBranch> check_branch(const Place& from, const WarmSolve& report);
  void check_anchor_in_time(WarmSolve& report);
  Points predicted_change(const Place& from, const Vector& to);
  void take_up(const Place& place);
  double held_distance(const Points& x) const;
  double residual_at(const Vector& q);

  Objective& objective_;
  TrackingOptions options_;
  std::vector<std::unique_ptr<Parameter>> parameters_;
  std::vector<int> first_;
  int number_count_ = 0;
  Vector q_;
  Vector solved_value_;                       // numbers at the last solve()
  std::optional<ElementStates> states_;       // of the shape solved last
  std::optional<std::vector<Switch>> kinks_;  // of this shape, once they were looked for
  std::optional<Place> anchor_;
  int negative_modes_ = 0;  // of the solved shape
  int steps_since_anchor_check_ = 0;
  double adjoint_residual_ = 0;
  bool is_solved_ = false, is_tangent_ready_ = false, is_nodal_ready_ = false;
  TangentSystem system_, near_;  // of the solved shape; of one near it
  NodalTangent nodal_;
  Vector g_;
};

}  // namespace coapt
