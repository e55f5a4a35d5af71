#include "optim/dynamic/dynamic.hpp"

#include "core/error.hpp"
#include "optim/dynamic/time_integrator.hpp"
#include "optim/dynamic/vertex_proximity.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace coapt {

double kinetic_energy(const Motion& at, const Vector& mass) { return 0.5 * at.v.cwiseAbs2().dot(mass); }

namespace {

constexpr const char *kDynamic = "dynamic", *kExplicit = "dynamic-explicit", *kMassSpring = "mass-spring";

constexpr double kShorter = 0.25;    // after a step that failed
constexpr double kShortest = 1e-12;  // of the first step
constexpr double kMostApproach =
    0.5;                        // of the distance of collisions, that a step may bring two nodes closer
constexpr int kRestSteps = 50;  // at rest in a row, after which collisions hold what the objective does not

// The largest of the nodes' vectors.
double fastest(const Vector& unknowns) {
  return unknowns.size() == 0 ? 0 : unknowns.reshaped(3, unknowns.size() / 3).colwise().norm().maxCoeff();
}

// The seeds' collisions, over unknowns.
class CollisionHandling {
 public:
  CollisionHandling(const DynamicOptions& options, const TriangleMesh& surface, const Objective& objective,
                    const Vector& masses)
      : kind_(options.collisions),
        proximity_(surface.vertices, surface.triangles, options.collision_distance),
        objective_(objective),
        masses_(masses) {
    for (Eigen::Index k = 0; k < masses_.size(); ++k)
      if (objective.fixed().col(k).any()) masses_[k] = kInfinity;
  }

  // Finds what is near at the new state and stops its approach. Returns whether a velocity changed.
  bool act(Motion& at) {
    if (proximity_.find(objective_.positions(at.q)) == 0) return false;
    Points v = nodal(at.v);
    proximity_.stop_approach(v, masses_);
    const Vector stopped = objective_.unknowns(v);
    const bool is_changed = stopped != at.v;
    at.v = stopped;
    return is_changed;
  }

  // The forces that balance what presses, for the next step.
  void press_back(const Motion& at, Vector& applied) const {
    if (kind_ == Collisions::Balanced)
      applied = objective_.unknowns(proximity_.balancing_forces(nodal(-at.g)));
  }

 private:
  // A vector of unknowns over the nodes; zero where nothing is free.
  Points nodal(const Vector& unknowns) const {
    return objective_.fixed().select(0, objective_.positions(unknowns).array()).matrix();
  }

  Collisions kind_;
  VertexProximity proximity_;
  const Objective& objective_;
  Vector masses_;  // of each node
};

class SolverDynamic final : public Solver {
 public:
  SolverDynamic(const char* name, const SolverOptions& options)
      : name_(name),
        options_(options.dynamic),
        factorisation_(options.factorisation),
        masses_(options.masses()) {
    if (!(masses_.array() > 0).all() || !masses_.allFinite())
      throw InputError("solver \"" + std::string(name_) + "\": every node needs a mass above 0");
    if (options_.collisions != Collisions::None) surface_ = options.surface();
  }

  std::string_view name() const override { return name_; }
  bool follows_path() const override { return true; }
  bool minimises_objective() const override { return name_ == kDynamic; }
  bool is_at_rest() const override { return is_at_rest_; }

  Status minimize(Objective& objective, Vector& q, Monitor& monitor) override {
    const Vector mass = objective.unknowns(masses_.transpose().replicate<3, 1>());
    Vector applied = Vector::Zero(q.size());
    const auto integrator = make_integrator({objective, monitor, mass, applied});
    std::optional<CollisionHandling> collisions;
    if (surface_) collisions.emplace(options_, *surface_, objective, masses_);
    const double extent = objective.extent(q);
    Motion at{q, Vector::Zero(q.size()), 0, Vector(), 0};
    at.energy = monitor.gradient(at.q, at.g);
    double kinetic = 0, h = options_.time_step;
    int rest_steps = 0;
    if (options_.adapts_steps && options_.integration == TimeIntegration::SemiImplicitEuler)
      h = std::min(h, integrator->next_step(h, at));
    while (true) {
      // The work that the tolerated force does along the scene.
      is_at_rest_ = kinetic <= monitor.tolerance() * objective.reference_force(at.q) * extent;
      const auto status = monitor.accept(at.q, at.energy + kinetic, at.g, at.time);
      if (status != Status::NonFinite) q = at.q;
      if (status && (*status != Status::Converged || is_at_rest_)) return *status;
      rest_steps = is_at_rest_ && at.time > 0 ? rest_steps + 1 : 0;
      if (collisions && rest_steps >= kRestSteps) return Status::Stalled;
      if (const Status step = advance(*integrator, monitor, h, at); step != Status::Converged) return step;
      if (collisions) {
        if (collisions->act(at)) integrator->restart();
        collisions->press_back(at, applied);
      }
      const double before = kinetic;
      kinetic = kinetic_energy(at, mass);
      if (options_.has_kinetic_damping && before > 0 && kinetic <= before) {
        // Back to the peak: velocities are half a step ahead of positions, and stopping them beyond it would
        // keep what fast oscillations have.
        at.q = last_.q;
        at.g = last_.g;
        at.energy = last_.energy;
        at.v.setZero();
        kinetic = 0;
        integrator->restart();
      }
    }
  }

