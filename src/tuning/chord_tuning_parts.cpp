#include "tuning/chord_tuning_parts.hpp"

#include "core/error.hpp"
#include "scene/build/build.hpp"
#include "sensitivity/parameters/line_access.hpp"
#include "tuning/chord_tuning_goal.hpp"

#include <algorithm>
#include <map>

namespace coapt {
namespace {

constexpr double kTightest = 1e-9;  // tolerance of a trial at most: derivatives are those at an equilibrium
constexpr int kTrialIterations = 200;  // of the whole method; a trial that needs more is rejected
constexpr double kTaut = 0.002;        // of its length, below which the slack of a path is none
constexpr double kTakenUp = 1.05;      // of the slack
constexpr double kSmallChange = 1e-6;  // of a factor

// What another pass has found already is not said again.
template <typename Act>
void collect(std::vector<std::string>& defects, const Act& act) {
  try {
    act();
  } catch (const InputError& error) {
    for (const std::string& defect : error.defects())
      if (std::find(defects.begin(), defects.end(), defect) == defects.end()) defects.push_back(defect);
  }
}

// The lines from each leaflet vertex down to a tip, through the junctions of a network that branches upward.
std::vector<std::vector<size_t>> chord_paths(const Model& model) {
  std::map<int, size_t> below;  // a junction: the line that ends there
  for (size_t line = 0; line < model.lines.size(); ++line) below[model.lines[line].b] = line;
  std::vector<std::vector<size_t>> paths;
  for (size_t line = 0; line < model.lines.size(); ++line) {
    if (model.lines[line].b >= model.mesh.vertex_count()) continue;
    std::vector<size_t>& path = paths.emplace_back(1, line);
    for (auto at = below.find(model.lines[line].a); at != below.end() && path.size() <= model.lines.size();
         at = below.find(model.lines[at->second].a))
      path.push_back(at->second);
  }
  return paths;
}

}  // namespace

PreparedTuning prepare_tuning(const std::string& text, const std::filesystem::path& file,
                              const SolverTable& solvers, const BoundedMinimiserTable& minimisers,
                              const ChordTuningOptions& options, const RunOptions& run_options,
                              Model& model) {
  std::vector<std::string> defects = options.defects;
  for (const std::string& defect : chord_tuning_defects(options, minimisers)) defects.push_back(defect);
  PreparedTuning ready;
  bool is_built = false;
  collect(defects, [&] {
    ready.scene = parse_scene(text, file);
    ready.setup = solve_setup(ready.scene, solvers, run_options);
    ready.geometry = scene_geometry(ready.scene);
    model = build(ready.scene, ready.geometry);
    is_built = true;
  });
  if (!is_built) throw InputError(std::move(defects));
  if (distance_weight_of(options) > 0) collect(defects, [&] { read_target(options, model); });
  if (options.orifice_weight > 0 && annulus_of(model) == nullptr)
    defects.push_back("--orifice-weight: " + file.string() +
                      ": has no node set \"annulus\", so that no orifice is measured");
  ready.chords = tunable_chords(ready.scene, ready.geometry, model);
  if (ready.chords.empty())
    defects.push_back(file.string() +
                      ": terms: no chord of a network with a rest length; there is nothing to tune");
  else
    collect(defects, [&] {
      ready.groups = chord_groups(ready.chords, model, options.grouping, options.only);
      for (const ChordGroup& group : ready.groups)
        for (const size_t k : group.chords)
          ready.lines.insert(ready.lines.end(), ready.chords[k].lines.begin(), ready.chords[k].lines.end());
    });
  if (!defects.empty()) throw InputError(std::move(defects));
  return ready;
}

EquilibriumMaker equilibrium_maker(const PreparedTuning& ready, Model& model, bool checks_branch) {
  struct Lengths {
    EnergyTerm* term;
    Vector first;
  };
  std::vector<Lengths> all;
  for (const auto& term : model.objective->terms())
    if (const auto lines = line_access(*term); lines != nullptr) {
      Vector first(term->stencils().count());
      for (int e = 0; e < first.size(); ++e) first[e] = lines->rest_length(e);
      if ((first.array() > 0).all()) all.push_back({term.get(), std::move(first)});
    }
  TrackingOptions tracking;
  tracking.factorisation = ready.setup.factorisation;
  tracking.tolerance = std::min(ready.setup.stop.tolerance, kTightest);
  tracking.max_iterations = kTrialIterations;
  tracking.checks_branch = checks_branch;
  return [&ready, &model, all, tracking](const Vector& q) {
    for (const Lengths& lengths : all) line_access(*lengths.term)->set_rest_lengths(lengths.first);
    auto equilibrium = std::make_unique<TrackedEquilibrium>(*model.objective, q, tracking);
    equilibrium->add(make_group_factors("chord lengths", ready.chords, ready.groups, model));
    return equilibrium;
  };
}

std::optional<Vector> with_slack_taken_up(const PreparedTuning& ready, const Model& model, const Vector& low,
                                          const Vector& factors, const Vector& q) {
  const Points x = model.objective->positions(q);
  Vector rest(static_cast<Eigen::Index>(model.lines.size()));
  for (Eigen::Index line = 0; line < rest.size(); ++line)
    rest[line] = model.lines[static_cast<size_t>(line)].rest_length;
  std::vector<Eigen::Index> group_of(model.lines.size(), -1);
  for (size_t g = 0; g < ready.groups.size(); ++g)
    for (const size_t k : ready.groups[g].chords)
      for (const size_t line : ready.chords[k].lines) {
        group_of[line] = static_cast<Eigen::Index>(g);
        rest[static_cast<Eigen::Index>(line)] *= factors[static_cast<Eigen::Index>(g)];
      }
  Vector lacking = Vector::Constant(factors.size(), kInfinity);  // of the factor of each group
  for (const std::vector<size_t>& path : chord_paths(model)) {
    double length = 0;
    for (const size_t line : path) length += rest[static_cast<Eigen::Index>(line)];
    const double slack =
        length - (x.col(model.lines[path.front()].b) - x.col(model.lines[path.back()].a)).norm();
    for (const size_t line : path) {
      if (group_of[line] < 0) continue;
      double own = 0;  // what a unit of the factor changes on this path
      for (const size_t other : path)
        if (group_of[other] == group_of[line]) own += model.lines[other].rest_length;
      double& least = lacking[group_of[line]];
      least = std::min(least, slack > kTaut * length ? slack / own : 0);
    }
  }
  const Vector taken = (lacking.array() > 0 && lacking.array().isFinite())
                           .select(kTakenUp * lacking.array(), Eigen::ArrayXd::Zero(lacking.size()));
  Vector value = (factors - taken).cwiseMax(low);
  if (((value - factors).array().abs() < kSmallChange).all()) return std::nullopt;
  return value;
}

}  // namespace coapt
