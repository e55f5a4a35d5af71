#include "optim/xpbd/solver_xpbd.hpp"

#include "core/error.hpp"
#include "energy/connected_parts.hpp"
#include "mesh/triangle_mesh.hpp"
#include "optim/monitor.hpp"
#include "optim/xpbd/heart_forces.hpp"
#include "optim/xpbd/system.hpp"

#include <cmath>
#include <cstdio>

namespace coapt {
namespace {

constexpr double kRestingMove = 1e-7;  // of a node in a step, relative to the extent of the start
constexpr int kRestingSteps = 50;      // in a row
constexpr double kHeld = 0.01;         // share of a step that collisions leave: no motion to speak of

std::string text(const char* format, double value) {
  char buffer[64];
  std::snprintf(buffer, sizeof buffer, format, value);
  return buffer;
}

Points scene_forces(const Objective& objective, const Points& x, HeartPhase phase) {
  Points forces = Points::Zero(3, x.cols());
  for (const auto& term : objective.terms())
    if (term->role() == TermRole::Load) forces += nodal_forces(*term, x);
  return phase == HeartPhase::Systole ? forces : Points(-forces);
}

// The scene's pressure on a mean nodal area over the paper's p: the force that stands for one of the paper's
// [force].
double force_unit(const XpbdBody& body) {
  const Vector areas = nodal_areas(body.rest, body.triangles);
  const double count = static_cast<double>((areas.array() > 0).count());
  return count > 0 ? body.pressure * areas.sum() / count / XpbdPaper::kPressure : 0;
}

// Forces on the nodes at x, in the unit of the masses.
class Forces {
 public:
  Forces(const Objective& objective, const XpbdBody& body, const XpbdOptions& options)
      : objective_(objective), body_(body), options_(options) {
    const bool is_paper = options.forces == XpbdForces::Paper;
    if (is_paper && !has_heart_axis(body))
      throw InputError(
          "solver \"xpbd\": forces \"paper\" need a membrane and an ordered set \"annulus\" that encloses an "
          "opening; the scene has none");
    if (is_paper == (options.stiffness == XpbdStiffness::Paper)) return;
    const double unit = force_unit(body);
    if (!(unit > 0))
      throw InputError(
          "solver \"xpbd\": stiffness and forces are one \"paper\" and one not, and the scene has "
          "no pressure that says how large the paper's forces are; use both or neither");
    factor_ = is_paper ? unit : 1 / unit;
  }

  Points at(const Points& x) const {
    if (options_.forces == XpbdForces::Scene) return factor_ * scene_forces(objective_, x, options_.phase);
    return factor_ * heart_forces(body_, x, XpbdPaper::kFlow, XpbdPaper::kPressure, options_.phase);
  }

 private:
  const Objective& objective_;
  const XpbdBody& body_;
  const XpbdOptions& options_;
  double factor_ = 1;
};

class SolverXpbd final : public Solver {
 public:
  explicit SolverXpbd(const SolverOptions& options)
      : options_(options.xpbd), body_of_scene_(options.xpbd_body), masses_of_scene_(options.masses) {
    std::vector<std::string> defects = check_xpbd_options(options_);
    for (std::string& defect : defects) defect = "solver \"xpbd\": " + defect;
    if (!defects.empty()) throw InputError(std::move(defects));
  }

  std::string_view name() const override { return "xpbd"; }
  bool follows_path() const override { return true; }
  std::string remark() const override { return remark_; }

  Status minimize(Objective& objective, Vector& q, Monitor& monitor) override {
    remark_.clear();
    Vector g;
    const double energy = monitor.gradient(q, g);
    if (const std::optional<Status> stop = monitor.accept(q, energy, g)) return *stop;
    load();
    const Points start = objective.positions(q);
    const Forces forces(objective, *body_, options_);
    XpbdSystem system(*body_, start, objective.fixed(), masses_, options_);
    const Status status = follow(system, forces, objective, q, monitor);
    if (status == Status::Stalled && body_->triangles.cols() > 0)
      remark_ += "; membrane area " +
                 text("%+.3g", surface_area(objective.positions(q), body_->triangles) -
                                   surface_area(body_->rest, body_->triangles)) +
                 " mm2 against rest";
    return status;
  }

 private:
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

  // Steps until the monitor says stop, nothing moves, or there have been enough.
  Status follow(XpbdSystem& system, const Forces& forces, Objective& objective, Vector& q, Monitor& monitor) {
    const double resting = kRestingMove * objective.extent(q);
    Vector g;
    double time = 0;
    int at_rest = 0, held = 0;
    for (int step = 1; step <= options_.steps; ++step) {
      {
        PhaseTimer timer(monitor.phases(), "sweeps");
        system.step(forces.at(system.positions()));
      }
      if (!system.positions().allFinite()) return Status::NonFinite;
      Vector next = objective.unknowns(system.positions());
      const double taken = monitor.step_limit(q, next - q, 1);
      if (taken < 1) {
        system.retract(taken);
        next = q + taken * (next - q);
      }
      time += taken * xpbd_time_step(options_);
      const double energy = monitor.gradient(next, g);
      const std::optional<Status> stop = monitor.accept(next, energy, g, time);
      if (stop == Status::NonFinite) return *stop;
      q = next;
      if (stop) {
        remark_ = "after " + std::to_string(step) + " steps" + text(" (%.3g s)", time);
        return *stop;
      }
      at_rest = system.largest_move() <= resting ? at_rest + 1 : 0;
      held = taken < kHeld ? held + 1 : 0;
      if (at_rest < kRestingSteps && held < kRestingSteps) continue;
      remark_ = (held < kRestingSteps ? "at rest after " : "held by collisions after ") +
                std::to_string(step) + " steps" + text(" (%.3g s)", time);
      return Status::Stalled;
    }
    remark_ = "still moving after " + std::to_string(options_.steps) + " steps" + text(" (%.3g s)", time);
    return Status::Stalled;
  }

  XpbdOptions options_;
  std::function<std::shared_ptr<const XpbdBody>()> body_of_scene_;
  std::function<Vector()> masses_of_scene_;
  std::shared_ptr<const XpbdBody> body_;
  Vector masses_;
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
  require(options.damping >= 0 && options.damping <= 1, "damping: must be a share, from 0 to 1");
  require(options.thickness > 0 && std::isfinite(options.thickness), "thickness: must be a length above 0");
  require(options.threads >= 1, "threads: must be at least 1");
  return defects;
}

std::unique_ptr<Solver> make_xpbd(const SolverOptions& options) {
  return std::make_unique<SolverXpbd>(options);
}

}  // namespace coapt
