#include "run/branches.hpp"

#include "core/random_source.hpp"
#include "run/run_parts.hpp"
#include "solve/solve_scene.hpp"

#include <algorithm>
#include <cmath>

namespace coapt {
namespace {

constexpr Eigen::Index kMostParts =
    128;  // of the nodes, that contact stops apart from each other: a bound on the time

constexpr double kSameState = 1e-3;  // distance of a node, over the mean edge length

// The length that moves and distances are told in [mm]: of the triangles, or else of the lines.
double edge_scale(const Model& model) {
  if (model.mesh.triangle_count() > 0) return mean_edge_length(model.mesh.vertices, model.mesh.triangles);
  double sum = 0;
  for (const Line& line : model.lines) sum += (model.X.col(line.a) - model.X.col(line.b)).norm();
  return model.lines.empty() ? 1 : sum / static_cast<double>(model.lines.size());
}

// Uniform in the ball of this radius: points of the cube around it, until one is inside.
Vec3 random_in_ball(RandomSource& random, double radius) {
  while (true) {
    Vec3 v;
    for (double& coordinate : v) coordinate = random.between(-1, 1);
    if (v.squaredNorm() <= 1) return radius * v;
  }
}

Points random_moves(const Objective& objective, double radius, RandomSource& random) {
  Points moves(3, objective.node_count());
  for (Eigen::Index k = 0; k < moves.cols(); ++k) moves.col(k) = random_in_ball(random, radius);
  return objective.fixed().select(0.0, moves.array()).matrix();
}

// Moves x by the columns from ... to - 1 of `moves` as far as the terms admit. A pair that is nearly in
// contact would stop all nodes: halves that are stopped are moved one after the other, down to `smallest`
// nodes.
void move_admissibly(Objective& objective, const Points& moves, Eigen::Index from, Eigen::Index to,
                     Eigen::Index smallest, Points& x) {
  Points part = Points::Zero(3, moves.cols());
  part.middleCols(from, to - from) = moves.middleCols(from, to - from);
  const double share = objective.step_limit(x, part, 1);
  if (share >= 1 || to - from <= smallest) {
    x += share * part;
    return;
  }
  const Eigen::Index middle = from + (to - from) / 2;
  move_admissibly(objective, moves, from, middle, smallest, x);
  move_admissibly(objective, moves, middle, to, smallest, x);
}

// Every free node of x at a random place near by. Pre: the objective's prescribed coordinates are those of x.
Points moved(Objective& objective, const Points& x, RandomSource& random, Branches& branches) {
  const Points moves = random_moves(objective, branches.kick_mm, random);
  Points there = x;
  move_admissibly(objective, moves, 0, moves.cols(), std::max<Eigen::Index>(1, moves.cols() / kMostParts),
                  there);
  const double wanted = moves.colwise().norm().sum();
  if (wanted > 0)
    branches.least_moved_share =
        std::min(branches.least_moved_share, (there - x).colwise().norm().sum() / wanted);
  return there;
}

// An equilibrium as it is compared with others.
struct KnownState {
  Points x;
  std::vector<int> free_nodes;  // ascending
};

struct NodeDistance {
  double greatest = 0, mean = 0;  // [mm]
  int left_out = 0;               // nodes
};

// Over the nodes that are not held and whose place both states determine.
NodeDistance node_distance(const KnownState& a, const KnownState& b, const FixedMask& fixed) {
  NodeDistance distance;
  int count = 0;
  for (int k = 0; k < static_cast<int>(a.x.cols()); ++k) {
    if (fixed.col(k).all()) continue;
    if (std::binary_search(a.free_nodes.begin(), a.free_nodes.end(), k) ||
        std::binary_search(b.free_nodes.begin(), b.free_nodes.end(), k)) {
      ++distance.left_out;
      continue;
    }
    const double here = (a.x.col(k) - b.x.col(k)).norm();
    distance.greatest = std::max(distance.greatest, here);
    distance.mean += here;
    ++count;
  }
  if (count > 0) distance.mean /= count;
  return distance;
}

NearbyEquilibrium nearby(const Result& result, const NodeDistance& distance, Metrics metrics) {
  return {result.energy,
          result.residual,
          result.certificate.stability.verdict,
          0,
          distance.greatest,
          distance.mean,
          std::move(metrics),
          distance.left_out};
}

std::vector<BranchRange> ranges_of_others(const std::vector<NearbyEquilibrium>& equilibria) {
  std::vector<BranchRange> ranges;
  if (equilibria.size() < 2) return ranges;
  const std::vector<MetricRow> names = metric_rows({});
  for (size_t row = 0; row < names.size(); ++row) {
    BranchRange range = {names[row].name, kInfinity, -kInfinity};
    for (size_t k = 1; k < equilibria.size(); ++k) {
      const std::optional<double> value = metric_rows(equilibria[k].metrics)[row].value;
      if (!value || !std::isfinite(*value)) continue;
      range.lowest = std::min(range.lowest, *value);
      range.highest = std::max(range.highest, *value);
    }
    if (range.lowest <= range.highest) ranges.push_back(range);
  }
  return ranges;
}

// Takes a state that a perturbed start came to into the list, or counts it where it is known.
void sort_in(const Result& result, Model& model, const IntersectionChecker& checker,
             std::vector<KnownState>& states, Branches& branches) {
  const Objective& objective = *model.objective;
  const KnownState state = {objective.positions(result.q), result.certificate.free_nodes};
  const NodeDistance from_own = node_distance(states.front(), state, objective.fixed());
  for (size_t k = 0; k < states.size(); ++k) {
    if (node_distance(states[k], state, objective.fixed()).greatest > branches.tolerance_mm) continue;
    ++branches.equilibria[k].found;
    if (k == 0) branches.greatest_return_mm = std::max(branches.greatest_return_mm, from_own.greatest);
    return;
  }
  states.push_back(state);
  branches.spread_mm = branches.spread_mm.cwiseMax((state.x - states.front().x).colwise().norm().transpose());
  const Fields fields = compute_fields(model, state.x);
  branches.equilibria.push_back(nearby(result, from_own, measure(model, result.q, fields, checker)));
  branches.equilibria.back().found = 1;
}

// The report with what the search found.
Report report_with(Branches branches, Report report, const Objective& objective) {
  if (branches.answers_suspicion()) std::erase(report.warnings, neighbour_warning(report.neighbours));
  report.branches = std::move(branches);
  report.fields.branch_spread = report.branches->spread_mm;
  report.fields.undetermined =
      undetermined_flags(report.result.certificate.free_nodes, report.branches, objective.node_count());
  return report;
}

}  // namespace

Branches find_branches(const Scene& scene, const SolverTable& solvers, const RunOptions& options,
                       const BranchSearch& search, Model& model, const Report& report) {
  Objective& objective = *model.objective;
  const Result& own = report.result;
  SolveSetup setup = solve_setup(scene, solvers, options);
  if (!own.certificate.is_made) setup.stability = {};  // there are terms without Hessians
  const double edge = edge_scale(model);
  Branches branches;
  branches.kick_mm = search.kick * edge;
  branches.tolerance_mm = kSameState * edge;
  std::vector<KnownState> states = {{objective.positions(own.q), own.certificate.free_nodes}};
  branches.equilibria = {
      nearby(own, node_distance(states.front(), states.front(), objective.fixed()), report.metrics)};
  branches.spread_mm = Vector::Zero(objective.node_count());
  const bool along_path = search.along_path && report.levels.empty();
  for (int start = 0; start < (along_path ? 2 : 1) * search.starts; ++start) {
    const bool is_from_own_start = start >= search.starts;
    const Points from = is_from_own_start ? model.X : states.front().x;
    objective.prescribe(from);
    RandomSource random(search.seed, static_cast<std::uint64_t>(start));
    const Points x = moved(objective, from, random, branches);
    const Result result =
        is_from_own_start ? solve_along_path(x, model, setup) : solve_again(x, model, setup);
    if (result.status == Status::Cancelled) break;
    ++branches.starts;
    if (is_from_own_start) ++branches.starts_along_path;
    if (result.status == Status::Converged)
      sort_in(result, model, options.checker, states, branches);
    else if (branches.not_converged++ == 0)
      branches.first_failure = result.message;
  }
  branches.others = ranges_of_others(branches.equilibria);
  objective.prescribe(states.front().x);
  return branches;
}

Report with_branches(const Scene& scene, const SolverTable& solvers, const RunOptions& options,
                     const BranchSearch& search, Model& model, Report report,
                     const std::filesystem::path& folder) {
  if (search.starts == 0) return report;
  if (report.result.status != Status::Converged) {
    report.warnings.push_back("No other equilibria were looked for: the solve did not converge.");
  } else {
    RunOptions again = options;
    again.solver = report.solver;
    again.tolerance = report.tolerance;
    Branches branches = find_branches(scene, solvers, again, search, model, report);
    report = report_with(std::move(branches), std::move(report), *model.objective);
  }
  if (!folder.empty()) write_run(folder, model, report);
  return report;
}

}  // namespace coapt
