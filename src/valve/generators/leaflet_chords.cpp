#include "valve/generators/leaflet_chords.hpp"

#include "core/error.hpp"
#include "mesh/vertex_graph.hpp"
#include "valve/generators/chord_junctions.hpp"

#include <algorithm>
#include <cmath>
#include <queue>
#include <random>
#include <set>

namespace coapt {
namespace {

constexpr int kMostLevels = 4, kMostBranches = 6, kMostChords = 10000;

struct NamedZone {
  const char* name;
  ChordZone zone;
};

const std::vector<NamedZone>& named_zones() {
  static const std::vector<NamedZone> kZones{{"free_edge", {"primary", 1, 0.4}},
                                             {"rough", {"secondary", 0.65, 0.8}},
                                             {"basal", {"tertiary", 0.25, 1.2}}};
  return kZones;
}

// The distance of each vertex from the nearest source along edges, and which source that is (its place in the
// list); infinity and -1 where no way leads. Dijkstra.
struct Distances {
  std::vector<double> length;
  std::vector<int> source;
};

Distances distances_from(const TriangleMesh& mesh, const VertexGraph& graph,
                         const std::vector<int>& sources) {
  Distances result{std::vector<double>(static_cast<size_t>(mesh.vertex_count()), kInfinity),
                   std::vector<int>(static_cast<size_t>(mesh.vertex_count()), -1)};
  using Entry = std::pair<double, int>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  for (size_t k = 0; k < sources.size(); ++k) {
    result.length[static_cast<size_t>(sources[k])] = 0;
    result.source[static_cast<size_t>(sources[k])] = static_cast<int>(k);
    open.emplace(0, sources[k]);
  }
  while (!open.empty()) {
    const auto [length, v] = open.top();
    open.pop();
    if (length > result.length[static_cast<size_t>(v)]) continue;
    for (const int w : graph.of(v)) {
      const double way = length + (mesh.vertices.col(v) - mesh.vertices.col(w)).norm();
      if (way >= result.length[static_cast<size_t>(w)]) continue;
      result.length[static_cast<size_t>(w)] = way;
      result.source[static_cast<size_t>(w)] = result.source[static_cast<size_t>(v)];
      open.emplace(way, w);
    }
  }
  return result;
}

// A vertex at which a chord may end, in coordinates along and across the leaflets [mm].
struct Site {
  int vertex = 0;
  double along = 0;    // of the free edge's length, at its nearest point
  double height = 1;   // 0 at the annulus, 1 at the free edge
  double leaflet = 0;  // from annulus to free edge there
};

struct LeafletSites {
  std::vector<Site> free_edge, inside;
  double length = 0;  // of the free edge
};

LeafletSites sites_of(const Valve& valve) {
  const TriangleMesh& mesh = valve.leaflets;
  const VertexGraph graph = vertex_graph(mesh.triangles, mesh.vertex_count());
  const Distances from_annulus = distances_from(mesh, graph, valve.annulus);
  const Distances from_edge = distances_from(mesh, graph, valve.free_edge);
  LeafletSites sites;
  std::vector<double> along;
  for (size_t k = 0; k < valve.free_edge.size(); ++k) {
    const int v = valve.free_edge[k], next = valve.free_edge[(k + 1) % valve.free_edge.size()];
    along.push_back(sites.length);
    const auto near = graph.of(v);
    if (std::find(near.begin(), near.end(), next) != near.end())  // else the next leaflet begins
      sites.length += (mesh.vertices.col(v) - mesh.vertices.col(next)).norm();
  }
  std::set<int> rims(valve.annulus.begin(), valve.annulus.end());
  for (size_t k = 0; k < valve.free_edge.size(); ++k) {
    // A vertex of both rims (a commissure down to the annulus) does not move: no chord ends there.
    if (!rims.contains(valve.free_edge[k])) sites.free_edge.push_back({valve.free_edge[k], along[k], 1, 0});
  }
  rims.insert(valve.free_edge.begin(), valve.free_edge.end());
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    const auto i = static_cast<size_t>(v);
    const double whole = from_annulus.length[i] + from_edge.length[i];
    if (rims.contains(v) || !std::isfinite(whole)) continue;
    sites.inside.push_back(
        {v, along[static_cast<size_t>(from_edge.source[i])], from_annulus.length[i] / whole, whole});
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

// Builds the network, from the tips to the leaflets.
class LeafletChordBuilder {
 public:
  LeafletChordBuilder(const Valve& valve, const LeafletChordOptions& options, const Plane& plane)
      : X_(valve.leaflets.vertices), options_(options), plane_(plane) {
    network_.papillary = valve.chords.papillary;
    network_.papillary_closed = valve.chords.papillary_closed;
  }

  void add(const ChordZone& zone, const std::vector<int>& vertices) {
    const Points& tips = network_.papillary;
    const int tip = nearest_tip(tips, 0, static_cast<int>(tips.cols()), middle(X_, vertices));
    const Points& closed = network_.papillary_closed.cols() > 0 ? network_.papillary_closed : tips;
    grow(zone, {{ChordEnd::Kind::Papillary, tip}, tips.col(tip), closed.col(tip)}, vertices, 1);
  }

  ChordNetwork finish() {
    network_.junctions.resize(3, static_cast<Eigen::Index>(junctions_.size()));
    for (size_t k = 0; k < junctions_.size(); ++k)
      network_.junctions.col(static_cast<Eigen::Index>(k)) = junctions_[k];
    return std::move(network_);
  }

 private:
  struct Place {
    ChordEnd end;
    Vec3 start, expected;  // in the open and in the closed valve
  };

  static Vec3 middle(const Points& X, const std::vector<int>& vertices) {
    return X(Eigen::all, vertices).rowwise().mean();
  }

  Vec3 expected(const Vec3& x) const {
    return x - ((x - plane_.centre).dot(plane_.normal) + options_.depth) * plane_.normal;
  }

  double rest_length(const Vec3& a, const Vec3& b) const { return options_.scale * (a - b).norm(); }

  void join(const ChordZone& zone, const Place& from, const Place& to, int level) {
    const double area = options_.level_areas.empty() ? zone.area / std::pow(options_.branches, level - 1)
                                                     : options_.level_areas[static_cast<size_t>(level - 1)];
    network_.chords.push_back(
        {from.end, to.end, rest_length(from.expected, to.expected), area, zone.material, level});
  }

  Place junction(const Place& from, const std::vector<int>& vertices) {
    const Vec3 goal = expected(middle(X_, vertices));
    Place place;
    place.expected = from.expected + kJunctionPlace * (goal - from.expected);
    JunctionLimits limits;
    limits.ends.resize(3, static_cast<Eigen::Index>(vertices.size()) + 1);
    limits.ends.col(0) = from.start;
    limits.rest_lengths = {rest_length(from.expected, place.expected)};
    for (size_t k = 0; k < vertices.size(); ++k) {
      const Vec3 x = X_.col(vertices[k]);
      limits.ends.col(static_cast<Eigen::Index>(k) + 1) = x;
      limits.rest_lengths.push_back(rest_length(place.expected, expected(x)));
    }
    place.start = place_junction(from.start + kJunctionPlace * (middle(X_, vertices) - from.start), limits);
    place.end = {ChordEnd::Kind::Junction, static_cast<int>(junctions_.size())};
    junctions_.push_back(place.start);
    return place;
  }

  void grow(const ChordZone& zone, const Place& from, const std::vector<int>& vertices, int level) {
    if (vertices.size() == 1) {
      const Vec3 x = X_.col(vertices[0]);
      return join(zone, from, {{ChordEnd::Kind::Leaflet, vertices[0]}, x, expected(x)}, level);
    }
    const Place place = junction(from, vertices);
    join(zone, from, place, level);
    const size_t part = vertices.size() / static_cast<size_t>(options_.branches);
    for (auto first = vertices.begin(); first != vertices.end(); first += static_cast<long>(part))
      grow(zone, place, {first, first + static_cast<long>(part)}, level + 1);
  }

  const Points& X_;
  const LeafletChordOptions& options_;
  const Plane& plane_;
  ChordNetwork network_;
  std::vector<Vec3> junctions_;
};

std::vector<std::string> option_defects(const LeafletChordOptions& o) {
  std::vector<std::string> defects;
  const auto range = [&](const char* name, double value, double low, double high) {
    if (!(value >= low && value <= high))
      defects.push_back("chords: " + std::string(name) + ": must be from " +
                        std::to_string(static_cast<int>(low)) + " to " +
                        std::to_string(static_cast<int>(high)));
  };
  range("count", o.count, 1, kMostChords);
  range("levels", o.levels, 1, kMostLevels);
  if (o.levels > 1) range("branches", o.branches, 2, kMostBranches);
  if (!(o.scale > 0 && std::isfinite(o.scale))) defects.push_back("chords: scale: must be greater than 0");
  if (!(o.depth >= 0 && std::isfinite(o.depth))) defects.push_back("chords: depth: must be at least 0");
  if (o.zones.empty()) defects.push_back("chords: zones: name at least one");
  for (const ChordZone& zone : o.zones)
    if (!(zone.height > 0 && zone.height <= 1) || !(zone.area > 0))
      defects.push_back("chords: zone of the " + zone.material +
                        " chords: height must be in (0, 1] and area above 0");
  if (!o.level_areas.empty() && static_cast<int>(o.level_areas.size()) != o.levels)
    defects.push_back("chords: level_areas: holds " + std::to_string(o.level_areas.size()) + " areas for " +
                      std::to_string(o.levels) + " levels");
  for (const double area : o.level_areas)
    if (!(area > 0 && std::isfinite(area))) defects.push_back("chords: level_areas: each must be above 0");
  return defects;
}

// The annulus plane, closed where that is known, its normal away from the tips.
Plane annulus_plane(const Valve& valve) {
  Plane plane = best_fit_plane(valve.annulus_closed.cols() > 0
                                   ? valve.annulus_closed
                                   : Points(valve.leaflets.vertices(Eigen::all, valve.annulus)));
  const Vec3 tips = valve.chords.papillary.rowwise().mean();
  if ((tips - plane.centre).dot(plane.normal) > 0) plane.normal = -plane.normal;
  return plane;
}

void check_tips(const Valve& valve, const Plane& plane, double depth, std::vector<std::string>& defects) {
  for (const Points& tips : {valve.chords.papillary, valve.chords.papillary_closed})
    for (int k = 0; k < tips.cols(); ++k)
      if ((tips.col(k) - plane.centre).dot(plane.normal) >= -depth)
        defects.push_back(
            "chords: tip " + std::to_string(k) +
            ": is not below the annulus plane by more than the depth of the insertions, so that a "
            "chord from it could hold nothing down");
}

void shift(std::vector<double>& along, double step, unsigned seed) {
  if (seed == 0) return;
  std::mt19937 random(seed);
  for (double& place : along) place += step / 3 * (2 * (static_cast<double>(random()) / 4294967296.0) - 1);
}

}  // namespace

ChordZone chord_zone(const std::string& name) {
  for (const NamedZone& zone : named_zones())
    if (name == zone.name) return zone.zone;
  throw InputError("chords: zone \"" + name + "\": expected one of free_edge, rough, basal");
}

std::vector<std::string> chord_zone_names() {
  std::vector<std::string> names;
  for (const NamedZone& zone : named_zones()) names.emplace_back(zone.name);
  return names;
}

ChordNetwork leaflet_chords(const Valve& valve, const LeafletChordOptions& options) {
  std::vector<std::string> defects = option_defects(options);
  if (valve.annulus.size() < 3)
    defects.push_back("chords: the valve names no annulus of three vertices or more");
  if (valve.free_edge.empty()) defects.push_back("chords: the valve names no free edge");
  if (valve.chords.papillary.cols() == 0) defects.push_back("chords: no papillary tips are given");
  const auto closed_tips = valve.chords.papillary_closed.cols();
  if (closed_tips > 0 && closed_tips != valve.chords.papillary.cols())
    defects.push_back("chords: there are as many closed papillary tips as open ones, or none");
  for (const auto& [name, tips] :
       {std::pair{"tip ", &valve.chords.papillary}, std::pair{"closed tip ", &valve.chords.papillary_closed}})
    for (int k = 0; k < tips->cols(); ++k)
      if (!(tips->col(k).array().abs() <= kGreatestCoordinate).all())
        defects.push_back("chords: " + std::string(name) + std::to_string(k) +
                          ": a coordinate is not finite or greater than 1e9 mm");
  if (!defects.empty()) throw InputError(defects);
  const Plane plane = annulus_plane(valve);
  check_tips(valve, plane, options.depth, defects);

  LeafletSites sites = sites_of(valve);
  const int per_chord = insertions_of_a_chord(options), wanted = options.count * per_chord;
  LeafletChordBuilder builder(valve, options, plane);
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
      std::vector<int> vertices;
      for (int i = k; i < k + per_chord; ++i)
        vertices.push_back(
            take_nearest(free_sites, along[static_cast<size_t>(i)], zone.height, sites.length));
      builder.add(zone, vertices);
    }
  }
  if (!defects.empty()) throw InputError(defects);
  return builder.finish();
}

