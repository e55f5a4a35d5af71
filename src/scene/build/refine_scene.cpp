#include "scene/build/refine_scene.hpp"

#include "mesh/remesh/uniform_refinement.hpp"

#include <algorithm>
#include <functional>
#include <map>

namespace coapt {
namespace {

// One cut of a mesh into four, and where the nodes went.
class Cut {
 public:
  explicit Cut(const Model& model)
      : old_count_(model.mesh.vertex_count()),
        finer(refined_uniformly(model.mesh)),
        is_boundary_(static_cast<size_t>(old_count_), false),
        beside_(finer.parents.size()) {
    for (size_t k = 0; k < finer.parents.size(); ++k) number_[finer.parents[k]] = k;
    for (const Edge& edge : edges(model.mesh.triangles)) {
      const size_t k = number_.at({edge.a, edge.b});
      if (edge.triangles.size() == 1)
        is_boundary_[static_cast<size_t>(edge.a)] = is_boundary_[static_cast<size_t>(edge.b)] = true;
      for (const int t : edge.triangles)
        beside_[k].push_back(model.mesh.triangles.col(t).sum() - edge.a - edge.b);
    }
  }

  int added() const { return static_cast<int>(finer.parents.size()); }
  int moved(int node) const { return node < old_count_ ? node : node + added(); }
  int middle(size_t edge) const { return old_count_ + static_cast<int>(edge); }

  // The edge between two nodes, or -1.
  long edge_between(int a, int b) const {
    const auto found = number_.find({std::min(a, b), std::max(a, b)});
    return found == number_.end() ? -1 : static_cast<long>(found->second);
  }

  // Whether the middle of an edge belongs to nodes to which both its ends belong.
  bool belongs(size_t edge, const std::function<bool(int)>& contains) const {
    const auto [a, b] = finer.parents[edge];
    if (!contains(a) || !contains(b)) return false;
    const std::vector<int>& beside = beside_[edge];
    if (beside.size() == 1 || !is_boundary(a) || !is_boundary(b)) return true;
    return std::any_of(beside.begin(), beside.end(), [&](int v) { return !is_boundary(v) && contains(v); });
  }

 private:
  bool is_boundary(int vertex) const { return is_boundary_[static_cast<size_t>(vertex)]; }

  int old_count_;

 public:
  FinerMesh finer;

