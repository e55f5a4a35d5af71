#include "xpbd/solver_xpbd.hpp"

#include "core/error.hpp"
#include "core/number_text.hpp"
#include "mesh/triangle_mesh.hpp"
#include "optim/monitor.hpp"
#include "xpbd/driving_forces.hpp"
#include "xpbd/paper_numbers.hpp"
#include "xpbd/separating_planes.hpp"
#include "xpbd/system.hpp"

#include <cmath>

namespace coapt {
namespace {

constexpr double kRestingMove = 1e-7;  // of a node in a step, relative to the extent of the start
constexpr int kRestingSteps = 50;      // in a row
constexpr double kLittle = 0.01;       // of the longest move: an advance not worth another
constexpr int kMostAdvances = 8;       // by planes placed anew, in which a step gets as far as it can

constexpr const char* kNotConverged =
    "; the sweeps have not converged: more iterations or a shorter time_step";

// The sign of the forces, and the part of the prescribed motion that goes with it.
struct Phase {
  HeartPhase heart = HeartPhase::Systole;
  double from = 0, to = 1;
};

// Where the last step of a system may go without passing through anything, by nodes; as far as the terms say.
class CollisionFreeSteps {
 public:
  CollisionFreeSteps(Objective& objective, const XpbdBody& body, const XpbdOptions& options)
      : objective_(objective) {
    if (objective.step_limiting_term() != nullptr) planes_.emplace(body, options.thickness);
  }

  // Returns how many nodes do not get where they would.
  int limit(XpbdSystem& system) {
    if (!planes_) return 0;
    const Points end = system.positions();
    Points x = system.positions_before(), move;
    int held = 0;
    for (int advance = 0; advance < kMostAdvances; ++advance) {
      move = end - x;
      held = planes_->admit(x, system.inverse_masses(), move);
      // The planes are shared by less than the terms allow: this finds nothing but round-off, and what else
      // a term may limit.
      x += objective_.step_limit(x, move, 1) * move;
      if (held == 0 || move.cwiseAbs().maxCoeff() < kLittle * planes_->longest_move()) break;
    }
    system.place(x);
    return held;
  }

 private:
  Objective& objective_;
  std::optional<SeparatingPlanes> planes_;
};

class SolverXpbd final : public Solver {
 public:
  explicit SolverXpbd(const SolverOptions& options)
      : options_(options.xpbd ? *options.xpbd : XpbdOptions{}),
        body_of_scene_(options.xpbd_body),
        masses_of_scene_(options.masses) {
    std::vector<std::string> defects = check_xpbd_options(options_);
    for (std::string& defect : defects) defect = "solver \"xpbd\": " + defect;
    if (!defects.empty()) throw InputError(std::move(defects));
  }

  std::string_view name() const override { return "xpbd"; }
  bool follows_path() const override { return true; }
  bool is_at_rest() const override { return is_at_rest_ && has_arrived_; }
  std::string remark() const override { return remark_; }

  bool minimises_objective() const override { return false; }

  bool takes_motion(const MotionPath& motion) override {
    motion_ = motion;
    has_arrived_ = false;
    return true;
  }

  Status minimize(Objective& objective, Vector& q, Monitor& monitor) override {
    remark_.clear();
    is_at_rest_ = true;
    Vector g;
    const double energy = monitor.gradient(q, g);
    const std::optional<Status> stop = monitor.accept(q, energy, g);
    if (stop && !(motion_.positions && *stop == Status::Converged)) return *stop;
    load();
    const Points start = objective.positions(q);
    const DrivingForces forces(objective, *body_, options_);
    XpbdSystem system(*body_, start, objective.fixed(), masses_, options_);
    CollisionFreeSteps collisions(objective, *body_, options_);
    Status status = Status::Stalled;
    time_ = 0;
    for (const Phase& phase : phases(start)) {
      if (time_ > 0) monitor.begin_outer_iteration(monitor.outer_iteration() + 1, monitor.tolerance());
      status = follow({system, forces, collisions, objective, monitor}, phase, q);
      if (status != Status::Converged && status != Status::Stalled) break;
    }
    motion_ = {};
    if (body_->triangles.cols() > 0) {
      const double change = surface_area(objective.positions(q), body_->triangles) -
                            surface_area(body_->rest, body_->triangles);
      remark_ += std::string("; membrane area ") + (std::signbit(change) ? "" : "+") + number_text(change) +
                 " mm2 against rest";
    }
    return status;
  }

 private:
  struct Run {
    XpbdSystem& system;
    const DrivingForces& forces;
    CollisionFreeSteps& collisions;
    Objective& objective;
    Monitor& monitor;
  };

  void load() {
    if (body_) return;
    if (!body_of_scene_) throw InputError("solver \"xpbd\": needs the constraints of a body (xpbd_body)");
    body_ = body_of_scene_();
    const Eigen::Index count = body_->rest.cols();
    masses_ = Vector::Ones(count);
    if (options_.stiffness == XpbdStiffness::Paper) return;
    if (!masses_of_scene_) throw InputError("solver \"xpbd\": needs the masses of the nodes (masses)");
    masses_ = masses_of_scene_();
    if (masses_.size() != count || !((masses_.array() > 0).all() && masses_.allFinite()))
      throw InputError("solver \"xpbd\": needs one positive mass for each of " + std::to_string(count) +
                       " nodes");
  }

  // What opens has to be closed before.
  std::vector<Phase> phases(const Points& start) const {
    const Phase closing, opening{HeartPhase::Diastole, 1, 0};
    if (options_.phase == HeartPhase::Systole) return {closing};
    if (start == body_->rest) return {closing, opening};
    return {opening};
  }

