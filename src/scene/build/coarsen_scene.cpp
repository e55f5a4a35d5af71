#include "scene/build/coarsen_scene.hpp"

#include "core/error.hpp"

#include <algorithm>

namespace coapt {
namespace {

using Kind = NodeSelection::Kind;

// Supports of a kind have the same prescribed coordinates and paths of as many stations.
std::vector<int> support_kinds(const SceneGeometry& geometry) {
  std::vector<int> kinds(static_cast<size_t>(geometry.model.mesh.vertex_count()), 0);
  for (size_t v = 0; v < kinds.size(); ++v)
    for (int c = 0; c < 3; ++c)
      if (geometry.prescribed.fixed(c, static_cast<int>(v))) kinds[v] |= 1 << c;
  for (const auto& [node, path] : geometry.prescribed.paths)
    if (static_cast<size_t>(node) < kinds.size())
      kinds[static_cast<size_t>(node)] += 8 * static_cast<int>(path.size());
  return kinds;
}

// The mesh edges with both nodes in the selection: cables run along them.
void add_lines(const Parameters& p, const SceneGeometry& geometry, std::vector<std::array<int, 2>>& lines) {
  const NodeSelection& selection = p.nodes("edges");
  if (selection.kind == Kind::Set && selection.text == "boundary") return;  // kept in any case
  std::vector<bool> is_wanted(static_cast<size_t>(geometry.model.X.cols()), false);
  for (const int node : selected_nodes(selection, geometry, p.where("edges")))
    is_wanted[static_cast<size_t>(node)] = true;
  for (const Edge& edge : edges(geometry.model.mesh.triangles))
    if (is_wanted[static_cast<size_t>(edge.a)] && is_wanted[static_cast<size_t>(edge.b)])
      lines.push_back({edge.a, edge.b});
}

// Nodes that carry a meaning of their own in a term.
void add_named(const Parameters& p, const SceneGeometry& geometry, std::vector<int>& keep) {
  constexpr size_t kFew = 64;  // of a set that gives the ends of a line
  if (p.has("nodes")) {
    const NodeSelection& selection = p.nodes("nodes");
    const std::vector<int> nodes = selected_nodes(selection, geometry, p.where("nodes"));
    if (selection.kind == Kind::Indices || selection.kind == Kind::Nearest)
      keep.insert(keep.end(), nodes.begin(), nodes.end());
  }
  if (p.has("to")) {  // of a link, one node for each of `nodes`
    for (const char* end : {"nodes", "to"}) {
      const std::vector<int> nodes = selected_nodes(p.nodes(end), geometry, p.where(end));
      keep.insert(keep.end(), nodes.begin(), nodes.end());
    }
  }
  if (p.has("toward_line") && p.line("toward_line").nodes) {
    const std::vector<int> nodes =
        selected_nodes(*p.line("toward_line").nodes, geometry, p.where("toward_line"));
    keep.insert(keep.end(), nodes.begin(), nodes.begin() + static_cast<long>(std::min(kFew, nodes.size())));
  }
}

}  // namespace

CoarsenOptions coarsen_options(const Scene& scene, const SceneGeometry& finest) {
  CoarsenOptions options;
  options.kinds = support_kinds(finest);
  std::vector<int> keep;
  for (const auto& [path, placed] : finest.networks)
    for (const Chord& chord : placed.network.chords)
      for (const ChordEnd& end : {chord.from, chord.to}) keep.push_back(placed.node(end));
  for (const auto& [name, pairs] : finest.links)
    for (const auto& pair : pairs) keep.insert(keep.end(), pair.begin(), pair.end());
  for (const TermSpec& term : scene.terms) {
    if (term.parameters.has("edges")) add_lines(term.parameters, finest, options.lines);
    add_named(term.parameters, finest, keep);
  }
  for (const int node : keep)
    if (node < finest.model.mesh.vertex_count()) options.keep.push_back(node);
  return options;
}

SceneGeometry coarsened(const SceneGeometry& finest, const TriangleMesh& coarse,
                        const std::vector<int>& kept) {
  const Model& fine = finest.model;
  const int fine_count = fine.mesh.vertex_count(), gone = fine_count - coarse.vertex_count();
  SceneGeometry geometry;
  geometry.finest = &finest;
  geometry.number.assign(static_cast<size_t>(fine.X.cols()), -1);
  std::vector<int> nodes = kept;  // the fine node of each node here
  for (int node = fine_count; node < fine.X.cols(); ++node) nodes.push_back(node);
  for (size_t k = 0; k < nodes.size(); ++k)
    geometry.number[static_cast<size_t>(nodes[k])] = static_cast<int>(k);

  Model& model = geometry.model;
  model.origin = fine.origin;
  model.mesh = coarse;
  model.X = fine.X(Eigen::all, nodes);
  model.obstacles = fine.obstacles.array() - gone;  // their nodes follow those of the mesh
  for (const auto& [name, set] : fine.sets) {
    std::vector<int>& here = model.sets[name];
    for (const int node : set)
      if (const int number = geometry.number[static_cast<size_t>(node)]; number >= 0) here.push_back(number);
  }
  geometry.networks = finest.networks;
  for (auto& [path, placed] : geometry.networks) {
    placed.first_papillary -= gone;
    placed.first_junction -= gone;
    for (Chord& chord : placed.network.chords)
      for (ChordEnd* end : {&chord.from, &chord.to})
        if (end->kind == ChordEnd::Kind::Leaflet)
          end->index = geometry.number[static_cast<size_t>(end->index)];
  }
  geometry.links = finest.links;
  for (auto& [name, pairs] : geometry.links)
    for (auto& pair : pairs)
      for (int& node : pair) node = geometry.number[static_cast<size_t>(node)];
  geometry.prescribed.fixed = finest.prescribed.fixed(Eigen::all, nodes);
  for (const auto& [node, path] : finest.prescribed.paths)
    if (const int number = geometry.number[static_cast<size_t>(node)]; number >= 0)
      geometry.prescribed.paths[number] = path;
  return geometry;
}

}  // namespace coapt
