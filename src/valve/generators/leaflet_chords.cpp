#include "valve/generators/leaflet_chords.hpp"

#include "core/error.hpp"
#include "mesh/triangle_mesh.hpp"
#include "valve/detail/along_edge.hpp"
#include "valve/generators/chord_insertions.hpp"
#include "valve/generators/chord_junctions.hpp"
#include "valve/generators/unseen_tips.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

namespace coapt {
namespace {

constexpr double kHangingShare = 0.5;  // of the area that the annulus leaves over
constexpr double kMostOfTheWay = 0.5;  // down to the highest tip
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

// Builds the network, from the tips to the leaflets.
class LeafletChordBuilder {
 public:
  LeafletChordBuilder(const Valve& valve, const LeafletChordOptions& options, const Plane& plane,
                      const Points& tips, std::vector<double> drops)
      : X_(valve.leaflets.vertices), options_(options), plane_(plane), drops_(std::move(drops)) {
    network_.papillary = tips;
    network_.papillary_closed = valve.chords.papillary_closed;
  }

  void add(const PlannedChord& chord) {
    const Points& tips = network_.papillary;
    const int tip = chord.tip >= 0
                        ? chord.tip
                        : nearest_tip(tips, 0, static_cast<int>(tips.cols()), middle(X_, chord.vertices));
    const Points& closed = network_.papillary_closed.cols() > 0 ? network_.papillary_closed : tips;
    grow(chord.zone, {{ChordEnd::Kind::Papillary, tip}, tips.col(tip), closed.col(tip)}, chord.vertices, 1);
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

  Vec3 expected(int vertex) const {
    const Vec3 x = X_.col(vertex);
    const double below = options_.depth + drops_[static_cast<size_t>(vertex)];
    return x - ((x - plane_.centre).dot(plane_.normal) + below) * plane_.normal;
  }

  Vec3 expected_middle(const std::vector<int>& vertices) const {
    Vec3 sum = Vec3::Zero();
    for (const int v : vertices) sum += expected(v);
    return sum / static_cast<double>(vertices.size());
  }

  double rest_length(const Vec3& a, const Vec3& b) const { return options_.scale * (a - b).norm(); }

  void join(const ChordZone& zone, const Place& from, const Place& to, int level) {
    const double area = options_.level_areas.empty() ? zone.area / std::pow(options_.branches, level - 1)
                                                     : options_.level_areas[static_cast<size_t>(level - 1)];
    // The paper's sum: of the vertex's distances from the plane and from the tip, where both are.
    const double length = options_.lengths == ChordLengths::Sum
                              ? options_.scale * (std::abs((to.start - plane_.centre).dot(plane_.normal)) +
                                                  (to.start - from.start).norm())
                              : rest_length(from.expected, to.expected);
    network_.chords.push_back({from.end, to.end, length, area, zone.material, level});
  }

  Place junction(const Place& from, const std::vector<int>& vertices) {
    const Vec3 goal = expected_middle(vertices);
    Place place;
    place.expected = from.expected + kJunctionPlace * (goal - from.expected);
    JunctionLimits limits;
    limits.ends.resize(3, static_cast<Eigen::Index>(vertices.size()) + 1);
    limits.ends.col(0) = from.start;
    limits.rest_lengths = {rest_length(from.expected, place.expected)};
    for (size_t k = 0; k < vertices.size(); ++k) {
      const Vec3 x = X_.col(vertices[k]);
      limits.ends.col(static_cast<Eigen::Index>(k) + 1) = x;
      limits.rest_lengths.push_back(rest_length(place.expected, expected(vertices[k])));
    }
    place.start = place_junction(from.start + kJunctionPlace * (middle(X_, vertices) - from.start), limits);
    place.end = {ChordEnd::Kind::Junction, static_cast<int>(junctions_.size())};
    junctions_.push_back(place.start);
    return place;
  }

  void grow(const ChordZone& zone, const Place& from, const std::vector<int>& vertices, int level) {
    if (vertices.size() == 1) {
      const Vec3 x = X_.col(vertices[0]);
      return join(zone, from, {{ChordEnd::Kind::Leaflet, vertices[0]}, x, expected(vertices[0])}, level);
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
  std::vector<double> drops_;  // of each vertex below the depth
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
  if (o.lengths == ChordLengths::Sum && o.levels > 1)
    defects.push_back("chords: lengths: the sum of distances is that of straight chords; take levels 1");
  if (!o.insertions.empty() && o.levels > 1)
    defects.push_back("chords: insertions: each has a straight chord of its own; take levels 1");
  if (!o.level_areas.empty() && static_cast<int>(o.level_areas.size()) != o.levels)
    defects.push_back("chords: level_areas: holds " + std::to_string(o.level_areas.size()) + " areas for " +
                      std::to_string(o.levels) + " levels");
  for (const double area : o.level_areas)
    if (!(area > 0 && std::isfinite(area))) defects.push_back("chords: level_areas: each must be above 0");
  return defects;
}

// The annulus plane, closed where that is known, its normal away from the tips, or from the leaflets where
// there are none.
Plane annulus_plane(const Valve& valve) {
  Plane plane = best_fit_plane(valve.annulus_closed.cols() > 0
                                   ? valve.annulus_closed
                                   : Points(valve.leaflets.vertices(Eigen::all, valve.annulus)));
  const bool has_tips = valve.chords.papillary.cols() > 0;
  const Vec3 below = (has_tips ? valve.chords.papillary : valve.leaflets.vertices).rowwise().mean();
  if ((below - plane.centre).dot(plane.normal) > 0) plane.normal = -plane.normal;
  return plane;
}

void check_tips(const Points& open, const Points& closed, const Plane& plane, double depth) {
  std::vector<std::string> defects;
  for (const Points& tips : {open, closed})
    for (int k = 0; k < tips.cols(); ++k)
      if ((tips.col(k) - plane.centre).dot(plane.normal) >= -depth)
        defects.push_back(
            "chords: tip " + std::to_string(k) +
            ": is not below the annulus plane by more than the depth of the insertions, so that a "
            "chord from it could hold nothing down");
  if (!defects.empty()) throw InputError(std::move(defects));
}

// The area that a polygon encloses as seen along its area vector [length^2].
double enclosed_area(const Points& polygon) {
  Vec3 twice = Vec3::Zero();
  const Vec3 origin = polygon.col(0);
  for (Eigen::Index k = 0; k + 1 < polygon.cols(); ++k)
    twice += (polygon.col(k) - origin).cross(polygon.col(k + 1) - origin);
  return 0.5 * twice.norm();
}

// How far below the line where leaflets meet their free edge hangs: half of the area that the annulus leaves
// over, along the whole edge. It stays above the middle of the way to the highest tip.
double hanging_height(const Valve& valve, const Plane& plane, const Points& tips, double depth) {
  const Points annulus = valve.annulus_closed.cols() > 0
                             ? valve.annulus_closed
                             : Points(valve.leaflets.vertices(Eigen::all, valve.annulus));
  const double left_over =
      surface_area(valve.leaflets.vertices, valve.leaflets.triangles) - enclosed_area(annulus);
  const double length = edge_lengths(valve.leaflets, valve.free_edge).length;
  double most = kInfinity;
  for (const auto tip : tips.colwise())
    most = std::min(most, -(tip - plane.centre).dot(plane.normal) - depth);
  return length > 0 ? std::clamp(kHangingShare * left_over / length, 0.0, kMostOfTheWay * most) : 0;
}

// How far below the others each vertex is expected in the closed valve.
std::vector<double> drops_of(const Valve& valve, const LeafletChordOptions& options, const Plane& plane,
                             const Points& tips) {
  std::vector<double> drops(static_cast<size_t>(valve.leaflets.vertex_count()), 0);
  if (options.lengths != ChordLengths::ToCoapted) return drops;
  const double height = hanging_height(valve, plane, tips, options.depth);
  const std::vector<double> from_edge = distances_along_edges(valve.leaflets, valve.free_edge);
  std::transform(from_edge.begin(), from_edge.end(), drops.begin(),
                 [&](double distance) { return std::max(0.0, height - distance); });
  return drops;
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

ChordLengths chord_lengths(const std::string& name) {
  if (name == "coapted") return ChordLengths::ToCoapted;
  if (name == "plane") return ChordLengths::ToPlane;
  if (name == "sum") return ChordLengths::Sum;
  throw InputError("chords: lengths \"" + name + "\": expected one of coapted, plane, sum");
}

ChordNetwork leaflet_chords(const Valve& valve, const LeafletChordOptions& options) {
  std::vector<std::string> defects = option_defects(options);
  if (valve.annulus.size() < 3)
    defects.push_back("chords: the valve names no annulus of three vertices or more");
  if (valve.free_edge.empty()) defects.push_back("chords: the valve names no free edge");
  const auto tip_count = valve.chords.papillary.cols(), closed_tips = valve.chords.papillary_closed.cols();
  const auto groups = static_cast<Eigen::Index>(options.insertions.size()),
             wanted = tip_count > 0 ? tip_count : 2;
  if (groups > 1 && groups != wanted)
    defects.push_back("chords: insertions: " + std::to_string(groups) + " groups for " +
                      std::to_string(wanted) + " tips; give one for each tip, or a single one");
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
  std::vector<PlannedChord> planned = planned_chords(valve, options);
  const Points tips = tip_count > 0 ? valve.chords.papillary : unseen_tips(valve, plane, planned);
  check_tips(tips, valve.chords.papillary_closed, plane, options.depth);
  const Points& closed = valve.chords.papillary_closed.cols() > 0 ? valve.chords.papillary_closed : tips;
  LeafletChordBuilder builder(valve, options, plane, tips, drops_of(valve, options, plane, closed));
  for (const PlannedChord& chord : planned) builder.add(chord);
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
      if (valve.chords.papillary.cols() == 0) {
        const double enclosed = enclosed_area(valve.leaflets.vertices(Eigen::all, loop));
        if (enclosed > farthest) valve.annulus = loop;
        farthest = std::max(farthest, enclosed);
        continue;
      }
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