  // Where the prescribed nodes have to be at a share of a phase; nothing moves those of a scene without
  // motion.
  Points prescribed_at(const Phase& phase, double share, const Run& run) const {
    if (!motion_.positions) return run.system.positions();
    run.monitor.set_path(share);
    return motion_.positions(phase.from + (phase.to - phase.from) * share);
  }

  // How far a phase has come, for the remark.
  std::string account(const Phase& phase, int steps) const {
    std::string said = std::to_string(steps) + " steps (" + number_text(time_) + " s)";
    if (phase.heart == HeartPhase::Diastole) said += " of opening";
    if (!has_arrived_) said += ", before the end of the prescribed motion";
    if (held_ > 0) said += ", " + std::to_string(held_) + " nodes held off";
    return said;
  }

  // Steps until the monitor says stop, nothing moves, or there have been enough.
  Status follow(const Run& run, const Phase& phase, Vector& q) {
    auto& [system, forces, collisions, objective, monitor] = run;
    const double extent = objective.extent(q), dt = xpbd_time_step(options_), begun = time_;
    const auto motion_steps = std::max(1.0, std::round(xpbd_motion_time(options_) / dt));
    Vector g;
    int resting = 0, step = 1;
    const auto say = [&](const char* how) { remark_ = how + account(phase, std::min(step, options_.steps)); };
    is_at_rest_ = false;
    for (; step <= options_.steps; ++step) {
      const double share = motion_.positions ? std::min(step / motion_steps, 1.0) : 1;
      const Points target = prescribed_at(phase, share, run);
      {
        PhaseTimer timer(monitor.phases(), "sweeps");
        system.step(forces.at(system.positions(), phase.heart), target);
      }
      if (!system.positions().allFinite()) {
        say("broke off after ");
        return Status::NonFinite;
      }
      {
        PhaseTimer timer(monitor.phases(), "collisions");
        held_ = collisions.limit(system);
      }
      const Points& x = system.positions();
      if (motion_.positions)
        has_arrived_ =
            share == 1 && objective.fixed().select(x - target, Points::Zero(3, x.cols())).isZero(0);
      objective.prescribe(x);
      const Vector next = objective.unknowns(x);
      time_ += dt;
      const double energy = monitor.gradient(next, g);
      const std::optional<Status> stop = monitor.accept(next, energy, g, time_ - begun);
      if (stop == Status::NonFinite) {
        objective.prescribe(system.positions_before());
        say("broke off after ");
        return *stop;
      }
      q = next;
      // The work that the tolerated force does along the scene.
      const bool is_slow =
          system.kinetic_energy() <= monitor.tolerance() * objective.reference_force(q) * extent;
      is_at_rest_ = is_slow;
      const bool goes_on =
          (stop == Status::Converged && !is_at_rest()) || (stop == Status::Stalled && !has_arrived_);
      if (stop && !goes_on) {
        say("after ");
        return *stop;
      }
      const bool rests = options_.rest_move > 0 ? system.mean_move() <= options_.rest_move
                                                : system.largest_move() <= kRestingMove * extent;
      resting = has_arrived_ && rests ? resting + 1 : 0;
      if (resting < kRestingSteps) continue;
      is_at_rest_ = true;
      say("at rest after ");
      if (body_->is_exact && options_.stiffness == XpbdStiffness::Material) remark_ += kNotConverged;
      return Status::Stalled;
    }
    say("still moving after ");
    return Status::Stalled;
  }

  XpbdOptions options_;
  std::function<std::shared_ptr<const XpbdBody>()> body_of_scene_;
  std::function<Vector()> masses_of_scene_;
  std::shared_ptr<const XpbdBody> body_;
  Vector masses_;
  MotionPath motion_;
  bool is_at_rest_ = true, has_arrived_ = true;  // masses, and the prescribed motion
  double time_ = 0;                              // since the start [s]
  int held_ = 0;                                 // nodes that the last step did not bring where they would
  std::string remark_;
};

}  // namespace

std::vector<std::string> check_xpbd_options(const XpbdOptions& options) {
  std::vector<std::string> defects;
  const auto require = [&](bool holds, const char* defect) {
    if (!holds) defects.emplace_back(defect);
  };
  require(options.time_step >= 0 && std::isfinite(options.time_step),
          "time_step: must be a time above 0, or 0 for the default");
  require(options.iterations >= 1, "iterations: must be at least 1");
  require(options.steps >= 1, "steps: must be at least 1");
  require(options.motion_time >= 0 && std::isfinite(options.motion_time),
          "motion_time: must be a time above 0, or 0 for the default");
  require(options.damping >= 0 && options.damping <= 1, "damping: must be a share, from 0 to 1");
  require(options.thickness > 0 && std::isfinite(options.thickness), "thickness: must be a length above 0");
  require(options.rest_move >= 0 && std::isfinite(options.rest_move),
          "rest_move: must be a length above 0, or 0 for the default");
  for (const PaperNumber& number : kPaperNumbers) {
    const double value = options.paper.*number.value;
    if (!(value >= 0 && (number.is_share ? value <= 1 : std::isfinite(value))))
      defects.push_back(
          std::string("paper.") + number.name +
          (number.is_share ? ": must be a share, from 0 to 1" : ": must be a number from 0 on"));
  }
  require(options.threads >= 1, "threads: must be at least 1");
  return defects;
}

std::unique_ptr<Solver> make_xpbd(const SolverOptions& options) {
  return std::make_unique<SolverXpbd>(options);
}

void add_xpbd_solver(SolverTable& table) { table["xpbd"] = make_xpbd; }

}  // namespace coapt
