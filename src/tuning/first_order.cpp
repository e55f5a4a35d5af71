#include "tuning/first_order.hpp"

#include "core/error.hpp"
#include "core/timing.hpp"
#include "report/shape_view.hpp"
#include "results/result_warnings.hpp"
#include "run/run_parts.hpp"
#include "tuning/tracked_scene.hpp"

#include <algorithm>
#include <cmath>
#include <exception>
#include <map>
#include <numbers>

namespace coapt {
namespace {

constexpr double kShare = 0.1;        // of a factor or a number, that is tried first
constexpr double kShift = 0.05;       // of the extent of the sheet, of a displacement
constexpr double kTilt = 0.1;         // [rad]
constexpr double kUsualExtent = 100;  // [mm], beyond which the tolerance grows with the sheet
constexpr double kKept = 0.8;         // of the tolerance: the rest is for rounding in a page
constexpr double kFigureReach = 0;    // of gaps beyond twice the contact distance [mean edges]: none counts
constexpr double kSmaller = 0.3;      // of a range at whose end nothing was found
constexpr double kLikely = 0.3;  // of the tolerance: a first step by the result's stiffness that may hold
constexpr double kLeastShare = 0.05;  // of the change that such a step leaves at once
constexpr double kLeft = 0.02;        // of the tolerance, that corrections leave
constexpr double kResponse = 1e-4;    // residual of the linear system of a response
constexpr double kRanking = 1e-1;     // the same where it only tells which move the sheet most
constexpr ViewDetail kFigureView = {.cells = 256, .refinement = 1};  // of figures whose changes are told
constexpr double kSameShape = 1e-2;      // of the tolerance, that a shape may miss the report's by
constexpr double kMostMovement = 6;      // of the tolerance, of a node by the change that is tried first
constexpr int kMostTrials = 6;           // for one end of a range
constexpr double kLeastCpu = 0.5;        // [s] that ranges may take whatever the solve took
constexpr double kLeastMovement = 0.05;  // of the tolerance: what moves the sheet less says nothing

// One number, or one direction among the numbers of a parameter.
struct Direction {
  ParameterResponse response;
  Vector change;          // of all numbers of the equilibrium, per unit
  double step = 0;        // that is tried first, in units
  bool is_exact = false;  // its motion, as a page shows it
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

// Groups of chords are named by their tissue or tip, terms by whatever they are.
std::string chords_in_words(const std::string& object) {
  if (object.find("chord") != std::string::npos || object.find("cable") != std::string::npos) return object;
  return object.starts_with("tip_") ? "chords of " + object : object + " chords";
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
  return {share((what == "length" ? chords_in_words(object) : object) + ": " + in_words(what), value[0])};
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

// Those of a result, and what a healthy closure asks for besides.
std::vector<MetricRow> figure_rows(const Metrics& metrics) {
  std::vector<MetricRow> rows = metric_rows(metrics);
  for (const HealthyCriterion& criterion : metrics.healthy_closure)
    if (std::none_of(rows.begin(), rows.end(),
                     [&](const MetricRow& row) { return row.name == criterion.name; }))
      rows.push_back({criterion.name, criterion.unit, "", false, criterion.value});
  return rows;
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
    for (const MetricRow& row : figure_rows(report.metrics))
      if (row.value) now_[row.name] = *row.value;
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
        Vector own = Vector::Zero(equilibrium_.parameter(index).value().size());
        own[static_cast<Eigen::Index>(k)] = all[k].per_unit;
        directions_.push_back({{.name = all[k].name,
                                .key = key,
                                .unit = all[k].unit,
                                .unit_change = own,
                                .usual_change = all[k].step},
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

  // The derivative of the shape by each, those that move the sheet most first; the first `most` as they are
  // to be shown.
  void rank(size_t most) {
    for (Direction& direction : directions_) respond(direction, kRanking);
    drop_idle();
    for (size_t k = 0; k < directions_.size() && k < most; ++k) respond(directions_[k], kResponse);
    drop_idle();
  }

  // Both ends of the range of a direction.
  void check(Direction& direction) {
    if (!direction.is_exact) respond(direction, kResponse);
    for (const size_t side : {size_t{0}, size_t{1}}) check(direction, side);
  }

  const Vector& unknowns() const { return equilibrium_.unknowns(); }
  std::vector<Direction>& directions() { return directions_; }
  FirstOrder& found() { return found_; }

 private:
  // Of the nodes that count, the greatest.
  double distance(const Points& x) const {
    const Points apart = (equilibrium_.positions() - x)(Eigen::all, nodes_);
    return apart.cols() == 0 ? 0 : std::sqrt(apart.colwise().squaredNorm().maxCoeff());
  }

  void respond(Direction& direction, double tolerance) try {
    direction.response.motion = equilibrium_.response(direction.change, tolerance);
    const Points moved = direction.response.motion(Eigen::all, nodes_);
    direction.response.movement_mm = direction.step * std::sqrt(moved.colwise().squaredNorm().mean());
    direction.is_exact = tolerance == kResponse;
  } catch (const InputError& error) {
    direction.response.movement_mm = 0;
    found_.message = error.defects().front();
  }

  void drop_idle() {
    std::erase_if(directions_, [this](const Direction& each) {
      return !(each.response.movement_mm > kLeastMovement * found_.tolerance_mm);
    });
    std::stable_sort(directions_.begin(), directions_.end(), [](const Direction& a, const Direction& b) {
      return a.response.movement_mm > b.response.movement_mm;
    });
  }

  Vector numbers_at(const Direction& direction, double change) const {
    return value_ + change * direction.change;
  }

  // The length of the corrections that lead from the first order's shape to the equilibrium is its error.
  void check(Direction& direction, size_t side) {
    const double kept = kKept * found_.tolerance_mm;
    const Points& motion = direction.response.motion;
    const Points moved = motion(Eigen::all, nodes_);
    const double furthest = std::sqrt(moved.colwise().squaredNorm().maxCoeff());
    double change = std::min(direction.step, kMostMovement * found_.tolerance_mm / furthest);
    if (side == 0) change = -change;
    change *= likely_share(direction, change);
    for (int trial = 0; trial < kMostTrials; ++trial) {
      if (std::abs(change) * furthest < kLeastMovement * found_.tolerance_mm) return;
      std::vector<MetricRow> figures;
      CorrectedShape shape;
      try {
        shape =
            equilibrium_.corrected(numbers_at(direction, change), x_ + change * motion, nodes_,
                                   kLeft * found_.tolerance_mm, 2 * kept, [&](const CorrectedShape& found) {
                                     if (found.distance + found.left <= kept) figures = figures_at(found.x);
                                   });
      } catch (const InputError&) {  // beyond a limit of the parameter
      }
      const double error = shape.distance + shape.left;
      if (shape.is_found && error <= kept) {
        direction.response.ends[side] = {change, error, changed(std::move(figures))};
        return;
      }
      // By the square where the shape is smooth, at least by a tenth.
      change *= shape.distance > kept ? std::clamp(0.9 * std::sqrt(kept / error), 0.1, 0.9) : kSmaller;
    }
  }

  // Of a change, that a first step by the result's own stiffness lets expect to hold: its length grows with
  // the square of the change, and more where contact stiffens on the way.
  double likely_share(const Direction& direction, double change) {
    try {
      const double step = equilibrium_.step_by_solved_factor(numbers_at(direction, change),
                                                             x_ + change * direction.response.motion, nodes_);
      return std::clamp(std::sqrt(kLikely * found_.tolerance_mm / step), kLeastShare, 1.0);
    } catch (const InputError&) {  // beyond a limit of the parameter
      return kSmaller;
    }
  }

  // Figures of the result as it was measured, plus what changes by a coarser measure of both.
  std::vector<MetricRow> changed(std::vector<MetricRow> figures) {
    if (here_.empty())
      for (const MetricRow& row : figures_at(x_))
        if (row.value) here_[row.name] = *row.value;
    for (MetricRow& row : figures)
      if (row.value && here_.contains(row.name) && now_.contains(row.name))
        *row.value = now_[row.name] + (*row.value - here_[row.name]);
    return figures;
  }

  std::vector<MetricRow> figures_at(const Points& x) {
    const Model& model = tracked_.model;
    take_rest_lengths(tracked_.model);
    const Fields fields = compute_fields(model, x, kFigureReach);
    const IntersectionChecker none = {
        "nobody", [](const Points&, const Triangles&) { return std::vector<std::array<int, 2>>(); }};
    const Metrics metrics = measure(model, model.objective->unknowns(x), fields, none, kFigureView);
    std::vector<MetricRow> rows = figure_rows(metrics);
    std::erase_if(rows, [](const MetricRow& row) { return row.name == "intersections"; });
    return rows;
  }

  TrackedScene tracked_;
  TrackedEquilibrium& equilibrium_;
  FirstOrder found_;
  std::vector<Direction> directions_;
  std::vector<int> nodes_;              // of the sheet, whose places are determined
  double extent_ = 0;                   // [mm]
  Points x_;                            // of the result
  Vector value_;                        // numbers there
  std::map<std::string, double> now_;   // figures there
  std::map<std::string, double> here_;  // the same by the coarser measure
};

}  // namespace

FirstOrder first_order(const Scene& scene, const SolverTable& solvers, const RunOptions& options,
                       const Model& model, const Report& report, const FirstOrderOptions& wanted) {
  FirstOrder none;
  none.message = "the solve did not converge";
  if (report.result.status != Status::Converged) return none;
  none.message = "the stability of the equilibrium is in doubt";
  if (is_in_doubt(report)) return none;
  const size_t most = std::min(wanted.most, most_sliders(static_cast<size_t>(model.X.cols())));
  none.message = "a page has no room for the displacements of so many nodes";
  if (most == 0) return none;
  const double begin = wall_seconds(), cpu_begin = cpu_seconds();
  const double most_cpu = std::max(kLeastCpu, wanted.share * report.result.cpu_s);
  const double left = options.max_seconds ? *options.max_seconds - report.result.wall_s : kInfinity;
  none.message = "the solve left no time for them";
  if (!(left > 0)) return none;
  const Points start = report.fields.x.colwise() + model.origin;
  RunOptions again = options;
  again.solver = report.solver;
  again.tolerance = report.tolerance;
  again.modes = 0;
  again.phase = {};
  const TrackingOptions tracking{.tolerance = report.tolerance,
                                 .max_seconds = left,
                                 .checks_branch = false,
                                 .anchor_steps = 0,
                                 .observer = options.observer};
  Responses responses(model, report, track_shape(scene, start, solvers, again, tracking), wanted);
  responses.take_parameters(scene);
  none.message = responses.solve_first(report.fields.x);
  if (!none.message.empty()) return none;
  responses.rank(most);
  FirstOrder& found = responses.found();
  bool is_ended = false;
  const double cpu_ready = cpu_seconds();
  int checked = 0;
  for (Direction& direction : responses.directions()) {
    is_ended =
        wall_seconds() - begin > left || (options.observer && !options.observer({}, responses.unknowns()));
    if (is_ended || found.parameters.size() == most) break;
    const double now = cpu_seconds(), usual = checked == 0 ? 0 : (now - cpu_ready) / checked;
    if (now - cpu_begin + usual > most_cpu && !found.parameters.empty()) {
      const auto wanting = responses.directions().size() - static_cast<size_t>(checked);
      found.left_out = static_cast<int>(std::min(most - found.parameters.size(), wanting));
      break;
    }
    ++checked;
    responses.check(direction);
    if (const auto& ends = direction.response.ends; ends[0].change != 0 || ends[1].change != 0)
      found.parameters.push_back(std::move(direction.response));
  }
  if (!found.parameters.empty())
    found.message.clear();
  else if (is_ended)
    found.message = "the search for them was ended before any was found";
  else if (found.message.empty())
    found.message = "no parameter moves the sheet over a range in which the first order holds";
  return std::move(found);
}

std::function<FirstOrder(const Scene&, const Model&, const Report&)> first_order_of_runs(
    SolverTable solvers, RunOptions options, FirstOrderOptions wanted) {
  return [solvers = std::move(solvers), options = std::move(options), wanted](
             const Scene& scene, const Model& model, const Report& report) {
    if (options.phase) options.phase({.name = "sliders of the page"});
    try {
      return first_order(scene, solvers, options, model, report, wanted);
    } catch (const std::exception& error) {  // the result is there, whatever its sliders are
      FirstOrder none;
      none.message = error.what();
      return none;
    }
  };
}

}  // namespace coapt
