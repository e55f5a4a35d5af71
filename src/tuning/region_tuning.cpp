#include "tuning/region_tuning.hpp"

#include "core/error.hpp"
#include "results/fields.hpp"
#include "scene/build/build.hpp"
#include "scene/build/groundwork.hpp"
#include "solve/solve_scene.hpp"
#include "tuning/tuned_scene.hpp"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>

namespace coapt {
namespace {

constexpr double kMargin = 0.01;        // below the limits
constexpr double kDifference = 0.1;     // of a logarithm
constexpr double kLongestStep = 0.7;    // of a logarithm: a factor of two
constexpr double kFirstDamping = 1e-2;  // relative to the mean diagonal
constexpr int kPatience = 100;          // iterations
constexpr double kMostDamping = 1e6;
constexpr double kLeastGain = 1e-3;  // of the merit in a round; below, two in a row end the search

// One solved state. excess: of each chord and of the orifice over its limit with margin, relative; positive
// is too much.
struct Solved {
  bool has_converged = false;
  std::string message;
  Points x;
  Vector excess;
  TuningState state;

  double merit() const { return excess.cwiseMax(0).squaredNorm(); }
  bool is_good(double margin = kMargin) const { return excess.size() > 0 && excess.maxCoeff() <= margin; }
};

class Tuning {
 public:
  Tuning(const TunedScene& tuned, SolveSetup setup, const RegionTuningOptions& options)
      : tuned_(tuned), setup_(std::move(setup)), options_(options), limit_(options.orifice_limit_mm2) {}

  // start: of the nodes; null: the scene's own.
  Solved solve(const Vector& logarithms, const Points* start) {
    ++solves;
    const Scene scene = tuned_.scene(logarithms.array().exp());
    Model model = build(scene, tuned_.ground);
    const Result result = start == nullptr ? solve_scene(scene, tuned_.ground, model, setup_).result
                                           : solve_again(*start, model, setup_);
    Solved solved;
    solved.has_converged = result.status == Status::Converged;
    is_cancelled = is_cancelled || result.status == Status::Cancelled;
    if (!solved.has_converged) ++failed;
    solved.message = result.message;
    if (start == nullptr)  // a change that takes far longer than the whole is a change for the worse
      setup_.stop.max_iterations = std::min(setup_.stop.max_iterations, kPatience + 3 * result.iterations);
    solved.x = model.objective->positions(result.q);
    const Fields fields = compute_fields(model, solved.x);
    const Metrics metrics = measure(model, result.q, fields);
    if (!limit_ && metrics.annulus_area_mm2) limit_ = 0.02 * *metrics.annulus_area_mm2;
    solved.state.orifice_area_mm2 = metrics.orifice_area_mm2;
    std::vector<double> excess;
    for (const Line& line : model.lines) {
      const std::optional<double> strain = line_strain(line, solved.x);
      if (!strain) continue;
      solved.state.max_chord_strain = std::max(solved.state.max_chord_strain, *strain);
      if (*strain > options_.yield_strain) ++solved.state.strained_chords;
      excess.push_back(*strain / options_.yield_strain - 1 + kMargin);
    }
    if (limit_ && metrics.orifice_area_mm2)
      excess.push_back(*metrics.orifice_area_mm2 / *limit_ - 1 + kMargin);
    solved.excess = Eigen::Map<const Vector>(excess.data(), static_cast<Eigen::Index>(excess.size()));
    return solved;
  }

  // Change of the excess with each logarithm; zero where a solve did not converge.
  Eigen::MatrixXd derivative(const Vector& logarithms, const Solved& at) {
    Eigen::MatrixXd J = Eigen::MatrixXd::Zero(at.excess.size(), logarithms.size());
    moved_ = 0;
    for (Eigen::Index k = 0; k < logarithms.size(); ++k) {
      Vector there = logarithms;
      there[k] += kDifference;
      const Solved moved = solve(there, &at.x);
      if (is_cancelled) break;
      if (!moved.has_converged) continue;
      J.col(k) = (moved.excess - at.excess) / kDifference;
      ++moved_;
    }
    return J;
  }

  // Whether any solve of the last derivative converged.
  bool has_moved_solves() const { return moved_ > 0; }

  std::optional<double> limit() const { return limit_; }
  int solves = 0, failed = 0;  // all, and those that did not converge
  bool is_cancelled = false;

