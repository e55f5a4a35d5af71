#include "tuning/first_order.hpp"

#include "core/error.hpp"
#include "run/run_parts.hpp"
#include "tuning/tracked_scene.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace coapt {
namespace {

constexpr double kShare = 0.1;           // of a factor or a number, that is tried first
constexpr double kShift = 0.05;          // of the extent of the sheet, of a displacement
constexpr double kTilt = 0.1;            // [rad]
constexpr double kUsualExtent = 40;      // [mm] of a sheet to which the tolerance belongs
constexpr double kKept = 0.8;            // of the tolerance: the rest is for rounding in a page
constexpr double kSameShape = 1e-2;      // of the tolerance, that a shape may miss the report's by
constexpr double kMostMovement = 8;      // of the tolerance, of a node by the change that is tried first
constexpr int kMostTrials = 4;           // solves for one end of a range
constexpr double kLeastMovement = 0.05;  // of the tolerance: what moves the sheet less says nothing

// One number, or one direction among the numbers of a parameter.
struct Direction {
  ParameterResponse response;
  Vector change;    // of all numbers of the equilibrium, per unit
  double step = 0;  // that is tried first, in units
};

struct Meaning {
  std::string name, unit;
  double step = 0, per_unit = 1;  // step in units; change of the number by one unit
};

// Of GROUP.WHAT or TERM.WHAT.
std::string in_words(const std::string& what) {
  if (what == "length") return "rest length";
  std::string words = what;
  std::replace(words.begin(), words.end(), '_', ' ');
  return words;
}

// What each number of a parameter means; none: this kind is not for sliders.
std::vector<Meaning> meanings(const std::string& key, const Vector& value, double extent) {
  const size_t dot = key.rfind('.');
  const std::string object = key.substr(0, dot), what = key.substr(dot + 1);
  const auto share = [&](const std::string& name, double size) {
    return Meaning{name, "%", 100 * kShare, size / 100};
  };
  if (what == "shift") {
    std::vector<Meaning> all;
    for (const char* axis : {"x", "y", "z"})
      all.push_back({object + ": shift along " + axis, "mm", kShift * extent, 1});
    return all;
  }
  if (what == "ring")
    return {share(object + ": longer width", 1),
            share(object + ": shorter width", 1),
            share(object + ": height of the saddle", 1),
            {object + ": tilt", "°", kTilt * 180 / std::numbers::pi, std::numbers::pi / 180}};
  if (value.size() != 1 || value[0] == 0) return {};
  return {share(object + ": " + in_words(what), value[0])};
}

// Lower is asked first; of two that change the same, the one that comes later is left out.
int order(const std::string& key, const Model& model) {
  const std::string object = key.substr(0, key.rfind('.')), what = key.substr(key.rfind('.') + 1);
  if (what == "lengths" || what == "positions" || what == "rest" || what == "forces") return -1;
  const bool is_set = model.sets.contains(object);
  if (is_set && what == "ring") return object == "annulus" ? 0 : -1;
  if (is_set && what == "shift") return object == "boundary" || object == "annulus" ? -1 : 1;
  const bool is_term = std::any_of(model.objective->terms().begin(), model.objective->terms().end(),
                                   [&](const auto& term) { return term->name() == object; });
  if (what == "length")
    return is_term ? 4 : object.starts_with("tip_") ? 3 : 2;  // materials before tips, before all
  if (what == "smoothing" || what == "scale") return -1;
  return 5;
}

class Responses {
 public:
  Responses(const Model& model, const Report& report, TrackedScene&& tracked, const FirstOrderOptions& wanted)
      : tracked_(std::move(tracked)), equilibrium_(*tracked_.equilibrium) {
    const Eigen::Index sheet = model.mesh.vertex_count() > 0 ? model.mesh.vertex_count() : model.X.cols();
    for (int node = 0; node < sheet; ++node)
      if (report.fields.undetermined.empty() || !report.fields.undetermined[static_cast<size_t>(node)])
        nodes_.push_back(node);
    const Points& x = report.fields.x;
    extent_ = (x.leftCols(sheet).rowwise().maxCoeff() - x.leftCols(sheet).rowwise().minCoeff()).norm();
    found_.tolerance_mm = wanted.tolerance_mm * std::max(1.0, extent_ / kUsualExtent);
  }

