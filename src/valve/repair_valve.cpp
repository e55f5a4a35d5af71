#include "valve/repair_valve.hpp"

#include "mesh/distance/surface_distance.hpp"

#include <algorithm>

namespace coapt {
namespace {

constexpr std::uint64_t kAnnulusRole = 1;
constexpr size_t kMostRoles = 63;  // of supports; vertices of further ones stay

RepairConstraints constraints_of(const Valve& valve, double aspect) {
  const auto count = static_cast<size_t>(valve.leaflets.vertex_count());
  RepairConstraints constraints;
  constraints.aspect = aspect;
  constraints.roles.assign(count, 0);
  constraints.stays.assign(count, false);
  for (const int v : valve.annulus) constraints.roles[static_cast<size_t>(v)] |= kAnnulusRole;
  for (size_t k = 0; k < valve.supports.size(); ++k)
    for (const int v : valve.supports[k].vertices) {
      if (k < kMostRoles)
        constraints.roles[static_cast<size_t>(v)] |= kAnnulusRole << (k + 1);
      else
        constraints.stays[static_cast<size_t>(v)] = true;
    }
  constraints.uncut_roles = ~kAnnulusRole;
  for (const int v : valve.commissures) constraints.stays[static_cast<size_t>(v)] = true;
  for (const Chord& chord : valve.chords.chords)
    for (const ChordEnd& end : {chord.from, chord.to})
      if (end.kind == ChordEnd::Kind::Leaflet) constraints.stays[static_cast<size_t>(end.index)] = true;
  return constraints;
}

// Where a closed loop runs from one end of the edge to the other; -1: nowhere. The place is before the
// entry that is returned.
int place_between(const std::vector<int>& loop, const std::array<int, 2>& edge) {
  for (size_t k = 0; k < loop.size(); ++k) {
    const int a = loop[k], b = loop[(k + 1) % loop.size()];
    if ((a == edge[0] && b == edge[1]) || (a == edge[1] && b == edge[0])) return static_cast<int>(k) + 1;
  }
  return -1;
}

void insert_column(Points& points, int at, const Vec3& point) {
  const Points tail = points.rightCols(points.cols() - at);
  points.conservativeResize(3, points.cols() + 1);
  points.col(at) = point;
  points.rightCols(tail.cols()) = tail;
}

// The rim runs through the apex of a triangle that was cut off.
void reroute(const RepairStep& step, Valve& valve) {
  const auto has_apex = [&](const std::vector<int>& loop) {
    return std::find(loop.begin(), loop.end(), step.apex) != loop.end();
  };
  if (const int at = place_between(valve.free_edge, step.edge); at >= 0 && !has_apex(valve.free_edge))
    valve.free_edge.insert(valve.free_edge.begin() + at, step.apex);
  const int at = place_between(valve.annulus, step.edge);
  if (at < 0 || has_apex(valve.annulus)) return;
  if (valve.annulus_closed.cols() > 0) {
    const size_t before = static_cast<size_t>(at) - 1, after = static_cast<size_t>(at) % valve.annulus.size();
    const Points& x = valve.leaflets.vertices;
    const Vec3 from = x.col(valve.annulus[before]), along = x.col(valve.annulus[after]) - from;
    const double share = (x.col(step.apex) - from).dot(along) / along.squaredNorm();
    insert_column(valve.annulus_closed, at,
                  (1 - share) * valve.annulus_closed.col(static_cast<Eigen::Index>(before)) +
                      share * valve.annulus_closed.col(static_cast<Eigen::Index>(after)));
  }
  valve.annulus.insert(valve.annulus.begin() + at, step.apex);
}

// One of two merged vertices leaves a list, with its position where there are positions.
void merge_in(std::vector<int>& list, Points* positions, int gone, int into) {
  const auto found = std::find(list.begin(), list.end(), gone);
  if (found == list.end()) return;
  if (std::find(list.begin(), list.end(), into) == list.end()) {
    *found = into;
    return;
  }
  if (positions != nullptr && positions->cols() > 0) {
    const auto at = static_cast<Eigen::Index>(found - list.begin());
    const Points tail = positions->rightCols(positions->cols() - at - 1);
    positions->middleCols(at, tail.cols()) = tail;
    positions->conservativeResize(3, positions->cols() - 1);
  }
  list.erase(found);
}

void renumber(const std::vector<int>& number, Valve& valve) {
  // A set of a file may name vertices that do not exist; those nobody takes.
  const auto renumbered = [&](std::vector<int>& list) {
    for (int& v : list)
      if (v >= 0 && static_cast<size_t>(v) < number.size()) v = number[static_cast<size_t>(v)];
  };
  renumbered(valve.annulus);
  renumbered(valve.free_edge);
  renumbered(valve.commissures);
  for (auto& [name, set] : valve.sets) renumbered(set);
  for (Support& support : valve.supports) renumbered(support.vertices);
  for (Chord& chord : valve.chords.chords)
    for (ChordEnd* end : {&chord.from, &chord.to})
      if (end->kind == ChordEnd::Kind::Leaflet) end->index = number[static_cast<size_t>(end->index)];
}

void carry_lists(const MeshRepair& repair, Valve& valve) {
  for (const RepairStep& step : repair.steps) {
    if (step.kind == RepairKind::Cut) reroute(step, valve);
    if (step.kind != RepairKind::Collapse) continue;
    const auto [gone, into] = step.edge;
    merge_in(valve.annulus, &valve.annulus_closed, gone, into);
    merge_in(valve.free_edge, nullptr, gone, into);
    for (auto& [name, set] : valve.sets) merge_in(set, nullptr, gone, into);
    for (Support& support : valve.supports) merge_in(support.vertices, &support.closed, gone, into);
  }
  renumber(repair.number, valve);
}

// The reference on the triangles of the repaired leaflets; vertices that were merged lose their positions.
TriangleMesh reference_alike(const TriangleMesh& before, const MeshRepair& repair) {
  std::vector<bool> is_merged(repair.number.size(), false);
  for (const RepairStep& step : repair.steps)
    if (step.kind == RepairKind::Collapse) is_merged[static_cast<size_t>(step.edge[0])] = true;
  TriangleMesh after;
  after.region_names = before.region_names;
  after.triangles = repair.mesh.triangles;
  after.vertices.resize(3, repair.mesh.vertex_count());
  for (size_t v = 0; v < is_merged.size(); ++v)
    if (!is_merged[v])
      after.vertices.col(repair.number[v]) = before.vertices.col(static_cast<Eigen::Index>(v));
  for (size_t t = 0; t < before.regions.size(); ++t)
    if (repair.triangle[t] >= 0) after.regions.push_back(before.regions[t]);
  return after;
}

bool is_same_mesh(const TriangleMesh& a, const TriangleMesh& b) {
  return a.vertex_count() == b.vertex_count() && a.triangle_count() == b.triangle_count() &&
         a.triangles == b.triangles;
}

}  // namespace

ValveRepair repair_valve(Valve& valve, double aspect) {
  ValveRepair repair;
  const TriangleMesh given = valve.leaflets;
  repair.leaflets = repair_slivers(given, constraints_of(valve, aspect));
  if (!repair.leaflets.is_changed()) return repair;
  carry_lists(repair.leaflets, valve);
  valve.leaflets = repair.leaflets.mesh;
  if (!valve.closed_reference || !is_same_mesh(given, *valve.closed_reference)) return repair;
  repair.has_reference = true;
  const TriangleMesh before = *valve.closed_reference;
  valve.closed_reference = reference_alike(before, repair.leaflets);
  repair.reference_move = std::max(surface_distance(before, *valve.closed_reference).max,
                                   surface_distance(*valve.closed_reference, before).max);
  return repair;
}

}  // namespace coapt