 private:
  const TunedScene& tuned_;
  SolveSetup setup_;
  const RegionTuningOptions& options_;
  std::optional<double> limit_;
  int moved_ = 0;
};

// The step that lowers the positive part of excess + J step most, damped, within the bounds. What becomes
// positive on the way joins in.
Vector damped_step(const Eigen::MatrixXd& J, const Vector& excess, double damping, const Vector& low,
                   const Vector& high) {
  const double scale = J.squaredNorm() / static_cast<double>(J.cols());
  Vector step = Vector::Zero(J.cols());
  for (int pass = 0; pass < 10; ++pass) {
    const Vector predicted = excess + J * step;
    std::vector<Eigen::Index> active;
    for (Eigen::Index i = 0; i < excess.size(); ++i)
      if (predicted[i] > 0 || excess[i] > 0) active.push_back(i);
    const Eigen::MatrixXd A = J(active, Eigen::all);
    Eigen::MatrixXd H = A.transpose() * A;
    H.diagonal().array() += damping * scale;
    Vector next = (-H.ldlt().solve(A.transpose() * excess(active))).cwiseMax(low).cwiseMin(high);
    if ((next - step).cwiseAbs().maxCoeff() < 1e-9) return next;
    step = next;
  }
  return step;
}

std::string refusal(const Solved& best, const Tuning& tuning, const RegionTuningOptions& options) {
  char text[256];
  std::snprintf(
      text, sizeof text,
      "no factors from %g to %g were found: %d chords stay above a strain of %g, the most at %.4f, with an "
      "orifice of %.2f mm2 (limit %.2f)",
      1 / options.greatest_factor, options.greatest_factor, best.state.strained_chords, options.yield_strain,
      best.state.max_chord_strain, best.state.orifice_area_mm2.value_or(0), tuning.limit().value_or(0));
  return text;
}

void check(const RegionTuningOptions& options) {
  std::vector<std::string> defects;
  if (!(options.yield_strain > 0)) defects.emplace_back("--yield-strain: must be above 0");
  if (!(options.greatest_factor > 1)) defects.emplace_back("--greatest-factor: must be above 1");
  if (options.orifice_limit_mm2 && !(*options.orifice_limit_mm2 > 0))
    defects.emplace_back("--orifice: must be an area above 0");
  if (!defects.empty()) throw InputError(defects);
}

// Steps until nothing is too much or nothing helps; returns why it ended.
std::string search(Tuning& tuning, const RegionTuningOptions& options, Vector& logarithms, Solved& best,
                   int& rounds) {
  const double bound = std::log(options.greatest_factor);
  double damping = kFirstDamping;
  int idle = 0;
  while (!best.is_good()) {
    if (rounds == options.max_rounds) return refusal(best, tuning, options);
    ++rounds;
    const Eigen::MatrixXd J = tuning.derivative(logarithms, best);
    if (tuning.is_cancelled) return "cancelled";
    if (J.isZero(0))
      return tuning.has_moved_solves() ? "no factor changes what is too much"
                                       : "no solve with changed factors converged";
    const double merit = best.merit();
    bool has_moved = false;
    for (; !has_moved && damping < kMostDamping; damping *= has_moved ? 0.1 : 10) {
      const Vector low = (-bound - logarithms.array()).cwiseMax(-kLongestStep),
                   high = (bound - logarithms.array()).cwiseMin(kLongestStep);
      const Vector trial = logarithms + damped_step(J, best.excess, damping, low, high);
      if (trial == logarithms) break;
      Solved solved = tuning.solve(trial, &best.x);
      if (tuning.is_cancelled) return "cancelled";
      has_moved = solved.has_converged && solved.merit() < merit;
      if (!has_moved) continue;
      logarithms = trial;
      best = std::move(solved);
      if (options.report) options.report(rounds, best.state);
    }
    idle = has_moved && best.merit() < (1 - kLeastGain) * merit ? 0 : idle + 1;
    damping = std::max(damping, 1e-8);
    if (!has_moved || idle == 2) return refusal(best, tuning, options);
  }
  return "";
}

}  // namespace

RegionTuning tune_regions(const Scene& scene, const SolverTable& solvers, const RegionTuningOptions& options,
                          const RunOptions& run) {
  const double start = wall_seconds();
  check(options);
  const SolveSetup setup = solve_setup(scene, solvers, run);
  Groundwork ground = lay_groundwork(scene);
  const Model own = build(scene, ground);  // for its defects, in the scene's own words
  if (options.orifice_limit_mm2 && annulus_of(own) == nullptr)
    throw InputError("--orifice: " + scene.file.string() +
                     ": has no node set \"annulus\", so that no orifice is measured; leave it out");
  const TunedScene tuned(scene, std::move(ground), options);
  Tuning tuning(tuned, setup, options);

  RegionTuning found;
  found.scene_file = scene.file.filename().string();
  found.yield_strain = options.yield_strain;
  Vector logarithms = Vector::Zero(tuned.factor_count());
  Solved best = tuning.solve(logarithms, nullptr);
  found.before = best.state;
  found.message = best.has_converged ? (best.is_good() ? "nothing to tune" : "")
                                     : "the scene itself is not solved: " + best.message;
  if (found.message.empty()) found.message = search(tuning, options, logarithms, best, found.rounds);
  found.is_reached = best.has_converged && best.is_good();
  if (found.message.empty()) found.message = "no chord exceeds its yield strain any more";
  found.after = best.state;
  found.orifice_limit_mm2 = tuning.limit();
  found.region_of_triangle = tuned.ground.model.mesh.regions;
  tuned.name_factors(logarithms.array().exp(), found.regions, found.chords);
  found.solves = tuning.solves;
  found.failed_solves = tuning.failed;
  found.wall_s = wall_seconds() - start;
  return found;
}

}  // namespace coapt
