#include "mesh/rim_order.hpp"

#include "mesh/triangle_mesh.hpp"

#include <algorithm>
#include <map>
#include <set>

namespace coapt {
namespace {

// One connected part of the boundary.
struct Rim {
  std::vector<int> vertices;  // in order where it is simple
  bool is_simple = true;      // every vertex has two neighbours
};

std::vector<Rim> rims_of(const Triangles& triangles) {
  std::map<int, std::vector<int>> neighbours;
  for (const Edge& edge : edges(triangles)) {
    if (edge.triangles.size() != 1) continue;
    // The way that the triangle runs comes last: the walk takes it first.
    const Eigen::Vector3i t = triangles.col(edge.triangles[0]);
    const bool runs_up = (t[0] == edge.a && t[1] == edge.b) || (t[1] == edge.a && t[2] == edge.b) ||
                         (t[2] == edge.a && t[0] == edge.b);
    const int from = runs_up ? edge.a : edge.b, to = runs_up ? edge.b : edge.a;
    neighbours[from].push_back(to);
    neighbours[to].insert(neighbours[to].begin(), from);
  }
  std::vector<Rim> rims;
  std::set<int> done;
  for (const auto& [start, ends] : neighbours) {
    if (done.contains(start)) continue;
    // Depth first: on a simple loop this is the walk around it.
    Rim rim;
    std::vector<int> open{start};
    while (!open.empty()) {
      const int vertex = open.back();
      open.pop_back();
      if (!done.insert(vertex).second) continue;
      rim.vertices.push_back(vertex);
      rim.is_simple = rim.is_simple && neighbours[vertex].size() == 2;
      open.insert(open.end(), neighbours[vertex].begin(), neighbours[vertex].end());
    }
    rims.push_back(std::move(rim));
  }
  return rims;
}

}  // namespace

bool is_same_loop(const std::vector<int>& a, const std::vector<int>& b) {
  if (a.size() != b.size()) return false;
  if (a.empty()) return true;
  std::vector<int> turned = a;
  for (int direction = 0; direction < 2; ++direction) {
    const auto first = std::find(turned.begin(), turned.end(), b.front());
    if (first == turned.end()) return false;
    std::rotate(turned.begin(), first, turned.end());
    if (turned == b) return true;
    std::reverse(turned.begin(), turned.end());
  }
  return false;
}

RimLoop rim_loop(const std::vector<int>& vertices, const Triangles& triangles) {
  RimLoop result{vertices};
  const std::set<int> wanted(vertices.begin(), vertices.end());
  if (vertices.size() < 3 || wanted.size() != vertices.size()) return result;
  std::vector<int> ordered;
  bool has_whole = false, is_simple = true;
  for (const Rim& rim : rims_of(triangles)) {
    const size_t before = ordered.size();
    for (const int vertex : rim.vertices)
      if (wanted.contains(vertex)) ordered.push_back(vertex);
    if (ordered.size() == before) continue;
    ++result.rims;
    has_whole = has_whole || ordered.size() - before == rim.vertices.size();
    is_simple = is_simple && rim.is_simple;
  }
  if (result.rims > 1 && !has_whole) result.rims = 0;
  const bool is_loop = result.rims == 1 && is_simple && ordered.size() == vertices.size();
  if (!is_loop || is_same_loop(ordered, vertices)) return result;
  std::rotate(ordered.begin(), std::find(ordered.begin(), ordered.end(), vertices.front()), ordered.end());
  result.vertices = std::move(ordered);
  result.is_reordered = true;
  return result;
}

std::string reordered_text() {
  return "its vertices did not follow one another around the rim; they were put in the order of the rim.";
}

std::string spans_rims_text(int rims) {
  return "its vertices lie on " + std::to_string(rims) +
         " rims of the mesh, one of them whole, which no closed loop can join; name the vertices of one rim";
}

}  // namespace coapt
