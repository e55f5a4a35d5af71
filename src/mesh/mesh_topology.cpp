#include "mesh/mesh_topology.hpp"

#include "core/error.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <string>
#include <utility>

namespace coapt {
namespace {

// Sets that grow together; the root of a set is its smallest member.
class DisjointSets {
 public:
  explicit DisjointSets(size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0); }

  int root(int i) {
    while (parent_[static_cast<size_t>(i)] != i) {
      int& parent = parent_[static_cast<size_t>(i)];
      parent = parent_[static_cast<size_t>(parent)];
      i = parent;
    }
    return i;
  }
  void join(int i, int j) {
    i = root(i);
    j = root(j);
    parent_[static_cast<size_t>(std::max(i, j))] = std::min(i, j);
  }

 private:
  std::vector<int> parent_;
};

int position_in(const Eigen::Vector3i& triangle, int vertex) {
  return triangle[0] == vertex ? 0 : triangle[1] == vertex ? 1 : 2;
}

// Whether the triangle runs from a to b along their edge.
bool runs_forward(const Eigen::Vector3i& triangle, int a, int b) {
  return triangle[(position_in(triangle, a) + 1) % 3] == b;
}

struct Neighbour {
  int triangle;
  bool agrees;
};

std::vector<std::vector<Neighbour>> neighbours_of(const TriangleMesh& mesh) {
  std::vector<std::vector<Neighbour>> neighbours(static_cast<size_t>(mesh.triangle_count()));
  for (const Edge& edge : edges(mesh.triangles)) {
    if (edge.triangles.size() != 2 || edge.a == edge.b || edge.triangles[0] == edge.triangles[1]) continue;
    const int s = edge.triangles[0], t = edge.triangles[1];
    const bool agrees = runs_forward(mesh.triangles.col(s), edge.a, edge.b) !=
                        runs_forward(mesh.triangles.col(t), edge.a, edge.b);
    neighbours[static_cast<size_t>(s)].push_back({t, agrees});
    neighbours[static_cast<size_t>(t)].push_back({s, agrees});
  }
  return neighbours;
}

}  // namespace

Components connected_components(const TriangleMesh& mesh) {
  const auto vertex_count = static_cast<size_t>(mesh.vertex_count());
  DisjointSets sets(vertex_count);
  std::vector<bool> used(vertex_count, false);
  for (int t = 0; t < mesh.triangle_count(); ++t)
    for (int k = 0; k < 3; ++k) {
      sets.join(mesh.triangles(0, t), mesh.triangles(k, t));
      used[static_cast<size_t>(mesh.triangles(k, t))] = true;
    }
  Components result;
  result.of_vertex.assign(vertex_count, -1);
  for (size_t i = 0; i < vertex_count; ++i) {
    if (!used[i]) continue;
    const int root = sets.root(static_cast<int>(i));  // the smallest vertex: numbered before the others
    result.of_vertex[i] =
        root == static_cast<int>(i) ? result.count++ : result.of_vertex[static_cast<size_t>(root)];
  }
  for (int t = 0; t < mesh.triangle_count(); ++t)
    result.of_triangle.push_back(result.of_vertex[static_cast<size_t>(mesh.triangles(0, t))]);
  return result;
}

Orientation consistent_orientation(const TriangleMesh& mesh) {
  const auto count = static_cast<size_t>(mesh.triangle_count());
  const auto neighbours = neighbours_of(mesh);
  Orientation result;
  result.flip.assign(count, false);
  std::vector<bool> seen(count, false);
  for (size_t start = 0; start < count; ++start) {
    if (seen[start]) continue;
    std::vector<size_t> part = {start};
    seen[start] = true;
    double kept_area = 0, flipped_area = 0;
    for (size_t i = 0; i < part.size(); ++i) {
      const size_t t = part[i];
      const double area = area_vector(mesh.vertices, mesh.triangles.col(static_cast<Eigen::Index>(t))).norm();
      (result.flip[t] ? flipped_area : kept_area) += area;
      for (const Neighbour& next : neighbours[t]) {
        const auto n = static_cast<size_t>(next.triangle);
        const bool flip = result.flip[t] != !next.agrees;
        if (!seen[n]) {
          seen[n] = true;
          result.flip[n] = flip;
          part.push_back(n);
        } else if (result.flip[n] != flip) {
          result.one_sided.push_back(static_cast<int>(t));
        }
      }
    }
    if (flipped_area > kept_area)
      for (const size_t t : part) result.flip[t] = !result.flip[t];
  }
  std::sort(result.one_sided.begin(), result.one_sided.end());
  result.one_sided.erase(std::unique(result.one_sided.begin(), result.one_sided.end()),
                         result.one_sided.end());
  result.flip_count = static_cast<int>(std::count(result.flip.begin(), result.flip.end(), true));
  return result;
}

