// What a solver is, what it is given and what it returns.
#pragma once

#include "core/timing.hpp"
#include "energy/objective.hpp"
#include "linear/factorisation.hpp"
#include "mesh/triangle_mesh.hpp"
#include "optim/dynamic/dynamic_options.hpp"
#include "optim/stability/certificate.hpp"

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace coapt {

enum class Status {
  Converged,  // the objective's own residual is below the tolerance
  IterationLimit,
  TimeLimit,
  Stalled,  // no further progress is possible at this precision
  LineSearchFailed,
  NonFinite,     // the objective could not be evaluated
  Cancelled,     // by the observer
  NoEquilibrium  // there is none, or the shape grows or shrinks without bound
};

std::string_view status_name(Status status);  // "converged", "iteration_limit", ...

struct StopRule {
  double tolerance = 1e-6;         // on the relative residual
  int max_iterations = 100000;     // of the solver, over all outer iterations and steps
  double max_seconds = kInfinity;  // wall time [s]
};

// One accepted iterate.
struct Iteration {
  int iteration = 0;
  int outer_iteration = 0;  // outer renewal or continuation step
  double energy = 0;        // of the potential that the solver minimises [force x length]
  double residual = 0;      // relative, of that potential
  double step = 0;          // largest change of an unknown [length]
  double seconds = 0;       // wall time since the start
  double time = 0;          // simulated since the start, of a method that follows the motion of masses [s]
  long evaluations = 0;     // of the gradient so far
  bool is_descent = true;   // whether the energy falls to it: not in a search for a state without forces
  double path = kNaN;       // share done of a path of loads or of prescribed motion; NaN: there is none
};

// Sees every accepted iterate; returning false cancels the run, which keeps that iterate.
using Observer = std::function<bool(const Iteration&, const Vector& q)>;

// Prescribed motion: positions of the prescribed coordinates at load parameter 0 <= t <= 1.
struct MotionPath {
  int steps = 1;                              // equal steps in t; at least one
  std::function<Points(double t)> positions;  // 3 x node_count; empty: nothing moves

  // Nodes that move by one instruction, and what messages call it; may be left out.
  struct Part {
    std::string name;
    std::vector<int> nodes;
  };
  std::vector<Part> parts = {};
};

class Monitor;

// A minimiser. It owns its method and nothing else: stop rules, trace, time and the verdict stand once,
// in Monitor and solve().
class Solver {
 public:
  virtual ~Solver() = default;
  virtual std::string_view name() const = 0;

  // Whether the method works from the exact out-of-balance force and needs the energy only to compare a
  // step with its start. Others get a load without potential in outer iterations, each with a true potential.
  virtual bool follows_path() const { return false; }

  // Whether the method raises and releases the limits of Objective::limit_stress() itself.
  virtual bool raises_stress_limits() const { return false; }

  // Whether the method asks Monitor::step_limit before every step. One that does not is refused terms that
  // limit steps.
  virtual bool honours_step_limits() const { return true; }

  // Whether minimize() goes by the energy of the objective alone. A method with laws or with a motion of its
  // own is led along no damped path.
  virtual bool minimises_objective() const { return true; }

  // Asked before the first minimize(): whether the method carries the prescribed nodes along this path itself
  // as time goes on. Those of other methods are moved in steps, with a minimize() after each.
  virtual bool takes_motion(const MotionPath& /*motion*/) { return false; }

  // Whether the last minimize() ended without motion. What passes through an equilibrium at speed has no
  // residual there and is moving to another state.
  virtual bool is_at_rest() const { return true; }

  // What there is to say of how the last minimize() ended, for the message of the result; may be empty.
  virtual std::string remark() const { return {}; }

  // Improves q until the monitor says stop or the method cannot go on; returns why. q is the last
  // accepted iterate, finite whatever happens. Never throws for numerical reasons.
  virtual Status minimize(Objective& objective, Vector& q, Monitor& monitor) = 0;
};

// Ways to the full problem by easier ones. All advance together with the prescribed motion, in as many steps
// as the one that wants most.
struct Continuation {
  int load_steps = 1;          // equal steps of all loads; 1: the full load at once
  int stiffness_steps = 1;     // steps of all other energies, in equal ratios; 1: the full stiffness at once
  double first_stiffness = 1;  // factor before the first step
  int damped_steps = 0;    // equal steps of all loads along a damped path (optim/damped_path.hpp); 0: none
  bool is_loaded = false;  // the damped path begins at the full problem, near its end
};

struct Problem {
  Objective& objective;
  Vector q0;
  MotionPath motion = {};
  Continuation continuation = {};

  // With a factorisation the result gets a certificate, and a saddle is left where the loads have a
  // potential.
  StabilityOptions stability = {};
};

// A step of a path, of loads, stiffnesses or prescribed motion, that ended on another branch of equilibria
// than the one it came by: the branch has a limit point before, and the shape snapped through.
struct BranchChange {
  int step = 0;         // that left the branch, from 1
  int before = 0;       // a step before it, where both branches have an equilibrium
  double distance = 0;  // of the two there: of the node farthest apart [length]
};

struct Result {
  Vector q;  // the best iterate: finite, last accepted
  Status status = Status::Stalled;
  std::string message;  // one sentence for the user
  double energy = 0;    // potential energy [force x length]
  double residual = 0;  // relative, exact loads, measured by the objective after the solver returned
  int iterations = 0;
  std::string route;         // how a load without potential was treated, for the user; empty = there was none
  int outer_iterations = 0;  // outer renewals of such a load
  int damped_steps = 0;      // along a damped path, those at the full problem included

  // Of a damped path: steps from half of the loads on whose shape is unstable without dampers, so that the
  // ways of neighbours part there; -1 where nobody looked, as where no certificate is asked for.
  int unstable_steps = -1;
  EvaluationCounts evaluations;
  long factorisations = 0;
  long factorised_steps = 0;  // of these, those of the method itself and not of certificates
  std::vector<TermReport> terms;
  Certificate certificate;                   // where the problem asked for it
  std::vector<BranchChange> branch_changes;  // from the third step of a path on; a path of fewer has none
  std::vector<Iteration> trace;
  double wall_s = 0, cpu_s = 0;
  std::map<std::string, double> phase_s, phase_cpu_s;  // wall time and time of the processor by phase
};

// Runs a solver on a problem: follows the prescribed motion, renews loads without a potential until the
// exact residual is small, and measures the outcome by the objective's residual alone. Throws InputError,
// before anything is done, when a term limits steps and the solver does not honour it.
Result solve(Solver& solver, const Problem& problem, const StopRule& stop, const Observer& observer = {});

// How a step is kept from going too far.
enum class Globalisation {
  LineSearch,  // along the direction, until the energy falls enough
  TrustRegion  // the shift of the diagonal is raised until the whole step keeps what the model promised
};

struct XpbdBody;
struct XpbdOptions;

// What a user may choose of the methods; each takes what concerns it.
struct MethodOptions {
  int memory = 12;                                          // pairs that lbfgs keeps
  bool is_preconditioned = false;                           // lbfgs: the factorised Hessian as start metric
  Globalisation globalisation = Globalisation::LineSearch;  // newton
  DynamicOptions dynamic = {};
  std::shared_ptr<const XpbdOptions> xpbd = {};  // null: its defaults
};

// And what the build and the body give them.
struct SolverOptions : MethodOptions {
  FactorisationFactory factorisation = make_multifrontal_factorisation;  // newton, lbfgs
  std::shared_ptr<LastFactor> last_factor = {};  // that all made by `factorisation` share; null: none
  std::function<TriangleMesh()> surface =
      {};                               // at rest, over all nodes; asked for by collisions of `dynamic`
  std::function<Vector()> masses = {};  // lumped, of each node [t]; asked for by methods that move them
  std::function<std::shared_ptr<const XpbdBody>()> xpbd_body = {};  // constraints; asked for by xpbd alone

  // Names of terms of membranes that are no springs, as `"leaflets" (cst_stvk)`; asked for by mass-spring.
  std::function<std::vector<std::string>()> membranes = {};
};

using SolverFactory = std::function<std::unique_ptr<Solver>(const SolverOptions&)>;
using SolverTable = std::map<std::string, SolverFactory>;

// The solvers of this room: "newton", "lbfgs", "bfgs", "dynamic", "dynamic-explicit", "mass-spring". Others
// add themselves (add_xpbd_solver, add_ceres_solver, ...).
SolverTable built_in_solvers();

}  // namespace coapt
