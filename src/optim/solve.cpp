#include "core/error.hpp"
#include "core/number_text.hpp"
#include "optim/bfgs.hpp"
#include "optim/continuation.hpp"
#include "optim/damped_path.hpp"
#include "optim/dynamic/dynamic.hpp"
#include "optim/lbfgs.hpp"
#include "optim/monitor.hpp"
#include "optim/newton.hpp"
#include "optim/solver.hpp"
#include "optim/stability/film_size.hpp"
#include "optim/stability/stationary_point.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace coapt {
namespace {

constexpr int kMostTurns = 3;        // of the lines along which films move
constexpr int kMostAttempts = 4;     // to leave saddles in one run
constexpr double kNear = 1e-3;       // residual of what is all but an equilibrium
constexpr double kFirstKick = 1e-2;  // off a saddle, relative to the extent of the unknowns
constexpr int kKickTrials = 8;       // lengths that are tried, each a quarter of the last

std::string sentence(const Result& result, double tolerance, const std::string& note) {
  const std::string wanted = " (tolerance " + number_text(tolerance) + ")";
  const std::string at = " at residual " + number_text(result.residual);
  std::string text;
  switch (result.status) {
    case Status::Converged:
      text = "converged" + at + wanted;
      if (const std::string doubt = stability_doubt(result.certificate); !doubt.empty())
        text = "converged, but its stability is in doubt (" + doubt + ")," + at + wanted;
      break;
    case Status::IterationLimit:
      text = "stopped at the iteration limit" + at;
      break;
    case Status::TimeLimit:
      text = "stopped at the time limit" + at;
      break;
    case Status::Cancelled:
      text = "cancelled" + at + "; the last accepted state was kept";
      break;
    case Status::NonFinite:
      text = "the energy or its gradient is not finite; the last finite state was kept";
      break;
    case Status::LineSearchFailed:
    case Status::Stalled:
      text = "stalled" + at + wanted;
      break;
    case Status::NoEquilibrium:
      text = "no equilibrium";
      break;
  }
  return note.empty() ? text : text + ": " + note;
}

bool feels_no_force(const Result& result) {
  return std::all_of(result.terms.begin(), result.terms.end(),
                     [](const TermReport& term) { return term.greatest_force == 0; });
}

// The verdict is the objective's, whatever the solver thinks.
void conclude(const Outcome& outcome, const Solver& solver, const Problem& problem, const StopRule& stop,
              Monitor& monitor, Result& result) {
  Objective& objective = problem.objective;
  std::string note = outcome.note;
  result.status = outcome.status;
  result.residual = objective.true_residual(result.q);
  const double sliding = objective.sliding_force(result.q);
  if (result.residual <= stop.tolerance && result.status != Status::Cancelled &&
      result.status != Status::NoEquilibrium && !outcome.is_short_of_full && solver.is_at_rest())
    result.status = Status::Converged;
  else if (result.status == Status::Converged || result.status == Status::LineSearchFailed)
    result.status = Status::Stalled;
  result.iterations = monitor.iterations();

  if (problem.stability.factorisation) {
    PhaseTimer timer(monitor.phases(), "certificate");
    result.certificate =
        certify(objective, result.q, stop.tolerance, problem.stability, result.status == Status::Converged);
    monitor.count_certificate(result.certificate.stability.factorisations);
  }
  // The potential around the final state, so that the energy depends on that state alone and not on the
  // path that a solver took to it.
  if (objective.has_circulatory_force()) objective.lag_circulatory_force(result.q);
  result.terms = objective.breakdown(result.q);
  result.energy = 0;
  for (const TermReport& term : result.terms) result.energy += term.energy;

  if (result.status == Status::Converged && result.iterations == 0) {
    if (objective.free_count() == 0)
      note = "no coordinate is free: there is nothing to solve";
    else
      note = feels_no_force(result) ? "no force acts anywhere: there is nothing to solve"
                                    : "the start is an equilibrium already";
  }
  if (result.status == Status::Converged && note.empty() && sliding > stop.tolerance)
    note = "forces along its films, up to " + number_text(sliding) + ", are the mesh's and left out";
  result.message = sentence(result, stop.tolerance, note);
}

// Leaves a saddle, or a divergence under a follower load, along its unstable mode: downhill, by the work
// along the way where there is no energy, and to the side on which that falls more, as the sign of a mode is
// the accident of the order of nodes. What descends from a saddle never comes back to it, as its energy is
// lower; what a follower load drives may, so that every other attempt tries the other side first, and later
// ones go farther. Returns false where there is nothing to leave or no way down was found.
bool leave_unstable(Objective& objective, int attempt, Monitor& monitor, Result& result) {
  const Vector& mode = result.certificate.stability.descent;
  if (result.status != Status::Converged || mode.size() == 0) return false;
  if (objective.has_circulatory_force()) objective.set_path_anchor(result.q);
  const double energy = monitor.value(result.q), wanted = energy - monitor.energy_noise(energy);
  const double first = (1 + attempt / 2) * kFirstKick * objective.extent(result.q);  // NOLINT: whole pairs
  double length = first / mode.lpNorm<Eigen::Infinity>();
  for (int trial = 0; trial < kKickTrials; ++trial, length *= 0.25) {
    std::array<Vector, 2> sides;
    std::array<double, 2> energies{};
    for (const int k : {0, 1}) {
      const Vector way = (k == 0 ? 1 : -1) * mode;
      sides[k] = result.q + monitor.step_limit(result.q, way, length) * way;
      energies[k] = monitor.value(sides[k]);
    }
    const int lower = energies[1] < energies[0] ? 1 : 0, first_tried = attempt % 2 == 0 ? lower : 1 - lower;
    for (const int k : {first_tried, 1 - first_tried})
      if (energies[k] < wanted) {
        result.q = sides[k];
        return true;
      }
  }
  return false;
}

// Minimises again along lines that are turned to the normals of the films found, while some lie askew.
Status turn_and_minimize(Solver& solver, Objective& objective, Vector& q, Monitor& monitor,
                         const StopRule& stop, Status status) {
  for (int turn = 0; turn < kMostTurns && status != Status::NoEquilibrium && status != Status::Cancelled &&
                     !monitor.is_out_of_time() && objective.turn_films(q);
       ++turn) {
    monitor.begin_outer_iteration(monitor.outer_iteration() + 1, stop.tolerance);
    status = solver.minimize(objective, q, monitor);
  }
  return status;
}

// Whether no easier problem precedes the full one.
bool is_at_once(const Problem& problem) {
  const Continuation& way = problem.continuation;
  return !problem.motion.positions && way.load_steps <= 1 && way.stiffness_steps <= 1 &&
         way.damped_steps == 0;
}

// What pinches off on one way may have an equilibrium on another: films are spanned between their supports
// anew.
std::optional<Vector> span_again(Solver& solver, const Problem& problem, const StopRule& stop,
                                 Monitor& monitor, const Vector& q) {
  Objective& objective = problem.objective;
  if (!is_at_once(problem) || monitor.is_out_of_time()) return std::nullopt;
  const auto spanned = spanned_films(objective, objective.positions(q));
  if (!spanned) return std::nullopt;
  Vector film = objective.unknowns(*spanned);
  objective.turn_films(film);
  monitor.begin_outer_iteration(monitor.outer_iteration() + 1, stop.tolerance);
  const Status first = solver.minimize(objective, film, monitor);
  if (turn_and_minimize(solver, objective, film, monitor, stop, first) != Status::Converged)
    return std::nullopt;
  return film;
}

// Where the run stands after a path that led nowhere.
void stand_again(const StopRule& stop, Monitor& monitor, Result& result) {
  Vector g;  // noise is measured where the run stands again
  monitor.begin_outer_iteration(monitor.outer_iteration() + 1, stop.tolerance);
  monitor.accept(result.q, monitor.gradient(result.q, g), g);
  result.iterations = monitor.iterations();
}

// Goes on from an unstable equilibrium to a stable one. It remains the answer where both ways from it lead to
// none, nor does a film that is spanned anew.
void reach_stable(Solver& solver, const Problem& problem, const StopRule& stop, Monitor& monitor,
                  Result& result) {
  int without_equilibrium = 0;
  for (int attempt = 0; attempt < kMostAttempts && without_equilibrium < 2; ++attempt) {
    Result unstable = result;
    if (!leave_unstable(problem.objective, attempt, monitor, result)) break;
    Outcome outcome;
    outcome.status = run_outer_iterations(solver, problem.objective, result.q, monitor, stop.tolerance,
                                          result.outer_iterations, outcome.note);
    if (outcome.status == Status::NoEquilibrium) {
      ++without_equilibrium;
      result = std::move(unstable);
      stand_again(stop, monitor, result);
      continue;
    }
    without_equilibrium = 0;
    if (outcome.note.empty()) outcome.note = "a saddle was left on the path to it";
    conclude(outcome, solver, problem, stop, monitor, result);
  }
  if (without_equilibrium == 0) return;
  if (auto film = span_again(solver, problem, stop, monitor, result.q)) {
    result.q = std::move(*film);
    conclude({Status::Converged, "an unstable one was left for films spanned between their supports anew"},
             solver, problem, stop, monitor, result);
    return;
  }
  stand_again(stop, monitor, result);
  result.message += "; once left, no equilibrium was found";
}

// What a run found, and whether it ends there although the state is unstable.
struct Found {
  Outcome outcome;
  bool is_only_unstable = false;
  double least_residual = kInfinity;  // of searches that found none
};

// The same along lines that are turned to the normals of films found elsewhere.
StationarySearch reach_stationary_film(Objective& objective, Vector& q, Monitor& monitor, double tolerance) {
  StationarySearch search = reach_stationary_point(objective, q, monitor, tolerance);
  for (int turn = 0; turn < kMostTurns && search.is_found && objective.turn_films(q); ++turn)
    search = reach_stationary_point(objective, q, monitor, tolerance);
  return search;
}

// A film whose size tension and pressure alone decide has none but unstable equilibria, which no minimiser
// comes to.
bool find_free_film(const Problem& problem, const StopRule& stop, Monitor& monitor, Vector& q) {
  Objective& objective = problem.objective;
  if (!is_at_once(problem)) return false;
  const auto films = free_films(objective, objective.positions(q));
  if (!films || films->balanced.size() == 0) return false;
  Vector film = objective.unknowns(films->balanced);
  if (!reach_stationary_film(objective, film, monitor, stop.tolerance).is_found) {
    const auto round = free_films(objective, rounded_films(objective, films->balanced));
    if (!round || round->balanced.size() == 0) return false;
    film = objective.unknowns(round->balanced);
    objective.turn_films(film);
    if (!reach_stationary_film(objective, film, monitor, stop.tolerance).is_found) return false;
  }
  q = std::move(film);
  return true;
}

// A minimiser may pass an equilibrium and run away: it is looked for where the forces were least, and at the
// start.
bool find_passed(const Problem& problem, const StopRule& stop, Monitor& monitor,
                 const EquilibriumWatch& watch, const Vector& start, Found& found, Vector& q) {
  double& least = found.least_residual;
  for (const Vector* from : {&watch.nearest(), &start}) {
    if (from->size() == 0 || monitor.is_out_of_time()) continue;
    Vector film = *from;
    const StationarySearch search = reach_stationary_film(problem.objective, film, monitor, stop.tolerance);
    least = std::min(least, search.least_residual);
    if (!search.is_found) continue;
    q = std::move(film);
    found.outcome = {Status::Converged, "the solver had left it: " + watch.reason()};
    return true;
  }
  if (least < kInfinity)
    found.outcome.note += "; before, no residual below " + number_text(least) + " was found" +
                          (least < kNear ? ", so little that a finer mesh may have one" : "");
  return false;
}

Found run_solver(Solver& solver, const Problem& problem, const StopRule& stop, Monitor& monitor,
                 EquilibriumWatch& watch, Result& result) {
  Objective& objective = problem.objective;
  Found found;
  if (find_free_film(problem, stop, monitor, result.q)) {
    found.outcome.note =
        "tension and pressure alone decide the size of the film, which grows without bound "
        "or shrinks to nothing once it leaves this one";
    found.is_only_unstable = true;
    return found;
  }
  const Vector start = result.q;
  Outcome& outcome = found.outcome;
  const bool is_damped = problem.continuation.damped_steps > 0 && solver.minimises_objective();
  outcome = (is_damped ? follow_damped_path : run_continuation)(solver, problem, stop, monitor, result);
  outcome.status = turn_and_minimize(solver, objective, result.q, monitor, stop, outcome.status);
  if (outcome.status == Status::NoEquilibrium) {
    outcome.note = watch.reason();
    if (watch.sees_films() && !find_passed(problem, stop, monitor, watch, start, found, result.q) &&
        found.least_residual >= kNear)
      if (auto film = span_again(solver, problem, stop, monitor, start)) {
        result.q = std::move(*film);
        outcome = {Status::Converged, "from the start, " + outcome.note};
      }
  }
  if (outcome.note.empty()) outcome.note = solver.remark();
  return found;
}

}  // namespace

