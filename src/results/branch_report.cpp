#include "results/branch_report.hpp"

#include "core/number_text.hpp"
#include "results/branches_json.hpp"

#include <algorithm>
#include <cmath>

namespace coapt {
namespace {

nlohmann::ordered_json finite_or_null(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
}

nlohmann::ordered_json equilibrium_json(const NearbyEquilibrium& equilibrium) {
  nlohmann::ordered_json metrics = nlohmann::ordered_json::object();
  for (const MetricRow& row : metric_rows(equilibrium.metrics)) {
    if (row.value && row.is_count)
      metrics[row.name] = std::lround(*row.value);
    else
      metrics[row.name] = finite_or_null(row.value.value_or(kNaN));
  }
  return {{"found", equilibrium.found},
          {"energy_mj", finite_or_null(equilibrium.energy)},
          {"stability", stability_name(equilibrium.stability)},
          {"residual", finite_or_null(equilibrium.residual)},
          {"greatest_distance_mm", finite_or_null(equilibrium.greatest_mm)},
          {"mean_distance_mm", finite_or_null(equilibrium.mean_mm)},
          {"left_out_nodes", equilibrium.left_out},
          {"metrics", metrics}};
}

}  // namespace

const BranchRange* range_of(const std::optional<Branches>& branches, const std::string& metric) {
  if (!branches) return nullptr;
  const auto found = std::find_if(branches->others.begin(), branches->others.end(),
                                  [&metric](const BranchRange& range) { return range.name == metric; });
  return found == branches->others.end() ? nullptr : &*found;
}

std::vector<char> undetermined_flags(const std::vector<int>& free_nodes,
                                     const std::optional<Branches>& branches, Eigen::Index node_count) {
  std::vector<char> flags(static_cast<size_t>(node_count), 0);
  if (branches && branches->spread_mm.size() == node_count)
    for (Eigen::Index k = 0; k < node_count; ++k)
      if (branches->spread_mm[k] > branches->tolerance_mm) flags[static_cast<size_t>(k)] = 2;
  for (const int node : free_nodes) flags[static_cast<size_t>(node)] = 1;
  return flags;
}

UndeterminedNodes undetermined_nodes(const std::vector<int>& free_nodes,
                                     const std::optional<Branches>& branches) {
  UndeterminedNodes count;
  count.free = static_cast<int>(free_nodes.size());
  if (!branches) return count;
  const std::vector<char> flags = undetermined_flags(free_nodes, branches, branches->spread_mm.size());
  count.differing = static_cast<int>(std::count(flags.begin(), flags.end(), char{2}));
  return count;
}

std::string branches_message(const Branches& branches) {
  const auto millimetres = [](double value) { return number_text(value, 2) + " mm"; };
  const std::string starts =
      std::to_string(branches.starts) + " perturbed start" + (branches.starts == 1 ? "" : "s");
  const std::string lost =
      branches.not_converged == 0 ? "" : "; " + std::to_string(branches.not_converged) + " did not converge";
  const size_t others = branches.equilibria.size() - 1;
  if (others == 0) {
    const int returned = branches.equilibria.front().found;
    if (branches.starts == 0) return "interrupted before a perturbed start was solved";
    if (returned == 0) return "none of " + starts + " converged (the first: " + branches.first_failure + ")";
    return (lost.empty() ? starts : std::to_string(returned) + " of " + starts) +
           " came back to the same state (greatest distance " + millimetres(branches.greatest_return_mm) +
           ")" + lost;
  }
  double farthest = 0;
  for (const NearbyEquilibrium& equilibrium : branches.equilibria)
    farthest = std::max(farthest, equilibrium.greatest_mm);
  return std::to_string(others) + (others == 1 ? " other" : " others") + " near by, from " + starts +
         "; nodes differ by up to " + millimetres(farthest) + lost;
}

nlohmann::ordered_json branches_json(const Branches& branches) {
  nlohmann::ordered_json equilibria = nlohmann::ordered_json::array();
  for (const NearbyEquilibrium& equilibrium : branches.equilibria)
    equilibria.push_back(equilibrium_json(equilibrium));
  nlohmann::ordered_json others = nlohmann::ordered_json::object();
  for (const BranchRange& range : branches.others)
    others[range.name] = {{"lowest", range.lowest}, {"highest", range.highest}};
  return {{"message", branches_message(branches)},
          {"starts", branches.starts},
          {"starts_along_path", branches.starts_along_path},
          {"not_converged", branches.not_converged},
          {"first_failure", branches.first_failure},
          {"kick_mm", branches.kick_mm},
          {"least_moved_share", branches.least_moved_share},
          {"tolerance_mm", branches.tolerance_mm},
          {"greatest_return_mm", branches.greatest_return_mm},
          {"equilibria", equilibria},
          {"others", others}};
}

}  // namespace coapt
