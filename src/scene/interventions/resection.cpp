// Resection: a wedge is cut out of a leaflet and its sides are sewn together.
#include "core/error.hpp"
#include "mesh/remesh/cut_away.hpp"
#include "scene/interventions/chord_selection.hpp"
#include "scene/interventions/free_edges.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace coapt {
namespace {

// Below zero within the wedge [mm]. Vertices of other leaflets are well outside it.
Vector wedge_level(const Parameters& p, const FreeEdge& edge, const TriangleMesh& mesh) {
  Vector level = Vector::Constant(mesh.vertex_count(), edge.length());
  for (const LeafletPoint& point : leaflet_points(edge, mesh))
    level[point.vertex] = std::abs(point.along - p.number("at") * edge.length()) -
                          p.number("width") / 2 * (1 - point.depth / p.number("depth"));
  return level;
}

// A wedge lies in its leaflet, away from the annulus and from other leaflets.
void refuse_too_large(const Parameters& p, const Vector& level, const FreeEdge& edge,
                      const ValveEdit& valve) {
  const TriangleMesh& mesh = valve.mesh;
  if ((level.array() >= 0).all())
    throw InputError(p.where() + ": the wedge holds no vertex of the mesh; make it greater than its edges");
  for (const int v : valve.set("annulus"))
    if (level[v] <= 0)
      throw InputError(p.where("depth") + ": the wedge reaches the annulus; make it less deep");
  for (int t = 0; t < mesh.triangle_count(); ++t) {
    if (mesh.region_names[static_cast<size_t>(mesh.regions[static_cast<size_t>(t)])] == edge.leaflet)
      continue;
    for (const int v : mesh.triangles.col(t))
      if (level[v] <= 0)
        throw InputError(p.where("at") + ": the wedge reaches beyond \"" + edge.leaflet +
                         "\"; make it narrower or move it towards the middle of the leaflet");
  }
}

// The cut as one chain of vertices from free edge to free edge.
std::vector<int> cut_chain(const Parameters& p, const CutMesh& cut) {
  std::map<int, std::vector<int>> next;
  for (const Edge& edge : edges(cut.mesh.triangles))
    if (edge.triangles.size() == 1 && cut.is_on_cut[static_cast<size_t>(edge.a)] &&
        cut.is_on_cut[static_cast<size_t>(edge.b)]) {
      next[edge.a].push_back(edge.b);
      next[edge.b].push_back(edge.a);
    }
  std::vector<int> chain;
  for (const auto& [vertex, neighbours] : next)
    if (neighbours.size() == 1 && chain.empty()) chain.push_back(vertex);
  while (!chain.empty()) {
    const std::vector<int>& onward = next.at(chain.back());
    const int before = chain.size() > 1 ? chain[chain.size() - 2] : -1;
    const auto step = std::find_if(onward.begin(), onward.end(), [&](int v) { return v != before; });
    if (step == onward.end() || chain.size() > next.size()) break;
    chain.push_back(*step);
  }
  if (chain.size() < 3 || chain.size() != next.size())
    throw InputError(p.where() +
                     ": the wedge does not leave one cut from free edge to free edge; make it wider, "
                     "deeper or take a finer mesh");
  return chain;
}

// One side of the cut, from its apex to the free edge.
struct Side {
  std::vector<int> vertices;
  std::vector<double> part;  // of its length, up to each
};

Side side_of(std::vector<int> vertices, const Points& x) {
  Side side{std::move(vertices), {0}};
  for (size_t k = 1; k < side.vertices.size(); ++k)
    side.part.push_back(side.part.back() + (x.col(side.vertices[k]) - x.col(side.vertices[k - 1])).norm());
  const double length = side.part.back();
  for (double& part : side.part) part /= length;
  return side;
}

// Puts a vertex before entry k of the side, at a part of its length.
void divide(Side& side, size_t k, double part, CutMesh& cut) {
  TriangleMesh& mesh = cut.mesh;
  const int a = side.vertices[k - 1], b = side.vertices[k];
  int triangle = 0;
  while (!((mesh.triangles.col(triangle).array() == a).any() &&
           (mesh.triangles.col(triangle).array() == b).any()))
    ++triangle;
  divide_edge(mesh, triangle, a, b, (part - side.part[k - 1]) / (side.part[k] - side.part[k - 1]));
  cut.source_triangle.push_back(cut.source_triangle[static_cast<size_t>(triangle)]);
  cut.is_on_cut.push_back(1);
  const auto place = static_cast<std::ptrdiff_t>(k);
  side.vertices.insert(side.vertices.begin() + place, mesh.vertex_count() - 1);
  side.part.insert(side.part.begin() + place, part);
}

// Pairs of vertices at equal parts of both sides, the apex excepted; where a side has none it gets one.
std::vector<std::array<int, 2>> stitches(Side a, Side b, CutMesh& cut) {
  constexpr double kNear = 0.3;         // of the shorter edge: near enough for a stitch
  constexpr double kCoincident = 1e-3;  // of the side: no room for a vertex of its own
  std::vector<std::array<int, 2>> pairs;
  for (size_t i = 1, j = 1; i < a.vertices.size() || j < b.vertices.size();) {
    const double at = a.part[i], other = b.part[j];
    const bool are_last = i + 1 == a.vertices.size() && j + 1 == b.vertices.size(),
               is_one_last = !are_last && (i + 1 == a.vertices.size() || j + 1 == b.vertices.size());
    const double spacing = std::min(at - a.part[i - 1], other - b.part[j - 1]);
    if (!are_last && (is_one_last || std::abs(at - other) > kNear * spacing)) {
      Side &ahead = at > other ? a : b, &behind = at > other ? b : a;
      size_t &k = at > other ? i : j, &n = at > other ? j : i;
      const double part = behind.part[n];
      if (part < ahead.part[k - 1] + kCoincident) {
        // Beside the last stitch: one more to the same vertex, unless that is the apex.
        if (k > 1) pairs.push_back({ahead.vertices[k - 1], behind.vertices[n]});
        ++n;
        continue;
      }
      divide(ahead, k, part, cut);
    }
    pairs.push_back({a.vertices[i++], b.vertices[j++]});
  }
  return pairs;
}

// The rim without the cut, where the files name one.
void close_free_edge(const std::vector<int>& chain, const CutMesh& cut, ValveEdit& valve) {
  const auto named = valve.sets.find("free_edge");
  if (named == valve.sets.end()) return;
  const std::set<int> inner(chain.begin() + 1, chain.end() - 1);
  for (std::vector<int>& loop : boundary_loops(cut.mesh.triangles)) {
    if (std::find(loop.begin(), loop.end(), chain.front()) == loop.end()) continue;
    std::erase_if(loop, [&](int v) { return inner.contains(v); });
    named->second = std::move(loop);
  }
}

// What held on to vertices that are gone goes with them.
void clear_away(const InterventionSpec& spec, const CutMesh& cut, ValveEdit& valve) {
  std::vector<bool> is_left(static_cast<size_t>(cut.mesh.vertex_count()), false);
  for (const int v : cut.mesh.triangles.reshaped()) is_left[static_cast<size_t>(v)] = true;
  const auto is_gone = [&](int v) { return !is_left[static_cast<size_t>(v)]; };
  for (auto& [name, vertices] : valve.sets) std::erase_if(vertices, is_gone);
  for (auto& [name, pairs] : valve.links)
    std::erase_if(pairs, [&](const auto& pair) { return is_gone(pair[0]) || is_gone(pair[1]); });
  size_t lost = 0;
  for (auto& [path, network] : valve.networks) {
    std::vector<size_t> chords;
    for (size_t k = 0; k < network.chords.size(); ++k)
      for (const ChordEnd& end : {network.chords[k].from, network.chords[k].to})
        if (end.kind == ChordEnd::Kind::Leaflet && is_gone(end.index)) chords.push_back(k);
    const size_t before = network.chords.size();
    remove_chords(network, chords);
    lost += before - network.chords.size();
  }
  if (lost > 0)
    valve.warnings.push_back(spec.parameters.where() + ": " + std::to_string(lost) +
                             " chords went with the tissue that they held.");
  for (auto& [name, patch] : valve.patches) patch = Vector(patch(cut.source_triangle));
}

void resect(const InterventionSpec& spec, ValveEdit& valve) {
  constexpr double kSnap = 0.2;
  const Parameters& p = spec.parameters;
  const FreeEdge edge = free_edges(spec, valve).front();
  const Vector level = wedge_level(p, edge, valve.mesh);
  refuse_too_large(p, level, edge, valve);
  CutMesh cut = cut_away(valve.mesh, level, kSnap);
  const std::vector<int> chain = cut_chain(p, cut);
  const auto depth = [&](int v) { return place_on(edge, cut.mesh.vertices, cut.mesh.vertices.col(v)).depth; };
  size_t apex = 0;
  for (size_t k = 0; k < chain.size(); ++k)
    if (depth(chain[k]) > depth(chain[apex])) apex = k;
  if (apex == 0 || apex + 1 == chain.size())
    throw InputError(p.where("depth") + ": the wedge is no deeper than a triangle; make it deeper");
  std::vector<int> first(chain.begin(), chain.begin() + static_cast<std::ptrdiff_t>(apex) + 1);
  std::reverse(first.begin(), first.end());
  const std::vector<int> second(chain.begin() + static_cast<std::ptrdiff_t>(apex), chain.end());
  std::vector<std::array<int, 2>> pairs =
      stitches(side_of(first, cut.mesh.vertices), side_of(second, cut.mesh.vertices), cut);
  close_free_edge(chain, cut, valve);
  clear_away(spec, cut, valve);
  valve.mesh = std::move(cut.mesh);
  valve.links[spec.name] = std::move(pairs);
}

}  // namespace

InterventionType resection_intervention() {
  std::vector<KeySpec> keys = {
      {.name = "leaflet", .kind = KeyKind::Text, .required = true, .doc = "Its region."},
      {.name = "at",
       .required = true,
       .min = 0,
       .max = 1,
       .doc = "Middle of the wedge, as the fraction of the free edge's length from the first commissure."},
      {.name = "width",
       .dimension = kLength,
       .required = true,
       .min = 0,
       .excludes_min = true,
       .doc = "What is taken of the free edge."},
      {.name = "depth",
       .dimension = kLength,
       .required = true,
       .min = 0,
       .excludes_min = true,
       .doc = "Distance of the apex of the wedge from the free edge."}};
  for (const KeySpec& key : link_keys()) keys.push_back(key);
  return {.name = "resection",
          .summary =
              "A wedge is cut out of a leaflet, from the free edge towards the annulus, and its sides are "
              "sewn together; chords that held it go with it.",
          .spec = {.keys = std::move(keys)},
          .edit = resect,
          .term = link_term};
}

}  // namespace coapt