std::string_view status_name(Status status) {
  switch (status) {
    case Status::Converged:
      return "converged";
    case Status::IterationLimit:
      return "iteration_limit";
    case Status::TimeLimit:
      return "time_limit";
    case Status::Stalled:
      return "stalled";
    case Status::LineSearchFailed:
      return "line_search_failed";
    case Status::NonFinite:
      return "non_finite";
    case Status::Cancelled:
      return "cancelled";
    case Status::NoEquilibrium:
      return "no_equilibrium";
  }
  return "";
}

Result solve(Solver& solver, const Problem& problem, const StopRule& stop, const Observer& observer) {
  Objective& objective = problem.objective;
  if (const EnergyTerm* term = objective.step_limiting_term();
      term != nullptr && !solver.honours_step_limits())
    throw InputError(
        "solver \"" + std::string(solver.name()) +
        "\" chooses its steps itself and cannot keep them free of collisions, which term \"" + term->name() +
        "\" (" + std::string(term->type()) +
        ") needs; use \"newton\", \"lbfgs\", \"bfgs\", \"dynamic\" or \"xpbd\", or \"contact_facet\"");
  const double cpu_start = cpu_seconds();
  const EvaluationCounts counts_before = objective.counts();
  Monitor monitor(objective, stop, observer);

  objective.restore_stiffness();
  Result result;
  result.q = objective.smooth_start(problem.q0);
  objective.turn_films(result.q);
  EquilibriumWatch watch(objective, result.q);
  monitor.set_watch(&watch);
  Found found{{Status::NoEquilibrium, watch.obstacle()}};
  if (found.outcome.note.empty()) found = run_solver(solver, problem, stop, monitor, watch, result);
  if (objective.has_circulatory_force())
    result.route = solver.follows_path()
                       ? "exact force, with its work along the path as merit"
                       : "potential of the surface closed by a fan, remainder lagged and updated in " +
                             std::to_string(result.outer_iterations) + " outer iterations";
  conclude(found.outcome, solver, problem, stop, monitor, result);
  if (!found.is_only_unstable) reach_stable(solver, problem, stop, monitor, result);

  result.evaluations = {objective.counts().value - counts_before.value,
                        objective.counts().gradient - counts_before.gradient,
                        objective.counts().hessian - counts_before.hessian};
  result.factorisations = monitor.factorisations();
  result.factorised_steps = monitor.factorised_steps();
  result.trace = monitor.take_trace();
  result.phase_s = monitor.phases().wall();
  result.phase_cpu_s = monitor.phases().cpu();
  result.wall_s = monitor.seconds();
  result.cpu_s = cpu_seconds() - cpu_start;
  return result;
}

SolverTable built_in_solvers() {
  return {{"lbfgs", [](const SolverOptions& options) { return make_lbfgs(options); }},
          {"bfgs", [](const SolverOptions&) { return make_bfgs(); }},
          {"dynamic", [](const SolverOptions& options) { return make_dynamic(options); }},
          {"dynamic-explicit", [](const SolverOptions& options) { return make_dynamic_explicit(options); }},
          {"mass-spring", [](const SolverOptions& options) { return make_mass_spring(options); }},
          {"newton", [](const SolverOptions& options) { return make_newton(options); }}};
}

}  // namespace coapt
