#include "tuning/chord_tuning_goal.hpp"

#include "core/error.hpp"
#include "formats/json/suggestion.hpp"
#include "formats/mesh_io.hpp"
#include "report/solve_view.hpp"
#include "sensitivity/metrics/metrics_opening.hpp"
#include "sensitivity/metrics/metrics_state.hpp"
#include "sensitivity/parameters/line_access.hpp"

#include <cmath>

namespace coapt {
namespace {

constexpr double kForceExponent = 8;  // of the smooth greatest force
constexpr double kBlur = 1;           // of the smooth orifice [mm]

// The power mean over several terms, each with its count of lines: that of all the lines together.
class ForceNorm final : public Metric {
 public:
  struct Part {
    std::unique_ptr<Metric> norm;
    double share;
  };
  explicit ForceNorm(std::vector<Part> parts) : Metric("chord force"), parts_(std::move(parts)) {}

  double evaluate(const Points& x, Points* gradient) const override {
    if (gradient != nullptr) gradient->setZero(3, x.cols());
    const Vector norms = of_parts(x);
    const double all = mean(norms);
    if (gradient == nullptr || all == 0) return all;
    Points own(3, x.cols());
    for (size_t k = 0; k < parts_.size(); ++k) {
      if (norms[index(k)] == 0) continue;
      parts_[k].norm->evaluate(x, &own);
      *gradient += slope(k, norms, all) * own;
    }
    return all;
  }

  Vector partial(const Parameter& parameter, const Points& x) const override {
    Vector sum = Vector::Zero(parameter.value().size());
    const Vector norms = of_parts(x);
    const double all = mean(norms);
    for (size_t k = 0; k < parts_.size() && all > 0; ++k)
      if (norms[index(k)] > 0) sum += slope(k, norms, all) * parts_[k].norm->partial(parameter, x);
    return sum;
  }

 private:
  static Eigen::Index index(size_t k) { return static_cast<Eigen::Index>(k); }

  Vector of_parts(const Points& x) const {
    Vector norms(index(parts_.size()));
    for (size_t k = 0; k < parts_.size(); ++k) norms[index(k)] = parts_[k].norm->evaluate(x, nullptr);
    return norms;
  }
  double mean(const Vector& norms) const {
    const double most = norms.maxCoeff();
    if (most == 0) return 0;
    double sum = 0;
    for (size_t k = 0; k < parts_.size(); ++k)
      sum += parts_[k].share * std::pow(norms[index(k)] / most, kForceExponent);
    return most * std::pow(sum, 1 / kForceExponent);
  }
  double slope(size_t k, const Vector& norms, double all) const {
    return parts_[k].share * std::pow(norms[index(k)] / all, kForceExponent - 1);
  }

