// Edge-to-edge clips: vertices of two leaflets joined at places along their free edges.
#include "core/error.hpp"
#include "core/number_text.hpp"
#include "formats/json/suggestion.hpp"
#include "scene/interventions/free_edges.hpp"

#include <algorithm>
#include <cmath>
#include <set>

namespace coapt {
namespace {

// Vertices within the arms of a clip; `along` from its middle.
std::vector<LeafletPoint> grasped(const FreeEdge& edge, const std::vector<LeafletPoint>& points, double at,
                                  const Parameters& p) {
  std::vector<LeafletPoint> inside;
  for (LeafletPoint point : points) {
    point.along -= at * edge.length();
    if (std::abs(point.along) <= p.number("width") / 2 && point.depth <= p.number("depth"))
      inside.push_back(point);
  }
  return inside;
}

// Whether the arms of a clip are as long as the leaflet is high where it sits: at the vertices of the annulus
// within its width, or else the one nearest to its middle.
bool reaches(const std::set<int>& annulus, const FreeEdge& edge, const std::vector<LeafletPoint>& points,
             double at, const Parameters& p) {
  const auto aside = [&](const LeafletPoint& point) { return std::abs(point.along - at * edge.length()); };
  double nearest = kInfinity;
  for (const LeafletPoint& point : points)
    if (annulus.contains(point.vertex)) nearest = std::min(nearest, aside(point));
  const double width = std::max(nearest, p.number("width") / 2);
  return std::any_of(points.begin(), points.end(), [&](const LeafletPoint& point) {
    return annulus.contains(point.vertex) && aside(point) <= width && point.depth <= p.number("depth");
  });
}

// Each vertex of the smaller side with the nearest one, by place on the leaflet, that is still free.
std::vector<std::array<int, 2>> pairs(std::vector<LeafletPoint> a, std::vector<LeafletPoint> b) {
  if (a.size() > b.size()) std::swap(a, b);
  struct Candidate {
    double distance = 0;
    size_t i = 0, j = 0;
  };
  std::vector<Candidate> candidates;
  for (size_t i = 0; i < a.size(); ++i)
    for (size_t j = 0; j < b.size(); ++j)
      if (a[i].vertex != b[j].vertex)
        candidates.push_back({std::hypot(a[i].along - b[j].along, a[i].depth - b[j].depth), i, j});
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& x, const Candidate& y) { return x.distance < y.distance; });
  std::vector<char> is_taken_a(a.size(), 0), is_taken_b(b.size(), 0);
  std::vector<std::array<int, 2>> joined;
  for (const Candidate& c : candidates) {
    if (is_taken_a[c.i] || is_taken_b[c.j]) continue;
    is_taken_a[c.i] = is_taken_b[c.j] = 1;
    joined.push_back({a[c.i].vertex, b[c.j].vertex});
  }
  return joined;
}

void clip_leaflets(const InterventionSpec& spec, ValveEdit& valve) {
  const Parameters& p = spec.parameters;
  const std::vector<FreeEdge> edges = free_edges(spec, valve);
  if (edges.size() == 2 && edges[0].leaflet == edges[1].leaflet)
    throw InputError(p.where("leaflets") + ": names \"" + edges[0].leaflet +
                     "\" twice; a clip joins two leaflets");
  if (edges.size() != 2) {
    std::vector<std::string> names;
    for (const FreeEdge& edge : edges) names.push_back(edge.leaflet);
    throw InputError((p.has("leaflets") ? p.where("leaflets") : p.where()) +
                     ": a clip joins two leaflets, not " + std::to_string(edges.size()) + "; name two of " +
                     listed(valve.mesh.region_names));
  }
  const std::vector<LeafletPoint> first = leaflet_points(edges[0], valve.mesh),
                                  second = leaflet_points(edges[1], valve.mesh);
  const std::vector<int> annulus = valve.set("annulus");
  const std::set<int> held(annulus.begin(), annulus.end());
  std::vector<std::string> defects;
  std::vector<std::array<int, 2>> all;
  for (size_t k = 0; k < p.numbers("at").size(); ++k) {
    const double at = p.numbers("at")[k];
    const auto joined = pairs(grasped(edges[0], first, at, p), grasped(edges[1], second, at, p));
    if (joined.empty())
      defects.push_back(
          p.where("at") + "[" + std::to_string(k) +
          "]: the clip grasps no vertex on one of the leaflets; make it wider or deeper than the "
          "mesh, whose edges are " +
          number_text(mean_edge_length(valve.mesh.vertices, valve.mesh.triangles)) + " mm long");
    if (reaches(held, edges[0], first, at, p) || reaches(held, edges[1], second, at, p))
      defects.push_back(p.where("depth") + ": the clip at[" + std::to_string(k) +
                        "] reaches the annulus; make it less deep");
    for (const auto& pair : joined)
      if (std::find(all.begin(), all.end(), pair) == all.end()) all.push_back(pair);
  }
  if (!defects.empty()) throw InputError(defects);
  valve.links[spec.name] = std::move(all);
}

std::vector<std::string> too_many_clips(const Parameters& p) {
  constexpr size_t kMost = 3;
  if (p.numbers("at").size() <= kMost) return {};
  return {"at: has " + std::to_string(p.numbers("at").size()) + " places; one to three clips are placed"};
}

}  // namespace

InterventionType clip_intervention() {
  std::vector<KeySpec> keys = {
      {.name = "at",
       .kind = KeyKind::Quantities,
       .required = true,
       .min = 0,
       .max = 1,
       .doc = "Where one to three clips sit, each as the fraction of the free edge's length from the first "
              "commissure."},
      {.name = "width",
       .dimension = kLength,
       .fallback = "\"5 mm\"",
       .min = 0,
       .excludes_min = true,
       .doc = "Of each clip, along the free edge."},
      {.name = "depth",
       .dimension = kLength,
       .fallback = "\"9 mm\"",
       .min = 0,
       .excludes_min = true,
       .doc = "How far from the free edge its arms reach."},
      {.name = "leaflets",
       .kind = KeyKind::Texts,
       .doc = "The two regions that are joined; default: the only two of the mesh."}};
  for (const KeySpec& key : link_keys()) keys.push_back(key);
  return {.name = "clip",
          .summary =
              "Edge-to-edge clips: pairs of vertices of two leaflets, within the arms of each clip, are "
              "held together.",
          .spec = {.keys = std::move(keys)},
          .check = too_many_clips,
          .edit = clip_leaflets,
          .term = link_term};
}

}  // namespace coapt