 private:
  std::vector<bool> is_boundary_;         // of each old vertex
  std::vector<std::vector<int>> beside_;  // of each edge: the vertices opposite to it
  std::map<std::array<int, 2>, size_t> number_;
};

// The set with the middles of its edges, each behind the first of the ends that follow each other in it.
std::vector<int> refined_set(const std::vector<int>& set, const Cut& cut, Eigen::Index old_nodes) {
  std::vector<bool> is_member(static_cast<size_t>(old_nodes), false),
      is_placed(cut.finer.parents.size(), false);
  for (const int node : set) is_member[static_cast<size_t>(node)] = true;
  const auto contains = [&](int node) { return is_member[static_cast<size_t>(node)]; };
  std::vector<int> result;
  for (size_t k = 0; k < set.size(); ++k) {
    result.push_back(cut.moved(set[k]));
    const long edge = cut.edge_between(set[k], set[(k + 1) % set.size()]);
    if (edge < 0 || is_placed[static_cast<size_t>(edge)] || !cut.belongs(static_cast<size_t>(edge), contains))
      continue;
    is_placed[static_cast<size_t>(edge)] = true;
    result.push_back(cut.middle(static_cast<size_t>(edge)));
  }
  for (size_t edge = 0; edge < is_placed.size(); ++edge)
    if (!is_placed[edge] && cut.belongs(edge, contains)) result.push_back(cut.middle(edge));
  return result;
}

// The pairs with those of the middles of edges whose ends are joined, so that a seam stays one.
std::vector<std::array<int, 2>> refined_links(const std::vector<std::array<int, 2>>& pairs, const Cut& cut) {
  std::vector<std::array<int, 2>> result;
  for (const auto& [a, b] : pairs) result.push_back({cut.moved(a), cut.moved(b)});
  for (size_t i = 0; i < pairs.size(); ++i)
    for (size_t j = i + 1; j < pairs.size(); ++j) {
      const long first = cut.edge_between(pairs[i][0], pairs[j][0]),
                 second = cut.edge_between(pairs[i][1], pairs[j][1]);
      if (first >= 0 && second >= 0)
        result.push_back({cut.middle(static_cast<size_t>(first)), cut.middle(static_cast<size_t>(second))});
    }
  return result;
}

Prescribed refined_supports(const Prescribed& coarse, const Points& X, const Cut& cut, int old_vertices) {
  Prescribed fine;
  fine.fixed = FixedMask::Constant(3, X.cols() + cut.added(), false);
  for (int node = 0; node < X.cols(); ++node) fine.fixed.col(cut.moved(node)) = coarse.fixed.col(node);
  for (const auto& [node, path] : coarse.paths) fine.paths[cut.moved(node)] = path;
  for (size_t edge = 0; edge < cut.finer.parents.size(); ++edge) {
    const int middle = old_vertices + static_cast<int>(edge);
    for (int c = 0; c < 3; ++c)
      fine.fixed(c, middle) = cut.belongs(edge, [&](int node) { return coarse.fixed(c, node); });
    if (!fine.fixed.col(middle).any()) continue;
    size_t stations = 0;
    for (const int end : cut.finer.parents[edge])
      if (const auto path = coarse.paths.find(end); path != coarse.paths.end())
        stations = std::max(stations, path->second.size());
    for (size_t k = 1; k <= stations; ++k) {
      Vec3 sum = Vec3::Zero();
      for (const int end : cut.finer.parents[edge]) {
        const auto path = coarse.paths.find(end);
        sum += path == coarse.paths.end()
                   ? Vec3(X.col(end))
                   : place_on_path(X.col(end), path->second,
                                   static_cast<double>(k) / static_cast<double>(stations));
      }
      fine.paths[middle].push_back(0.5 * sum);
    }
  }
  return fine;
}

}  // namespace

SceneGeometry refined(const SceneGeometry& geometry) {
  const Model& coarse = geometry.model;
  const int old_vertices = coarse.mesh.vertex_count();
  const Cut cut(coarse);
  SceneGeometry fine;
  fine.finest = geometry.finest != nullptr ? geometry.finest : &geometry;
  fine.is_refined = true;
  fine.coarser = &geometry;
  fine.parents = cut.finer.parents;
  const auto count = fine.finest->model.X.cols();
  for (int node = 0; node < count; ++node)
    fine.number.push_back(
        cut.moved(geometry.finest != nullptr ? geometry.number[static_cast<size_t>(node)] : node));

  Model& model = fine.model;
  model.origin = coarse.origin;
  model.mesh = cut.finer.mesh;
  model.X.resize(3, coarse.X.cols() + cut.added());
  model.X.leftCols(model.mesh.vertex_count()) = model.mesh.vertices;
  model.X.rightCols(coarse.X.cols() - old_vertices) = coarse.X.rightCols(coarse.X.cols() - old_vertices);
  model.obstacles = coarse.obstacles.array() + cut.added();  // their nodes follow those of the mesh
  model.closed_reference = coarse.closed_reference;
  model.registration = coarse.registration;
  for (const auto& [name, set] : coarse.sets) model.sets[name] = refined_set(set, cut, coarse.X.cols());
  std::vector<int>& all = model.sets["all"];
  all.clear();
  for (int node = 0; node < model.X.cols(); ++node) all.push_back(node);

  fine.networks = geometry.networks;
  for (auto& [path, placed] : fine.networks) {
    placed.first_papillary += cut.added();
    placed.first_junction += cut.added();
  }
  for (const auto& [name, pairs] : geometry.links) fine.links[name] = refined_links(pairs, cut);
  fine.prescribed = refined_supports(geometry.prescribed, coarse.X, cut, old_vertices);
  return fine;
}

}  // namespace coapt