  // Parameters that go together, with what each of their numbers means.
  void take_parameters(const Scene& scene) {
    std::vector<std::string> keys = parameter_names(tracked_);
    const auto place = [this](const std::string& key) { return order(key, tracked_.model); };
    std::erase_if(keys, [&](const std::string& key) { return place(key) < 0; });
    std::stable_sort(keys.begin(), keys.end(),
                     [&](const auto& a, const auto& b) { return place(a) < place(b); });
    std::vector<std::pair<size_t, std::string>> taken;
    for (const std::string& key : keys) try {
        std::unique_ptr<Parameter> parameter = make_named_parameter(key, scene, tracked_);
        if (meanings(key, parameter->value(), extent_).empty()) continue;
        taken.emplace_back(equilibrium_.add(std::move(parameter)), key);
      } catch (const InputError&) {  // changes what one before it does, or cannot be changed alone
      }
    for (const auto& [index, key] : taken) {
      const std::vector<Meaning> all = meanings(key, equilibrium_.parameter(index).value(), extent_);
      for (size_t k = 0; k < all.size(); ++k) {
        const Eigen::Index number = equilibrium_.first_number(index) + static_cast<Eigen::Index>(k);
        directions_.push_back({{.name = all[k].name, .key = key, .unit = all[k].unit},
                               all[k].per_unit * Vector::Unit(equilibrium_.number_count(), number),
                               all[k].step});
      }
    }
    found_.candidates = static_cast<int>(directions_.size());
  }

  // Pre: the report's shape. Empty: it is an equilibrium of the tracked scene.
  std::string solve_first(const Points& x) {
    if (const WarmSolve solved = equilibrium_.solve(); solved.status != Status::Converged)
      return "the shape is no equilibrium when it is solved again: " + solved.message;
    x_ = equilibrium_.positions();
    value_ = equilibrium_.value();
    if (distance(x) > kSameShape * found_.tolerance_mm)
      return "the scene solved again from the result ends elsewhere";
    return "";
  }

  // The derivative of the shape by each, those that move the sheet most first.
  void rank(size_t most) {
    for (Direction& direction : directions_) try {
        direction.response.motion = equilibrium_.response(direction.change);
        const Points moved = direction.response.motion(Eigen::all, nodes_);
        direction.response.movement_mm = direction.step * std::sqrt(moved.colwise().squaredNorm().mean());
      } catch (const InputError& error) {
        found_.message = error.defects().front();
      }
    std::erase_if(directions_, [this](const Direction& each) {
      return !(each.response.movement_mm > kLeastMovement * found_.tolerance_mm);
    });
    std::stable_sort(directions_.begin(), directions_.end(), [](const Direction& a, const Direction& b) {
      return a.response.movement_mm > b.response.movement_mm;
    });
    most_ = most;
  }

  // Until as many as wanted are checked.
  FirstOrder checked() {
    for (Direction& direction : directions_) {
      if (found_.parameters.size() == most_ || is_lost_) break;
      for (const int side : {0, 1}) check(direction, side);
      const auto& ends = direction.response.ends;
      if (ends[0].change != 0 || ends[1].change != 0)
        found_.parameters.push_back(std::move(direction.response));
    }
    if (!found_.parameters.empty())
      found_.message.clear();
    else if (found_.message.empty())
      found_.message = "no parameter moves the sheet over a range in which the first order holds";
    return std::move(found_);
  }

 private:
  // Of the nodes that count, the greatest.
  double distance(const Points& x) const {
    const Points apart = (equilibrium_.positions() - x)(Eigen::all, nodes_);
    return apart.cols() == 0 ? 0 : std::sqrt(apart.colwise().squaredNorm().maxCoeff());
  }

  // Whether the solve converged.
  bool solve_at(const Vector& value) {
    try {
      equilibrium_.set(value);
      return equilibrium_.solve().status == Status::Converged;
    } catch (const InputError&) {  // beyond a limit of the parameter, or no tangent to predict with
      return false;
    }
  }

