#include "formats/fe_model.hpp"

#include "mesh/rim_order.hpp"

#include <algorithm>
#include <cmath>
#include <set>

namespace coapt::formats {
namespace {

std::string plural(size_t count, const std::string& noun) {
  return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

// Lengths, areas and their squares must stay finite.
void refuse_far_nodes(const FeModel& model, Defects& defects) {
  const auto is_near = [](const Vec3& x) { return (x.array().abs() <= kGreatestCoordinate).all(); };
  for (Eigen::Index k = 0; k < model.nodes.cols(); ++k)
    if (!is_near(model.nodes.col(k)))
      defects.add("node", model.labels[static_cast<size_t>(k)],
                  "a coordinate is not finite or greater than 1e9 mm");
  for (const auto& [node, hold] : model.holds)
    if (!is_near(hold.displacement))
      defects.add("node", model.labels[static_cast<size_t>(node)],
                  "a displacement is not finite or greater than 1e9 mm");
  defects.throw_if_any();
}

// Vertex of each node, -1 where no triangle has it.
std::vector<int> number_vertices(const FeModel& model) {
  std::vector<int> vertex(static_cast<size_t>(model.nodes.cols()), -1);
  for (const FeTriangle& triangle : model.triangles)
    for (const int node : triangle.corners) vertex[static_cast<size_t>(node)] = 0;
  int count = 0;
  for (int& number : vertex)
    if (number == 0) number = count++;
  return vertex;
}

TriangleMesh leaflets_of(const FeModel& model, const std::vector<int>& vertex) {
  TriangleMesh mesh;
  const auto used = std::count_if(vertex.begin(), vertex.end(), [](int number) { return number >= 0; });
  mesh.vertices.resize(3, used);
  for (size_t node = 0; node < vertex.size(); ++node)
    if (vertex[node] >= 0) mesh.vertices.col(vertex[node]) = model.nodes.col(static_cast<Eigen::Index>(node));
  mesh.triangles.resize(3, static_cast<Eigen::Index>(model.triangles.size()));
  std::vector<int> renumbered(model.region_names.size(), -1);
  for (size_t t = 0; t < model.triangles.size(); ++t) {
    const FeTriangle& triangle = model.triangles[t];
    for (int k = 0; k < 3; ++k)
      mesh.triangles(k, static_cast<Eigen::Index>(t)) =
          vertex[static_cast<size_t>(triangle.corners[static_cast<size_t>(k)])];
    int& region = renumbered[static_cast<size_t>(triangle.region)];
    if (region < 0) {
      region = static_cast<int>(mesh.region_names.size());
      mesh.region_names.push_back(model.region_names[static_cast<size_t>(triangle.region)]);
    }
    mesh.regions.push_back(region);
  }
  return mesh;
}

// Turns the triangles to the side of the pressure, which must be one and uniform.
void apply_pressure(FeModel& model, Valve& valve, Defects& defects) {
  double low = 0, high = 0;
  size_t loaded = 0, turned = 0;
  for (const FeTriangle& triangle : model.triangles) {
    if (triangle.pressure == 0) continue;
    const double size = std::abs(triangle.pressure);
    low = loaded == 0 ? size : std::min(low, size);
    high = std::max(high, size);
    ++loaded;
    if (triangle.pressure < 0) ++turned;
  }
  if (loaded == 0) return;
  constexpr double kSame = 1e-9;
  if (high - low > kSame * high)
    defects.add("pressures from " + std::to_string(low) + " to " + std::to_string(high) +
                " act on the shells; a scene has one uniform pressure");
  if (turned > 0 && turned < loaded)
    defects.add("the pressure acts on the side of the normal of " + plural(loaded - turned, "triangle") +
                " and on the other side of " + plural(turned, "triangle") +
                "; orient the elements alike, or load one side");
  if (loaded < model.triangles.size())
    model.warnings.push_back(model.file + ": the pressure acts on " + std::to_string(loaded) + " of " +
                             plural(model.triangles.size(), "triangle") + "; the scene loads all of them.");
  if (turned == loaded)
    for (int t = 0; t < valve.leaflets.triangle_count(); ++t)
      std::swap(valve.leaflets.triangles(1, t), valve.leaflets.triangles(2, t));
  valve.pressure = high;
}

// Wholly held vertices on the rim, in its order; of several rims the one that has most of them.
std::vector<int> annulus_of(const std::vector<std::vector<int>>& loops, const std::vector<bool>& is_held) {
  std::vector<int> best;
  for (const std::vector<int>& loop : loops) {
    // Begin behind a free vertex, so that a part of a rim is one run.
    size_t begin = 0;
    for (size_t k = 0; k < loop.size(); ++k)
      if (!is_held[static_cast<size_t>(loop[k])]) begin = k;
    std::vector<int> held;
    for (size_t k = 0; k < loop.size(); ++k) {
      const int vertex = loop[(begin + k) % loop.size()];
      if (is_held[static_cast<size_t>(vertex)]) held.push_back(vertex);
    }
    if (held.size() > best.size()) best = std::move(held);
  }
  return best.size() >= 3 ? best : std::vector<int>{};
}

Points moved(const TriangleMesh& mesh, const std::vector<int>& vertices, const std::map<int, FeHold>& holds) {
  Points points(3, static_cast<Eigen::Index>(vertices.size()));
  bool moves = false;
  for (size_t k = 0; k < vertices.size(); ++k) {
    const Vec3& displacement = holds.at(vertices[k]).displacement;
    points.col(static_cast<Eigen::Index>(k)) = mesh.vertices.col(vertices[k]) + displacement;
    moves = moves || !displacement.isZero(0);
  }
  return moves ? points : Points(3, 0);
}

// A name that no set of the valve and no word of the scene has.
std::string free_name(const Valve& valve, const std::string& wanted) {
  static const std::set<std::string> kTaken = {
      "all",         "boundary", "papillary",        "junctions",      "annulus", "free_edge",
      "commissures", "leaflets", "papillary_closed", "annulus_closed", "chords"};
  const auto is_taken = [&](const std::string& name) {
    return kTaken.contains(name) || valve.sets.contains(name) ||
           std::any_of(valve.supports.begin(), valve.supports.end(),
                       [&](const Support& support) { return support.name == name; });
  };
  std::string name = wanted;
  for (int number = 2; is_taken(name); ++number) name = wanted + "_" + std::to_string(number);
  return name;
}

void fill_supports(const std::map<int, FeHold>& holds, Valve& valve) {
  const TriangleMesh& mesh = valve.leaflets;
  std::vector<bool> is_held(static_cast<size_t>(mesh.vertex_count()), false);
  for (const auto& [vertex, hold] : holds)
    is_held[static_cast<size_t>(vertex)] = hold.axes == std::array{true, true, true};
  const auto loops = boundary_loops(mesh.triangles);
  valve.annulus = annulus_of(loops, is_held);
  const std::set<int> annulus(valve.annulus.begin(), valve.annulus.end());
  std::vector<const std::vector<int>*> free_loops;
  for (const std::vector<int>& loop : loops)
    if (std::none_of(loop.begin(), loop.end(), [&](int vertex) { return annulus.contains(vertex); }))
      free_loops.push_back(&loop);
  if (!annulus.empty() && free_loops.size() == 1) valve.free_edge = *free_loops[0];

  std::map<std::array<bool, 3>, std::vector<int>> groups;
  for (const auto& [vertex, hold] : holds)
    if (!annulus.contains(vertex) && hold.axes != std::array{false, false, false})
      groups[hold.axes].push_back(vertex);
  for (const auto& [axes, vertices] : groups) {
    std::string name = "support_";
    for (size_t c = 0; c < 3; ++c)
      if (axes[c]) name += "xyz"[c];
    valve.supports.push_back({free_name(valve, name), vertices, axes, moved(mesh, vertices, holds)});
  }
}

// Sets of vertices alone that name some of them. Those with a meaning of their own fill it, but an annulus
// must be what is held. Sets are often sorted by label: a loop keeps the order of the rim unless the set goes
// round it too.
void fill_sets(const FeModel& model, const std::vector<int>& vertex, Valve& valve) {
  for (const auto& [name, nodes] : model.node_sets) {
    std::vector<int> vertices;
    for (const int node : nodes) vertices.push_back(vertex[static_cast<size_t>(node)]);
    const bool are_vertices = !vertices.empty() && *std::min_element(vertices.begin(), vertices.end()) >= 0;
    const std::set<int> different(vertices.begin(), vertices.end());
    if (!are_vertices || static_cast<int>(different.size()) == valve.leaflets.vertex_count()) continue;
    const std::set<int> annulus(valve.annulus.begin(), valve.annulus.end());
    if (name == "commissures") {
      valve.commissures = std::move(vertices);
    } else if (name == "free_edge") {
      valve.free_edge = rim_loop(vertices, valve.leaflets.triangles).vertices;
    } else if (name == "annulus" && different == annulus) {
      if (is_same_loop(valve.annulus, vertices)) valve.annulus = std::move(vertices);
    } else {
      valve.sets[free_name(valve, name)] = std::move(vertices);
    }
  }
}

// A support of the vertices of a set has its name.
void name_supports(Valve& valve) {
  for (Support& support : valve.supports)
    for (auto set = valve.sets.begin(); set != valve.sets.end(); ++set)
      if (set->second == support.vertices) {
        support.name = set->first;
        valve.sets.erase(set);
        break;
      }
}

}  // namespace

Valve valve_of(FeModel& model) {
  Defects defects(model.file);
  refuse_far_nodes(model, defects);
  if (model.triangles.empty() && model.lines.empty())
    defects.fail("holds no shells, membranes or lines of tension");
  if (model.triangles.empty()) defects.fail("holds no shells or membranes; a valve has leaflets");
  const std::vector<int> vertex = number_vertices(model);
  Valve valve;
  valve.name = model.name;
  valve.thickness = model.thickness;
  valve.leaflets = leaflets_of(model, vertex);
  for (const std::string& name : valve.leaflets.region_names)
    if (const auto found = model.membranes.find(name); found != model.membranes.end())
      valve.membranes.insert(*found);
  apply_pressure(model, valve, defects);
  std::map<int, FeHold> holds;
  for (const auto& [node, hold] : model.holds)
    if (const int number = vertex[static_cast<size_t>(node)]; number >= 0) holds[number] = hold;
  fill_supports(holds, valve);
  fill_sets(model, vertex, valve);
  name_supports(valve);
  valve.annulus_closed = moved(valve.leaflets, valve.annulus, holds);
  fill_chords(model, vertex, valve, defects);
  defects.throw_if_any();
  return valve;
}

}  // namespace coapt::formats
