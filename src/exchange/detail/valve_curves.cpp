#include "exchange/detail/valve_curves.hpp"

#include "core/error.hpp"
#include "formats/json/markups.hpp"
#include "mesh/curve_match.hpp"
#include "valve/generators/leaflet_chords.hpp"

#include <algorithm>

namespace coapt::detail {
namespace {

constexpr int kCurvePoints = 1024;  // of a curve through few control points, at least

Points fine_curve(const Points& points) {
  const int n = static_cast<int>(points.cols());
  return smooth_closed_curve(points, (kCurvePoints + n - 1) / n);
}

double length_of(const std::vector<int>& loop, const Points& x) {
  double length = 0;
  for (size_t k = 0; k < loop.size(); ++k)
    length += (x.col(loop[(k + 1) % loop.size()]) - x.col(loop[k])).norm();
  return length;
}

void apply_tips(const ImportOptions& options, const std::string& file, Valve& valve,
                std::vector<std::string>& warnings) {
  if (!options.papillary.empty()) {
    const Points tips = papillary_points(options.papillary);
    if (valve.chords.papillary.cols() > 0)
      throw InputError(file +
                       ": has papillary tips already; --papillary gives tips to a valve without chords, "
                       "--papillary-closed moves those that there are");
    if (valve.free_edge.empty())
      throw InputError(file +
                       ": has no free edge to which chords from the papillary tips could go; its mesh "
                       "needs two rims");
    valve.chords.papillary = tips;
    valve.chords = leaflet_chords(valve, {});
    warnings.push_back(file + ": has no chords; " + std::to_string(valve.chords.chords.size()) +
                       " were made from the papillary tips to the free edge (coapt chords makes others).");
  }
  if (options.papillary_closed.empty()) return;
  const Points closed = papillary_points(options.papillary_closed);
  if (closed.cols() != valve.chords.papillary.cols())
    throw InputError(options.papillary_closed.string() + ": has " + std::to_string(closed.cols()) +
                     " points for " + std::to_string(valve.chords.papillary.cols()) +
                     " papillary tips; give one for each, in their order");
  valve.chords.papillary_closed = closed;
}

}  // namespace

void choose_annulus(Valve& valve, const Points& curve) {
  const Points& x = valve.leaflets.vertices;
  std::vector<std::vector<int>> loops = boundary_loops(valve.leaflets.triangles);
  if (loops.empty()) return;
  const auto cost = [&](const std::vector<int>& loop) {
    return curve.cols() > 0 ? mean_distance(x(Eigen::all, loop), curve) : -length_of(loop, x);
  };
  std::vector<double> costs;
  for (const std::vector<int>& loop : loops) costs.push_back(cost(loop));
  const auto best = std::min_element(costs.begin(), costs.end()) - costs.begin();
  valve.annulus = loops[static_cast<size_t>(best)];
  loops.erase(loops.begin() + best);
  valve.free_edge = loops.size() == 1 ? loops[0] : std::vector<int>{};
}

void apply_curves(const ImportOptions& options, const std::string& file, Valve& valve,
                  std::vector<std::string>& warnings) {
  std::vector<std::string> defects;
  const auto attempt = [&](auto&& step) {
    try {
      step();
    } catch (const InputError& error) {
      defects.insert(defects.end(), error.defects().begin(), error.defects().end());
    }
  };
  attempt([&] {
    if (options.annulus_closed.empty()) return;
    const Points curve = fine_curve(annulus_curve(options.annulus_closed));
    const bool is_given = !valve.chords.chords.empty() || !valve.supports.empty() || valve.pressure > 0;
    if (!is_given || valve.annulus.size() < 3) choose_annulus(valve, curve);
    if (valve.annulus.size() < 3)
      throw InputError(file + ": the mesh has no rim that could be the annulus of --annulus-closed");
    valve.annulus_closed = matched_by_length(valve.leaflets.vertices(Eigen::all, valve.annulus), curve);
  });
  attempt([&] { apply_tips(options, file, valve, warnings); });
  if (!defects.empty()) throw InputError(defects);
}

}  // namespace coapt::detail