  void check(Direction& direction, int side) {
    const Points moved = direction.response.motion(Eigen::all, nodes_);
    const double furthest = std::sqrt(moved.colwise().squaredNorm().maxCoeff());
    double change = std::min(direction.step, kMostMovement * found_.tolerance_mm / furthest);
    if (side == 0) change = -change;
    for (int trial = 0; trial < kMostTrials && !is_lost_; ++trial) {
      const bool is_solved = solve_at(value_ + change * direction.change);
      const double error = is_solved ? distance(x_ + change * direction.response.motion) : kInfinity;
      if (error <= kKept * found_.tolerance_mm) {
        direction.response.ends[static_cast<size_t>(side)] = {change, error, figures()};
        return;
      }
      // What ends so far away may be on another branch.
      if (error > kMostMovement * found_.tolerance_mm || trial + 1 == kMostTrials)
        is_lost_ = !solve_at(value_) || distance(x_) > kKept * found_.tolerance_mm;
      // By the square where the shape is smooth, at least by a tenth.
      const double share = std::isfinite(error) ? std::sqrt(kKept * found_.tolerance_mm / error) : 0;
      change *= std::clamp(0.9 * share, 0.1, trial == 0 ? 0.9 : 0.5);
    }
  }

  std::vector<MetricRow> figures() {
    take_rest_lengths(tracked_.model);
    const Fields fields = compute_fields(tracked_.model, equilibrium_.positions());
    const IntersectionChecker none = {
        "nobody", [](const Points&, const Triangles&) { return std::vector<std::array<int, 2>>(); }};
    return metric_rows(measure(tracked_.model, equilibrium_.unknowns(), fields, none));
  }

  TrackedScene tracked_;
  TrackedEquilibrium& equilibrium_;
  FirstOrder found_;
  std::vector<Direction> directions_;
  std::vector<int> nodes_;  // of the sheet, whose places are determined
  double extent_ = 0;       // [mm]
  size_t most_ = 0;
  Points x_;              // of the result
  Vector value_;          // numbers there
  bool is_lost_ = false;  // the result was not found again
};

}  // namespace

FirstOrder first_order(const Scene& scene, const SolverTable& solvers, const RunOptions& options,
                       const Model& model, const Report& report, const FirstOrderOptions& wanted) {
  FirstOrder none;
  none.message = "the solve did not converge";
  if (report.result.status != Status::Converged) return none;
  const Points start = report.fields.x.colwise() + model.origin;
  RunOptions again = options;
  again.solver = report.solver;
  again.tolerance = report.tolerance;
  again.modes = 0;
  TrackingOptions tracking{.tolerance = report.tolerance, .checks_branch = false, .anchor_steps = 0};
  if (options.max_seconds) tracking.max_seconds = *options.max_seconds;
  tracking.observer = options.observer;
  Given given;
  given.start.emplace(start.data(), 3, start.cols());
  TrackedScene tracked = track(scene, std::move(given), solvers, again, std::move(tracking));
  none.message = "the scene solved again from the result does not converge: " + tracked.first.message;
  if (tracked.first.status != Status::Converged) return none;
  Responses responses(model, report, std::move(tracked), wanted);
  responses.take_parameters(scene);
  none.message = responses.solve_first(report.fields.x);
  if (!none.message.empty()) return none;
  responses.rank(wanted.most);
  return responses.checked();
}

Report with_first_order(const Scene& scene, const SolverTable& solvers, const RunOptions& options,
                        const Model& model, Report report, const std::filesystem::path& folder) {
  if (!report.has_page) {
    report.warnings.emplace_back("No sliders of parameters: no page is written.");
    return report;
  }
  report.first_order = first_order(scene, solvers, options, model, report);
  if (report.first_order->parameters.empty()) {
    report.warnings.push_back("No sliders of parameters: " + report.first_order->message + ".");
    report.first_order.reset();
  }
  if (!folder.empty()) write_run(folder, model, report);
  return report;
}

}  // namespace coapt