  std::vector<Part> parts_;
};

bool is_fit_alone(const ChordTuningOptions& options) {
  return options.orifice_weight == 0 && options.force_weight == 0;
}

std::unique_ptr<Metric> make_force_metric(const Model& model, const std::vector<size_t>& lines) {
  std::vector<ForceNorm::Part> parts;
  for (const auto& term : model.objective->terms()) {
    std::vector<int> elements;
    for (const size_t line : lines)
      if (model.lines[line].term == term->name()) elements.push_back(model.lines[line].element);
    if (elements.empty()) continue;
    const double share = static_cast<double>(elements.size()) / static_cast<double>(lines.size());
    parts.push_back({make_line_force_norm(term->name(), *term, std::move(elements), kForceExponent), share});
  }
  return std::make_unique<ForceNorm>(std::move(parts));
}

}  // namespace

double distance_weight_of(const ChordTuningOptions& options) {
  if (options.distance_weight) return *options.distance_weight;
  return !options.target.empty() || is_fit_alone(options) ? 1 : 0;
}

double change_weight_of(const ChordTuningOptions& options) {
  return options.change_weight.value_or(is_fit_alone(options) ? 1e-6 : 1e-3);
}

std::string chord_tuning_method(const ChordTuningOptions& options) {
  if (!options.method.empty()) return options.method;
  return is_fit_alone(options) ? "gauss_newton" : "slsqp";
}

std::vector<std::string> chord_tuning_defects(const ChordTuningOptions& options,
                                              const BoundedMinimiserTable& minimisers) {
  std::vector<std::string> defects;
  const auto check = [&](bool is_good, const char* text) {
    if (!is_good) defects.emplace_back(text);
  };
  const auto is_weight = [](double weight) { return weight >= 0 && std::isfinite(weight); };
  const double distance = distance_weight_of(options);
  check(is_weight(distance), "--distance-weight: must not be negative");
  check(is_weight(options.orifice_weight), "--orifice-weight: must not be negative");
  check(is_weight(options.force_weight), "--force-weight: must not be negative");
  check(is_weight(change_weight_of(options)), "--change-weight: must not be negative");
  check(distance > 0 || options.orifice_weight > 0 || options.force_weight > 0,
        "--distance-weight, --orifice-weight, --force-weight: all are 0; there is nothing to minimise");
  check(options.target.empty() || distance > 0,
        "--target: is of no influence, its weight is 0; leave it out, or give --distance-weight");
  check(std::isfinite(options.target_scale) && options.target_scale > 0,
        "--target-scale: must be a number above 0");
  const bool is_finite = std::isfinite(options.lowest) && std::isfinite(options.highest);
  if (is_finite && options.lowest > options.highest)
    defects.emplace_back("--bounds: are reversed; give the lower first, as in -20%..20%");
  else
    check(is_finite && options.lowest > -1 && options.lowest <= 0 && options.highest >= 0,
          "--bounds: must be above -100 % and hold 0, the lengths as they are");
  check(options.lowest != options.highest || options.lowest != 0,
        "--bounds: leave no room; give them a width");
  check(options.step > 0 && std::isfinite(options.step), "--step: must be a length above 0");
  check(options.gain >= 0 && std::isfinite(options.gain), "--gain: must not be negative");
  check(options.max_solves >= 2, "--max-solves: must be at least 2, the first solve and one trial");
  check(options.max_seconds > 0, "--max-seconds: must be above 0");
  check(options.noise > 0 && std::isfinite(options.noise), "--noise: must be a length above 0");
  check(options.determined > 0 && std::isfinite(options.determined),
        "--determined: must be a length above 0");

  const std::string method = chord_tuning_method(options);
  std::vector<std::string> known;
  for (const auto& [name, make] : minimisers) known.push_back(name);
  const auto found = minimisers.find(method);
  if (found == minimisers.end()) {
    const bool is_optional =
        method == "slsqp" || method == "mma" || method == "lbfgs" || method == "cobyla" || method == "ceres";
    const std::string package = method == "ceres" ? "Ceres" : "NLopt";
    defects.push_back("--method: \"" + method + "\" " +
                      (is_optional ? "needs " + package + ", which this build has not"
                                   : "is not known" + suggestion(method, known)) +
                      "; there are: " + listed(known));
  } else if (!is_fit_alone(options) && found->second()->needs_residuals()) {
    defects.push_back(
        "--method: \"" + method +
        "\" fits a surface alone; with --orifice-weight or --force-weight take another of: " + listed(known));
  }
  return defects;
}

TriangleMesh read_target(const ChordTuningOptions& options, const Model& model) {
  TriangleMesh target;
  if (options.target.empty()) {
    if (!model.closed_reference)
      throw InputError(
          "--target: missing, and the scene has no reference.closed_surface; name the closed surface to fit, "
          "or give --orifice-weight or --force-weight");
    if (model.registration)
      throw InputError(
          "reference.register: a surface that is fitted has one place; register it onto a closed shape of "
          "this "
          "valve first (`coapt register`) and name what that writes");
    target = *model.closed_reference;
  } else {
    target = read_mesh(options.target).mesh;
    target.vertices *= options.target_scale;
    target.vertices.colwise() -= model.origin;
  }
  if (!(surface_area(target.vertices, target.triangles) > 0))
    throw InputError("--target: " + options.target.string() + ": has no area");
  return target;
}

ChordTuningGoal make_chord_tuning_goal(const ChordTuningOptions& options, const Model& model,
                                       const Fields& before, const std::vector<size_t>& lines) {
  ChordTuningGoal made;
  if (distance_weight_of(options) > 0) {
    made.residuals =
        make_surface_residuals(model.mesh.triangles, before.x, read_target(options, model), options.sides);
    made.goal.residuals = made.residuals.get();
    made.goal.residual_weight = distance_weight_of(options);
  }
  const auto add = [&](std::unique_ptr<Metric> metric, double weight) {
    made.goal.metrics.push_back({metric.get(), weight});
    made.metrics.push_back(std::move(metric));
  };
  if (options.orifice_weight > 0) {
    const std::vector<int>* annulus = annulus_of(model);
    if (annulus == nullptr)
      throw InputError(
          "--orifice-weight: the scene has no node set \"annulus\", so that no orifice is known");
    add(make_opening_area("orifice", model.mesh.triangles, *annulus, before.x,
                          {viewing_frame(model, before).up, kBlur}),
        options.orifice_weight);
  }
  if (options.force_weight > 0) add(make_force_metric(model, lines), options.force_weight);
  return made;
}

}  // namespace coapt
