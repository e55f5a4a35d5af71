#include "valve/generators/chord_insertions.hpp"

#include "core/error.hpp"
#include "valve/detail/along_edge.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

namespace coapt {
namespace {

// A vertex at which a chord may end, in coordinates along and across the leaflets [mm].
struct Site {
  int vertex = 0;
  double along = 0;    // of the free edge's length, by along_edge()
  double height = 1;   // 0 at the annulus, 1 at the free edge
  double leaflet = 0;  // from annulus to free edge there
};

struct LeafletSites {
  std::vector<Site> free_edge, inside;
  double length = 0;  // of the free edge
};

LeafletSites sites_of(const Valve& valve) {
  const TriangleMesh& mesh = valve.leaflets;
  const std::vector<double> from_annulus = distances_along_edges(mesh, valve.annulus);
  const std::vector<double> from_edge = distances_along_edges(mesh, valve.free_edge);
  const EdgeLengths edge = edge_lengths(mesh, valve.free_edge);
  LeafletSites sites;
  sites.length = edge.length;
  std::set<int> rims(valve.annulus.begin(), valve.annulus.end());
  for (size_t k = 0; k < valve.free_edge.size(); ++k) {
    // A vertex of both rims (a commissure down to the annulus) does not move: no chord ends there.
    if (!rims.contains(valve.free_edge[k]))
      sites.free_edge.push_back({valve.free_edge[k], edge.along[k], 1, 0});
  }
  rims.insert(valve.free_edge.begin(), valve.free_edge.end());
  const std::vector<double> inside = along_edge(mesh, valve.free_edge, edge);
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    const auto i = static_cast<size_t>(v);
    const double whole = from_annulus[i] + from_edge[i];
    if (rims.contains(v) || !std::isfinite(whole)) continue;
    sites.inside.push_back({v, inside[i], from_annulus[i] / whole, whole});
  }
  return sites;
}

// The free site nearest to a place; it is taken.
int take_nearest(std::vector<Site>& free_sites, double along, double height, double length) {
  const auto cost = [&](const Site& site) {
    const double around = std::abs(site.along - along), up = site.leaflet * (site.height - height);
    const double step = std::min(around, length - around);
    return step * step + up * up;
  };
  const auto best = std::min_element(free_sites.begin(), free_sites.end(),
                                     [&](const Site& a, const Site& b) { return cost(a) < cost(b); });
  const int vertex = best->vertex;
  free_sites.erase(best);
  return vertex;
}

int insertions_of_a_chord(const LeafletChordOptions& options) {
  int insertions = 1;
  for (int level = 1; level < options.levels; ++level) insertions *= options.branches;
  return insertions;
}

void shift(std::vector<double>& along, double step, unsigned seed) {
  if (seed == 0) return;
  std::mt19937 random(seed);
  for (double& place : along) place += step / 3 * (2 * (static_cast<double>(random()) / 4294967296.0) - 1);
}

std::vector<PlannedChord> chosen_by_the_user(const Valve& valve, const LeafletChordOptions& options) {
  std::vector<std::string> defects;
  std::vector<PlannedChord> planned;
  const std::set<int> edge(valve.free_edge.begin(), valve.free_edge.end()),
      annulus(valve.annulus.begin(), valve.annulus.end());
  std::set<int> taken;
  for (size_t group = 0; group < options.insertions.size(); ++group)
    for (const int v : options.insertions[group]) {
      const std::string name = "chords: insertion " + std::to_string(v);
      if (v < 0 || v >= valve.leaflets.vertex_count())
        defects.push_back(name + ": no such vertex; the leaflets have " +
                          std::to_string(valve.leaflets.vertex_count()) + ", from 0 on");
      else if (annulus.contains(v))
        defects.push_back(name + ": is on the annulus, which does not move; name a vertex of the leaflets");
      else if (!taken.insert(v).second)
        defects.push_back(name + ": is named twice");
      else
        planned.push_back({chord_zone(edge.contains(v) ? "free_edge" : "rough"),
                           {v},
                           options.insertions.size() == 1 ? -1 : static_cast<int>(group)});
    }
  if (!defects.empty()) throw InputError(std::move(defects));
  return planned;
}

}  // namespace

std::vector<PlannedChord> planned_chords(const Valve& valve, const LeafletChordOptions& options) {
  if (!options.insertions.empty()) return chosen_by_the_user(valve, options);
  std::vector<std::string> defects;
  std::vector<PlannedChord> planned;
  LeafletSites sites = sites_of(valve);
  const int per_chord = insertions_of_a_chord(options), wanted = options.count * per_chord;
  for (const ChordZone& zone : options.zones) {
    std::vector<Site>& free_sites = zone.height < 1 ? sites.inside : sites.free_edge;
    if (static_cast<size_t>(wanted) > free_sites.size()) {
      defects.push_back("chords: zone of the " + zone.material + " chords: " + std::to_string(wanted) +
                        " insertions, but only " + std::to_string(free_sites.size()) +
                        " free vertices; take fewer chords, branches or levels, or a finer mesh");
      continue;
    }
    if (!defects.empty()) continue;
    const double step = sites.length / wanted;
    std::vector<double> along;
    for (int k = 0; k < wanted; ++k) along.push_back((k + 0.5) * step);
    shift(along, step, options.seed);
    for (int k = 0; k < wanted; k += per_chord) {
      PlannedChord chord{zone, {}, -1};
      for (int i = k; i < k + per_chord; ++i)
        chord.vertices.push_back(
            take_nearest(free_sites, along[static_cast<size_t>(i)], zone.height, sites.length));
      planned.push_back(std::move(chord));
    }
  }
  if (!defects.empty()) throw InputError(std::move(defects));
  return planned;
}

}  // namespace coapt