TriangleMesh orient_consistently(const TriangleMesh& mesh) {
  const Orientation orientation = consistent_orientation(mesh);
  if (!orientation.one_sided.empty())
    throw InputError("the surface has one side only (it closes on itself with a twist at triangle " +
                     std::to_string(orientation.one_sided[0]) + "); it cannot be oriented");
  TriangleMesh result = mesh;
  for (int t = 0; t < mesh.triangle_count(); ++t)
    if (orientation.flip[static_cast<size_t>(t)]) std::swap(result.triangles(1, t), result.triangles(2, t));
  return result;
}

std::vector<int> first_coincident(const Points& vertices) {
  const auto count = static_cast<size_t>(vertices.cols());
  std::vector<int> order(count), first(count);
  std::iota(order.begin(), order.end(), 0);
  const auto key = [&](int i) {
    return std::array<double, 3>{vertices(0, i), vertices(1, i), vertices(2, i)};
  };
  std::sort(order.begin(), order.end(),
            [&](int l, int r) { return std::pair(key(l), l) < std::pair(key(r), r); });
  for (size_t i = 0; i < count; ++i) {
    const bool is_same = i > 0 && key(order[i]) == key(order[i - 1]);
    first[static_cast<size_t>(order[i])] = is_same ? first[static_cast<size_t>(order[i - 1])] : order[i];
  }
  return first;
}

WeldedMesh weld(const TriangleMesh& mesh) {
  WeldedMesh result;
  result.mesh = mesh;
  result.new_index = first_coincident(mesh.vertices);
  int kept = 0;
  for (int i = 0; i < mesh.vertex_count(); ++i) {
    int& index = result.new_index[static_cast<size_t>(i)];
    if (index != i) {
      index = result.new_index[static_cast<size_t>(index)];  // a smaller number: already renumbered
      continue;
    }
    result.mesh.vertices.col(kept) = mesh.vertices.col(i);
    index = kept++;
  }
  result.removed = mesh.vertex_count() - kept;
  result.mesh.vertices.conservativeResize(3, kept);
  for (int t = 0; t < mesh.triangle_count(); ++t)
    for (int k = 0; k < 3; ++k)
      result.mesh.triangles(k, t) = result.new_index[static_cast<size_t>(mesh.triangles(k, t))];
  return result;
}

std::vector<int> bowtie_vertices(const TriangleMesh& mesh) {
  DisjointSets corners(static_cast<size_t>(mesh.triangle_count()) * 3);  // corner k of triangle t: 3 t + k
  for (const Edge& edge : edges(mesh.triangles))
    for (const int vertex : {edge.a, edge.b}) {
      const auto corner = [&](int t) { return 3 * t + position_in(mesh.triangles.col(t), vertex); };
      for (const int t : edge.triangles) corners.join(corner(edge.triangles[0]), corner(t));
    }
  std::vector<int> fans(static_cast<size_t>(mesh.vertex_count()), 0);
  for (int t = 0; t < mesh.triangle_count(); ++t)
    for (int k = 0; k < 3; ++k)
      if (corners.root(3 * t + k) == 3 * t + k) ++fans[static_cast<size_t>(mesh.triangles(k, t))];
  std::vector<int> result;
  for (size_t i = 0; i < fans.size(); ++i)
    if (fans[i] > 1) result.push_back(static_cast<int>(i));
  return result;
}

}  // namespace coapt