void find_rims(Valve& valve) {
  if (!valve.annulus.empty() && !valve.free_edge.empty()) return;
  const std::vector<std::vector<int>> loops = boundary_loops(valve.leaflets.triangles);
  if (valve.annulus.empty()) {
    if (loops.size() < 2)
      throw InputError(
          "chords: the mesh has " + std::to_string(loops.size()) +
          " boundary loops, so that annulus and free edge cannot be told apart; name them in a valve "
          "JSON or in the scene's sets");
    double farthest = -1;
    for (const auto& loop : loops) {
      double distance = 0;
      for (const int v : loop)
        distance += (valve.chords.papillary.colwise() - Vec3(valve.leaflets.vertices.col(v)))
                        .colwise()
                        .norm()
                        .minCoeff();
      if (distance / static_cast<double>(loop.size()) <= farthest) continue;
      farthest = distance / static_cast<double>(loop.size());
      valve.annulus = loop;
    }
  }
  if (!valve.free_edge.empty()) return;
  const std::set<int> annulus(valve.annulus.begin(), valve.annulus.end());
  for (std::vector<int> loop : loops) {
    // Starts behind a piece of the annulus, so that what is left stays in one piece.
    const auto first = std::find_if(loop.begin(), loop.end(), [&](int v) { return annulus.contains(v); });
    std::rotate(loop.begin(), first == loop.end() ? loop.begin() : first, loop.end());
    for (const int v : loop)
      if (!annulus.contains(v)) valve.free_edge.push_back(v);
  }
  if (valve.free_edge.empty())
    throw InputError("chords: every boundary vertex is on the annulus; the mesh has no free edge");
}

}  // namespace coapt
