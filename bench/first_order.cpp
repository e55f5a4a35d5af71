// Sliders of a page against solves: what they cost, how many there are, and what a warm solve finds at both
// ends of each range. Arguments: scene files; --cost first: without those solves,
// --limited: and within the share of the solve's time that a page gives them.
#include "tuning/first_order.hpp"

#include "core/error.hpp"
#include "core/timing.hpp"
#include "solve/solve_scene.hpp"
#include "tuning/tracked_scene.hpp"

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <string_view>

namespace {

using namespace coapt;

double greatest(const Points& apart, const std::vector<int>& nodes) {
  return std::sqrt(apart(Eigen::all, nodes).colwise().squaredNorm().maxCoeff());
}

// One line for the valve, and one for each end where a solve is not where the page says.
void compare(const char* file, bool count_only, bool is_limited) {
  const Scene scene = load_scene(file);
  RunOptions options;
  options.writes = false;
  const double start = cpu_seconds();
  const RunReport run = coapt::run(scene, scene_solvers(), options);
  const double solved = cpu_seconds();
  const FirstOrder found = first_order(scene, scene_solvers(), options, run.model, run.report,
                                       {.share = is_limited ? FirstOrderOptions{}.share : kInfinity});
  const double sliders = cpu_seconds();
  std::printf("%s: %d triangles, solve %.2f s, sliders %.2f s, %zu of %d %s\n", file,
              run.model.mesh.triangle_count(), solved - start, sliders - solved, found.parameters.size(),
              found.candidates, found.message.c_str());
  if (found.parameters.empty() || count_only) return;

  const Points x = run.report.fields.x;
  std::vector<int> nodes;
  for (int node = 0; node < run.model.mesh.vertex_count(); ++node)
    if (run.report.fields.undetermined.empty() || !run.report.fields.undetermined[static_cast<size_t>(node)])
      nodes.push_back(node);
  int ends = 0, failed = 0, lost = 0;
  double worst = 0, worst_error = 0;
  for (const ParameterResponse& response : found.parameters)
    for (const CheckedEnd& end : response.ends) {
      if (end.change == 0) continue;
      ++ends;
      TrackedScene tracked = track_shape(scene, x.colwise() + run.model.origin, scene_solvers(), options,
                                         {.tolerance = run.report.tolerance, .checks_branch = true});
      TrackedEquilibrium& equilibrium = *tracked.equilibrium;
      equilibrium.add(make_named_parameter(response.key, scene, tracked));
      if (equilibrium.solve().status != Status::Converged) continue;
      equilibrium.set(equilibrium.value() + end.change * response.unit_change);
      const WarmSolve solve = equilibrium.solve();
      if (solve.status != Status::Converged) {
        ++failed;
        std::printf("  %s %+.3g: the solve: %s\n", response.name.c_str(), end.change, solve.message.c_str());
        continue;
      }
      lost += solve.lost_branch ? 1 : 0;
      const double error = greatest(equilibrium.positions() - x - end.change * response.motion, nodes);
      worst = std::max(worst, std::abs(error - end.error_mm));
      worst_error = std::max(worst_error, error);
      if (std::abs(error - end.error_mm) > 0.02 * found.tolerance_mm)
        std::printf("  %s %+.3g: told %.4f mm, found %.4f mm%s\n", response.name.c_str(), end.change,
                    end.error_mm, error, solve.lost_branch ? " on another branch" : "");
    }
  std::printf(
      "  %d ends, %d solves failed, %d on another branch; greatest error %.4f mm, told within %.5f mm\n",
      ends, failed, lost, worst_error, worst);
}

}  // namespace

int main(int count, char** files) {
  const std::string_view first = count > 1 ? files[1] : "";
  const bool count_only = first == "--cost" || first == "--limited", is_limited = first == "--limited";
  for (int k = count_only ? 2 : 1; k < count; ++k) try {
      compare(files[k], count_only, is_limited);
    } catch (const std::exception& error) {
      std::printf("%s: %s\n", files[k], error.what());
    }
  return 0;
}