 private:
  std::unique_ptr<TimeIntegrator> make_integrator(const TimeIntegratorContext& context) const {
    return options_.integration == TimeIntegration::BackwardDifferences
               ? make_backward_differences(context, options_, factorisation_)
               : make_semi_implicit_euler(context, options_);
  }

  // One step of h, or of the greatest shorter length that leads anywhere; h becomes that of the next.
  // Converged: it was done.
  Status advance(TimeIntegrator& integrator, Monitor& monitor, double& h, Motion& at) {
    if (surface_ || options_.has_kinetic_damping) last_ = at;
    while (true) {
      if (integrator.step(h, at)) {
        if (!surface_ || !options_.adapts_steps || approach(at) <= options_.collision_distance) break;
        at = last_;  // what was far apart may have passed through each other
        integrator.restart();
      }
      if (monitor.is_out_of_time()) return Status::TimeLimit;
      if (!options_.adapts_steps || h < kShortest * options_.time_step) return Status::LineSearchFailed;
      h *= kShorter;
    }
    if (options_.adapts_steps) h = std::min(integrator.next_step(h, at), options_.longest_step);
    const double speed = surface_ ? 2 * fastest(at.v) : 0;
    if (speed > 0 && options_.adapts_steps)
      h = std::min(h, kMostApproach * options_.collision_distance / speed);
    return Status::Converged;
  }

  // The most that two nodes can have come closer in the last step.
  double approach(const Motion& at) const { return 2 * fastest(at.q - last_.q); }

  std::string_view name_;
  DynamicOptions options_;
  FactorisationFactory factorisation_;
  Vector masses_;                        // of each node
  std::optional<TriangleMesh> surface_;  // where collisions are looked for
  Motion last_;                          // before the last step; only of those who look back
  bool is_at_rest_ = true;
};

std::unique_ptr<Solver> make(const char* name, const SolverOptions& options) {
  const std::string who = "solver \"" + std::string(name) + "\"";
  if (!options.masses) throw InputError(who + " needs the masses of the nodes");
  const DynamicOptions& dynamic = options.dynamic;
  if (!(dynamic.time_step > 0 && dynamic.longest_step > 0 && dynamic.relaxation_time >= 0))
    throw InputError(who + ": time steps must be above 0, the relaxation time at least 0");
  if (dynamic.collisions != Collisions::None && !(options.surface && dynamic.collision_distance > 0))
    throw InputError(who + ": collisions need a surface and a distance above 0");
  return std::make_unique<SolverDynamic>(name, options);
}

}  // namespace

std::unique_ptr<Solver> make_dynamic(const SolverOptions& options) { return make(kDynamic, options); }

std::unique_ptr<Solver> make_dynamic_explicit(const SolverOptions& options) {
  SolverOptions own = options;
  own.dynamic.integration = TimeIntegration::SemiImplicitEuler;
  return make(kExplicit, own);
}

std::unique_ptr<Solver> make_mass_spring(const SolverOptions& options) {
  std::vector<std::string> defects;
  for (const std::string& membrane : options.membranes ? options.membranes() : std::vector<std::string>())
    defects.push_back(
        "solver \"mass-spring\" moves masses on springs, and term " + membrane +
        " is none; take term type \"spring\" (as --model hammer-2008 and hammer-2011 do), `coapt "
        "compare --methods mass-spring`, which puts springs in its place, or solver "
        "\"dynamic-explicit\"");
  if (!defects.empty()) throw InputError(defects);
  SolverOptions own = options;
  own.dynamic.integration = TimeIntegration::SemiImplicitEuler;
  own.dynamic.drag = Drag::Equal;
  return make(kMassSpring, own);
}

bool is_dynamic(std::string_view solver) {
  return solver == kDynamic || solver == kExplicit || solver == kMassSpring;
}

}  // namespace coapt
